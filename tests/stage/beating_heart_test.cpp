// The beating heart that ships: sound meshes, a plausible beat, and the generator that made them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "examples/beating_heart/control_mesh.h"
#include "examples/beating_heart/heart_keyframes.h"

namespace echocine::beating_heart {
namespace {

const std::vector<std::string> kClosed{"lv_cavity", "lv_wall", "rv_cavity", "rv_wall",
                                       "la",        "la_wall", "ra",        "ra_wall"};
const std::vector<std::string> kSheets{"mitral_anterior", "mitral_posterior", "tricuspid_septal",
                                       "tricuspid_lateral"};

struct Mesh {
  std::vector<Vec3d> points_cm;
  std::vector<Face> faces;
};

std::string shippedText(const std::string& file_name) {
  const auto path = std::filesystem::path(ECHOCINE_DATA_DIR) / "beating_heart" / file_name;
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Mesh shippedMesh(const std::string& structure, int keyframe) {
  const std::string number = (keyframe < 10 ? "_0" : "_") + std::to_string(keyframe);
  std::istringstream text(shippedText(structure + number + ".obj"));
  Mesh mesh;
  for (std::string kind; text >> kind;) {
    if (kind == "v") {
      Vec3d p;
      text >> p.x >> p.y >> p.z;
      mesh.points_cm.push_back(p);
    } else {
      Face face;
      text >> face[0] >> face[1] >> face[2];
      for (auto& vertex : face) --vertex;
      mesh.faces.push_back(face);
    }
  }
  return mesh;
}

// How often each directed edge is run by a face.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edgesOf(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Face& face : mesh.faces)
    for (int k = 0; k < 3; ++k) ++edges[{face[k], face[(k + 1) % 3]}];
  return edges;
}

// The number of vertices on the boundary; fails where an edge has three faces or two that disagree.
std::size_t boundaryVertices(const Mesh& mesh) {
  const auto edges = edgesOf(mesh);
  std::set<std::uint32_t> boundary;
  for (const auto& [edge, uses] : edges) {
    EXPECT_EQ(uses, 1);
    if (edges.count({edge.second, edge.first}) == 0) boundary.insert({edge.first, edge.second});
  }
  return boundary.size();
}

// One level of Loop subdivision of a closed mesh.
Mesh subdivided(const Mesh& mesh) {
  const auto edges = edgesOf(mesh);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> opposite, middle;
  std::vector<std::vector<std::uint32_t>> ring(mesh.points_cm.size());
  for (const Face& face : mesh.faces)
    for (int k = 0; k < 3; ++k) {
      opposite[{face[k], face[(k + 1) % 3]}] = face[(k + 2) % 3];
      ring[face[k]].push_back(face[(k + 1) % 3]);
    }
  Mesh fine;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double n = double(ring[i].size());
    const double weight =
        (0.625 - std::pow(0.375 + 0.25 * std::cos(2 * std::numbers::pi / n), 2)) / n;
    Vec3d point = (1 - n * weight) * mesh.points_cm[i];
    for (const auto other : ring[i]) point = point + weight * mesh.points_cm[other];
    fine.points_cm.push_back(point);
  }
  for (const auto& [edge, uses] : edges) {
    const auto [a, b] = edge;
    if (a > b) continue;
    middle[{a, b}] = middle[{b, a}] = static_cast<std::uint32_t>(fine.points_cm.size());
    const auto& p = mesh.points_cm;
    fine.points_cm.push_back(0.375 * (p[a] + p[b]) +
                             0.125 * (p[opposite.at({a, b})] + p[opposite.at({b, a})]));
  }
  for (const Face& f : mesh.faces) {
    const Face m{middle[{f[0], f[1]}], middle[{f[1], f[2]}], middle[{f[2], f[0]}]};
    fine.faces.insert(fine.faces.end(),
                      {{f[0], m[0], m[2]}, {m[0], f[1], m[1]}, {m[2], m[1], f[2]}, m});
  }
  return fine;
}

// Volume of the surface as it is rendered.
double volume_ml(const std::string& structure, int keyframe) {
  const Mesh rendered = subdivided(subdivided(shippedMesh(structure, keyframe)));
  return volumeOf(rendered.points_cm, rendered.faces);
}

std::vector<double> volumes_ml(const std::string& structure) {
  std::vector<double> volumes;
  for (int k = 0; k < kKeyframes; ++k) volumes.push_back(volume_ml(structure, k));
  return volumes;
}

// How often a periodic curve turns from falling to rising; steps below the tolerance are level.
int minimaOf(const std::vector<double>& curve, double tolerance) {
  std::vector<bool> rising;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double step = curve[(i + 1) % curve.size()] - curve[i];
    if (std::abs(step) > tolerance) rising.push_back(step > 0);
  }
  int minima = 0;
  for (std::size_t i = 0; i < rising.size(); ++i)
    minima += rising[i] && !rising[(i + rising.size() - 1) % rising.size()];
  return minima;
}

}  // namespace

TEST(BeatingHeart, ChambersAndWallsAreClosedAndLookOutward) {
  for (const auto& name : kClosed)
    for (int k = 0; k < kKeyframes; ++k) {
      SCOPED_TRACE(name + " " + std::to_string(k));
      const Mesh mesh = shippedMesh(name, k);
      ASSERT_FALSE(mesh.faces.empty());
      EXPECT_EQ(boundaryVertices(mesh), 0u);
      EXPECT_GT(volumeOf(mesh.points_cm, mesh.faces), 0);
      // Euler: a sphere has twice as many faces as vertices, less four.
      EXPECT_EQ(mesh.faces.size(), 2 * mesh.points_cm.size() - 4);
    }
}

TEST(BeatingHeart, LeafletsAreSheetsWithOneBorder) {
  for (const auto& name : kSheets) {
    SCOPED_TRACE(name);
    const Mesh mesh = shippedMesh(name, 0);
    ASSERT_EQ(mesh.points_cm.size(), 63u);
    EXPECT_EQ(boundaryVertices(mesh), 28u);
  }
}

TEST(BeatingHeart, FacesAreTheSameInEveryKeyframe) {
  for (const auto& names : {kClosed, kSheets})
    for (const auto& name : names) {
      const Mesh first = shippedMesh(name, 0);
      for (int k = 1; k < kKeyframes; ++k) {
        const Mesh mesh = shippedMesh(name, k);
        EXPECT_EQ(mesh.faces, first.faces) << name << " " << k;
        EXPECT_EQ(mesh.points_cm.size(), first.points_cm.size()) << name << " " << k;
      }
    }
}

TEST(BeatingHeart, LeftVentricleFillsAndEjectsOncePerBeat) {
  const std::vector<double> volumes = volumes_ml("lv_cavity");
  const auto [least, most] = std::minmax_element(volumes.begin(), volumes.end());
  EXPECT_NEAR(*most, 120, 2);
  const double ejection_fraction = 1 - *least / *most;
  EXPECT_GT(ejection_fraction, 0.55);
  EXPECT_LT(ejection_fraction, 0.65);
  EXPECT_EQ(most - volumes.begin(), 0);  // phase 0 is end-diastole
  EXPECT_EQ(minimaOf(volumes, 0.1), 1);  // 0.1 mL: relaxation at constant volume is level
}

TEST(BeatingHeart, VentriclesEjectTheSameVolume) {
  const std::vector<double> left = volumes_ml("lv_cavity"), right = volumes_ml("rv_cavity");
  const auto stroke = [](const std::vector<double>& curve) {
    const auto [least, most] = std::minmax_element(curve.begin(), curve.end());
    return *most - *least;
  };
  EXPECT_NEAR(stroke(left), stroke(right), 0.03 * stroke(left));
}

TEST(BeatingHeart, MuscleKeepsItsVolume) {
  const std::vector<double> outer = volumes_ml("lv_wall"), cavity = volumes_ml("lv_cavity");
  std::vector<double> muscle;
  for (int k = 0; k < kKeyframes; ++k) muscle.push_back(outer[k] - cavity[k]);
  const auto [least, most] = std::minmax_element(muscle.begin(), muscle.end());
  EXPECT_LT(*most - *least, 0.05 * *least);
}

TEST(BeatingHeart, AtriaAreFullestWhenTheVentriclesAreEmptiest) {
  for (const char* name : {"la", "ra"}) {
    const std::vector<double> volumes = volumes_ml(name);
    const auto fullest = std::max_element(volumes.begin(), volumes.end()) - volumes.begin();
    EXPECT_NEAR(double(fullest) / kKeyframes, 0.4, 0.06) << name;
  }
}

// The gap between the free edges' middles, across the ring.
double mitralGap_cm(int keyframe) {
  constexpr std::size_t kMiddleOfFreeEdge = 6 * 9 + 4;
  const Mesh anterior = shippedMesh("mitral_anterior", keyframe);
  const Mesh posterior = shippedMesh("mitral_posterior", keyframe);
  return posterior.points_cm[kMiddleOfFreeEdge].x - anterior.points_cm[kMiddleOfFreeEdge].x;
}

TEST(BeatingHeart, MitralValveIsShutInSystoleAndOpensTwiceInDiastole) {
  std::vector<double> gaps_cm;
  for (int k = 0; k < kKeyframes; ++k) gaps_cm.push_back(mitralGap_cm(k));
  for (int k = 0; k <= 8; ++k) EXPECT_LT(gaps_cm[k], 0.1) << k;
  const double e_wave_cm = gaps_cm[10], diastasis_cm = gaps_cm[15], a_wave_cm = gaps_cm[18];
  EXPECT_GT(e_wave_cm, 2);
  EXPECT_LT(diastasis_cm, 0.6 * a_wave_cm);
  EXPECT_LT(a_wave_cm, e_wave_cm);
}

TEST(BeatingHeart, GeneratorWritesTheShippedBytes) {
  const std::vector<KeyframeFile> files = heartKeyframes();
  EXPECT_EQ(files.size(), (kClosed.size() + kSheets.size()) * kKeyframes);
  for (const KeyframeFile& file : files)
    EXPECT_TRUE(file.text == shippedText(file.name)) << file.name;
}

}  // namespace echocine::beating_heart
