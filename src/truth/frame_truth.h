#pragma once
// The truth of one frame, as far as the scene asks for it.

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "motion/interior/motion_field.h"
#include "motion/mesh_motion.h"
#include "truth/contour.h"
#include "truth/label_table.h"
#include "truth/motion_planes.h"
#include "truth/plane_labels.h"

namespace echocine {

struct FrameTruth {
  PlaneLabels::Ids picture_ids;           // structures at the picture's pixels, from 1
  std::vector<std::uint8_t> labels;       // the same by the scene's numbers
  std::vector<std::uint32_t> sample_ids;  // structures at the samples
  std::vector<Contour> contours;          // whole, before the sector cuts them
  MotionPlanes motion;
  // A channel's plane; one of the two is empty.
  std::span<const float> values(Channel channel) const;
};

// An instant and its neighbours, from which velocity is taken.
struct TruthTime {
  double phase = 0, before = 0, after = 0;
  double seconds = 0;  // from before to after
};

class TruthMaker {
 public:
  // References are kept. The field is fitted at once where motion is asked for.
  TruthMaker(const Scene& scene, const MeshMotion& motion, const PictureGrid& grid,
             double first_phase);

  const LabelTable& labels() const { return labels_; }
  const std::optional<MotionField>& field() const { return field_; }

  // Thread-safe.
  FrameTruth at(const TruthTime& time) const;

  static bool wanted(const Scene& scene);

 private:
  struct Space;
  std::shared_ptr<Space> space() const;
  void addMotion(const TruthTime& time, Space& space, FrameTruth& truth) const;

  const Scene& scene_;
  const MeshMotion& motion_;
  LabelTable labels_;
  PlaneLabels plane_;
  bool samples_, motion_wanted_, velocity_;
  std::optional<MotionField> field_;
  FieldFrame first_;  // the loop's first frame
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Space>> free_;
};

}  // namespace echocine
