#pragma once
// Tissue as the motion field carries it: speckle and truth move by one field.

#include <memory>
#include <optional>

#include "motion/surfaces/interior_motion.h"
#include "motion/surfaces/trabeculae.h"
#include "speckle/block_reach.h"
#include "speckle/material.h"
#include "speckle/tissue_strength.h"

namespace echocine {

class FieldMaterial : public Material {
 public:
  // Tissue is uniform unless the plan has heterogeneity or anisotropy; no plan: neither.
  // Trabeculae that stand in a cavity belong to the wall behind them. `shared` is kept by
  // reference; null: a field of its own.
  FieldMaterial(const Scene& scene, const MeshMotion& motion, const EffectPlan* plan = nullptr,
                const Trabeculae* trabeculae = nullptr, const SharedMotionField* shared = nullptr);
  ~FieldMaterial() override;

  CubeLattice lattice() const override { return lattice_; }
  bool blood(std::uint16_t group) const override { return blood_[group]; }
  float surroundings(std::uint16_t group) const override { return surroundings_[group]; }
  bool coarse(std::uint16_t group) const override { return coarse_[group]; }
  std::vector<std::uint16_t> groupsIn(Vec3f low_m) const override;
  void groupsAt(std::span<const Vec3f> reference_m, std::span<std::uint16_t> groups) const override;
  void overTheBeat(const std::function<void(const MaterialFrame&)>& look) const override;
  bool differs() const override { return strength_ != nullptr; }
  void amplitudes(std::span<const Vec3f> reference_m, std::uint16_t group,
                  std::span<float> out) const override {
    strength_->amplitudes(reference_m, group, blood_[group], out);
  }
  double reachAcross_m() const override { return across_m_; }
  double reachAlong_m() const override { return along_m_; }
  Box movesOver(Vec3f low_m, std::uint16_t group) const override {
    return reach_.over(low_m, lattice_, group);
  }

  const MotionField& field() const { return field_; }

 private:
  struct Ridges;
  std::optional<SharedMotionField> own_field_;
  const MotionField& field_;
  std::vector<Ridges> ridges_;
  BlockReach reach_;
  CubeLattice lattice_;
  std::vector<bool> blood_, coarse_;  // by group
  std::vector<float> surroundings_;   // likewise
  std::unique_ptr<const TissueStrength> strength_;
  double across_m_ = 0, along_m_ = 0;
};

class FieldMaterialFrame : public MaterialFrame {
 public:
  // Precondition: `frame` is the field's at the instant, `on_sheets_m` the sheets' points then;
  // both outlive this.
  explicit FieldMaterialFrame(const FieldFrame& frame, std::span<const Vec3f> on_sheets_m = {})
      : frame_(frame), on_sheets_m_(on_sheets_m) {}
  std::span<const Vec3f> onSheets() const override { return on_sheets_m_; }
  CubeCorners corners(std::uint16_t group, Vec3f low_m, float edge_m) const override;

 private:
  const FieldFrame& frame_;
  std::span<const Vec3f> on_sheets_m_;
};

}  // namespace echocine
