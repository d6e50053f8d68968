#pragma once
// Where a probe is held for the standard views of echocardiography.

#include <optional>
#include <span>
#include <string_view>

#include "motion/heart/heart.h"
#include "scene/view_placement.h"

namespace echocine::heart {

using View = echocine::View;

struct ViewName {
  View view;
  const char* key;  // such as "a4c"
  const char* meaning;
};
std::span<const ViewName> viewNames();
std::optional<View> viewOf(std::string_view key);

// In heart coordinates, metres. The image has `lateral` to the right and `axis` downwards; as by
// convention apical views have the left ventricle on the right, parasternal long axes the aorta on
// the right, short axes the septum on the left and are seen from the apex.
struct ProbePose {
  Vec3d apex;           // of the sector, on the skin
  Vec3d axis, lateral;  // unit, across each other
  double depth_m = 0, sector_deg = 0;
  double chest_m = 0;  // from the skin to the pericardium, at end-diastole
};

// Aimed by the heart at end-diastole, over which the probe stays where it is.
ProbePose poseOf(View view, const ParametricHeart& heart);

}  // namespace echocine::heart
