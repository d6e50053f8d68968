#include "trace/line_samples.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/lanes.h"

namespace echocine {

namespace {

constexpr int kBlock = kFloatLanes;  // of samples

// First sample whose centre is at or beyond a depth, within 0..samples.
int sampleFrom(const Sampling& s, double depth_m) {
  const double k = std::ceil((depth_m - s.min_depth_m) / s.spacing_m - 0.5);
  return static_cast<int>(std::clamp(k, 0.0, static_cast<double>(s.samples)));
}

// 1 / 2^e with 2^e <= x < 2^(e + 1), of a normal number x > 0.
double perPowerOfTwo(double x) {
  constexpr std::uint64_t kExponent = 0x7ffULL << 52, kTwiceOne = 2046ULL << 52;
  return std::bit_cast<double>(kTwiceOne - (std::bit_cast<std::uint64_t>(x) & kExponent));
}

// Powers of what one sample's attenuation leaves: of the first samples of a block, and of all.
struct SamplePowers {
  double exponent_per_m = 0;
  Floats8 within = Floats8{} + 1;
  double block = 1;
};

// Powers for the few media that a line passes, each computed once.
class PowerTable {
 public:
  explicit PowerTable(double spacing_m) : spacing_m_(spacing_m) {}

  const SamplePowers& of(double exponent_per_m) {
    for (std::size_t i = 0; i < count_; ++i)
      if (entries_[i].exponent_per_m == exponent_per_m) return entries_[i];
    SamplePowers& powers = entries_[count_ < entries_.size() ? count_++ : 0];
    powers.exponent_per_m = exponent_per_m;
    powers.block = 1;
    const double sample_factor = std::exp(-exponent_per_m * spacing_m_);
    for (int j = 0; j < kBlock; ++j) {
      powers.within[j] = static_cast<float>(powers.block);
      powers.block *= sample_factor;
    }
    return powers;
  }

 private:
  double spacing_m_;
  std::size_t count_ = 0;
  std::array<SamplePowers, 8> entries_;
};

// One segment's backscatter in blocks of eight samples: within a block stored powers of the
// attenuation of one sample, from block to block its eighth power, in double: no call in the loops,
// which vectorise, and rounding of one part in 1e16 per block. Up to seven samples behind the
// segment are written too, which what follows it overwrites.
template <bool kSpread, bool kAttenuation>
void fillSegment(const MediumSegment& segment, const Sampling& s, PowerTable& table, int begin,
                 int end, float* out) {
  const double offset_m = s.centre(begin) - segment.begin_depth_m;
  double path_step = segment.path_per_depth * s.spacing_m;
  double path_m = segment.begin_path_m + segment.path_per_depth * offset_m;
  double strength = segment.strength_m2_sr;
  // Metres are taken in a unit that makes the segment begin between 1 and 2: with l < 1 the
  // strength would reach the floats' lower end before the intensity does. A power of two changes no
  // digit.
  if constexpr (kSpread) {
    const double unit = path_m > 0 ? perPowerOfTwo(path_m) : 1;
    path_m *= unit;
    path_step *= unit;
    strength *= unit * unit;
  }
  double block_factor = 1;
  Floats8 power{};
  if constexpr (kAttenuation) {
    strength *= std::exp(-(segment.begin_exponent + segment.exponent_per_m * offset_m));
    const SamplePowers& powers = table.of(segment.exponent_per_m);
    block_factor = powers.block;
    power = powers.within;
  }
  Floats8 path_offset{};
  for (int j = 0; j < kBlock; ++j) path_offset[j] = static_cast<float>(path_step * j);
  for (int k = begin; k < end; k += kBlock) {
    Floats8 value = Floats8{} + static_cast<float>(strength);
    if constexpr (kAttenuation) value *= power;
    if constexpr (kSpread) {
      const Floats8 l = path_offset + static_cast<float>(path_m);
      value /= l * l;
    }
    if (k + kBlock <= s.samples)
      std::memcpy(out + k, &value, sizeof value);  // a plain store
    else
      std::memcpy(out + k, &value, static_cast<std::size_t>(end - k) * sizeof(float));
    strength *= block_factor;
    path_m += path_step * kBlock;
  }
}

void fillOne(const MediumSegment& segment, const Sampling& s, const IntensityTerms& parts,
             PowerTable& table, int begin, int end, float* out) {
  if (parts.spread_undone_at_m == 0) {
    const double near_m = s.spread_from_m - segment.begin_path_m;
    const int near =
        near_m > 0
            ? std::clamp(sampleFrom(s, segment.begin_depth_m + near_m / segment.path_per_depth),
                         begin, end)
            : begin;
    if (near > begin) {
      IntensityTerms constant = parts;
      constant.spread_undone_at_m = s.spread_from_m;
      fillOne(segment, s, constant, table, begin, near, out);
      begin = near;
      if (begin == end) return;
    }
    return parts.attenuation ? fillSegment<true, true>(segment, s, table, begin, end, out)
                             : fillSegment<true, false>(segment, s, table, begin, end, out);
  }
  MediumSegment scaled = segment;
  scaled.strength_m2_sr /= parts.spread_undone_at_m * parts.spread_undone_at_m;
  if (parts.attenuation) return fillSegment<false, true>(scaled, s, table, begin, end, out);
  std::fill(out + begin, out + end, static_cast<float>(scaled.strength_m2_sr));
}

// Every sample once: segments that scatter, zeros elsewhere.
void fillBackscatter(const LineTrace& line, const Sampling& s, const IntensityTerms& parts,
                     float* out) {
  PowerTable table(s.spacing_m);
  int done = 0, begin = 0, end = 0;
  double depth_m = s.min_depth_m;  // of `end`
  for (const MediumSegment& segment : line.segments) {
    begin = segment.begin_depth_m == depth_m ? end : sampleFrom(s, segment.begin_depth_m);
    begin = std::max(begin, done);
    depth_m = segment.end_depth_m;
    end = sampleFrom(s, depth_m);
    if (begin >= end || segment.strength_m2_sr == 0) continue;
    std::fill(out + done, out + begin, 0.0f);
    fillOne(segment, s, parts, table, begin, end, out);
    done = end;
  }
  std::fill(out + done, out + s.samples, 0.0f);
}

}  // namespace

void sampleIntensity(const LineTrace& line, const Sampling& sampling, const IntensityTerms& parts,
                     std::span<float> values) {
  if (parts.backscatter)
    fillBackscatter(line, sampling, parts, values.data());
  else
    std::fill(values.begin(), values.end(), 0.0f);
  if (!parts.reflection) return;
  for (const Echo& echo : line.echoes) {
    const double k = std::floor((echo.depth_m - sampling.min_depth_m) / sampling.spacing_m);
    if (k < 0 || k >= sampling.samples) continue;
    const double lost = parts.attenuation ? std::exp(-echo.exponent) : 1.0;
    values[static_cast<std::size_t>(k)] +=
        static_cast<float>(parts.echo_samples * parts.shown(echo.intensity, echo.intensity) * lost);
  }
}

namespace {

// e^-x of x >= 0, to 3e-13; x beyond 700 counts as 700, which leaves nothing of a float either.
// -x is n ln 2 + r: n is rounded to a whole number by adding a number whose last digit is 1, e^r is
// its power series up to the tenth power, by pairs, so that few steps wait for each other.
Doubles4 expOfMinus(Doubles4 x) {
  constexpr double kWhole = 0x1.8p52;
  constexpr double kLog2High = 0x1.62e42feep-1, kLog2Low = 0x1.a39ef35793c76p-33;
  const Doubles4 y = -smaller(x, 700);
  const Doubles4 shifted = y * std::numbers::log2e + kWhole, n = shifted - kWhole;
  const Doubles4 r = (y - n * kLog2High) - n * kLog2Low, r2 = r * r, r4 = r2 * r2;
  const Doubles4 low = (1 + r) + r2 * (1.0 / 2 + r * (1.0 / 6));
  const Doubles4 middle = (1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720 + r * (1.0 / 5040));
  const Doubles4 high = (1.0 / 40320 + r * (1.0 / 362880)) + r2 * (1.0 / 3628800);
  const Doubles4 series = low + r4 * (middle + r4 * high);
  return reinterpret_cast<Doubles4>(reinterpret_cast<Mask4>(series) +
                                    (reinterpret_cast<Mask4>(shifted) << 52));
}

}  // namespace

void addToSamples(const CellEchoes& echoes, const IntensityTerms& parts, std::span<float> plane) {
  if (!parts.reflection) return;
  constexpr std::size_t kTogether = 64;
  static_assert(kTogether % kDoubleLanes == 0);
  std::array<double, kTogether> values;
  for (std::size_t first = 0; first < echoes.count; first += kTogether) {
    const std::size_t count = std::min(kTogether, echoes.count - first);
    for (std::size_t j = 0; j < count; j += kDoubleLanes) {
      const Doubles4 filled = lanesAt(&echoes.filled[first + j]);
      Doubles4 value =
          parts.shown(lanesAt(&echoes.intensity[first + j]), filled) * parts.echo_samples;
      if (parts.attenuation) value *= expOfMinus(lanesAt(&echoes.exponent[first + j]));
      store(value, &values[j]);
    }
    for (std::size_t j = 0; j < count; ++j)
      plane[echoes.at[first + j]] += static_cast<float>(values[j]);
  }
}

void sampleExponent(const LineTrace& line, const Sampling& sampling, std::span<float> values) {
  std::fill(values.begin(), values.end(), 0.0f);
  for (const MediumSegment& segment : line.segments) {
    const int begin = sampleFrom(sampling, segment.begin_depth_m);
    const int end = sampleFrom(sampling, segment.end_depth_m);
    for (int k = begin; k < end; ++k)
      values[static_cast<std::size_t>(k)] =
          static_cast<float>(segment.begin_exponent +
                             segment.exponent_per_m * (sampling.centre(k) - segment.begin_depth_m));
  }
}

void sampleMedium(const LineTrace& line, const Sampling& sampling, std::span<std::uint32_t> ids) {
  std::fill(ids.begin(), ids.end(), kNoMedium);
  for (const MediumSegment& segment : line.segments) {
    const int begin = sampleFrom(sampling, segment.begin_depth_m);
    const int end = sampleFrom(sampling, segment.end_depth_m);
    if (begin < end)
      std::fill(ids.begin() + begin, ids.begin() + end,
                static_cast<std::uint32_t>(index(segment.medium)));
  }
}

}  // namespace echocine
