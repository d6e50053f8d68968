#pragma once
// The truth of one frame, as far as the scene asks for it.

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
// planes_only: what stands at pixels and samples; nothing of contours, function and tracks.
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
  // References are kept. The field is fitted at once where motion is asked for, without `shared` by
  // this object. along_paths: at() is always given paths.
  TruthMaker(const Scene& scene, const MeshMotion& motion, const PictureGrid& grid,
             double first_phase, bool along_paths = false,
             const SharedMotionField* shared = nullptr);
  ~TruthMaker();

  const LabelTable& labels() const { return labels_; }
  // Null where nothing of truth moves.
  const MotionField* field() const { return field_; }

  // The material points that are tracked: endocardium, middle and epicardium of so many columns
  // through the wall, those nearest to the imaging plane at the reference phase.
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

  // Which paths at() needs where the picture does not show things at straight path lengths: as
  // close as half a pixel at the deepest sample, so that labels are within a quarter of one.
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
