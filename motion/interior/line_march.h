#pragma once
// A straight line of now as its material lay at the reference phase. In a cell of the lattice the
// field is one trilinear function, so the material's path is smooth there and bends where it passes
// to the next cell: its places and slopes at these passages say all of it.

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

  // Where the material of a place of the line is found, from a guess of its reference place. False
  // where it is not.
  bool startAt(float at, Vec3f guess_m);
  // From where the last stretch ended to where the line leaves the cell, and to `end` at most.
  // False where the field does not say where the material was.
  bool advance(float end);

  // The ends of the stretch, in steps of the line. They are the same after startAt().
  float from() const { return from_.at; }
  float to() const { return to_.at; }

  // Between the stretch's ends: the displacement that brought the material here, and that of other
  // frames of the same group.
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
    int axis = -1, next = 0;  // none below 0; the cell beyond it along the axis
    float steps = 0;          // of the line to it, below 0 when it is passed
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
  Side side_;              // through which the stretch leaves the cell
  End from_, to_;
};

}  // namespace echocine
