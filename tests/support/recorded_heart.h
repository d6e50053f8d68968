#pragma once
// Parametric hearts as they are written, shared by the tests of one process, and measures of their
// meshes that owe nothing to the code that made them.

#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "motion/heart/leaflet.h"
#include "motion/subdivision/subdivision.h"
#include "output/heart_files.h"
#include "support/meshes.h"

namespace echocine::support {

using Dials = std::map<std::string, double>;

struct RecordedHeart {
  heart::Parameters parameters;
  heart::ParametricHeart model;
  heart::Recording recording;
};

inline const heart::ParametricHeart& defaultHeart() {
  static const heart::ParametricHeart made(heart::parametersFrom({}));
  return made;
}

// Made once for the same dials.
inline const RecordedHeart& recordedHeart(const Dials& dials, int keyframes) {
  static std::map<std::pair<Dials, int>, std::unique_ptr<RecordedHeart>> made;
  std::unique_ptr<RecordedHeart>& place = made[{dials, keyframes}];
  if (place) return *place;
  const heart::Parameters parameters = heart::parametersFrom(dials);
  const heart::ParametricHeart model(parameters);
  place = std::make_unique<RecordedHeart>(
      RecordedHeart{parameters, model, heart::record(model, heart::View::a4c, keyframes)});
  return *place;
}

// Vertices and triangles of an OBJ text, in its own unit.
inline Mesh meshOfObj(const std::string& text) {
  Mesh mesh;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3d& p = mesh.points.emplace_back();
      words >> p.x >> p.y >> p.z;
    } else if (kind == "f") {
      Triangle& t = mesh.triangles.emplace_back();
      for (std::uint32_t& vertex : t) {
        words >> vertex;
        --vertex;
      }
    }
  }
  return mesh;
}

// A part's keyframe as its file holds it, in mm.
inline Mesh writtenMesh(const heart::Recording& recording, const char* part, std::size_t keyframe) {
  return meshOfObj(heartMesh(recording.part(part), keyframe));
}

// The surface that a closed control mesh stands for, after one level of Loop's subdivision.
inline Mesh subdivided(const Mesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.points.size());
  const Subdivision subdivision(mesh.triangles, count, {}, 1, {});
  std::vector<Vec3f> control, refined(subdivision.vertexCount());
  for (const Vec3d p : mesh.points) control.push_back(toFloat(p));
  subdivision.apply(control, refined);
  Mesh fine{{}, subdivision.triangles()};
  for (const Vec3f p : refined) fine.points.push_back(toDouble(p));
  return fine;
}

inline Vec3d meanOf(const std::vector<Vec3d>& points) {
  Vec3d sum;
  for (const Vec3d p : points) sum = sum + p;
  return (1.0 / static_cast<double>(points.size())) * sum;
}

// Divergence theorem: a third of the flux of x through the faces, about the mesh's own middle.
inline double fluxVolume(const Mesh& mesh) {
  const Vec3d middle = meanOf(mesh.points);
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.points[t[0]], b = mesh.points[t[1]], c = mesh.points[t[2]];
    const Vec3d centre = (1.0 / 3) * (a + b + c) - middle;
    volume += dot(centre, 0.5 * cross(b - a, c - a)) / 3;
  }
  return volume;
}

// Of a mesh in mm.
inline double millilitresOf(const Mesh& mesh) {
  return fluxVolume(mesh) * 1e-3;
}

// How often a closed mesh winds round a point: 1 inside, 0 outside. Solid angles after Van Oosterom
// and Strackee, IEEE Trans. Biomed. Eng. 30, 125-126, 1983.
inline double windingNumber(const Mesh& mesh, Vec3d point) {
  double solid_angle = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.points[t[0]] - point, b = mesh.points[t[1]] - point,
                c = mesh.points[t[2]] - point;
    const double la = length(a), lb = length(b), lc = length(c);
    solid_angle += 2 * std::atan2(dot(a, cross(b, c)),
                                  la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return solid_angle / (4 * std::numbers::pi);
}

inline bool isInside(const Mesh& mesh, Vec3d point) {
  return windingNumber(mesh, point) > 0.5;
}

// A part at any phase as the model has it, in metres.
inline const heart::Part& partOf(const std::vector<heart::Part>& parts, std::string_view name) {
  for (const heart::Part& part : parts)
    if (part.kind.name == name) return part;
  throw std::runtime_error("no part " + std::string(name));
}

}  // namespace echocine::support
