#pragma once
// The material points of a scene's meshes.

#include <memory>
#include <mutex>
#include <utility>

#include "motion/interior/motion_field.h"
#include "motion/surfaces/mesh_motion.h"

namespace echocine {

// The field of everything that the scene's surfaces move, fitted to them as they are drawn
// (refined), with `accuracy.motion_field_cells`. References to neither are kept.
MotionField interiorMotion(const Scene& scene, const MeshMotion& motion);

// The field of a scene for all that ask for it: fitted once, by the first call.
class SharedMotionField {
 public:
  // References are kept until the field is fitted. known: the field, if it is known; null: not.
  SharedMotionField(const Scene& scene, const MeshMotion& motion,
                    std::shared_ptr<const MotionField> known = nullptr)
      : scene_(scene), motion_(motion), field_(std::move(known)) {}

  // Thread-safe. An error leaves the field to be fitted by the next call.
  const MotionField& field() const { return *shared(); }
  // The same, for an owner that outlives this.
  const std::shared_ptr<const MotionField>& shared() const;

 private:
  const Scene& scene_;
  const MeshMotion& motion_;
  mutable std::once_flag once_;
  mutable std::shared_ptr<const MotionField> field_;
};

}  // namespace echocine
