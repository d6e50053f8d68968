#include "motion/cycle/beat_duration.h"

#include <cmath>

#include "core/hash_random.h"

namespace echocine {

namespace {

constexpr std::uint64_t kPurpose = 0x5252;  // "RR": other uses of the seed have other purposes

// A standard normal truncated at kCut has the standard deviation kCutDeviation = sqrt(1 - 2 a p(a)
// / (2 P(a) - 1)); their ratio is 3.
constexpr double kCut = 2.954538559, kCutDeviation = 0.984846186;

// Mean 0, standard deviation 1, within +-3.
double cutNormal(int seed, std::int64_t beat) {
  for (std::uint64_t attempt = 0;; attempt += 2) {
    const double z = normalFromHashes(hashOf(seed, kPurpose, beat, attempt),
                                      hashOf(seed, kPurpose, beat, attempt + 1));
    if (std::fabs(z) <= kCut) return z / kCutDeviation;
  }
}

}  // namespace

double beatDuration(const Acquisition& acquisition, std::int64_t beat) {
  const double mean_s = 1 / acquisition.heart_rate_hz;
  if (acquisition.rr_variability == 0) return mean_s;
  return mean_s * (1 + acquisition.rr_variability * cutNormal(acquisition.seed, beat));
}

}  // namespace echocine
