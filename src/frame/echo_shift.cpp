#include "frame/echo_shift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"
#include "trace/beam_rays.h"
#include "trace/packet_walk.h"

namespace echocine {

namespace {

constexpr int kLines = 128, kGroups = 8, kBands = 8;
constexpr double kExceeding = 0.25;  // of a field's lines
// Elevations of the rays in standard deviations: in the plane, and to both sides of it.
constexpr std::array<double, 3> kElevations{0, -1, 1};

// No scanner receives echoes with an attenuation of 120 dB, as from inside or behind lung.
// Our choice; 160 mm of tissue attenuate by 40 to 60 dB.
constexpr double kLostExponent = 27.6;  // nepers of intensity

// Where a line ends, or attenuation has taken what a scanner receives.
double endOf(const LineTrace& line) {
  for (const MediumSegment& segment : line.segments) {
    const double left = kLostExponent - segment.begin_exponent;
    if (left <= 0) return segment.begin_depth_m;
    if (left < segment.exponent_per_m * (segment.end_depth_m - segment.begin_depth_m))
      return segment.begin_depth_m + left / segment.exponent_per_m;
  }
  return line.segments.empty() ? 0 : line.segments.back().end_depth_m;
}

}  // namespace

// The farthest shift of each line in each band of depth.
struct EchoShiftMeter::Fields {
  explicit Fields(const Probe& probe)
      : lines(probe.lines),
        groups(std::min(kGroups, probe.lines)),
        band_m((probe.max_depth_m) / kBands),
        of_lines(static_cast<std::size_t>(probe.lines) * kBands) {}

  void add(int line, const EchoShift& shift) {
    const int band = std::clamp(static_cast<int>(shift.depth_m / band_m), 0, kBands - 1);
    EchoShift& worst = of_lines[static_cast<std::size_t>(line * kBands + band)];
    worst = std::max(worst, shift);
  }

  EchoShift worst() const {
    EchoShift worst;
    std::vector<EchoShift> field;
    for (int group = 0; group < groups; ++group)
      for (int band = 0; band < kBands; ++band) {
        field.clear();
        for (int i = group * lines / groups; i < (group + 1) * lines / groups; ++i)
          field.push_back(of_lines[static_cast<std::size_t>(i * kBands + band)]);
        const auto counted =
            field.begin() + static_cast<int>(kExceeding * static_cast<double>(field.size()));
        std::nth_element(field.begin(), counted, field.end(),
                         [](const EchoShift& a, const EchoShift& b) { return b < a; });
        worst = std::max(worst, *counted);
      }
    return worst;
  }

  int lines, groups;
  double band_m;
  std::vector<EchoShift> of_lines;
};

EchoShiftMeter::EchoShiftMeter(const Scene& scene, const EffectPlan& plan)
    : scene_(scene), plan_(plan) {
  if (scene_.probe.lines > 1) scene_.probe.lines = kLines;
  plan_.attenuation = true;
  plan_.snell_angles = true;  // straight rays end where bent ones would by their angles
}

// Smallest lateral distance at which two echoes are resolved: the beam's width, but at least a
// wavelength, because the formula does not hold near the transducer.
double EchoShiftMeter::resolution(double depth_m) const {
  const Probe& probe = scene_.probe;
  const double wavelength_m = ScanGeometry(probe).wavelength();
  const double width_m =
      scene_.signal.beam_width == BeamWidth::fixed
          ? scene_.signal.beam_width_m
          : focusedBeamWidth(depth_m, probe.aperture_m, probe.focus_m, wavelength_m);
  return std::max(width_m, wavelength_m);
}

double EchoShiftMeter::elevationResolution(double depth_m) const {
  const Probe& probe = scene_.probe;
  const double wavelength_m = ScanGeometry(probe).wavelength();
  return std::max(elevationBeamWidth(depth_m, probe.elevation_aperture_m, probe.elevation_focus_m,
                                     wavelength_m),
                  wavelength_m);
}

void EchoShiftMeter::measureRays(const FrameGeometry& geometry, double elevation,
                                 Fields& fields) const {
  TraceSettings bent(scene_, plan_), straight(scene_, plan_);
  bent.refraction = true;
  bent.note_hits = true;
  straight.refraction = false;
  const Probe& probe = scene_.probe;
  const BeamRays beams(probe,
                       {.rays = 2, .lateral = false, .elevation = elevation != 0, .seed = 0});
  std::array<StartedRay, kPacket> rays;
  std::array<LineTrace, kPacket> of_bent, of_straight;
  Ray last{{0, 0, -1e9}, {0, 0, 1}};
  InsideSet inside;
  for (int first = 0; first < probe.lines; first += kPacket) {
    const int count = std::min(probe.lines - first, static_cast<int>(kPacket));
    for (int i = 0; i < count; ++i) {
      const BeamRay ray = beams.through(lineGeometry(probe, first + i), 0, elevation, 0);
      // To find the surfaces around a point takes all their triangles; most rays start in one.
      if (!(ray.ray.origin == last.origin)) inside = geometry.insideAt(ray.ray.origin);
      last = ray.ray;
      rays[static_cast<std::size_t>(i)] = {ray.ray, inside, ray.start_m};
    }
    const std::span<const StartedRay> started =
        std::span(rays).first(static_cast<std::size_t>(count));
    walkTogether(geometry, bent, started, of_bent);
    walkTogether(geometry, straight, started, of_straight);
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Ray& ray = rays[at].ray;
      for (const InterfaceHit& hit : of_bent[at].hits) {
        if (!hit.seen || hit.exponent > kLostExponent) continue;
        const Vec3d to = hit.point - ray.origin;
        const Vec3d off = to - dot(to, ray.direction) * ray.direction;
        const double widths = std::max(std::hypot(off.x, off.z) / resolution(hit.depth_m),
                                       std::abs(off.y) / elevationResolution(hit.depth_m));
        fields.add(first + i, {length(off), widths, hit.depth_m, 0});
      }
      const double one = endOf(of_bent[at]), other = endOf(of_straight[at]);
      const double from = std::min(one, other), to = std::max(one, other);
      for (double depth_m = from; to - from > resolution(from) && depth_m < to;
           depth_m += fields.band_m)
        fields.add(first + i, {to - from, (to - from) / resolution(from), depth_m, 0});
    }
  }
}

EchoShift EchoShiftMeter::measure(const FrameGeometry& geometry, double phase) const {
  EchoShift worst;
  const std::size_t elevations = plan_.elevation ? kElevations.size() : 1;
  for (std::size_t e = 0; e < elevations; ++e) {
    Fields fields(scene_.probe);
    measureRays(geometry, kElevations[e], fields);
    worst = std::max(worst, fields.worst());
  }
  worst.phase = phase;
  return worst;
}

}  // namespace echocine
