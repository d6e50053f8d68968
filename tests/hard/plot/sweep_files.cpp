#include "sweep_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/error.h"
#include "core/file.h"

namespace echocine {

namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 28;
constexpr std::string_view kColumns = "at,got,expected,error";

// The lines of a file, each with its number.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file)
      : file_(file), text_(readTextFile(file, kMostBytes)), rest_(text_) {}

  std::optional<std::string_view> next() {
    ++number_;
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(atPlace({file_.string(), number_, {}}, what));
  }

 private:
  std::filesystem::path file_;
  std::string text_;
  std::string_view rest_;
  int number_ = 0;
};

double numberOf(std::string_view text, const Lines& lines) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    lines.fail(fmt::format("\"{}\" is no number", text));
  return value;
}

std::string heading(std::string_view name, Lines& lines) {
  const std::string start = fmt::format("# {}: ", name);
  const std::string_view line = lines.next().value_or("");
  if (!line.starts_with(start) || line.size() == start.size())
    lines.fail(fmt::format("is no line \"{}...\"", start));
  return std::string(line.substr(start.size()));
}

SweepPoint pointOf(std::string_view line, const Lines& lines) {
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t comma = line.find(',');
    const bool last = i + 1 == values.size();
    if ((comma == line.npos) != last)
      lines.fail(fmt::format("is no row of four numbers, {}", kColumns));
    values[i] = numberOf(line.substr(0, comma), lines);
    if (!last) line.remove_prefix(comma + 1);
  }
  const SweepPoint point{values[0], values[3]};
  if (!std::isfinite(point.at)) lines.fail("\"at\" is not finite");
  if (!(point.error >= 0)) lines.fail("an error is 0 or more");
  return point;
}

HardCaseSweep readSweep(const std::filesystem::path& file) {
  Lines lines(file);
  HardCaseSweep sweep;
  sweep.file = file.filename().string();
  sweep.name = heading("case", lines);
  sweep.oracle = heading("against", lines);
  sweep.variable = heading("variable", lines);
  sweep.bound = numberOf(heading("bound", lines), lines);
  if (!(sweep.bound >= 0) || !std::isfinite(sweep.bound)) lines.fail("a bound is 0 or more");
  if (lines.next() != kColumns) lines.fail(fmt::format("is not the columns' names, {}", kColumns));
  while (const std::optional<std::string_view> line = lines.next())
    sweep.points.push_back(pointOf(*line, lines));
  if (sweep.points.empty()) lines.fail("there is no point");
  std::stable_sort(sweep.points.begin(), sweep.points.end(),
                   [](const SweepPoint& a, const SweepPoint& b) { return a.at < b.at; });
  return sweep;
}

bool errsLess(const SweepPoint& a, const SweepPoint& b) {
  return a.error < b.error;
}

}  // namespace

SweepPoint HardCaseSweep::worst() const {
  return *std::max_element(points.begin(), points.end(), errsLess);
}

std::vector<HardCaseSweep> readSweeps(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    if (it->path().extension() == ".csv") files.push_back(it->path());
  if (error)
    throw SceneError(fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
  if (files.empty())
    throw SceneError(fmt::format(
        "{}: has no sweep, accepted: a folder of the CSV files that tests write", folder.string()));
  std::sort(files.begin(), files.end());
  std::vector<HardCaseSweep> sweeps;
  for (const std::filesystem::path& file : files) sweeps.push_back(readSweep(file));
  return sweeps;
}

std::vector<SweepPoint> thinned(const std::vector<SweepPoint>& points, std::size_t count) {
  if (points.size() <= count) return points;
  std::vector<SweepPoint> kept;
  const auto at = [&](std::size_t i) {
    return points.begin() + static_cast<std::ptrdiff_t>(i * points.size() / count);
  };
  for (std::size_t i = 0; i < count; ++i)
    kept.push_back(*std::max_element(at(i), at(i + 1), errsLess));
  return kept;
}

}  // namespace echocine
