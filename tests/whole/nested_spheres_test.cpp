// Whole frames of two nested spheres against the closed form, straight and refracted.

#include <gtest/gtest.h>

#include "scene/scan_geometry.h"
#include "whole/nested_spheres.h"

namespace echocine {
namespace {

using namespace support;

struct Traced {
  TempFolder folder;
  Scene scene;
  PolarFrame frame;

  explicit Traced(const std::string& refraction, Switch reflection_cap = Switch::automatic)
      : scene(writeNestedSpheres(folder, refraction)) {
    scene.effects.reflection_cap = reflection_cap;
    const MeshMotion motion(scene);
    SurfaceFrame surfaces;
    motion.frameAt(0, surfaces);
    FrameGeometry geometry(motion.surfaces());
    geometry.update(surfaces);
    const EffectPlan plan = planEffects(scene);
    traceFrame(geometry, scene.probe, TraceSettings(scene, plan), planeRequest(scene, plan), frame);
  }
  double value(Channel channel, int line, int k) const {
    return frame.planes.at(channel)[static_cast<std::size_t>(line * frame.samples + k)];
  }
};

struct Errors {
  long samples = 0, over_small = 0, echoes = 0, checked_dark = 0;
  double worst_db = 0, worst_echo = 0;
  double worst_of_facets = 0;  // error of an echo over what its facet's normal can make
};

// How far facets' normals are from the sphere's, at most: at their corners.
double facetOffset() {
  const Mesh unit = icosphere(kSphereLevel, 1);
  double least_cosine = 1;
  for (const Triangle& t : unit.triangles) {
    const Vec3d a = unit.points[t[0]], b = unit.points[t[1]], c = unit.points[t[2]];
    const Vec3d normal = normalised(cross(b - a, c - a));
    for (const Vec3d& p : {a, b, c}) least_cosine = std::min(least_cosine, dot(normal, p));
  }
  return std::acos(least_cosine);
}

bool nearInterface(const ExactLine& line, Real l, Real margin_m) {
  for (std::size_t i = 0; i + 1 < line.pieces.size(); ++i)
    if (std::abs(line.pieces[i].end_m - l) <= margin_m) return true;
  return false;
}

void compareBackscatter(const Traced& traced, const ExactLine& exact, int line, Errors& errors) {
  const Sampling sampling = samplingOf(traced.scene.probe);
  for (int k = 0; k < sampling.samples; ++k) {
    const Real l = sampling.centre(k);
    if (nearInterface(exact, l, 2 * sampling.spacing_m)) continue;
    const double db = std::abs(decibelsFromIntensity(
        traced.value(Channel::y, line, k) /
        static_cast<double>(exactBackscatter(exact, l, traced.scene.unit_volume_m3))));
    ++errors.samples;
    errors.over_small += db > 0.05;
    errors.worst_db = std::max(errors.worst_db, db);
  }
}

// Echoes by the sum over the samples within two of the interface; interfaces that share samples are
// left out.
void compareEchoes(const Traced& traced, const ExactLine& exact, int line, Errors& errors) {
  static const double facet_offset = facetOffset();
  const Sampling sampling = samplingOf(traced.scene.probe);
  const Real pulse_m = static_cast<Real>(traced.scene.signal.pulse_cycles) *
                       ScanGeometry(traced.scene.probe).wavelength() / 2;
  const Real echo_samples = std::max<Real>(pulse_m / sampling.spacing_m, 1);
  for (std::size_t i = 0; i + 1 < exact.pieces.size(); ++i) {
    const ExactEdge& p = exact.pieces[i];
    // Interfaces that one pulse holds are left out too.
    const Real reach = std::max<Real>(6 * sampling.spacing_m, pulse_m);
    if (p.incidence_deg >= 60 || p.end_m > traced.scene.probe.max_depth_m - reach) continue;
    if ((i > 0 && p.end_m - p.begin_m < reach) ||
        (i + 2 < exact.pieces.size() && exact.pieces[i + 1].end_m - p.end_m < reach))
      continue;
    const int centre = static_cast<int>((p.end_m - sampling.min_depth_m) / sampling.spacing_m);
    double sum = 0;
    for (int k = centre - 2; k <= centre + 2; ++k)
      sum += traced.value(Channel::reflection, line, k);
    const Real expected =
        echo_samples * p.echo *
        std::exp(-(p.exponent + 4 * p.medium->attenuation_np_per_m * (p.end_m - p.begin_m)));
    ++errors.echoes;
    const double error = std::abs(static_cast<double>(sum / expected - 1));
    errors.worst_echo = std::max(errors.worst_echo, error);
    const double tangent =
        std::tan(radiansFromDegrees(static_cast<double>(p.incidence_deg)) + facet_offset);
    errors.worst_of_facets = std::max(errors.worst_of_facets, error / (2 * tangent * facet_offset));
  }
}

void expectDark(const Traced& traced, const ExactLine& exact, int line, Errors& errors) {
  const Sampling sampling = samplingOf(traced.scene.probe);
  const Real end_m = exact.pieces.back().end_m;
  for (int k = 0; k < sampling.samples; ++k) {
    if (sampling.centre(k) < end_m + 2 * sampling.spacing_m) continue;
    ++errors.checked_dark;
    EXPECT_EQ(traced.value(Channel::y, line, k), 0) << line << ' ' << k;
  }
}

void report(const char* name, const Errors& e) {
  std::printf(
      "%s: %ld samples, %ld over 0.05 dB, worst %.4f dB; %ld echoes, worst %.2f %%, %.2f of what "
      "facets can make; %ld samples dark\n",
      name, e.samples, e.over_small, e.worst_db, e.echoes, 100 * e.worst_echo, e.worst_of_facets,
      e.checked_dark);
  ::testing::Test::RecordProperty("worst_db", std::to_string(e.worst_db));
  ::testing::Test::RecordProperty("worst_echo_percent", std::to_string(100 * e.worst_echo));
}

void expectClosedForm(const std::string& refraction, const char* name) {
  const Traced traced(refraction);
  ExactRay ray(traced.scene, refraction == "on");
  Errors errors;
  for (const auto& [channel, plane] : traced.frame.planes)
    for (const float value : plane) ASSERT_TRUE(std::isfinite(value) && value >= 0);
  for (int line = 0; line < traced.scene.probe.lines; ++line) {
    const ExactLine exact = ray.trace(lineGeometry(traced.scene.probe, line));
    if (exact.worst_incidence_deg < 70) {
      compareBackscatter(traced, exact, line, errors);
      compareEchoes(traced, exact, line, errors);
    }
    // A facet's normal is up to 0.6 degrees off the sphere's.
    if (exact.ends && exact.beyond_critical_deg > 1.2) expectDark(traced, exact, line, errors);
  }
  report(name, errors);
  EXPECT_GT(errors.samples, 150000);
  EXPECT_GT(errors.echoes, 400);
  EXPECT_GT(errors.checked_dark, 1000);
  EXPECT_LE(static_cast<double>(errors.over_small), 1e-3 * static_cast<double>(errors.samples));
  EXPECT_LE(errors.worst_db, 0.5);
  // The lobe cos^2 by a normal that is off by delta errs by 2 tan(theta) delta: 4 % at 60 degrees.
  EXPECT_LE(errors.worst_of_facets, 1);
  EXPECT_LE(errors.worst_echo, 0.04);
}

// R rises with the angle while cos^2 falls, so without the cap a part of a facet's error cancels.
TEST(NestedSpheres, WithoutTheCapFacetsErrLess) {
  const Traced traced("off", Switch::off);
  ExactRay ray(traced.scene, false);
  Errors errors;
  for (int line = 0; line < traced.scene.probe.lines; ++line) {
    const ExactLine exact = ray.trace(lineGeometry(traced.scene.probe, line));
    if (exact.worst_incidence_deg < 70) compareEchoes(traced, exact, line, errors);
  }
  report("without the cap", errors);
  EXPECT_GT(errors.echoes, 400);
  EXPECT_LE(errors.worst_echo, 0.03);
}

TEST(NestedSpheres, StraightRaysMeetTheClosedForm) {
  expectClosedForm("off", "straight");
}

TEST(NestedSpheres, RefractedRaysMeetTheClosedForm) {
  expectClosedForm("on", "refracted");
}

}  // namespace
}  // namespace echocine
