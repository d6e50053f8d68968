#pragma once
// Small random worlds, the same for the same number in every run: structures that nest, overlap,
// touch and coincide, snapped to the planes that rays and slices decide by; media from tissue to
// absurd; every effect and signal setting.

#include <cstdint>

#include "core/hash_random.h"
#include "support/plain_scene.h"
#include "support/world.h"

namespace echocine::support {

// A stream of numbers that are hashes of (world, count).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}
  double unit() { return uniformFromHash(hashOf(seed_, ++count_)); }
  double number(double lo, double hi) { return lo + (hi - lo) * unit(); }
  double decade(double lo, double hi) { return lo * std::pow(hi / lo, unit()); }
  int whole(int lo, int hi) { return lo + static_cast<int>(unit() * (hi - lo + 1)); }
  bool chance(double p) { return unit() < p; }
  Vec3d vector(double lo, double hi) {
    const double x = number(lo, hi), y = number(lo, hi), z = number(lo, hi);
    return {x, y, z};
  }

 private:
  std::uint64_t seed_, count_ = 0;
};

inline Medium randomMedium(Dice& dice, int number) {
  const bool absurd = dice.chance(0.2);
  const double density = absurd ? dice.decade(1e-2, 1e5) : dice.number(900, 1200);
  const double speed = absurd ? dice.decade(10, 1e5) : dice.number(1400, 1700);
  const double alpha = dice.chance(0.3) ? 0 : dice.decade(1e-2, absurd ? 1e9 : 1e2);
  const double eta = dice.chance(0.3) ? 0 : dice.decade(1e-6, absurd ? 1e6 : 1);
  return medium("m" + std::to_string(number), density, speed, alpha, eta);
}

inline std::vector<Medium> randomMedia(Dice& dice) {
  std::vector<Medium> media;
  const int count = dice.whole(2, 5);
  for (int i = 0; i < count; ++i) {
    media.push_back(randomMedium(dice, i));
    if (i == 0) continue;
    const Medium& before = media[static_cast<std::size_t>(i) - 1];
    if (dice.chance(0.1)) media.back().impedance_kg_m2_s = before.impedance_kg_m2_s;
    if (dice.chance(0.1)) media.back().sound_speed_m_s = before.sound_speed_m_s;
  }
  return media;
}

inline Probe randomProbe(Dice& dice) {
  Probe p;
  p.kind = static_cast<ProbeKind>(dice.whole(0, 3));
  const bool radial = p.kind == ProbeKind::radial;
  p.lines = radial ? dice.whole(16, 25) : dice.chance(0.1) ? 1 : dice.whole(2, 9);
  p.samples = dice.chance(0.1) ? 1 : dice.whole(2, 64);
  p.min_depth_m = dice.chance(0.5) ? 0 : dice.number(0, 0.01);
  p.max_depth_m = p.min_depth_m + dice.decade(1e-3, 0.2);
  p.frequency_hz = dice.decade(1e6, 1.5e7);
  p.aperture_m = dice.number(0.005, 0.04);
  p.focus_m = dice.number(0.01, 0.15);
  if (p.kind == ProbeKind::linear) {
    p.first_offset_m = -dice.number(0.001, 0.04);
    p.last_offset_m = -p.first_offset_m;
  } else if (radial) {
    lookAllRound(dice.number(0.001, 0.02), p);
  } else {
    const double half = dice.chance(0.1) ? 90 : dice.number(5, 80);
    p.first_angle_rad = radiansFromDegrees(-half);
    p.last_angle_rad = radiansFromDegrees(half);
  }
  if (p.kind == ProbeKind::curvilinear) p.face_radius_m = dice.number(0.005, 0.06);
  return p;
}

inline Mesh randomShape(Dice& dice, bool membrane) {
  if (membrane) return sheet(dice.whole(1, 3), 1, 0);
  switch (dice.whole(0, 5)) {
    case 0:
      return icosphere(dice.whole(0, 2), 1);
    case 1:
      return octasphere(dice.whole(0, 2), 1);
    case 2:
      return uvSphere(dice.whole(2, 6), dice.whole(3, 8), 1);
    case 3:
      return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
              {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
    default:
      return box({-1, -1, -1}, {1, 1, 1});
  }
}

inline Mesh rotated(const Mesh& mesh, Vec3d axis, double angle) {
  Mesh copy = mesh;
  for (Vec3d& p : copy.points)
    p = std::cos(angle) * p + std::sin(angle) * cross(axis, p) +
        ((1 - std::cos(angle)) * dot(axis, p)) * axis;
  return copy;
}

// Coordinates on a grid of 5 mm and of the apex lie exactly on scan lines, planes and each other.
inline void snap(Mesh& mesh, Dice& dice) {
  const double grid = dice.chance(0.5) ? 0.005 : 0.01;
  for (Vec3d& p : mesh.points)
    p = {grid * std::round(p.x / grid), grid * std::round(p.y / grid),
         grid * std::round(p.z / grid)};
}

inline Mesh randomMesh(Dice& dice, bool membrane) {
  Mesh mesh = randomShape(dice, membrane);
  const double size = dice.decade(1e-3, 0.08);
  const double flat = dice.chance(0.15) ? dice.decade(1e-9, 1e-2) : 1;  // slivers, thin walls
  for (Vec3d& p : mesh.points) p = {size * p.x, size * p.y, size * flat * p.z};
  if (dice.chance(0.5))
    mesh = rotated(mesh, normalised(dice.vector(0.1, 1)), dice.number(0, 2 * std::numbers::pi));
  mesh = mesh.moved({dice.number(-0.04, 0.04), dice.number(-0.02, 0.02), dice.number(-0.02, 0.15)});
  if (dice.chance(0.3)) snap(mesh, dice);
  if (dice.chance(0.1)) {  // a vertex of it at the apex
    const Vec3d corner = mesh.points[static_cast<std::size_t>(
        dice.unit() * static_cast<double>(mesh.points.size()))];
    mesh = mesh.moved(-corner);
  }
  if (dice.chance(0.05)) {  // a triangle without area, and one that is there twice both ways
    const auto [a, b, c] = mesh.triangles[0];
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, b}, {a, b, c}, {c, b, a}});
  }
  return mesh;
}

inline void addRandomStructure(World& world, Dice& dice) {
  const bool membrane = dice.chance(0.2);
  addStructure(
      world.scene,
      static_cast<std::size_t>(dice.whole(0, static_cast<int>(world.scene.media.size()) - 1)),
      dice.whole(0, 4), membrane);
  Structure& s = world.scene.structures.back();
  s.reflection_gain = dice.chance(0.8) ? 1 : dice.number(0, 5);
  s.reflection_exponent = dice.chance(0.7) ? dice.whole(0, 2) : dice.decade(0.01, 200);
  const std::size_t others = world.meshes.size();
  if (others > 0 && !membrane && dice.chance(0.25)) {
    const auto pick = static_cast<std::size_t>(dice.unit() * static_cast<double>(others));
    if (!world.scene.structures[pick].membrane) {  // coincident, touching, or nested
      Mesh copy = world.meshes[pick];
      if (dice.chance(0.3))
        copy = copy.moved({dice.chance(0.5) ? 0.01 : 0, 0, dice.decade(1e-9, 1e-2)});
      if (dice.chance(0.3)) copy = copy.scaled(dice.number(0.9, 1.1));
      world.meshes.push_back(copy);
      return;
    }
  }
  world.meshes.push_back(randomMesh(dice, membrane));
}

inline Switch randomSwitch(Dice& dice) {
  return dice.chance(0.6) ? Switch::automatic : dice.chance(0.5) ? Switch::on : Switch::off;
}

inline void randomSettings(Scene& scene, Dice& dice) {
  EffectSwitches& e = scene.effects;
  for (Switch* s : {&e.reflection, &e.lobe, &e.transmission_loss, &e.refraction, &e.attenuation,
                    &e.backscatter, &e.spread, &e.beam_width, &e.travel_time})
    *s = randomSwitch(dice);
  SignalSettings& s = scene.signal;
  s.tgc = static_cast<Tgc>(dice.whole(0, 2));
  if (s.tgc == Tgc::table) s.tgc_table = {{0.0, -5.0}, {0.05, dice.number(0, 40)}, {0.1, 60.0}};
  s.spread = static_cast<Spread>(dice.whole(0, 1));
  s.beam_width = static_cast<BeamWidth>(dice.whole(0, 2));
  s.beam_width_m = dice.decade(1e-5, 0.05);
  s.pulse_cycles = dice.chance(0.2) ? 0 : dice.number(0.1, 10);
  s.dynamic_range_db = dice.decade(1, 300);
  scene.output.channels = {Channel::y,          Channel::unattenuated, Channel::attenuation,
                           Channel::reflection, Channel::backscatter,  Channel::medium};
  scene.output.width = 24;
  scene.output.height = 20;
  scene.unit_volume_m3 = dice.chance(0.8) ? 1e-6 : dice.decade(1e-12, 1);
}

// Several rays per beam, over a lens from needle to plate.
inline void randomBeam(Scene& scene, Dice& dice) {
  scene.accuracy.rays_per_beam = dice.chance(0.2) ? dice.whole(17, 70) : dice.whole(2, 16);
  scene.probe.elevation_aperture_m = dice.decade(1e-4, 0.1);
  scene.probe.elevation_focus_m = dice.decade(1e-3, 10);
  scene.acquisition.seed = dice.whole(0, 1000000);
  if (scene.signal.beam_width == BeamWidth::fixed) scene.signal.beam_width = BeamWidth::focused;
  scene.effects.elevation = randomSwitch(dice);
}

inline World randomWorld(std::uint64_t number) {
  Dice dice(hashOf(std::uint64_t{0x5ce4e}, number));
  World world;
  world.scene.media = randomMedia(dice);
  world.scene.probe = randomProbe(dice);
  randomSettings(world.scene, dice);
  const int structures = dice.whole(1, 6);
  for (int i = 0; i < structures; ++i) addRandomStructure(world, dice);
  if (dice.chance(0.3))
    for (const Mesh& mesh : world.meshes) {  // smooth normals, some of them missing
      world.normals.emplace_back();
      for (std::size_t v = 0; v < mesh.points.size(); ++v)
        world.normals.back().push_back(dice.chance(0.1) ? Vec3f{}
                                                        : toFloat(normalised(dice.vector(-1, 1))));
    }
  return world;
}

}  // namespace echocine::support
