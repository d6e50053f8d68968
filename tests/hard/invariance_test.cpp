// What must not change the image: the unit of the meshes, where the world stands and how it is
// turned, its mirror image, the order of structures and triangles, how a face is cut up.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "motion/surfaces/mesh_motion.h"
#include "support/random_world.h"
#include "support/scene_text.h"
#include "support/sweep.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

// Largest difference of two images, relative to the brighter sample.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i])
      worst = std::max(worst, static_cast<double>(std::abs(a[i] - b[i]) / std::max(a[i], b[i])));
  return worst;
}

// Does the image show anything but the background?
bool shows(const World& world, const std::vector<float>& reflection) {
  const auto lit =
      std::count_if(reflection.begin(), reflection.end(), [](float v) { return v > 0; });
  return lit > 2 * world.scene.probe.lines;
}

// A wall, a cavity in it and a leaflet, in centimetres about (0, 0, 7); the probe is at the origin.
struct Parts {
  Mesh wall = icosphere(3, 3.5).moved({0.3, 0.2, 7}),
       cavity = icosphere(3, 2.5).moved({0.4, 0.1, 7}), leaflet = sheet(4, 0.8, 6.53);
};

std::string textOf(Vec3d v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z);
}

// The world after a map of all its points (and of the probe, which follows it); y: mirrored probes
// keep their right hand by themselves.
template <typename Map>
World worldOf(Map&& map, double unit_m = 0.01, bool flip_faces = false) {
  const TempFolder folder;
  const Parts parts;
  const auto write = [&](Mesh mesh, const char* name) {
    for (Vec3d& p : mesh.points) p = map(p);
    writeObj(flip_faces ? mesh.insideOut() : mesh, folder / name);
    return "\"" + (folder / name).string() + "\"";
  };
  SceneText text;
  text.setProbe("lines", "48");
  text.setProbe("samples", "200");
  text.setProbe("apex", textOf(map({0, 0, 0})));
  text.setProbe("axis", textOf(map({0, 0, 1}) - map({0, 0, 0})));
  text.setProbe("lateral", textOf(map({1, 0, 0}) - map({0, 0, 0})));
  text.motion["mesh_unit"] = unit_m == 1 ? "\"m\"" : unit_m == 0.01 ? "\"cm\"" : "\"mm\"";
  text.addStructure("wall", "myocardium", write(parts.wall, "wall.obj"), 1);
  text.addStructure("cavity", "blood", write(parts.cavity, "cavity.obj"), 2);
  text.structures +=
      "[[structure]]\nname = \"leaflet\"\nmedium = \"valve\"\nmembrane = true\nkeyframes = " +
      write(parts.leaflet, "leaflet.obj") + "\n";
  World world{parsed(text), {}};
  const MeshMotion motion(world.scene);
  SurfaceFrame frame;
  motion.frameAt(0, frame);
  for (std::size_t s = 0; s < frame.positions_m.size(); ++s) {
    Mesh mesh{{}, motion.surfaces()[s].triangles};
    for (const Vec3f p : frame.positions_m[s]) mesh.points.push_back(toDouble(p));
    world.meshes.push_back(mesh);
  }
  return world;
}

const auto kSame = [](Vec3d p) { return p; };

// Mostly to the last bit, since world coordinates are double until they are in the probe frame; a
// vertex that comes out in another rounding of single precision (4 nm at 7 cm) may move an angle.
void expectSameImages(const std::string& name, const World& a, const World& b) {
  Sweep sweep(name + ": image", "the image before", kOfTracer, 1e-5);
  for (const Tracer tracer : kTracers)
    for (const Switch refraction : {Switch::off, Switch::on}) {
      if (refraction == Switch::on && tracer != Tracer::embree) continue;
      World one = a, other = b;
      one.scene.effects.refraction = other.scene.effects.refraction = refraction;
      one.scene.output.channels = other.scene.output.channels = {Channel::y, Channel::reflection};
      const PolarFrame before = traceWorld(one, tracer), after = traceWorld(other, tracer);
      EXPECT_TRUE(shows(one, before.planes.at(Channel::reflection))) << name;
      sweep.addError(static_cast<double>(tracer),
                     difference(before.planes.at(Channel::y), after.planes.at(Channel::y)));
    }
}

// The unit is a scene key: the same heart in another unit is the same picture.
TEST(Invariance, MillimetresCentimetresAndMetres) {
  const World cm = worldOf(kSame);
  expectSameImages("mm for cm", cm, worldOf([](Vec3d p) { return 10.0 * p; }, 0.001));
  expectSameImages("m for cm", cm, worldOf([](Vec3d p) { return 0.01 * p; }, 1));
}

// Coordinates of a scanner's or a patient's table: floats must not see them.
TEST(Invariance, AThousandUnitsAway) {
  for (const double unit_m : {0.001, 0.01, 1.0}) {
    const double scale = 0.01 / unit_m;
    const auto near = [scale](Vec3d p) { return scale * p; };
    const auto far = [scale](Vec3d p) { return scale * p + Vec3d{1000, -1000, 1000}; };
    expectSameImages(fmt::format("offset of 1e3 units of {:g} m", unit_m), worldOf(near, unit_m),
                     worldOf(far, unit_m));
  }
}

TEST(Invariance, WorldAndProbeTurnedTogether) {
  const World still = worldOf(kSame);
  for (const double angle : {0.1, 1.0, 2.5}) {
    const Vec3d axis = normalised(Vec3d{1, -2, 0.7});
    const auto turn = [axis, angle](Vec3d p) {
      return std::cos(angle) * p + std::sin(angle) * cross(axis, p) +
             ((1 - std::cos(angle)) * dot(axis, p)) * axis + Vec3d{3, 1, -2};
    };
    expectSameImages(fmt::format("rigid motion of the world, {:g} rad", angle), still,
                     worldOf(turn));
  }
}

// Mirrored world and probe: the same image. Meshes turn their faces, so that they still look out.
TEST(Invariance, WorldAndProbeMirroredTogether) {
  const World still = worldOf(kSame);
  expectSameImages("mirror across the beam", still,
                   worldOf(
                       [](Vec3d p) {
                         return Vec3d{-p.x, p.y, p.z};
                       },
                       0.01, true));
  expectSameImages("mirror along the beam", still,
                   worldOf(
                       [](Vec3d p) {
                         return Vec3d{p.x, p.y, -p.z};
                       },
                       0.01, true));
  expectSameImages("mirror of the elevation", still,
                   worldOf(
                       [](Vec3d p) {
                         return Vec3d{p.x, -p.y, p.z};
                       },
                       0.01, true));
}

// Only the meshes mirrored: the lines come in reverse order.
TEST(Invariance, AMirroredHeartMirrorsTheImage) {
  Sweep sweep("mirrored meshes: reversed lines", "the image before", kOfTracer, 1e-5);
  World world = worldOf(kSame), mirrored = world;
  for (Mesh& mesh : mirrored.meshes) {
    for (Vec3d& p : mesh.points) p.x = -p.x;
    mesh = mesh.insideOut();
  }
  const auto samples = static_cast<std::size_t>(world.scene.probe.samples);
  for (const Tracer tracer : kTracers) {
    const std::vector<float> a = traceWorld(world, tracer).planes.at(Channel::y),
                             b = traceWorld(mirrored, tracer).planes.at(Channel::y);
    std::vector<float> reversed;
    for (std::size_t begin = b.size(); begin > 0; begin -= samples)
      reversed.insert(reversed.end(), b.begin() + static_cast<std::ptrdiff_t>(begin - samples),
                      b.begin() + static_cast<std::ptrdiff_t>(begin));
    sweep.addError(static_cast<double>(tracer), difference(a, reversed));
  }
}

// Priorities that differ decide whatever the order: to the last bit, over many random worlds.
TEST(Invariance, OrderOfStructures) {
  Sweep sweep("order of structures", "the image before", "number of the random scene", 0);
  withThreads(1, [&] {
    for (std::uint64_t number = 0; number < 300; ++number) {
      World world = randomWorld(number);
      world.normals.clear();
      std::vector<Structure>& list = world.scene.structures;
      // Two membranes, or a wall and a membrane, in one place have an order of their own.
      std::erase_if(list, [](const Structure& s) { return s.membrane; });
      if (list.size() != world.meshes.size()) continue;
      for (std::size_t s = 0; s < list.size(); ++s) list[s].priority = static_cast<int>(s * 7 % 11);
      World turned = world;
      std::reverse(turned.scene.structures.begin(), turned.scene.structures.end());
      std::reverse(turned.meshes.begin(), turned.meshes.end());
      for (const Tracer tracer : {Tracer::slice, Tracer::embree})
        sweep.addError(static_cast<double>(number),
                       difference(traceWorld(world, tracer).planes.at(Channel::y),
                                  traceWorld(turned, tracer).planes.at(Channel::y)));
    }
  });
}

// Sums and ties may depend on the order only by rounding.
TEST(Invariance, OrderOfTrianglesAndOfTheirCorners) {
  // Corners in another order add up to the normal in another rounding.
  Sweep sweep("order of triangles and corners", "the image before", kOfTracer, 1e-5);
  World world = worldOf(kSame), turned = world;
  for (Mesh& mesh : turned.meshes) {
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    for (Triangle& t : mesh.triangles) t = {t[1], t[2], t[0]};
  }
  for (const Tracer tracer : kTracers)
    sweep.addError(static_cast<double>(tracer),
                   difference(traceWorld(world, tracer).planes.at(Channel::y),
                              traceWorld(turned, tracer).planes.at(Channel::y)));
}

// Each triangle into three about a point in it, or into four by the middles of its edges.
Mesh split(const Mesh& mesh, int parts) {
  Mesh fine{mesh.points, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto add = [&](Vec3d p) {
    fine.points.push_back(p);
    return static_cast<std::uint32_t>(fine.points.size() - 1);
  };
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), 0u);
    if (is_new) place->second = add(0.5 * (mesh.points[a] + mesh.points[b]));
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    if (parts == 3) {
      const std::uint32_t m = add(0.25 * (2.0 * mesh.points[a] + mesh.points[b] + mesh.points[c]));
      fine.triangles.insert(fine.triangles.end(), {{a, b, m}, {b, c, m}, {c, a, m}});
    } else {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      fine.triangles.insert(fine.triangles.end(),
                            {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
  }
  return fine;
}

// A box of short binary fractions, so that the new vertices lie exactly in its faces.
TEST(Invariance, AFaceCutIntoThreeOrFour) {
  World whole{
      plainScene({medium("tissue", 1050, 1540, 5, 0.05), medium("muscle", 1060, 1580, 9, 0.1)}),
      {box({-0.03125, -0.0625, 0.046875}, {0.0390625, 0.03125, 0.09375})}};
  addStructure(whole.scene, 1, 1);
  whole.scene.probe.lines = 31;  // odd: the middle line meets edges and vertices of the cut
  Sweep sweep("coplanar split 1 to 3, 1 to 4, twice", "the image before", "parts", 1e-5);
  // A cell takes each piece of contour at its middle: cutting it is a finer quadrature of the lobe.
  Sweep cells("coplanar split, integrated over cells", "the image before", "parts", 0.1);
  for (const int parts : {3, 4})
    for (int times = 1; times <= 2; ++times) {
      World cut = whole;
      for (int i = 0; i < times; ++i) cut.meshes[0] = split(cut.meshes[0], parts);
      for (const Tracer tracer : kTracers)
        (tracer == Tracer::cells ? cells : sweep)
            .addError(parts, difference(traceWorld(whole, tracer).planes.at(Channel::y),
                                        traceWorld(cut, tracer).planes.at(Channel::y)));
    }
}

}  // namespace
}  // namespace echocine
