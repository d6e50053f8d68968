#include "scene/view_names.h"

#include <algorithm>
#include <string>

namespace echocine {

namespace {

constexpr ViewName kViews[] = {
    {View::a4c, "a4c", "apical four-chamber"},
    {View::a2c, "a2c", "apical two-chamber"},
    {View::a3c, "a3c", "apical long axis (three-chamber)"},
    {View::plax, "plax", "parasternal long axis"},
    {View::psax_base, "psax-base", "parasternal short axis at the aortic valve"},
    {View::psax_mid, "psax-mid", "parasternal short axis at the papillary muscles"},
    {View::psax_apex, "psax-apex", "parasternal short axis near the apex"},
    {View::subcostal, "subcostal", "subcostal four-chamber"},
    {View::tee_4c, "tee-4c", "transoesophageal four-chamber (mid-oesophageal, 0 degrees)"},
};

}  // namespace

std::span<const ViewName> viewNames() {
  return kViews;
}

std::optional<View> viewOf(std::string_view key) {
  std::string dashed(key);
  std::replace(dashed.begin(), dashed.end(), '_', '-');
  for (const ViewName& name : kViews)
    if (dashed == name.key) return name.view;
  return std::nullopt;
}

const char* keyOf(View view) {
  for (const ViewName& name : kViews)
    if (view == name.view) return name.key;
  return "";
}

}  // namespace echocine
