#pragma once
// The dials that a fit can search.

#include <map>
#include <string>
#include <vector>

#include "fit/dial_checks.h"

namespace echocine::fit {

struct SearchedDial {
  DialRange range;
  double step = 0;  // of differences: about an SD of what one loop leaves in planted hearts
};

// Adult hearts, failing to vigorous. Our choice. The keys of kPriorDials in their order, then the
// left atrium, which the right one follows, apical motion, the right ventricle, and the dials of
// heart::SectionShape.
const std::vector<SearchedDial>& searchedDials();

// Those that a fit searches by default: ejection fraction, volume, wall, sphericity and ring; in
// two views also conicity, and in three apical motion and the right ventricle's volume too. Fewer
// views do not determine them. Three views with own look also search heart::SectionShape: descents
// without a polish do not find the minimum of so many dials.
std::vector<std::string> dialsSearchedIn(std::size_t views, bool own_look);

// Their keys, for messages.
std::string searchedKeys();
// Throws SceneError for a key that is not in searchedDials().
void checkSearched(const std::vector<std::string>& keys);

// Whether dials fix one of searchedDials(): by its own value, or by that of a dial which replaces
// it.
bool isFixed(const std::string& key, const std::map<std::string, double>& dials);

// Adds dials that follow searched ones: the right atrium's volume the left one's. Replaces
// kRightRatio by rv-edv, which is at least what ejects the stroke volume.
void addFollowers(std::map<std::string, double>& dials);

// Step of a dial in a range: that of the table, at most a quarter of the range. A tenth of the
// range for other dials.
double stepOf(const DialRange& range);

}  // namespace echocine::fit
