// The smallest images: one line, one sample, both, through every tracer, probe kind and the chain.

#include <gtest/gtest.h>

#include "signal/signal_chain.h"
#include "support/plain_scene.h"
#include "support/sweep.h"
#include "support/world.h"

namespace echocine {
namespace {

using namespace support;

World ballWorld(ProbeKind kind, int lines, int samples) {
  World world{
      plainScene({medium("tissue", 1050, 1540, 5, 0.05), medium("blood", 1060, 1540, 1, 0)}),
      {icosphere(2, 0.03).moved({0, 0, 0.07})}};
  addStructure(world.scene, 1, 1);
  world.scene.effects.refraction = Switch::off;
  world.scene.output.width = world.scene.output.height = 64;
  Probe& probe = world.scene.probe;
  probe.kind = kind;
  probe.lines = lines;
  probe.samples = samples;
  if (kind == ProbeKind::linear) {
    probe.first_angle_rad = probe.last_angle_rad = 0;
    probe.first_offset_m = -0.01;
    probe.last_offset_m = 0.01;
  }
  if (kind == ProbeKind::curvilinear) probe.face_radius_m = 0.02;
  return world;
}

// The middle line meets the same as in an image of 65 lines, whose middle one it is.
TEST(SmallestImages, OneLineIsTheMiddleOneOfMany) {
  Sweep sweep("one line", "middle line of 65", "sample", 0);
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear})
    for (const Tracer tracer : {Tracer::slice, Tracer::embree}) {
      const World one = ballWorld(kind, 1, 100), many = ballWorld(kind, 65, 100);
      const std::vector<float> a = traceWorld(one, tracer).planes.at(Channel::y),
                               b = traceWorld(many, tracer).planes.at(Channel::y);
      ASSERT_EQ(a.size(), 100u);
      for (std::size_t k = 0; k < a.size(); ++k)
        sweep.add(static_cast<double>(k), a[k], b[32 * 100 + k]);
    }
}

// One sample holds every echo of its line and the backscatter of the middle depth.
TEST(SmallestImages, OneSampleHoldsTheWholeLine) {
  Sweep sweep("one sample", "closed form over the line", "line", 1e-5);
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear})
    for (const int lines : {1, 2, 17})
      for (const Tracer tracer : {Tracer::slice, Tracer::embree}) {
        const World world = ballWorld(kind, lines, 1);
        const PolarFrame polar = traceWorld(world, tracer);
        const std::vector<float>& plane = polar.planes.at(Channel::y);
        ASSERT_EQ(plane.size(), static_cast<std::size_t>(lines));
        for (std::size_t line = 0; line < plane.size(); ++line) {
          const LineTrace& trace = polar.traces[line];
          long double sum = 0;
          for (const Echo& e : trace.echoes)
            sum += e.intensity * std::exp(-static_cast<long double>(e.exponent));
          const long double l = world.scene.probe.middleDepth();
          for (const MediumSegment& s : trace.segments)
            if (l >= s.begin_depth_m && l < s.end_depth_m)
              sum += s.strength_m2_sr / (l * l) *
                     std::exp(-(s.begin_exponent + s.exponent_per_m * (l - s.begin_depth_m)));
          sweep.add(static_cast<double>(line), plane[line], sum);
        }
      }
}

TEST(SmallestImages, GoThroughTheWholeSignalChain) {
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear})
    for (const int lines : {1, 2})
      for (const int samples : {1, 2})
        for (const Tracer tracer : {Tracer::slice, Tracer::cells, Tracer::embree}) {
          if (tracer == Tracer::cells && lines == 1) continue;
          const World world = ballWorld(kind, lines, samples);
          PolarFrame polar = traceWorld(world, tracer);
          const SignalChain chain(world.scene, planEffects(world.scene));
          chain.process(polar.intensities);
          const Greys greys = chain.compress(std::move(polar.intensities), 1e-6);
          for (const float grey : greys) EXPECT_TRUE(grey >= 0 && grey <= 1) << grey;
          GreyImage image;
          chain.picture(greys, image);
          EXPECT_EQ(image.pixels.size(), 64u * 64u);
        }
}

}  // namespace
}  // namespace echocine
