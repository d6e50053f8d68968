#pragma once
// study.html: the study as one self-contained page.

#include <filesystem>

#include "study/study.h"

namespace echocine {

// The numbers of studyJson() and the pictures of every setting. Throws JobError.
void writeStudyPage(const StudyResult& result, const std::filesystem::path& path);

}  // namespace echocine
