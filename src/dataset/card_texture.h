#pragma once
// The card's section about the texture of muscle: decorrelation.h over all loops.

#include <span>
#include <string>

#include "dataset/layout.h"

namespace echocine::dataset {

// Markdown with quartiles over loops by lag, and figures/decorrelation.svg; empty if no loop has
// tracks. Lags that a quarter of the loops do not reach are left out.
std::string decorrelationText(std::span<const Json> records, Sink& sink);

}  // namespace echocine::dataset
