#pragma once
// A study as files: study.json, study.csv, and a table for the terminal.

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "study/study.h"

namespace echocine {

// All measurements. Values that depend on the machine and the time are under "machine" and, in each
// row, "timing"; everything else is the same in every run of the same scene.
nlohmann::ordered_json studyJson(const StudyResult& result);

// One line per row: sweep, knob, value, errors, work, times in ms, and the setting's keys.
std::string studyCsv(const StudyResult& result);

// For the terminal: presets first, then each knob; an asterisk marks the Pareto front.
std::string studyTable(const StudyResult& result);

// Writes study.json and study.csv into the folder, each completely or not at all. Throws JobError.
void writeStudyFiles(const StudyResult& result, const std::filesystem::path& folder);

// Is each row's point on the Pareto front of median time and RMS error (in steps of kToldApart_db)
// over all points?
std::vector<bool> rowsOnFront(const StudyResult& result);

}  // namespace echocine
