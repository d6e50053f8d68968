#pragma once
// What 500 clinical apical stills measure, and how simulated ones stand against it.

#include <string>
#include <vector>

#include "texture/echo_texture.h"

namespace echocine::bench {

// p10, p25, median, p75, p90 of one statistic over good images of one view and instant.
struct Population {
  double p10, p25, p50, p75, p90;
};

// Of CAMUS (Leclerc et al., IEEE TMI 38(9), 2198-2210, 2019), columns 4CH-ED, 4CH-ES, 2CH-ED,
// 2CH-ES.
struct Statistic {
  const char* name;
  double (*of)(const SectorTexture&, const RegionTexture&);
  Population columns[4];
};
const std::vector<Statistic>& textureStatistics();  // the 15 that do not hang on a scanner's preset

}  // namespace echocine::bench
