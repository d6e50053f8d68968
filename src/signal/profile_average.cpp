#include "signal/profile_average.h"

#include <algorithm>
#include <cstring>

#include "core/lanes.h"
#include "core/parallel.h"

namespace echocine {

ProfileAverage::ProfileAverage(const Probe& probe, double pulse_cycles)
    : lines_(probe.lines), samples_(probe.samples), windows_(probe, pulse_cycles) {}

// Eight samples of all rows, of all groups their mean, and of all rows their average.
struct ProfileAverage::Slab {
  std::vector<Floats8> rows, groups, averages;

  explicit Slab(const ProfileAverage& average)
      : rows(static_cast<std::size_t>(average.windows_.rows)),
        groups(static_cast<std::size_t>(average.windows_.groups)),
        averages(rows.size()),
        average_(average) {}

  // From the first line's samples.
  void read(const float* plane, int count) {
    readMeans(average_.lines_, average_.windows_.in_row, rows, [&](int line) {
      Floats8 samples{};
      std::memcpy(&samples, plane + std::ptrdiff_t{line} * average_.samples_,
                  static_cast<std::size_t>(count) * sizeof(float));
      return samples;
    });
    readMeans(average_.windows_.rows, average_.windows_.in_group, groups,
              [&](int row) { return rows[static_cast<std::size_t>(row)]; });
  }

 private:
  template <typename At>
  static void readMeans(int count, int together, std::vector<Floats8>& means, const At& at) {
    for (int first = 0; first < count; first += together) {
      const int end = std::min(first + together, count);
      Floats8 sum{};
      for (int i = first; i < end; ++i) sum += at(i);
      means[static_cast<std::size_t>(first / together)] =
          sum * (1.0f / static_cast<float>(end - first));
    }
  }

  const ProfileAverage& average_;
};

void ProfileAverage::apply(std::vector<float>& plane, LineRange lines) const {
  parallelBlocks(windows_.zones.size(), 4, [&](std::size_t begin, std::size_t end) {
    Slab slab(*this);
    for (std::size_t z = begin; z < end; ++z)
      for (int first = windows_.zones[z].first; first < windows_.zones[z].last;
           first += int{kFloatLanes})
        averageSamples(windows_.zones[z], first, lines, slab, plane);
  });
}

namespace {

// Four sums that do not wait for each other.
Floats8 weightedSum(const float* weights, const Floats8* rows, int count) {
  Floats8 sums[4]{};
  int i = 0;
  for (; i + 4 <= count; i += 4)
    for (int j = 0; j < 4; ++j) sums[j] += weights[i + j] * rows[i + j];
  for (; i < count; ++i) sums[0] += weights[i] * rows[i];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace

void ProfileAverage::averageSamples(const ProfileWindows::Zone& zone, int first, LineRange lines,
                                    Slab& slab, std::vector<float>& plane) const {
  const int count = std::min(int{kFloatLanes}, zone.last - first);
  slab.read(plane.data() + first, count);
  // With the rows on both sides, between which lines are interpolated.
  const int first_row = std::max(lines.first / windows_.in_row - 1, 0);
  const int end_row = std::min(lines.end / windows_.in_row + 2, windows_.rows);
  for (int row = first_row; row < end_row; ++row) {
    const ProfileWindows::Window& window =
        windows_.windows[zone.windows + static_cast<std::size_t>(row)];
    const float* weights = &windows_.weights[window.weights];
    const int before = window.first / windows_.in_group, own = window.end - window.first;
    const int behind = (window.end + windows_.in_group - 1) / windows_.in_group;
    slab.averages[static_cast<std::size_t>(row)] =
        weightedSum(weights, slab.groups.data(), before) +
        weightedSum(weights + before, slab.rows.data() + window.first, own) +
        weightedSum(weights + before + own, slab.groups.data() + behind, windows_.groups - behind);
  }
  for (int line = lines.first; line < lines.end; ++line)
    storeLine(slab, line, count, plane.data() + std::ptrdiff_t{line} * samples_ + first);
}

void ProfileAverage::storeLine(const Slab& slab, int line, int count, float* to) const {
  const auto wanted = static_cast<std::size_t>(count);
  if (windows_.in_row == 1)
    return storeSome(slab.averages[static_cast<std::size_t>(line)], wanted, to);
  const double place =
      std::clamp((line - 0.5 * (windows_.in_row - 1)) / windows_.in_row, 0.0, windows_.rows - 1.0);
  const auto row = std::min(static_cast<std::size_t>(place), slab.averages.size() - 2);
  const auto part = static_cast<float>(place - static_cast<double>(row));
  storeSome((1 - part) * slab.averages[row] + part * slab.averages[row + 1], wanted, to);
}

}  // namespace echocine
