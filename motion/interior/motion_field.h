#pragma once
// Material points: one field that carries every place of the reference phase to where its tissue is
// at any phase. Speckle and truth read the same field, so what a tracker should find is how the
// scatterers moved.
//
// Every closed structure is a group of its own (or shares one that the scene names), the background
// is one more. A group has a lattice of displacements, trilinear between its nodes, fitted once per
// keyframe to the surfaces that bound what can be seen of the group, and blended over the beat with
// the very weights of the meshes. Neighbouring groups agree at the surface between them and may
// slide on one another elsewhere. Points of a surface, and of membranes always, are bound to their
// triangle instead (bound_point.h).

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/box.h"
#include "core/ids.h"
#include "core/vec3.h"
#include "motion/keyframes/interpolation.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// A surface as the field takes it; probe frame, metres.
struct InteriorSurface {
  std::string name;                             // for messages
  std::vector<Triangle> triangles;              // outward
  KeyframeWeights weights;                      // one keyframe: stands still
  std::vector<std::vector<Vec3f>> keyframes_m;  // vertices at each keyframe, as they are drawn
  bool membrane = false;
  int priority = 0;  // where closed surfaces overlap the highest wins, among equals the later
  // Surfaces with the same number of 0 or more move as one group; below 0: by itself.
  int group = -1;
};

// Which field moves a point: groups of surfaces are numbered from 0, the last is the background.
enum class GroupId : std::uint16_t {};

struct FieldSettings {
  double reference_phase = 0;  // where material points have their names
  int cells = 48;              // along the moving surfaces' diagonal. Our choice, see README
  double beyond_m = 0;         // by which material may stand out of its surfaces: trabeculae
};

// Nodes of a group's lattice. All groups' nodes stand on one lattice of the scene; those of the
// background and of still surroundings on every second node of it.
struct LatticeGrid {
  Vec3f origin_m;  // of node (0, 0, 0)
  float spacing_m = 0;
  int nx = 0, ny = 0, nz = 0;

  bool empty() const { return nx < 2 || ny < 2 || nz < 2; }
  std::size_t count() const {
    return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) *
           static_cast<std::size_t>(nz);
  }
  // Rows run along x; slabs of equal y are contiguous.
  std::size_t at(int ix, int iy, int iz) const {
    return (static_cast<std::size_t>(iy) * static_cast<std::size_t>(nz) +
            static_cast<std::size_t>(iz)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(ix);
  }
};

// A group at one phase: displacement from the reference at each node. Empty: nothing moves.
struct GroupFrame {
  LatticeGrid grid;
  std::vector<Vec3f> displacement_m;

  // Where the material of a reference place is now. Outside the lattice the nearest place on its
  // border lends its displacement, which is 0 round groups that stand in still surroundings.
  Vec3f place(Vec3f reference_m) const;
  void place(std::span<const Vec3f> reference_m, std::span<Vec3f> placed_m) const;

  // The reference place of the material that is here now, by Newton's method from `guess`; nothing
  // where it does not settle within a micrometre.
  std::optional<Vec3f> reference(Vec3f placed_m, Vec3f guess_m) const;

  // Determinant of the gradient: a small volume now, in parts of that at the reference phase.
  double volumeRatio(Vec3f reference_m) const;
};

// All groups at one phase, by GroupId. Reused without allocation.
struct FieldFrame {
  double phase = 0;
  std::uint64_t field_number = 0;  // of the field that wrote the groups; 0: none yet
  std::vector<GroupFrame> groups;

  const GroupFrame& operator[](GroupId group) const { return groups[index(group)]; }
};

// The part of each group that will be needed, by GroupId: the lowest and the highest reference y,
// m; none for an unused group.
using FieldPart = std::vector<std::optional<std::pair<float, float>>>;

class MotionField {
 public:
  // Fits all groups. Uses the threads of the enclosing withThreads(); the same field for any
  // number.
  explicit MotionField(std::vector<InteriorSurface> surfaces, const FieldSettings& settings = {});
  ~MotionField();
  MotionField(MotionField&&) noexcept;

  std::size_t groupCount() const;            // the background included
  GroupId background() const;                // the last one
  GroupId groupOf(SurfaceId surface) const;  // of a membrane: the background
  bool moves(GroupId group) const;           // false: place() is the identity
  double referencePhase() const;
  double spacing() const;   // between nodes, m
  double residual() const;  // of the equations, in parts of their right side: the worst group's

  // The group whose material is at a reference place: that of the winning closed surface there.
  GroupId groupAt(Vec3f reference_m) const;
  // The same for places that are near each other: faster the smaller the box about them.
  void groupsAt(std::span<const Vec3f> reference_m, std::span<GroupId> groups) const;
  // All groups that have places in a box, perhaps more. None twice.
  std::vector<GroupId> groupsIn(const Box& reference_m) const;
  // The winning closed surface at a reference place; nothing in the background.
  std::optional<SurfaceId> surfaceAt(Vec3f reference_m) const;

  // The field at a phase; of a part only the nodes about it are blended, the others keep what they
  // had: the cost is the part's. Thread-safe.
  void at(double phase, FieldFrame& frame) const;
  void at(double phase, FieldFrame& frame, const FieldPart& part) const;

  // A bound of the displacement of any node along y from the reference over the beat, m: material
  // that the imaging plane can show lies within it of the plane. Between keyframes it includes the
  // overshoot of the interpolation. For all groups, or for one.
  double reachAcrossPlane() const;
  double reachAcrossPlane(GroupId group) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace echocine
