#pragma once
// A current straight line at the place of its material at the reference phase. In a cell of the
// lattice the field is one trilinear function, so the material's path is smooth there and bends at
// the passage to the next cell. Positions and slopes at these passages describe it completely.

#include "motion/interior/lattice_cell.h"
#include "motion/interior/motion_field.h"

namespace echocine {

// A displacement at a place of a line and its change per step of the line, m.
struct LineValue {
  Vec3f value_m, slope_m;

  friend LineValue operator-(const LineValue& a, const LineValue& b) {
    return {a.value_m - b.value_m, a.slope_m - b.slope_m};
  }
};

class LineMarch {
 public:
  // Places start + at * step, m, of a group that moves. A reference is kept.
  LineMarch(const GroupFrame& now, Vec3d start_m, Vec3d step_m);

  // Finds the reference place of the line's material at `at`, from a guess. False if it is not
  // found.
  bool startAt(float at, Vec3f guess_m);
  // Continues from the end of the last stretch to where the line leaves the cell, at most to `end`.
  // False if the field does not define the reference place.
  bool advance(float end);

  // The ends of the stretch, in steps of the line. They are equal after startAt().
  float from() const { return from_.at; }
  float to() const { return to_.at; }

  // Within the stretch: the displacement that moved the material here, and that of other frames of
  // the same group.
  struct Stretch {
    LineValue from, to;
  };
  Stretch moved() const { return {movedAt(from_), movedAt(to_)}; }
  Stretch in(const GroupFrame& other) const;
  Stretch between(const GroupFrame& before, const GroupFrame& after) const;

 private:
  // In nodes of the lattice, by axis; slope: per step of the line.
  struct End {
    float at = 0;
    Floats4 place{}, slope{};
  };
  // The side through which a line leaves a cell.
  struct Side {
    int axis = -1, next = 0;  // none if negative; the next cell along the axis
    float steps = 0;          // of the line to it, negative once passed
  };
  static void go(End& end, float steps);
  float settle(End& end) const;
  void enterCell();
  Side sideAhead(const End& end) const;
  float bend() const;
  Floats4 inCell(const End& end) const;
  LineValue movedAt(const End& end) const;
  LineValue valueAt(const CellCorners& corners, const End& end) const;
  CellNodes nodes() const;

  const GroupFrame& now_;
  Floats4 start_, step_;   // of the line, in nodes
  Ints4 counts_;           // nodes by axis
  Ints4 cell_{};           // from -1, before the first node, to the last node, beyond it
  CellCorners corners_{};  // of the cell, in metres
  Side side_;              // through which the line leaves the cell
  End from_, to_;
};

}  // namespace echocine
