#pragma once
// The ground truth of one frame that the scene requests.

#include <memory>
#include <optional>
#include <vector>

#include "core/free_list.h"
#include "motion/surfaces/interior_motion.h"
#include "motion/surfaces/mesh_motion.h"
#include "truth/contour.h"
#include "truth/heart_function.h"
#include "truth/label_table.h"
#include "truth/motion_planes.h"
#include "truth/plane_labels.h"
#include "truth/shown_labels.h"
#include "truth/truth_values.h"
#include "truth/valve_times.h"
#include "truth/view_offset.h"

namespace echocine {

// An instant and its neighbours, from which velocity is taken.
// planes_only: values at pixels and samples; no contours, function or tracks.
struct TruthTime {
  double phase = 0, before = 0, after = 0;  // phases of the keyframes, [0, 1)
  double seconds = 0;                       // from before to after
  bool planes_only = false;
};

// Results that the tracer already has for the same phase; null if it has none.
struct TruthShared {
  const SurfaceFrame* surfaces = nullptr;
  const PlaneSlice* slice = nullptr;  // of all surfaces
  const SoundPaths* paths = nullptr;  // those that TruthMaker::pathsFor() names
};

class TruthMaker {
 public:
  // References are kept. If motion is requested and `shared` is absent, the constructor fits the
  // field. along_paths: every call of at() gives paths.
  TruthMaker(const Scene& scene, const MeshMotion& motion, const PictureGrid& grid,
             double first_phase, bool along_paths = false,
             const SharedMotionField* shared = nullptr);
  ~TruthMaker();

  const LabelTable& labels() const { return labels_; }
  // Null if no requested truth needs motion.
  const MotionField* field() const { return field_; }

  // The tracked material points: endocardium, middle and epicardium of the wall columns that are
  // nearest to the imaging plane at the reference phase.
  struct Tracked {
    std::uint8_t layer;    // 0 endocardium, 1 middle, 2 epicardium
    std::uint8_t segment;  // 1 to 17
    std::uint32_t column;  // of HeartFunction::columns()
  };
  const std::vector<Tracked>& tracked() const { return tracked_; }

  // For the whole loop, if function is requested: the left ventricle's valves (none if its
  // volume does not change), and the view at end-diastole (none without the roles of a heart).
  const std::optional<ValveTimes>& valves() const { return valves_; }
  const std::optional<ViewOffset>& view() const { return view_; }

  // Thread-safe.
  FrameTruth at(const TruthTime& time, const TruthShared& shared = {}) const;

  static bool wanted(const Scene& scene);

  // The paths that at() needs if the picture does not show echoes at straight path lengths. They
  // are at most half a pixel apart at the deepest sample, so labels are within a quarter pixel.
  static SoundPaths pathsFor(const Scene& scene, const PictureGrid& grid);

 private:
  struct Space;
  std::shared_ptr<Space> space() const;
  void chooseTracks();
  void lookAtBeat();
  FieldPart tissueInPlane() const;
  void addTracks(const SurfaceFrame& surfaces, const Space& space, FrameTruth& truth) const;
  void numberLabels(FrameTruth& truth) const;
  const PlaneSlice& sliceOf(const SurfaceFrame& surfaces, const TruthShared& shared,
                            Space& space) const;
  void addPlanes(const SurfaceFrame& surfaces, const TruthSettings& wanted,
                 const TruthShared& shared, Space& space, FrameTruth& truth) const;
  FieldPart partAround(const SoundPaths* paths) const;
  void addMotion(const TruthTime& time, const SoundPaths* paths, Space& space,
                 FrameTruth& truth) const;

  const Scene& scene_;
  const MeshMotion& motion_;
  LabelTable labels_;
  PlaneLabels plane_;
  std::optional<ShownLabels> shown_;
  bool samples_, motion_wanted_, velocity_;
  std::optional<SharedMotionField> own_field_;
  const MotionField* field_ = nullptr;
  std::optional<HeartFunction> function_;
  std::vector<Tracked> tracked_;
  FieldPart in_plane_, about_tracks_;  // what a frame blends for motion and for tracks
  std::optional<ValveTimes> valves_;
  std::optional<ViewOffset> view_;
  FieldFrame first_;  // the loop's first frame
  mutable FreeList<Space> spaces_;
};

}  // namespace echocine
