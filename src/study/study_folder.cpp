#include "study/study_folder.h"

#include "core/part_file.h"
#include "core/stop.h"
#include "study/study_files.h"
#include "study/study_page.h"

namespace echocine {

StudyFolder::StudyFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  for (const char* name : {"study.json", "study.csv", "study.html"}) removePartsOf(folder_ / name);
}

void StudyFolder::write(const StudyResult& result, bool last) {
  unstoppable([&] {
    writeStudyFiles(result, folder_);
    const auto now = std::chrono::steady_clock::now();
    if (!last && page_ && now - *page_ < std::chrono::seconds(5)) return;
    writeStudyPage(result, folder_ / "study.html");
    page_ = now;
  });
}

}  // namespace echocine
