#pragma once
// The closed surface of highest priority at a place of the reference phase.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "motion/interior/columns.h"

namespace echocine {

class TopSurfaces {
 public:
  struct Closed {
    SurfaceId id;
    int priority;
    Columns columns;
  };

  // In any order. Among equal priorities the later surface wins.
  explicit TopSurfaces(std::vector<Closed> closed);

  // The top surface at a place, ignoring `without`.
  std::optional<SurfaceId> at(Vec3d place_m, std::optional<SurfaceId> without = {}) const;

  // For places within one box: tests only surfaces with a border there.
  class Within {
   public:
    // Precondition: place_m is in the box.
    std::optional<SurfaceId> at(Vec3d place_m) const;
    // All that at() may return, perhaps more.
    std::vector<std::optional<SurfaceId>> surfaces() const;
    // For places within a box in the box: tests only those of these surfaces with a border there.
    Within within(const Box& box_m) const;
    bool isOne() const { return asked_.empty(); }  // at() is the same everywhere

   private:
    friend class TopSurfaces;
    bool add(const Closed& surface, const Box& box_m);
    std::vector<const Closed*> asked_;  // highest priority first
    std::optional<SurfaceId> else_;     // if none of them contains the place
  };
  Within within(const Box& box_m) const;

  // Does `a` win where both closed surfaces overlap?
  bool isStronger(SurfaceId a, SurfaceId b) const { return rank_[index(a)] < rank_[index(b)]; }

  // Does a surface of higher priority than `surface` contain the place?
  bool hides(Vec3d place_m, SurfaceId surface) const;

  // The top surfaces of a row of places x = start + i step, by index; kNone in the background.
  static constexpr std::int16_t kNone = -1;
  void alongX(double start, double step, double y, double z, std::span<std::int16_t> row) const;

 private:
  std::vector<Closed> closed_;     // highest priority first
  std::vector<std::size_t> rank_;  // by SurfaceId; beyond the last for a membrane
};

}  // namespace echocine
