#pragma once
// A heart fitted to files of loops, and its output folder.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fit/heart_fit.h"
#include "fit/view_ranking.h"

namespace echocine::fit {

struct FitFile {
  std::optional<heart::View> view;  // none: ranked
  std::filesystem::path file;
  echo::SideOptions side{};
};

struct FittedFiles {
  HeartFit fit;
  std::vector<std::string> labels;  // of the loops, by view of the fit
};

// The view of a ranking of the loop of this file. Throws SceneError if its confidence (Eq. 8) is
// below kLeastConfidence.
heart::View clearView(const std::string& file, const ViewRanking& ranking);

// Reads the loops, ranks the views of those without one, and fits. With a folder, writes the files
// of writeFit() there, and the heart's meshes and scene in heart/ unless the result is refused;
// also if the fit is stopped after a start is known. A stopped fit leaves fit.journal in the
// folder; `resume` continues it, and begins a fit without one. Throws SceneError for an existing
// heart/ without a journal to resume, a journal of another fit, a view of low confidence, and like
// readLoop() and fitHeart(); JobError if the folder cannot be written. `options.journal` is not
// used.
FittedFiles fitFiles(const std::vector<FitFile>& files, const HeartFitOptions& options,
                     const std::optional<std::filesystem::path>& folder,
                     const Monitor& monitor = {}, bool resume = false);

}  // namespace echocine::fit
