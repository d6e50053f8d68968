#pragma once
// Published hearts of one instant, moved by a stated beat with the time course of the patient's
// left ventricle. Fits were never tuned on the first two.

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/planted_fits.h"
#include "support/stated_beat.h"
#include "support/whole_patient.h"

namespace echocine::support {

// Our choice: cavities of about 110 mL.
inline constexpr double kTemplateUnit_m = 0.0115, kFourChambersLarger = 1.12;

// Part of systole that has passed at each of the patient's frames, 0 at end-diastole, 1 at
// end-systole.
inline const std::array<double, kVentricleFrames>& systoleParts() {
  static const std::array<double, kVentricleFrames> parts = [] {
    const std::vector<double> ml = volumesOf(sceneOf(Family::patient, View::a4c));
    const double least = *std::min_element(ml.begin(), ml.end());
    std::array<double, kVentricleFrames> out{};
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k] = std::clamp((ml.front() - ml[k * ml.size() / out.size()]) / (ml.front() - least), 0.0,
                          1.0);
    return out;
  }();
  return parts;
}

// A mesh in all frames, in mm.
inline std::vector<std::shared_ptr<const TriangleMesh>> framesOf(const TriangleMesh& mesh_m,
                                                                 const StatedBeat& beat,
                                                                 double roof_m) {
  std::vector<std::shared_ptr<const TriangleMesh>> frames;
  for (const double part : systoleParts()) {
    TriangleMesh moved = mesh_m;
    for (Vec3d& p : moved.positions) p = 1e3 * beat.moved(p, part, roof_m);
    frames.push_back(std::make_shared<const TriangleMesh>(std::move(moved)));
  }
  return frames;
}

inline TriangleMesh meshOf(const RealHeart& heart, std::size_t surface) {
  TriangleMesh mesh;
  mesh.positions = heart.surfaces[surface].points_m;
  mesh.triangles = heart.triangles[surface];
  return mesh;
}
inline TriangleMesh meshOf(const RealHeart& heart, Role role) {
  for (std::size_t s = 0; s < heart.surfaces.size(); ++s)
    if (heart.surfaces[s].role == role) return meshOf(heart, s);
  return {};
}

// The mesh with each vertex moved along its normal, to the outside if `by_m` is positive.
inline TriangleMesh grown(TriangleMesh mesh, double by_m) {
  std::vector<Vec3d> normals(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d area = cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                             mesh.positions[t[2]] - mesh.positions[t[0]]);
    for (const std::uint32_t v : t) normals[v] = normals[v] + area;
  }
  for (std::size_t v = 0; v < normals.size(); ++v)
    mesh.positions[v] = mesh.positions[v] + by_m * normalised(normals[v]);
  return mesh;
}

// The cavity of a muscle like a cup: the largest patch of faces that look at a point inside, closed
// by fans over its rim. Rims that touch themselves need the repair "split".
inline TriangleMesh cavityOfCup(const TriangleMesh& cup, Vec3d inside) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Edge, std::size_t> faceAt;
  for (std::size_t f = 0; f < cup.triangles.size(); ++f) {
    const Triangle& t = cup.triangles[f];
    const Vec3d a = cup.positions[t[0]], b = cup.positions[t[1]], c = cup.positions[t[2]];
    if (dot(cross(b - a, c - a), inside - 1.0 / 3 * (a + b + c)) <= 0) continue;
    for (std::size_t k = 0; k < 3; ++k) faceAt[{t[k], t[(k + 1) % 3]}] = f;
  }
  std::set<std::size_t> largest, seen;
  for (const auto& [edge, first] : faceAt) {
    std::set<std::size_t> patch;
    std::vector<std::size_t> open{first};
    while (!open.empty()) {
      const std::size_t f = open.back();
      open.pop_back();
      if (!seen.insert(f).second) continue;
      patch.insert(f);
      const Triangle& t = cup.triangles[f];
      for (std::size_t k = 0; k < 3; ++k)
        if (const auto next = faceAt.find({t[(k + 1) % 3], t[k]}); next != faceAt.end())
          open.push_back(next->second);
    }
    if (patch.size() > largest.size()) largest = patch;
  }
  TriangleMesh cavity;
  std::map<std::uint32_t, std::uint32_t> kept;
  const auto keep = [&](std::uint32_t v) {
    const auto [at, added] =
        kept.try_emplace(v, static_cast<std::uint32_t>(cavity.positions.size()));
    if (added) cavity.positions.push_back(cup.positions[v]);
    return at->second;
  };
  std::vector<Edge> rim;
  for (const std::size_t f : largest) {
    const Triangle& t = cup.triangles[f];
    cavity.triangles.push_back({keep(t[0]), keep(t[2]), keep(t[1])});
    for (std::size_t k = 0; k < 3; ++k) {
      const auto next = faceAt.find({t[(k + 1) % 3], t[k]});
      if (next == faceAt.end() || !largest.contains(next->second))
        rim.emplace_back(keep(t[k]), keep(t[(k + 1) % 3]));
    }
  }
  Vec3d hub{};
  for (const auto& [from, to] : rim) hub = hub + cavity.positions[from];
  const auto middle = static_cast<std::uint32_t>(cavity.positions.size());
  cavity.positions.push_back(1 / static_cast<double>(rim.size()) * hub);
  for (const auto& [from, to] : rim) cavity.triangles.push_back({from, to, middle});
  return cavity;
}

// Chambers of a heart and the walls around them that have meshes, in a scene.
inline Scene sceneOfChambers(View view, const RealHeart& heart, const NamedMeshes& meshes) {
  SceneText text;
  text.motion = {{"mesh_unit", "\"mm\""}};
  text.acquisition = {{"heart_rate_bpm", "72.2"}, {"frame_rate_hz", "30.0833"}};
  holdProbe(view, heart.surfaces, 1e-3, text);
  text.output.clear();
  for (const RoleSurface& s : heart.surfaces) {
    const bool muscle = s.role == Role::lv_wall;
    text.addStructure(s.name, muscle ? "myocardium" : "blood", "\"" + s.name + "_???.obj\"",
                      muscle ? 10 : (s.role == Role::lv_cavity ? 12 : 11),
                      "role = \"" + std::string(nameOf(s.role)) + "\"\nrepair = [\"split\"]");
    if (meshes.contains(frameName(s.name + "_wall", 0)))
      text.addStructure(s.name + "_wall", "myocardium", "\"" + s.name + "_wall_???.obj\"", 1);
  }
  return parseScene(text.text(), "scene.toml", meshes);
}

// Meshes of the chambers over the beat, in mm, by the names of sceneOfChambers(). walls: right
// ventricle and atria get one.
inline NamedMeshes meshesOfChambers(const RealHeart& heart, const BeatStated& stated, bool walls) {
  constexpr double kRightWall_m = 3e-3, kAtrialWall_m = 2e-3;  // our choice
  const TriangleMesh wall = meshOf(heart, Role::lv_wall);
  const LeftVentricle left{farthestFrom(heart.mitral, wall.positions),
                           heart.mitral,
                           meshOf(heart, Role::lv_cavity),
                           {wall, meshOf(heart, Role::rv_cavity)}};
  const StatedBeat beat(left, stated);
  const Vec3d axis = normalised(left.mitral - left.apex);
  double roof_m = 0;
  for (const Role role : {Role::la, Role::ra})
    for (const Vec3d p : heart.points(role)) roof_m = std::max(roof_m, dot(p - heart.mitral, axis));
  NamedMeshes out;
  for (std::size_t s = 0; s < heart.surfaces.size(); ++s) {
    const RoleSurface& surface = heart.surfaces[s];
    const auto add = [&](const std::string& name, const TriangleMesh& mesh) {
      const auto frames = framesOf(mesh, beat, roof_m);
      for (int k = 0; k < kVentricleFrames; ++k)
        out[frameName(name, k)] = frames[static_cast<std::size_t>(k)];
    };
    add(surface.name, meshOf(heart, s));
    if (walls && surface.role != Role::lv_wall && surface.role != Role::lv_cavity)
      add(surface.name + "_wall",
          grown(meshOf(heart, s), surface.role == Role::rv_cavity ? kRightWall_m : kAtrialWall_m));
  }
  return out;
}

// Four chambers of another heart. Its left ventricle is a cup of muscle; the cavity is what it
// holds.
inline Scene movingFourChambersScene(View view) {
  static const RealHeart heart = [] {
    RealHeart out = fourChamberHeart();
    for (RoleSurface& s : out.surfaces)
      for (Vec3d& p : s.points_m) p = kFourChambersLarger * p;
    for (Vec3d* mark : {&out.apex, &out.mitral, &out.tricuspid})
      *mark = kFourChambersLarger * *mark;
    RoleSurface& left = out.surfaces.front();  // of the role lv_cavity
    TriangleMesh cup = meshOf(out, 0);
    const TriangleMesh cavity = cavityOfCup(cup, 0.5 * (out.apex + out.mitral));
    out.mitral = cavity.positions.back();
    out.surfaces.push_back({Role::lv_wall, "lv_wall", left.points_m, cup.triangles});
    out.triangles.push_back(cup.triangles);
    out.surfaces.front() = {Role::lv_cavity, "lv_cavity", cavity.positions, cavity.triangles};
    out.triangles.front() = cavity.triangles;
    return out;
  }();
  static const NamedMeshes meshes = meshesOfChambers(
      heart, {.ef = 0.52, .rv_ef = 0.50, .shortening = 0.14, .twist_deg = 10}, true);
  return sceneOfChambers(view, heart, meshes);
}

// The mean ventricles of a shape model with atria and great vessels, larger than published: the
// left ventricle's cavity has 113 mL.
inline Scene movingTemplateScene(View view) {
  static const std::filesystem::path folder = realFolder() / "meshes/bivme_template_1f";
  static const NamedMeshes meshes = [] {
    const RealHeart heart = ventriclesIn(folder, "template", kTemplateUnit_m);
    const TriangleMesh epi = meshOf(heart, Role::lv_wall);
    const StatedBeat beat({farthestFrom(heart.mitral, epi.positions),
                           heart.mitral,
                           meshOf(heart, Role::lv_cavity),
                           {epi, meshOf(heart, Role::rv_cavity)}},
                          {.ef = 0.40, .rv_ef = 0.38, .shortening = 0.09, .twist_deg = 6});
    constexpr double kRoof_m = 60e-3;  // of the tubes, about
    std::map<std::string, std::vector<std::shared_ptr<const TriangleMesh>>> frames;
    for (std::size_t s = 0; s < heart.surfaces.size(); ++s)
      frames[heart.surfaces[s].name] = framesOf(meshOf(heart, s), beat, kRoof_m);
    return wholeMeshes(folder, [&](const std::string& part, int frame) {
      return frames.at(part + "_000")[static_cast<std::size_t>(frame)];
    });
  }();
  static const RealHeart heart =
      withAtria(ventriclesIn(folder, "template", kTemplateUnit_m), meshes);
  return wholeScene(view, heart, folder, meshes);
}

// The heart of wholeHeartScene() with muscle that keeps its volume.
inline Scene movingWholeHeartScene(View view) {
  static const RealHeart heart = [] {
    RealHeart out = wholeHeart();
    for (RoleSurface& s : out.surfaces) s.name = nameOf(s.role);
    return out;
  }();
  static const NamedMeshes meshes = meshesOfChambers(
      heart, {.ef = 0.52, .rv_ef = 0.50, .shortening = 0.14, .twist_deg = 10}, false);
  return sceneOfChambers(view, heart, meshes);
}

struct NamedHeart {
  const char* name;
  Scene (*in)(View);
};

}  // namespace echocine::support
