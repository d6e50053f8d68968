#pragma once
// A real loop against models, without files: what an optimiser asks again and again.

#include <string>
#include <vector>

#include "echo/read_loop.h"
#include "fit/pose_search.h"

namespace echocine {
class Simulator;
}

namespace echocine::fit {

inline constexpr int kFitFrames = 20;  // of a beat; our choice: 46 ms at 65 beats per minute

struct FitSettings {
  FitWeights weights;
  PoseLimits limits;  // scale_free: set where the real loop has no scale
};

// When the real beat starts, and how sure that is.
struct BeatFound {
  echo::BeatSpan span;
  std::string length_source, start_source;
  // 1: known; of an ECG in the picture the trace's; else Eq. 8 of descent.h: rivals lie three
  // pictures away or more, what says nothing is the median of all starts.
  double confidence = 1;
  // Of the loop's end-systole, the same; rivals lie three pictures away or more.
  std::string systole_source;
  double systole_confidence = 1;
};

// Built once from a real loop.
class ModelDiscrepancy {
 public:
  // `first`: a model of about the right heart and view: it tells the start of the beat where
  // neither the file (`side`: the user) has R waves nor end-diastole, and the depth of a loop
  // without scale. Throws SceneError: less than half a beat. Runs in parallel.
  ModelDiscrepancy(const echo::EchoLoop& real, const echo::SideOptions& side,
                   const ModelLoop& first, const FitSettings& settings = {});

  // The pose of least D, from everywhere, or near given ones; with that D and its terms.
  // Thread-safe. Precondition: the model has kFitFrames frames.
  PoseFound search(const ModelLoop& model) const;
  PoseFound refine(const ModelLoop& model, const std::vector<FitPose>& starts) const;
  // From everywhere, where another pose may lie lower, and from given ones too, near which none
  // then lies higher.
  PoseFound searchAlsoFrom(const ModelLoop& model, const std::vector<FitPose>& starts) const;
  // Of a simulator's heart; its scene's lines and signal play no part.
  PoseFound search(const Simulator& model) const;
  // Without moving anything.
  PoseFound at(const ModelLoop& model, const FitPose& pose) const;

  FitMap map(const ModelLoop& model, const FitPose& pose) const;
  const BeatFound& beat() const { return beat_; }
  const echo::EchoStack& stack() const { return *stack_; }
  const FitSettings& settings() const { return settings_; }

 private:
  void findStart(const echo::EchoLoop& real, const ModelLoop& first);
  void findSystole(const echo::EchoLoop& real, const echo::SideOptions& side,
                   const ModelLoop& first);

  FitSettings settings_;
  BeatFound beat_;
  std::optional<echo::EchoStack> stack_;
};

}  // namespace echocine::fit
