#pragma once
// How well a linear classifier distinguishes the dataset's pictures from those of real loops.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "dataset/layout.h"

namespace echocine::dataset {

struct RealLoop {
  std::filesystem::path file;  // any that readVideo() reads
  double mm_per_pixel = 0;     // pixels are square
};

struct RealComparison {
  std::size_t hearts = 0, frames = 0;  // of the dataset that were measured
  struct Loop {
    std::size_t frames = 0;
    double area = 0;  // under the ROC curve of this loop's frames, with the loop left out
  };
  std::vector<Loop> loops;  // in the order given
  struct Weight {
    std::string statistic;
    double weight = 0, simulated = 0, real = 0;  // of the classifier; means
  };
  std::vector<Weight> strongest;  // the two largest weights
};

// Throws SceneError for what compareWithReal() refuses without reading a loop: a spec without
// native loops, fewer than two real loops, or one that does not exist.
void checkRealLoops(const Spec& spec, std::span<const RealLoop> real);

// Measures the statistics of sector_texture.h in every third frame of real loops and of native
// loops of at most 60 hearts, spread evenly over the dataset. For each real loop, Fisher's
// discriminant is fitted to the other real loops and to every other heart; its area under the ROC
// curve is that of the loop and of the remaining hearts. Loops of both kinds are read the same way:
// pixels outside the detected sector are excluded. Runs on all threads of the enclosing
// withThreads(). Throws SceneError for fewer than two real loops or two hearts, if native loops are
// missing, or if a loop cannot be read or measured; JobError if stopped.
RealComparison compareWithReal(const std::filesystem::path& folder, std::span<const Json> records,
                               std::span<const RealLoop> real, const Monitor& monitor);

// The card's section; without a comparison it states that there is none.
std::string realLoopsText(const std::optional<RealComparison>& comparison);

Json realLoopsJson(const RealComparison& comparison);

}  // namespace echocine::dataset
