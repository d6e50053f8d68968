#pragma once
// A probe placed by anatomy.

#include "core/error.h"
#include "core/vec3.h"

namespace echocine {

// The standard views of echocardiography.
enum class View { a4c, a2c, a3c, plax, psax_base, psax_mid, psax_apex, subcostal, tee_4c };

// The probe is in the oesophagus, not on the chest.
inline bool isTransoesophageal(View view) {
  return view == View::tee_4c;
}

// The pose of a standard view, computed from structures with roles, and its modification: a shift
// along the probe's lateral, elevation and depth axes, then rotations about its apex.
struct ViewPlacement {
  View view = View::a4c;
  Vec3d shift_m{};
  double tilt_rad = 0;    // of the imaging plane, about the lateral axis
  double rotate_rad = 0;  // of the imaging plane, about the depth axis
  SourcePlace place;
};

}  // namespace echocine
