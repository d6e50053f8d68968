#include "texture/box_echo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/check.h"

namespace echocine {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// The greys of a box about their mean.
class BoxGreys {
 public:
  BoxGreys(const BlockPlane& frame, const EchoBox& box)
      : lines_(box.last_line - box.first_line + 1),
        samples_(box.last_sample - box.first_sample + 1) {
    for (int i = box.first_line; i <= box.last_line; ++i)
      for (int k = box.first_sample; k <= box.last_sample; ++k)
        greys_.push_back(static_cast<double>(
            frame.values[static_cast<std::size_t>(i) * static_cast<std::size_t>(frame.samples) +
                         static_cast<std::size_t>(k)]));
    for (const double grey : greys_) mean_ += grey;
    mean_ /= static_cast<double>(greys_.size());
    for (double& grey : greys_) grey -= mean_;
  }

  double mean() const { return mean_; }
  int lines() const { return lines_; }
  int samples() const { return samples_; }

  // Mean product of greys so many lines and samples apart.
  double covariance(int lines, int samples) const {
    double sum = 0;
    for (int i = 0; i + lines < lines_; ++i)
      for (int k = 0; k + samples < samples_; ++k) sum += at(i, k) * at(i + lines, k + samples);
    return sum / ((lines_ - lines) * (samples_ - samples));
  }

 private:
  double at(int line, int sample) const {
    return greys_[static_cast<std::size_t>(line * samples_ + sample)];
  }
  int lines_, samples_;
  double mean_ = 0;
  std::vector<double> greys_;
};

// Twice the lag at which it first is half; lags up to two thirds of the box, where pairs are left.
double widthAtHalf(const BoxGreys& greys, bool along) {
  const double whole = greys.covariance(0, 0);
  if (!(whole > 0)) return kUnknown;
  const int most = 2 * (along ? greys.samples() : greys.lines()) / 3;
  double before = 1;
  for (int lag = 1; lag <= most; ++lag) {
    const double here = greys.covariance(along ? 0 : lag, along ? lag : 0) / whole;
    if (here <= 0.5) return 2 * (lag - 1 + (before - 0.5) / (before - here));
    before = here;
  }
  return kUnknown;
}

struct Place {
  double line, sample;
};

// The box's middle in every frame, as block matching follows it; where it is lost it stays.
std::vector<Place> follow(std::span<const BlockPlane> frames, Place start, std::size_t placed,
                          const BlockMatchSettings& settings) {
  std::vector<Place> places(frames.size(), start);
  const auto step = [&](std::size_t from, std::size_t to) {
    places[to] = places[from];
    const auto found =
        matchBlock(frames[from], frames[to], static_cast<int>(std::lround(places[from].line)),
                   static_cast<int>(std::lround(places[from].sample)), settings);
    if (!found) return;
    places[to].line += found->lines;
    places[to].sample += found->samples;
  };
  for (std::size_t f = placed; f + 1 < frames.size(); ++f) step(f, f + 1);
  for (std::size_t f = placed; f > 0; --f) step(f, f - 1);
  return places;
}

class Mean {
 public:
  void add(double value) {
    sum_ += value;
    ++count_;
  }
  double value() const { return count_ > 0 ? sum_ / count_ : kUnknown; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

}  // namespace

BoxEcho boxEcho(std::span<const BlockPlane> frames, const EchoBox& box, std::size_t placed,
                const BlockMatchSettings& reach) {
  CHECK_LT(placed, frames.size());
  BoxEcho echo;
  const BoxGreys greys(frames[placed], box);
  echo.mean = greys.mean();
  echo.deviation = std::sqrt(greys.covariance(0, 0));
  echo.axial_samples = widthAtHalf(greys, true);
  echo.lateral_lines = widthAtHalf(greys, false);

  BlockMatchSettings block = reach;
  block.half_lines = (greys.lines() - 1) / 2;
  block.half_samples = (greys.samples() - 1) / 2;
  const Place start{0.5 * (box.first_line + box.last_line),
                    0.5 * (box.first_sample + box.last_sample)};
  const std::vector<Place> places = follow(frames, start, placed, block);
  for (int lag = 1; lag <= kEchoLags; ++lag) {
    Mean tracked, in_place;
    BlockMatchSettings wide = block;
    wide.search_lines = reach.search_lines * lag;
    wide.search_samples = reach.search_samples * lag;
    for (std::size_t f = 0; f + static_cast<std::size_t>(lag) < frames.size(); ++f) {
      const int line = static_cast<int>(std::lround(places[f].line)),
                sample = static_cast<int>(std::lround(places[f].sample));
      const BlockPlane& later = frames[f + static_cast<std::size_t>(lag)];
      if (const auto found = matchBlock(frames[f], later, line, sample, wide))
        tracked.add(found->correlation);
      if (const auto same = correlationInPlace(frames[f], later, line, sample, block))
        in_place.add(*same);
    }
    echo.tracked[lag - 1] = tracked.value();
    echo.in_place[lag - 1] = in_place.value();
  }
  return echo;
}

}  // namespace echocine
