#pragma once
// Two nested spheres of 81,920 triangles, and what the paper's equations say of a ray through the
// true spheres.

#include <optional>

#include "motion/surfaces/mesh_motion.h"
#include "scene/scan_geometry.h"
#include "support/plain_scene.h"
#include "support/scene_text.h"
#include "support/temp_folder.h"

namespace echocine::support {

inline constexpr int kSphereLevel = 6;

using Real = long double;
using Vec3r = Vec3<Real>;

inline constexpr Vec3d kSphereCentre{0.006, 0, 0.075};  // m; off the axis and in the imaging plane
inline constexpr double kOuterRadius = 0.04, kInnerRadius = 0.025;

// Speeds and densities of the order of soft tissue; the outer critical angle is 76.9 degrees.
inline SceneText nestedSpheres(const std::string& refraction) {
  SceneText text;
  text.background = "outside";
  const auto medium = [](const char* name, const char* rho, const char* c, const char* a,
                         const char* eta) {
    return std::string("[media.") + name + "]\ndensity_kg_m3 = " + rho +
           "\nsound_speed_m_s = " + c + "\nattenuation_db_cm_mhz = " + a +
           "\nbackscatter = { kind = \"fixed\", per_cm_sr = " + eta + " }\n";
  };
  text.media = medium("outside", "1000", "1500", "0.3", "1e-3") +
               medium("wall", "1060", "1540", "0.5", "4e-3") +
               medium("cavity", "1030", "1520", "0.15", "2e-4");
  text.probe["lines"] = "301";
  text.probe["samples"] = "1024";
  text.probe["depth_mm"] = "140";
  text.effects = {{"refraction", "\"" + refraction + "\""}};
  text.output = {{"cine", "false"}, {"channels", "[\"Y\", \"reflection.Y\"]"}};
  text.addStructure("wall", "wall", "\"outer.obj\"", 1);
  text.addStructure("cavity", "cavity", "\"inner.obj\"", 2);
  return text;
}

inline Scene writeNestedSpheres(const TempFolder& folder, const std::string& refraction,
                                int sphere_level = kSphereLevel) {
  const Mesh unit = icosphere(sphere_level, 1);
  writeObj(unit.scaled(100 * kOuterRadius).moved(100 * kSphereCentre), folder / "outer.obj");
  writeObj(unit.scaled(100 * kInnerRadius).moved(100 * kSphereCentre), folder / "inner.obj");
  return readScene(folder.write("scene.toml", nestedSpheres(refraction).text()));
}

// One straight piece of the exact ray, and the interface at its end.
struct ExactEdge {
  const Medium* medium;
  Real begin_m, end_m;  // path lengths
  Real exponent;        // A at its beginning
  Real passed;          // prod (1-R)^2 along it
  Real echo = 0;        // unattenuated, of the interface at its end
  Real incidence_deg = 0;
};

struct ExactLine {
  std::vector<ExactEdge> pieces;
  Real worst_incidence_deg = 0;
  bool ends = false;             // by total reflection
  Real beyond_critical_deg = 0;  // by how much
};

// The paper's product form along a ray through the true spheres.
class ExactRay {
 public:
  ExactRay(const Scene& scene, bool refraction) : scene_(scene), refraction_(refraction) {}

  ExactLine trace(const LineGeometry& start) {
    p_ = {start.origin.x, start.origin.y, start.origin.z};
    wave_ = d_ = {start.direction.x, start.direction.y, start.direction.z};
    ExactLine line;
    Real path = 0, exponent = 0, passed = 1;
    for (int shell = 0; !line.ends;) {  // 0 outside, 1 wall, 2 cavity
      const auto [distance, next] = nextSphere(shell);
      const Medium& medium = mediumOf(shell);
      line.pieces.push_back({&medium, path, path + distance, exponent, passed});
      if (next < 0) break;
      passInterface(line, medium, mediumOf(next),
                    std::max(shell, next) == 2 ? kInnerRadius : kOuterRadius, distance, passed);
      path += distance;
      exponent += 4 * medium.attenuation_np_per_m * distance;
      shell = next;
    }
    return line;
  }

 private:
  const Medium& mediumOf(int shell) const {
    return scene_.medium(shell == 0
                             ? scene_.background
                             : scene_.structures[static_cast<std::size_t>(shell - 1)].medium);
  }
  Vec3r fromCentre() const { return p_ - Vec3r{kSphereCentre.x, kSphereCentre.y, kSphereCentre.z}; }

  // Distance to the entry into a sphere from outside, or to the exit from inside.
  std::optional<Real> distanceTo(Real radius, bool from_inside) const {
    const Vec3r q = fromCentre();
    const Real b = dot(q, d_), h2 = radius * radius - dot(q, q) + b * b;
    if (h2 <= 0 || (!from_inside && b >= 0)) return std::nullopt;
    return from_inside ? -b + std::sqrt(h2) : -b - std::sqrt(h2);
  }
  std::pair<Real, int> nextSphere(int shell) const {
    if (shell == 0) {
      const auto entry = distanceTo(kOuterRadius, false);
      return entry ? std::pair(*entry, 1) : std::pair(Real(10), -1);
    }
    if (shell == 2) return {*distanceTo(kInnerRadius, true), 1};
    if (const auto entry = distanceTo(kInnerRadius, false)) return {*entry, 2};
    return {*distanceTo(kOuterRadius, true), 0};
  }

  void passInterface(ExactLine& line, const Medium& from, const Medium& to, Real radius,
                     Real distance, Real& passed) {
    p_ = p_ + distance * d_;
    const Vec3r normal = (1 / radius) * fromCentre();
    const Real cos_i = std::abs(dot(normal, wave_)), sin_i = std::sqrt(1 - cos_i * cos_i);
    const Real r = static_cast<Real>(to.sound_speed_m_s) / from.sound_speed_m_s;
    ExactEdge& piece = line.pieces.back();
    piece.incidence_deg = std::acos(cos_i) * 180 / std::numbers::pi_v<Real>;
    line.worst_incidence_deg = std::max(line.worst_incidence_deg, piece.incidence_deg);
    line.ends = r * sin_i >= 1;
    if (r > 1)
      line.beyond_critical_deg =
          piece.incidence_deg - std::asin(1 / r) * 180 / std::numbers::pi_v<Real>;
    const Real cos_t = line.ends ? 0 : std::sqrt(1 - r * r * sin_i * sin_i);
    const Real a = to.impedance_kg_m2_s * cos_i, b = from.impedance_kg_m2_s * cos_t;
    const Real R = line.ends ? 1 : (a - b) / (a + b) * ((a - b) / (a + b));
    const Real Z_1 = from.impedance_kg_m2_s, Z_2 = to.impedance_kg_m2_s;
    const Real upright = (Z_2 - Z_1) / (Z_2 + Z_1);
    const bool capped = scene_.effects.reflection_cap != Switch::off;
    piece.echo = passed * (capped ? std::min(R, upright * upright) : R) * cos_i * cos_i;
    passed *= (1 - R) * (1 - R);
    if (line.ends) return;
    const Vec3r forward = dot(normal, d_) < 0 ? -normal : normal;
    wave_ = normalised(r * wave_ + (cos_t - r * cos_i) * forward);
    if (refraction_) d_ = wave_;
  }

  const Scene& scene_;
  bool refraction_;
  Vec3r p_{}, d_{};
  Vec3r wave_{};  // Snell's direction, which straight rays carry for their angles
};

// I_R of section 4.1 at a path length.
inline Real exactBackscatter(const ExactLine& line, Real l, double unit_volume_m3) {
  for (const ExactEdge& p : line.pieces)
    if (l < p.end_m)
      return p.medium->backscatter_per_m_sr * unit_volume_m3 / (l * l) * p.passed *
             std::exp(-(p.exponent + 4 * p.medium->attenuation_np_per_m * (l - p.begin_m)));
  return 0;
}

}  // namespace echocine::support
