#pragma once
// What the heart does when: volumes and valve openings over one beat at 65 per minute.

namespace echocine::beating_heart {

struct HeartState {
  double lv_volume_ml = 0, rv_volume_ml = 0, la_volume_ml = 0, ra_volume_ml = 0;
  double contraction =
      0;  // 0 at end-diastole, 1 at end-systole: share of the stroke volume ejected
  double mitral_opening = 0, tricuspid_opening = 0;  // 0 closed, 1 wide open
};

// The state at a phase in [0, 1), 0 at end-diastole.
HeartState heartStateAt(double phase);

}  // namespace echocine::beating_heart
