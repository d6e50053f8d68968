#pragma once
// Looks for folds of a closed surface over a beat.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "motion/heart/beat_rows.h"
#include "motion/heart/control_mesh.h"

namespace echocine::heart {

// Examines the instants of a loop of 200 frames per beat. Faces that hardly turn between two
// keyframes cannot fold there: a bound of their turn excludes most of them in one step.
class FoldFinder {
 public:
  // Keeps the faces. Phases as in SurfaceBeat (unfold.h).
  FoldFinder(std::span<const double> phases, const std::vector<Face>& faces);

  // Calls found(keyframe, face) for every face in a fold, in the order of instants, until it
  // returns false.
  template <typename Found>
  void look(const BeatRows& rows, Found&& found) {
    for (std::size_t first = 0; first < rows.keyframes(); first += kDoubleLanes) {
      suspect(rows, first);
      for (std::size_t k = first; k < std::min(first + kDoubleLanes, rows.keyframes()); ++k)
        if (!examine(rows, k, found)) return;
    }
  }

 private:
  // A face's normal, with twice its area as its length. The sign of a product decides most pairs,
  // so normals are not normalised.
  struct Normal {
    Vec3d area;
    double squared;
  };
  // Normals halfway between two keyframes in four intervals. A face is calm if its normal stays
  // within 20 degrees of this one.
  struct Middle {
    Doubles4 x, y, z;
    Mask4 is_calm;
  };
  struct Hinge {  // two faces with a common edge
    std::uint32_t a, b;
  };
  // Edges and faces that may fold in an interval.
  struct Suspects {
    std::vector<Hinge> hinges;
    std::vector<std::uint32_t> faces;  // may turn away from both keyframes
  };
  // A point between keyframes is the sum of weight * keyframe.
  struct Term {
    std::size_t keyframe;
    double weight;
  };
  using Terms = std::vector<Term>;

  static bool areFolded(const Normal& a, const Normal& b);
  static bool areTurned(const Normal& a, const Normal& b);
  static Normal normalOf(Vec3d a, Vec3d b, Vec3d c);
  Middle middleOf(const BeatRows& rows, const Face& face, std::size_t first) const;
  void suspect(const BeatRows& rows, std::size_t first);
  Normal normalAt(const BeatRows& rows, std::size_t face, std::size_t keyframe) const;
  Normal normalAt(const BeatRows& rows, std::size_t face, const Terms& terms) const;

  // False if `found` ended the search.
  template <typename Found>
  bool examine(const BeatRows& rows, std::size_t k, Found&& found) {
    const Suspects& may_fold = suspects_[k % kDoubleLanes];
    if (may_fold.hinges.empty() && may_fold.faces.empty()) return true;
    const std::size_t next = (k + 1) % rows.keyframes();
    for (const Terms& terms : instants_[k]) {
      ++instant_;
      const auto now = [&](std::size_t face) -> const Normal& {
        Known& known = known_[face];
        if (known.instant != instant_) known = {instant_, normalAt(rows, face, terms)};
        return known.normal;
      };
      for (const Hinge& hinge : may_fold.hinges)
        if (areFolded(now(hinge.a), now(hinge.b)) && !(found(k, hinge.a) && found(k, hinge.b)))
          return false;
      for (const std::uint32_t face : may_fold.faces)
        if (areTurned(now(face), normalAt(rows, face, k)) &&
            areTurned(now(face), normalAt(rows, face, next)) && !found(k, face))
          return false;
    }
    return true;
  }

  const std::vector<Face>& faces_;
  std::vector<Hinge> hinges_;
  std::vector<std::vector<Terms>> instants_;  // [interval][instant]
  // Bounds by interval, for the change of a point from the middle: of the weights of the keyframes
  // before and after it, and of half the difference of the weights of its own two.
  std::vector<double> before_, after_, half_;
  struct Known {  // a face's normal at an instant
    std::uint64_t instant = 0;
    Normal normal{};
  };
  std::vector<Known> known_;  // by face
  std::uint64_t instant_ = 0;
  std::vector<Middle> middles_;                  // by face
  std::array<Suspects, kDoubleLanes> suspects_;  // by interval, of four
};

}  // namespace echocine::heart
