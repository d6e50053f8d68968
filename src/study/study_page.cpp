#include "study/study_page.h"

#include <nlohmann/json.hpp>

#include "page/assets.h"
#include "page/page.h"
#include "study/study_files.h"
#include "study/thumbnail.h"

namespace echocine {

void writeStudyPage(const StudyResult& result, const std::filesystem::path& path) {
  nlohmann::ordered_json data = studyJson(result), images = nlohmann::ordered_json::array();
  for (const StudyPoint& point : result.points) {
    const bool made = !point.thumbnail.empty();  // not yet, where the study was stopped
    images.push_back({{"thumbnail", made ? dataUri(point.thumbnail) : ""},
                      {"difference", made ? dataUri(point.difference) : ""}});
  }
  data["images"] = std::move(images);
  data["white_difference_db"] = kWhiteDifference_db;
  writePage(path,
            pageLook("EchoCine study: " + result.scene_file, pageAsset("study.html"),
                     pageAsset("study.js")),
            data);
}

}  // namespace echocine
