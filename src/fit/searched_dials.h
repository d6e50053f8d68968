#pragma once
// The dials that a fit can search.

#include <vector>

#include "fit/dial_checks.h"

namespace echocine::fit {

struct SearchedDial {
  DialRange range;
  double step = 0;  // of differences: about an SD of what one loop leaves in planted hearts
};

// Adult hearts, failing to vigorous. Our choice. The same keys in the same order as kPriorDials.
const std::vector<SearchedDial>& searchedDials();

// Step of a dial in a range: that of the table, at most a quarter of the range. A tenth of the
// range for other dials.
double stepOf(const DialRange& range);

}  // namespace echocine::fit
