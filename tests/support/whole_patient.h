#pragma once
// The real patient's ventricles with what cine MR did not give: atria and great vessels. They are
// tubes on the valve rings, which move with the rings; their roofs stay in place.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "support/real_hearts.h"
#include "support/view_loops.h"

namespace echocine::support {

// A tube from a ring along its normal. `wide`: its largest width over that of the ring.
struct TubeShape {
  const char* name;
  const char* wall;   // structure around it
  const char* valve;  // mesh of its lid
  double length_m, wide, wall_m;
  bool vessel;
  int priority, wall_priority;
};

// Our choice: widths of the patient's valves.
inline constexpr TubeShape kTubes[] = {
    {"aorta", "aortic_wall", "aortic_valve", 0.060, 1.10, 2e-3, true, 9, 8},
    {"la", "la_wall", "mitral_valve", 0.045, 1.30, 2e-3, false, 7, 6},
    {"ra", "ra_wall", "tricuspid_valve", 0.048, 1.15, 2e-3, false, 5, 4},
    {"pulmonary_artery", "pulmonary_wall", "pulmonary_valve", 0.045, 1.05, 2e-3, true, 3, 2}};

// The ring of a fan of triangles about its last vertex, in order, and its unit normal: the way that
// the triangles face.
struct Ring {
  std::vector<Vec3d> points;
  Vec3d middle, normal;
};

inline Ring ringOf(const TriangleMesh& fan, double metres_per_unit) {
  const auto hub = static_cast<std::uint32_t>(fan.positions.size() - 1);
  std::map<std::uint32_t, std::uint32_t> next;
  for (const Triangle& t : fan.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k] == hub) next[t[(k + 1) % 3]] = t[(k + 2) % 3];
  Ring ring;
  for (std::uint32_t v = next.begin()->first; ring.points.size() < next.size(); v = next.at(v))
    ring.points.push_back(metres_per_unit * fan.positions[v]);
  ring.middle = meanPoint(ring.points);
  Vec3d area{};
  for (std::size_t i = 0; i < ring.points.size(); ++i)
    area = area + cross(ring.points[i] - ring.middle,
                        ring.points[(i + 1) % ring.points.size()] - ring.middle);
  ring.normal = normalised(area);
  return ring;
}

// Closed tube from the ring `now` to the roof that stands over the ring `first`; `more_m` is added
// to its radius and its ends.
inline TriangleMesh tubeOn(const Ring& now, const Ring& first, const TubeShape& shape,
                           double more_m) {
  constexpr int kRows = 12;
  constexpr double kWidest = 0.45;  // part of the length; our choice
  constexpr double kInto_m = 1e-3;  // into the ventricle, which wins there
  const Vec3d roof = first.middle + (shape.length_m + more_m) * first.normal,
              floor = now.middle - (kInto_m + more_m) * now.normal;
  TriangleMesh mesh;
  const auto count = static_cast<std::uint32_t>(now.points.size());
  double radius_m = 0;
  for (const Vec3d p : now.points) radius_m += length(p - now.middle) / count;
  for (int row = 0; row < kRows; ++row) {
    const double s = static_cast<double>(row) / kRows;
    // Half an ellipse closes an atrium; a vessel stays open for longer.
    const double beyond = std::max(0.0, (s - kWidest) / (1 - kWidest));
    const double rise = std::sin(0.5 * std::numbers::pi * std::min(1.0, s / kWidest));
    const double width =
        (1 + (shape.wide - 1) * rise) * std::pow(1 - std::pow(beyond, shape.vessel ? 8 : 2), 0.5);
    const Vec3d middle = (1 - s) * floor + s * roof;
    for (std::uint32_t i = 0; i < count; ++i) {
      // The rim becomes a circle on its way.
      const Vec3d own = now.points[i] - now.middle,
                  across = own - dot(own, now.normal) * now.normal;
      const Vec3d round = radius_m * normalised(across);
      const double part = std::min(1.0, s / kWidest);
      const Vec3d from = (1 - part) * own + part * round;
      mesh.positions.push_back(middle + width * from + more_m * normalised(across));
    }
  }
  mesh.positions.push_back(floor);
  mesh.positions.push_back(roof);
  const std::uint32_t bottom = kRows * count, top = bottom + 1;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = (i + 1) % count, last = (kRows - 1) * count;
    mesh.triangles.push_back({bottom, j, i});
    mesh.triangles.push_back({last + i, last + j, top});
    for (std::uint32_t row = 0; row + 1 < kRows; ++row) {
      const std::uint32_t a = row * count, b = a + count;
      mesh.triangles.push_back({a + i, a + j, b + j});
      mesh.triangles.push_back({a + i, b + j, b + i});
    }
  }
  return mesh;
}

inline std::string frameName(const std::string& part, int frame) {
  return part + (frame < 10 ? "_00" : "_0") + std::to_string(frame) + ".obj";
}

inline constexpr int kVentricleFrames = 25;

// Mesh of a part of the ventricles, named as the patient's, in one frame, in mm.
using VentriclesAt =
    std::function<std::shared_ptr<const TriangleMesh>(const std::string& part, int frame)>;

// Meshes of ventricles and of their tubes, in mm, by the names that patientScene(folder) gives.
inline NamedMeshes wholeMeshes(const std::filesystem::path& folder, const VentriclesAt& at) {
  NamedMeshes out;
  for (const char* part : {"epi", "lv_endo_closed", "rv_endo_closed", "mitral_valve",
                           "aortic_valve", "tricuspid_valve", "pulmonary_valve"})
    for (int frame = 0; frame < kVentricleFrames; ++frame)
      out[(folder / frameName(part, frame)).string()] = at(part, frame);
  for (const TubeShape& shape : kTubes) {
    const Ring first = ringOf(*at(shape.valve, 0), 1e-3);
    for (int frame = 0; frame < kVentricleFrames; ++frame) {
      const Ring now = ringOf(*at(shape.valve, frame), 1e-3);
      for (const bool wall : {false, true}) {
        TriangleMesh tube = tubeOn(now, first, shape, wall ? shape.wall_m : 0);
        for (Vec3d& p : tube.positions) p = 1e3 * p;
        out[frameName(wall ? shape.wall : shape.name, frame)] =
            std::make_shared<const TriangleMesh>(std::move(tube));
      }
    }
  }
  return out;
}

// The ventricles with their tubes' cavities at end-diastole.
inline RealHeart withAtria(RealHeart ventricles, const NamedMeshes& meshes) {
  const auto add = [&](Role role, const char* name) {
    const TriangleMesh& mesh = *meshes.at(frameName(name, 0));
    RoleSurface surface{role, name, {}, mesh.triangles};
    for (const Vec3d p : mesh.positions) surface.points_m.push_back(1e-3 * p);
    ventricles.surfaces.push_back(std::move(surface));
    ventricles.triangles.push_back(mesh.triangles);
  };
  add(Role::la, "la");
  add(Role::ra, "ra");
  return ventricles;
}

// A scene of them in a view.
inline Scene wholeScene(View view, const RealHeart& heart, const std::filesystem::path& folder,
                        const NamedMeshes& meshes) {
  SceneText text = patientScene(folder);
  holdProbe(view, heart.surfaces, 1e-3, text);
  text.output.clear();
  // Over all tubes.
  const auto raise = [&](const char* from, const char* to) {
    for (std::size_t at = 0; (at = text.structures.find(from, at)) != std::string::npos;
         at += std::strlen(to))
      text.structures.replace(at, std::strlen(from), to);
  };
  raise("priority = 2\n", "priority = 12\n");
  raise("priority = 1\n", "priority = 11\n");
  for (const TubeShape& shape : kTubes) {
    text.addStructure(shape.name, "blood", "\"" + std::string(shape.name) + "_???.obj\"",
                      shape.priority);
    text.addStructure(shape.wall, shape.vessel ? "vessel_wall" : "myocardium",
                      "\"" + std::string(shape.wall) + "_???.obj\"", shape.wall_priority);
  }
  return parseScene(text.text(), "scene.toml", meshes);
}

// The patient's heart in a view, with atria and great vessels.
inline Scene wholePatientScene(View view) {
  static const NamedMeshes meshes =
      wholeMeshes(patientMeshes(), [](const std::string& part, int frame) {
        Sha256 digest;
        return std::make_shared<const TriangleMesh>(
            readMesh(patientMeshes() / frameName(part, frame), digest));
      });
  static const RealHeart heart = withAtria(patientHeart(), meshes);
  return wholeScene(view, heart, patientMeshes(), meshes);
}

}  // namespace echocine::support
