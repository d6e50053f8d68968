#include "study/study_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "output/manifest.h"
#include "study/machine.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

Json knobsJson(const KnobTable& table) {
  Json knobs = Json::array();
  for (const Knob& knob : table.knobs) {
    Json values = Json::array(), presets = Json::object();
    for (const KnobValue& value : knob.values) values.push_back(value.label);
    for (std::size_t p = 0; p < kPresets; ++p)
      presets[kPresetNames[p]] = knob.values[knob.of_preset[p]].label;
    knobs.push_back({{"name", knob.name},
                     {"key", knob.key},
                     {"meaning", knob.meaning},
                     {"values", values},
                     {"presets", presets}});
  }
  return knobs;
}

Json leftOutJson(const std::vector<KnobLeftOut>& list) {
  Json json = Json::array();
  for (const KnobLeftOut& l : list) json.push_back({{"knob", l.knob}, {"reason", l.reason}});
  return json;
}

Json refusedJson(const std::vector<RefusedRow>& rows) {
  Json json = Json::array();
  for (const RefusedRow& r : rows)
    json.push_back(
        {{"sweep", r.sweep}, {"knob", r.knob}, {"value", r.value}, {"reason", r.reason}});
  return json;
}

// "interpolation spline, from draft".
std::string nameOf(const RefusedRow& r) {
  return r.knob + (r.value.empty() ? "" : " " + r.value) + (r.sweep.empty() ? "" : ", " + r.sweep);
}

Json framesJson(const std::vector<FrameTime>& frames) {
  Json json = Json::array();
  for (const FrameTime& f : frames) json.push_back({{"time_s", f.time_s}, {"phase", f.phase}});
  return json;
}

Json errorsJson(const StudyErrors& e) {
  return {{"rms_db", e.rms_db},
          {"worst_frame_rms_db", e.worst_rms_db},
          {"max_db", e.max_db},
          {"ssim", e.ssim},
          {"interface_rms_mm", e.interface_rms_mm},
          {"interface_p95_mm", e.interface_p95_mm},
          {"interface_missed", e.interface_missed}};
}

Json timingJson(const StudyPoint& point, bool on_front) {
  const Quartiles wall = point.wall_ms();
  Json stages = Json::object();
  for (std::size_t s = 0; s < kStages; ++s)
    stages[stageName(static_cast<Stage>(s))] = point.stage_ms(static_cast<Stage>(s));
  return {{"ms_per_frame", wall.median},
          {"first_quartile_ms", wall.first_quartile},
          {"third_quartile_ms", wall.third_quartile},
          {"rounds", point.times.size()},
          {"stages_ms", stages},
          {"pareto", on_front}};
}

Json buysJson(const StudyResult& result) {
  Json buys = Json::array();
  for (const KnobStep& step : bestBuys(result))
    buys.push_back({{"knob", step.knob},
                    {"from", step.from},
                    {"to", step.to},
                    {"added_ms", step.added_ms},
                    {"error_drop_db", step.error_drop_db},
                    {"db_per_ms", step.perMillisecond()}});
  return buys;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

// Errors are rounded to their resolution: the storage of intensities alone changes them by as much.
std::vector<bool> rowsOnFront(const StudyResult& result) {
  std::vector<CostAndError> points;
  for (const StudyRow& row : result.rows) {
    const StudyPoint& point = result.points[row.point];
    points.push_back(
        {point.wall_ms().median, std::round(point.errors.rms_db / kToldApart_db) * kToldApart_db});
  }
  return paretoFront(points);
}

// Values that depend on a clock are under "machine" and "timing" only, so that two studies of a
// scene can be compared as text.
Json studyJson(const StudyResult& result) {
  const std::vector<bool> front = rowsOnFront(result);
  Json rows = Json::array();
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    const StudyRow& row = result.rows[i];
    const StudyPoint& point = result.points[row.point];
    rows.push_back({{"sweep", row.sweep},
                    {"knob", row.knob},
                    {"value", row.value},
                    {"point", row.point},
                    {"setting", point.keys},
                    {"tracer", point.tracer},
                    {"errors", errorsJson(point.errors)},
                    {"work_per_frame", workJson(point.work)},
                    {"exr_bytes_per_frame", point.exr_bytes},
                    {"timing", timingJson(point, front[i])}});
  }
  return {{"version", ECHOCINE_VERSION},
          {"scene", result.scene_file},
          {"scene_sha256", result.scene_sha256},
          {"reference_intensity", result.reference_intensity},
          {"dynamic_range_db", result.dynamic_range_db},
          {"frames", framesJson(result.frames)},
          {"knobs", knobsJson(result.table)},
          {"left_out", leftOutJson(result.table.left_out)},
          {"refused", refusedJson(result.refused)},
          {"rows", rows},
          {"machine",
           {{"processor", processorName()},
            {"cores", processorCores()},
            {"threads", result.threads},
            {"rounds", result.rounds},
            {"complete", result.complete},
            {"best_buys", buysJson(result)}}}};
}

// Times in ms with their quartiles, lengths in mm: the columns' names have the units.
std::string studyCsv(const StudyResult& result) {
  const std::vector<bool> front = rowsOnFront(result);
  std::string text =
      "sweep,knob,value,rms_db,worst_frame_rms_db,max_db,ssim,interface_rms_mm,interface_p95_mm,"
      "interface_missed,exr_bytes_per_frame,ms_per_frame,first_quartile_ms,third_quartile_ms";
  for (std::size_t s = 0; s < kStages; ++s)
    text += fmt::format(",{}_ms", stageName(static_cast<Stage>(s)));
  text += ",pareto,tracer,setting,refused\n";
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    const StudyRow& row = result.rows[i];
    const StudyPoint& point = result.points[row.point];
    const StudyErrors& e = point.errors;
    const Quartiles wall = point.wall_ms();
    text += fmt::format(
        "{},{},{},{:.6g},{:.6g},{:.6g},{:.8g},{:.6g},{:.6g},{:.6g},{:.10g},{:.6g},{:.6g},{:.6g}",
        quoted(row.sweep), quoted(row.knob), quoted(row.value), e.rms_db, e.worst_rms_db, e.max_db,
        e.ssim, e.interface_rms_mm, e.interface_p95_mm, e.interface_missed, point.exr_bytes,
        wall.median, wall.first_quartile, wall.third_quartile);
    for (std::size_t s = 0; s < kStages; ++s)
      text += fmt::format(",{:.6g}", point.stage_ms(static_cast<Stage>(s)));
    text += fmt::format(",{},{},{},\n", front[i] ? 1 : 0, point.tracer, quoted(point.keys));
  }
  // Without numbers: the columns between a row's name and its reason are empty.
  constexpr std::size_t kNumbers = 11, kAfterTimes = 3;
  for (const RefusedRow& r : result.refused)
    text += fmt::format("{},{},{},{}{}\n", quoted(r.sweep), quoted(r.knob), quoted(r.value),
                        std::string(kNumbers + kStages + kAfterTimes, ','), quoted(r.reason));
  return text;
}

std::string studyTable(const StudyResult& result) {
  const std::vector<bool> front = rowsOnFront(result);
  std::string text =
      fmt::format("{:<30} {:>9} {:>15} {:>9} {:>8} {:>8} {:>9} {:>9} {:>9}\n", "", "ms/frame",
                  "quartiles", "RMS dB", "max dB", "SSIM", "RMS mm", "95 % mm", "EXR kB");
  std::string head;
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    const StudyRow& row = result.rows[i];
    const StudyPoint& point = result.points[row.point];
    const std::string title = row.sweep == "preset" ? "presets" : row.knob + ", " + row.sweep;
    if (title != head) text += (head = title) + "\n";
    const Quartiles wall = point.wall_ms();
    const StudyErrors& e = point.errors;
    text += fmt::format(
        "  {:<27}{} {:>9.2f} {:>7.2f}-{:<7.2f} {:>9.3g} {:>8.3g} {:>8.4f} {:>9.3f} {:>9.3f} "
        "{:>9.0f}\n",
        row.value, front[i] ? '*' : ' ', wall.median, wall.first_quartile, wall.third_quartile,
        e.rms_db, e.max_db, e.ssim, e.interface_rms_mm, e.interface_p95_mm, 1e-3 * point.exr_bytes);
  }
  text += "* no other setting is both faster and more accurate\n";
  for (const KnobLeftOut& l : result.table.left_out)
    text += fmt::format("left out: {}: {}\n", l.knob, l.reason);
  for (const RefusedRow& l : result.refused)
    text += fmt::format("refused: {}: {}\n", nameOf(l), l.reason);
  const std::vector<KnobStep> buys = bestBuys(result);
  if (!buys.empty()) text += "from draft, dB of RMS error per millisecond:";
  for (const KnobStep& b : buys)
    text += fmt::format("{} {} {} -> {} ({:.2f} dB for {:.2f} ms)", &b == &buys.front() ? "" : ",",
                        b.knob, b.from, b.to, b.error_drop_db, b.added_ms);
  return text + (buys.empty() ? "" : "\n");
}

void writeStudyFiles(const StudyResult& result, const std::filesystem::path& folder) {
  using nlohmann::json;
  // A file's name may be no UTF-8.
  const std::string text =
      studyJson(result).dump(1, ' ', false, json::error_handler_t::replace) + "\n";
  const std::string csv = studyCsv(result);
  writeFileWhole(folder / "study.json", std::as_bytes(std::span(text)));
  writeFileWhole(folder / "study.csv", std::as_bytes(std::span(csv)));
}

}  // namespace echocine
