#pragma once
// The stages of a loop's frames: built once, used by all threads.

#include <memory>
#include <mutex>
#include <optional>

#include "core/stage_clock.h"
#include "frame/frame_rays.h"
#include "frame/making.h"
#include "frame/persistence.h"
#include "frame/rolling.h"
#include "frame/scene_speckle.h"
#include "frame/truth_source.h"
#include "frame/work_tally.h"
#include "frame/workspace.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/trabeculae.h"
#include "motion/surfaces/valve_parts.h"
#include "motion/surfaces/volumes.h"
#include "plan/loop_plan.h"
#include "signal/signal_chain.h"

namespace echocine {

// Effects between trace and picture. Null if the plan disables the effect. `source`: as
// Simulator's, null: none.
struct FrameEffects {
  FrameEffects(const Scene& scene, const MeshMotion& motion, const SharedMotionField& field,
               const LoopPlan& plan, const CardiacClock& clock, const SignalChain& chain,
               const SceneSpeckle* source, const ValveParts& valves);

  std::unique_ptr<const Trabeculae> trabeculae;
  std::shared_ptr<const SceneSpeckle> speckle;
  std::unique_ptr<const RollingLines> rolling;
  std::unique_ptr<const Persistence> persistence;
};

struct FrameStages {
  // `source`, `known_field`: as Simulator's. `chain`: that of other stages, whose scene and plan
  // differ at most in structures and in the probe's pose; null: made here.
  FrameStages(Scene scene, std::shared_ptr<const MeshMotion> motion, LoopPlan plan,
              const SceneSpeckle* source = nullptr,
              std::shared_ptr<const SignalChain> chain = nullptr,
              std::shared_ptr<const MotionField> known_field = nullptr);

  // As Simulator::make().
  Volumes make(const FrameTime& time, const Making& making, Workspace& workspace) const;

  const Scene scene;
  const std::shared_ptr<const MeshMotion> motion;
  const LoopPlan plan;
  const CardiacClock cardiac_clock;
  const std::shared_ptr<const SignalChain> shared_chain;
  const SignalChain& chain;
  const ValveParts valves;  // those of the plan
  const FrameRays rays;
  const SharedMotionField field;  // of speckle and of truth
  const FrameEffects effects;
  const TruthSource truth;
  const WorkspacePool workspaces;

  // Measured so far.
  mutable StageClock clock;
  mutable WorkTally tally;
  mutable struct White {
    std::mutex mutex;
    std::optional<double> value;
  } white;  // of the log compression

 private:
  std::vector<int> takenBy(LineRange lines) const;
  void stand(const FrameTime& time, Workspace& workspace) const;
  void process(const FrameTime& time, LineRange lines, bool keeps_field,
               Workspace& workspace) const;
  Greys withoutPersistence(double white_at, const FrameTime& time) const;
};

}  // namespace echocine
