// Images of flat slabs through both tracers against the closed form: tilt up to grazing, depths
// about the edges of samples, walls down to nothing, a probe from outside over the surface to
// inside.

#include <gtest/gtest.h>

#include <numeric>

#include "support/plain_scene.h"
#include "support/sweep.h"
#include "support/world.h"

namespace echocine {
namespace {

using namespace support;

const std::vector<Tracer> kSlabTracers{Tracer::slice, Tracer::embree};

Medium tissue() {
  return medium("tissue", 1050, 1540, 5, 0.05);
}
Medium muscle() {
  return medium("muscle", 1060, 1580, 9, 0.1);
}

// One line along z through a slab of muscle whose front, through (0, 0, front), is tilted.
World slabWorld(double front_m, double thickness_m, double tilt_rad = 0) {
  World world{plainScene({tissue(), muscle()}), {}};
  world.scene.effects.refraction = Switch::off;
  world.scene.output.channels = {Channel::y, Channel::reflection, Channel::backscatter};
  addStructure(world.scene, 1, 1);
  Mesh slab = box({-4, -4, 0}, {4, 4, thickness_m});
  for (Vec3d& p : slab.points)
    p = {std::cos(tilt_rad) * p.x + std::sin(tilt_rad) * p.z, p.y,
         front_m - std::sin(tilt_rad) * p.x + std::cos(tilt_rad) * p.z};
  world.meshes.push_back(slab);
  return world;
}

// Section 4.1 in long double for the slab: R and cos^n at both sides, losses, attenuation, 1/l^2
// from a wavelength on. W is at most R at normal incidence, R_0.
struct SlabForm {
  long double R, R_0, cos_i, front, back;  // path lengths of both sides; back - front = inside

  SlabForm(double front_m, double thickness_m, double tilt_rad) {
    const Medium a = tissue(), b = muscle();
    cos_i = std::cos(static_cast<long double>(tilt_rad));
    const long double r = static_cast<long double>(b.sound_speed_m_s) / a.sound_speed_m_s;
    const long double cos_t = std::sqrt(1 - r * r * (1 - cos_i * cos_i));
    const long double ratio = (b.impedance_kg_m2_s * cos_i - a.impedance_kg_m2_s * cos_t) /
                              (b.impedance_kg_m2_s * cos_i + a.impedance_kg_m2_s * cos_t);
    R = ratio * ratio;
    R_0 = std::pow((b.impedance_kg_m2_s - a.impedance_kg_m2_s) /
                       static_cast<long double>(b.impedance_kg_m2_s + a.impedance_kg_m2_s),
                   2);
    front = front_m;
    back = front + thickness_m / cos_i;
  }
  long double exponent(long double l) const {
    const long double inside = std::clamp(l, front, back) - front;
    return 4 *
           (tissue().attenuation_np_per_m * (l - inside) + muscle().attenuation_np_per_m * inside);
  }
  long double backscatter(long double l) const {
    const long double loss = (1 - R) * (1 - R);
    const long double eta = l >= front && l < back ? muscle().backscatter_per_m_sr * loss
                            : l >= back            ? tissue().backscatter_per_m_sr * loss * loss
                                                   : tissue().backscatter_per_m_sr;
    const long double spread = std::max(l, 1540 / 2.5e6L);
    return eta * 1e-6L / (spread * spread) * std::exp(-exponent(l));
  }
  long double frontEcho() const {
    return std::min(R, R_0) * cos_i * cos_i * std::exp(-exponent(front));
  }
};

float sumOf(const std::vector<float>& plane) {
  return std::accumulate(plane.begin(), plane.end(), 0.0f);
}

// Straight rays: the back side has the incidence of the front, from muscle into tissue.
TEST(SlabSweep, TiltedUpToTheCriticalAngle) {
  Sweep echoes("tilted wall, 0 to 76 degrees: echo", "closed form", "tilt, degrees", 1e-5);
  Sweep samples("tilted wall, 0 to 76 degrees: backscatter", "closed form", "tilt, degrees", 1e-5);
  for (int i = 0; i <= 300; ++i) {
    const double tilt = radiansFromDegrees(76.0 * i / 300);
    const World world = slabWorld(0.05, 3, tilt);
    const SlabForm form(0.05, 3, tilt);
    for (const Tracer tracer : kSlabTracers) {
      const PolarFrame polar = traceWorld(world, tracer);
      echoes.add(76.0 * i / 300, sumOf(polar.planes.at(Channel::reflection)), form.frontEcho());
      const Sampling sampling = samplingOf(world.scene.probe);
      for (const int k : {0, 10, 49, 51, 100, 159})
        samples.add(76.0 * i / 300,
                    polar.planes.at(Channel::backscatter)[static_cast<std::size_t>(k)],
                    form.backscatter(sampling.centre(k)));
    }
  }
}

// Beyond the critical angle, 77.1 degrees, everything deeper is 0, and the front sends back no more
// than seen head-on.
TEST(SlabSweep, BeyondTheCriticalAngleThereIsOnlyTheFront) {
  Sweep echoes("wall beyond the critical angle: echo", "closed form", "tilt, degrees", 1e-5);
  for (int i = 0; i <= 200; ++i) {
    const double tilt = radiansFromDegrees(77.3 + 12.6 * i / 200);
    const World world = slabWorld(0.05, 3, tilt);
    const long double cos_i = std::cos(static_cast<long double>(tilt));
    for (const Tracer tracer : kSlabTracers) {
      const PolarFrame polar = traceWorld(world, tracer);
      echoes.add(degreesFromRadians(tilt), sumOf(polar.planes.at(Channel::reflection)),
                 SlabForm(0.05, 3, 0).R_0 * cos_i * cos_i * std::exp(-4 * 5 * 0.05L));
      const std::vector<float>& deep = polar.planes.at(Channel::y);
      for (std::size_t k = 51; k < deep.size(); ++k) ASSERT_EQ(deep[k], 0.0f) << k;
    }
  }
}

// The wall's depth moves over the edge between two samples, which lie 1 mm apart, ulp by ulp of
// the mesh's floats: the echo stands whole in the one or in the other.
// An echo leaves one sample and enters the next from one float to the neighbouring one.
TEST(SlabSweep, AWallOverTheEdgeOfASample) {
  Sweep sweep("wall about a sample's edge: its echo in one sample", "closed form",
              "depth behind the edge, m", 1e-5);
  const double edge = static_cast<float>(0.05);
  std::vector<double> depths;
  for (float up = 0.05f, down = 0.05f; depths.size() < 60;) {
    depths.push_back(up = std::nextafter(up, 1.0f));
    depths.push_back(down = std::nextafter(down, 0.0f));
  }
  depths.push_back(edge);
  for (const double depth : depths)
    for (const Tracer tracer : kSlabTracers) {
      const World world = slabWorld(depth, 3);
      const std::vector<float> plane = traceWorld(world, tracer).planes.at(Channel::reflection);
      const SlabForm form(depth, 3, 0);
      // Which one is the law's own: floor((l - min) / spacing) of the depth that the mesh has.
      const auto k =
          static_cast<std::size_t>(std::floor(depth / world.scene.probe.sampleSpacing()));
      sweep.add(depth - edge, plane[k], form.frontEcho());
      EXPECT_EQ(plane[k], sumOf(plane));
    }
}

// What a pulse of two cycles, a gated sine, gets back from both faces of an upright slab, and what
// passes it forward and back: Airy's formula with 1 / |1 - R exp(ix)|^2 and its square as Fourier
// series in the phase x, whose terms the pulse weighs by its correlation, which ends at X.
struct BothFaces {
  long double back, through;

  BothFaces(long double R, long double thickness_m) {
    const long double pi = std::numbers::pi_v<long double>, X = 4 * pi;
    const long double x = 4 * pi * 2.5e6L / 1580 * thickness_m;
    long double once = 1, twice = 1 + R * R, power = 1;
    for (long double y = x; y < X && power > 1e-12L; y += x) {
      const long double C = (1 - y / X) * std::cos(y) + std::sin(y) / X;
      power *= R;
      once += 2 * power * C;
      twice += 2 * power * (1 + R * R + y / x * (1 - R * R)) * C;
    }
    back = 1 - (1 - R) / (1 + R) * once;
    through = std::pow(1 - R, 4) / std::pow(1 - R * R, 3) * twice;
    if (x < X) return;
    back = R + (1 - R) * (1 - R) * R;  // nothing turns back twice
    through = std::pow(1 - R, 4);
  }
};

// Walls of 10 cm down to a tenth of a nanometre, within one sample from 1 mm down. Below a
// ten-thousandth of a wavelength (60 nm) it is no wall at all, just as its physics has it: (k d)^2.
// Two interfaces, then two that one pulse holds, then none.
// Attenuation is off, since it differs between the faces.
TEST(SlabSweep, AWallThatThinsToNothing) {
  Sweep echoes("wall thinner than a sample: both echoes", "closed form", "thickness, m", 3e-3);
  Sweep behind("wall thinner than a sample: backscatter behind it", "closed form", "thickness, m",
               1e-5);
  for (const double d : decades(1e-10, 0.1, 600)) {
    World world = slabWorld(0, 1);
    world.scene.effects.attenuation = Switch::off;
    const float front = 0.0301f;
    const auto back = static_cast<float>(front + d);
    world.meshes[0] = box({-4, -4, front}, {4, 4, back});
    const double thickness = static_cast<double>(back) - front;
    const double thin = 1e-4 * kScannerSpeed / world.scene.probe.frequency_hz;
    const bool seen = thickness > thin;
    const BothFaces faces(SlabForm(front, thickness, 0).R, thickness);
    for (const Tracer tracer : kSlabTracers) {
      const PolarFrame polar = traceWorld(world, tracer);
      echoes.add(d, sumOf(polar.planes.at(Channel::reflection)), seen ? faces.back : 0);
      const long double l = samplingOf(world.scene.probe).centre(150);
      behind.add(d, polar.planes.at(Channel::backscatter)[150],
                 0.05L * 1e-6L / (l * l) * (seen ? faces.through : 1));
    }
  }
}

// The slab's front moves from before the probe, through it, to behind it: outside, on, inside. A
// front within a thousandth of a wavelength of the face is in the face: the probe is inside.
// On the wall itself it stands in the medium behind it.
TEST(SlabSweep, AProbeOutsideOnAndInside) {
  Sweep sweep("probe outside, on and inside: backscatter", "closed form", "depth of the front, m",
              1e-5);
  std::vector<double> fronts{0};
  for (const double d : decades(1e-12, 1e-2, 100)) {
    fronts.push_back(static_cast<float>(d));
    fronts.push_back(-static_cast<float>(d));
  }
  for (const double front : fronts)
    for (const Tracer tracer : kSlabTracers) {
      World world = slabWorld(0, 1);
      world.meshes[0] = box({-4, -4, front}, {4, 4, 0.1});
      const double thin = 1e-3 * kScannerSpeed / world.scene.probe.frequency_hz;
      const std::vector<float> plane = traceWorld(world, tracer).planes.at(Channel::backscatter);
      for (const int k : {20, 60}) {
        const long double l = samplingOf(world.scene.probe).centre(k);
        const SlabForm outside(front, 0.1 - front, 0);
        const long double inside = 0.1L * 1e-6L / (l * l) * std::exp(-4 * 9 * l);
        sweep.add(front, plane[static_cast<std::size_t>(k)],
                  front > thin ? outside.backscatter(l) : inside);
      }
    }
}

// Two equal media: the slab must vanish to the last bit, at every tilt.
TEST(SlabSweep, AWallOfItsSurroundingsIsNotThere) {
  Sweep sweep("equal media: image with and without the wall", "the image without it",
              "tilt, degrees", 0);
  World without = slabWorld(0.05, 0.02);
  without.scene.media[1] = without.scene.media[0];
  without.meshes[0] = without.meshes[0].moved({0, 0, -10});
  for (int i = 0; i <= 90; ++i) {
    World world = slabWorld(0.05, 0.02, radiansFromDegrees(i));
    world.scene.media[1] = world.scene.media[0];
    for (const Tracer tracer : kSlabTracers) {
      const std::vector<float> a = traceWorld(world, tracer).planes.at(Channel::reflection);
      EXPECT_EQ(sumOf(a), 0.0f);
      const std::vector<float> b = traceWorld(world, tracer).planes.at(Channel::y),
                               c = traceWorld(without, tracer).planes.at(Channel::y);
      double worst = 0;
      for (std::size_t k = 0; k < b.size(); ++k)
        worst = std::max(worst, static_cast<double>(std::abs(b[k] / c[k] - 1)));
      // A stretch that begins elsewhere is summed from elsewhere: a few roundings of a float.
      sweep.addError(i, worst < 5e-7 ? 0 : worst);
    }
  }
}

}  // namespace
}  // namespace echocine
