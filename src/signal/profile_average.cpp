#include "signal/profile_average.h"

#include <algorithm>
#include <cstring>

#include "core/lanes.h"
#include "core/parallel.h"

namespace echocine {

namespace {

constexpr int kAtOnce = kFloatLanes;
// Samples that are read and written together: whole cache lines of each line. Our choice.
constexpr int kVectors = 8, kSlab = kVectors * kAtOnce;

// Four sums that do not wait for each other.
Floats8 weightedSum(const float* weights, const Floats8* rows, int count) {
  Floats8 sums[4]{};
  int i = 0;
  for (; i + 4 <= count; i += 4)
    for (int j = 0; j < 4; ++j) sums[j] += weights[i + j] * rows[i + j];
  for (; i < count; ++i) sums[0] += weights[i] * rows[i];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

bool isZero(Floats8 a) {
  return bitsOf(a != 0) == 0;
}

}  // namespace

// Samples first to last - 1 of all lines: vectors of eight, each by row.
struct ProfileAverage::Slab {
  int first, last;
  std::vector<Floats8> rows, averages;  // by vector and row
  std::vector<Floats8> groups;          // means of one vector
  std::vector<int> echoing;             // rows that are not 0, of one vector

  Slab(const ProfileAverage& average, int first_sample)
      : first(first_sample),
        last(std::min(first_sample + kSlab, average.samples_)),
        rows(static_cast<std::size_t>(kVectors * average.windows_.rows)),
        averages(rows.size()),
        groups(static_cast<std::size_t>(average.windows_.groups)) {}
};

ProfileAverage::ProfileAverage(const Probe& probe, const BeamPulse& pulse)
    : lines_(probe.lines),
      samples_(probe.samples),
      shared_(sharedProfileWindows(probe, pulse)),
      windows_(*shared_) {}

void ProfileAverage::apply(std::vector<float>& plane, LineRange lines, BeamPart part) const {
  const auto slabs = static_cast<std::size_t>((samples_ + kSlab - 1) / kSlab);
  parallelBlocks(slabs, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Slab slab(*this, static_cast<int>(i) * kSlab);
      read(plane.data(), slab);
      for (int v = 0; slab.first + v * kAtOnce < slab.last; ++v)
        averageVector(v, lines, part, slab);
      write(slab, lines, plane.data());
    }
  });
}

void ProfileAverage::read(const float* plane, Slab& slab) const {
  const auto rows = static_cast<std::size_t>(windows_.rows);
  const auto bytes = static_cast<std::size_t>(slab.last - slab.first) * sizeof(float);
  for (int line = 0; line < lines_; ++line) {
    Floats8 samples[kVectors]{};
    std::memcpy(samples, plane + std::ptrdiff_t{line} * samples_ + slab.first, bytes);
    const int row = line / windows_.in_row;
    const int in_row = std::min(windows_.in_row, lines_ - row * windows_.in_row);
    for (std::size_t v = 0; v < kVectors; ++v)
      slab.rows[v * rows + static_cast<std::size_t>(row)] +=
          samples[v] * (1.0f / static_cast<float>(in_row));
  }
}

// Rows that are not 0.
void ProfileAverage::findEchoing(const Floats8* rows, Slab& slab) const {
  slab.echoing.clear();
  for (int row = 0; row < windows_.rows; ++row)
    if (!isZero(rows[row])) slab.echoing.push_back(row);
}

void ProfileAverage::findGroups(const Floats8* rows, Slab& slab) const {
  for (int g = 0; g < windows_.groups; ++g) {
    const int first = g * windows_.in_group,
              end = std::min(first + windows_.in_group, windows_.rows);
    Floats8 sum{};
    for (int row = first; row < end; ++row) sum += rows[row];
    slab.groups[static_cast<std::size_t>(g)] = sum * (1.0f / static_cast<float>(end - first));
  }
}

void ProfileAverage::averageVector(int vector, LineRange lines, BeamPart part, Slab& slab) const {
  const std::size_t at = static_cast<std::size_t>(vector) * static_cast<std::size_t>(windows_.rows);
  const Floats8* const rows = &slab.rows[at];
  const bool whole = part == BeamPart::whole;
  whole ? findGroups(rows, slab) : findEchoing(rows, slab);
  const ProfileWindows::Zone& zone = windows_.zoneOf(slab.first + vector * kAtOnce);
  // With the rows on both sides, between which lines are interpolated.
  const int first_row = std::max(lines.first / windows_.in_row - 1, 0);
  const int end_row = std::min(lines.end / windows_.in_row + 2, windows_.rows);
  for (int row = first_row; row < end_row; ++row) {
    const ProfileWindows::Window& window =
        windows_.windows[zone.windows + static_cast<std::size_t>(row)];
    slab.averages[at + static_cast<std::size_t>(row)] =
        whole ? averageAll(window, rows, slab) : averageEchoing(window, rows, slab);
  }
}

Floats8 ProfileAverage::averageAll(const ProfileWindows::Window& window, const Floats8* rows,
                                   const Slab& slab) const {
  const float* weights = &windows_.weights[window.weights];
  const int before = window.first / windows_.in_group, own = window.end - window.first;
  const int behind = (window.end + windows_.in_group - 1) / windows_.in_group;
  return weightedSum(weights, slab.groups.data(), before) +
         weightedSum(weights + before, rows + window.first, own) +
         weightedSum(weights + before + own, slab.groups.data() + behind, windows_.groups - behind);
}

Floats8 ProfileAverage::averageEchoing(const ProfileWindows::Window& window, const Floats8* rows,
                                       const Slab& slab) const {
  const float* weights = &windows_.weights[window.weights] + window.first / windows_.in_group;
  Floats8 sum{};
  for (auto row = std::lower_bound(slab.echoing.begin(), slab.echoing.end(), window.first);
       row != slab.echoing.end() && *row < window.end; ++row)
    sum += weights[*row - window.first] * rows[*row];
  return sum;
}

void ProfileAverage::write(const Slab& slab, LineRange lines, float* plane) const {
  const auto rows = static_cast<std::size_t>(windows_.rows);
  const auto bytes = static_cast<std::size_t>(slab.last - slab.first) * sizeof(float);
  for (int line = lines.first; line < lines.end; ++line) {
    const int in_row = windows_.in_row;
    const double place = std::clamp((line - 0.5 * (in_row - 1)) / in_row, 0.0, windows_.rows - 1.0);
    const auto row = std::min(static_cast<std::size_t>(place), rows - 2);
    const auto part = static_cast<float>(place - static_cast<double>(row));
    Floats8 samples[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Floats8* const of_row = &slab.averages[v * rows + row];
      samples[v] = part == 0   ? of_row[0]
                   : part == 1 ? of_row[1]
                               : (1 - part) * of_row[0] + part * of_row[1];
    }
    std::memcpy(plane + std::ptrdiff_t{line} * samples_ + slab.first, samples, bytes);
  }
}

}  // namespace echocine
