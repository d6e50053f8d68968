#pragma once
// Discrepancy between a real loop and models, in memory, for repeated calls by an optimiser.

#include <string>
#include <vector>

#include "echo/read_loop.h"
#include "fit/pose_search.h"

namespace echocine {
class Simulator;
}

namespace echocine::fit {

inline constexpr int kFitFrames = 20;  // of a beat; our choice: 46 ms at 65 beats per minute

// BeatFound::length_source if the length of the beat is unknown.
inline constexpr const char* kLoopIsBeat = "the loop is assumed to be one beat";

struct FitSettings {
  FitWeights weights;
  PoseLimits limits;  // scale_free: set if the real loop has no scale
};

// Start of the real beat, and its confidence.
struct BeatFound {
  echo::BeatSpan span;
  std::string length_source, start_source;
  // 1: known; for an ECG in the picture that of the trace; else Eq. 8 of descent.h. Rivals are at
  // least three pictures away; the baseline is the median of all starts.
  double confidence = 1;
  // The same for the loop's end-systole; rivals are at least three pictures away.
  std::string systole_source;
  double systole_confidence = 1;
};

// Built once from a real loop.
class ModelDiscrepancy {
 public:
  // `first`: a model of roughly the right heart and view. It determines the start of the beat if
  // neither the file nor `side` (the user) gives R waves or end-diastole, and the depth of a loop
  // without scale. Throws SceneError for less than half a beat, or weights that are negative or
  // all 0. Runs in parallel.
  ModelDiscrepancy(const echo::EchoLoop& real, const echo::SideOptions& side,
                   const ModelLoop& first, const FitSettings& settings = {});

  // The pose of lowest D, searched globally or near given poses, with its D and terms. Thread-safe.
  // Throws SceneError like checkStarts(). Precondition: the model has kFitFrames frames.
  PoseFound search(const ModelLoop& model) const;
  PoseFound refine(const ModelLoop& model, const std::vector<FitPose>& starts) const;
  // Global search plus the given starts: no lower minimum near a start is missed.
  PoseFound searchAlsoFrom(const ModelLoop& model, const std::vector<FitPose>& starts) const;
  // The same for a simulator's heart. Lines and signal chain of its scene are not used.
  PoseFound search(const Simulator& model) const;
  // Evaluates poses without a search. Throws SceneError like checkPose(). The second runs in
  // parallel.
  PoseFound at(const ModelLoop& model, const FitPose& pose) const;
  std::vector<FitTerms> terms(const ModelLoop& model, const std::vector<FitPose>& poses) const;

  // The same without the pictures from `first` to before `end`, of kFitFrames.
  ModelDiscrepancy without(int first, int end) const;

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
