#include "trace/trace_beams.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "core/parallel.h"
#include "scene/scan_geometry.h"
#include "trace/packet_walk.h"

namespace echocine {

namespace {

constexpr std::size_t kRaysOfBlock = 64;  // shared among threads at least so many at once

// A plane of intensities and where it goes.
struct Wanted {
  IntensityTerms parts;
  std::vector<float>* plane;
  // The plane of CoherentEchoes, if it is one.
  std::vector<float> CoherentEchoes::*coherent = nullptr;
};

std::vector<Wanted> intensityPlanes(const TraceSettings& settings, const PlaneRequest& request,
                                    PolarFrame& frame) {
  std::vector<Wanted> wanted;
  for (const Channel channel : request.channels)
    if (channel != Channel::medium && channel != Channel::attenuation)
      wanted.push_back({partsOf(channel, settings.attenuation, request.spread_undone_at_m),
                        &frame.planes.at(channel)});
  for (Wanted& plane : wanted) plane.parts.echo_samples = request.echo_samples;
  if (!request.intensities) return wanted;
  wanted.push_back({request.intensity_terms, &frame.intensities.values});
  if (!settings.coherent_echoes) return wanted;
  frame.coherent.clear(frame.intensities.size());
  IntensityTerms echoes = request.intensity_terms;
  echoes.backscatter = false;
  for (const auto plane :
       {&CoherentEchoes::intensity, &CoherentEchoes::real, &CoherentEchoes::imaginary})
    wanted.push_back({echoes, &(frame.coherent.*plane), plane});
  return wanted;
}

// Which closed surfaces hold the places along the transducer's lens, the line across the imaging
// plane through a scan line's start: every ray of a beam starts there, and asking all triangles for
// each would cost more than tracing it. A ray's own balance of entries and exits proves the answer.
class LensStates {
 public:
  LensStates(const FrameGeometry& geometry, const TraceSettings& settings, Vec3d start, bool across)
      : settings_(settings), centre_(geometry.insideAt(start)) {
    if (!across) return;
    const std::array<RayQuery, 2> both{RayQuery{{start, {0, 1, 0}}, centre_, {}},
                                       RayQuery{{start, {0, -1, 0}}, centre_, {}}};
    geometry.crossings(both, met_);
  }

  InsideSet at(double y_m) const {
    if (y_m == 0) return centre_;
    const RayCrossings& met = met_[y_m > 0 ? 0 : 1];
    InsideSet inside = met.inside;
    for (const Crossing& c : met.crossings) {
      if (c.distance_m >= std::abs(y_m)) break;
      const std::size_t s = index(c.surface);
      if (!settings_.surfaces[s].membrane) inside[s] = c.entering;
    }
    return inside;
  }

 private:
  const TraceSettings& settings_;
  InsideSet centre_;
  std::array<RayCrossings, 2> met_;
};

// Spreads an interface's echo over the depths of the ray's stratum: to each sample its share, and
// the middle of that in samples.
template <typename Each>
void overStratum(const Echo& echo, const BeamRay& ray, const Sampling& sampling, const Each& each) {
  const double lean = std::clamp(dot(ray.lateral, echo.tilt), -kSteepestLean, kSteepestLean);
  const auto place = [&](double slope) {  // in samples from the shallowest one's beginning
    const double depth_m = echo.depth_m * (1 - lean * slope);
    return (depth_m - sampling.min_depth_m) / sampling.spacing_m;
  };
  const double first = place(ray.from_slope), last = place(ray.to_slope);
  const double from = std::min(first, last), to = std::max(first, last);
  const double samples = static_cast<double>(sampling.samples);
  if (std::floor(from) == std::floor(to)) {
    if (from < 0 || from >= samples) return;
    each(static_cast<std::size_t>(from), 1.0, (from + to) / 2);
    return;
  }
  const double begin = std::max(from, 0.0), end = std::min(to, samples);
  for (double k = std::floor(begin); k < end; ++k) {
    const double one = std::max(k, from), other = std::min(k + 1, to);
    each(static_cast<std::size_t>(k), (other - one) / (to - from), (one + other) / 2);
  }
}

// The part of an echo that a plane records, at a place in samples.
double coherentPart(std::vector<float> CoherentEchoes::*plane, const TraceSettings& settings,
                    const Sampling& sampling, const Echo& echo, double place) {
  if (!plane) return 1;
  const double part = settings.surfaces[index(echo.surface)].coherent_part;
  if (part == 0 || plane == &CoherentEchoes::intensity) return part;
  const EchoPhase phase(sampling.min_depth_m + place * sampling.spacing_m, settings.wavelength_m);
  return part * (plane == &CoherentEchoes::real ? phase.real : phase.imaginary);
}

// Weighted sums of one line's rays. In double: the average of equal values is that value, however
// many rays there are.
class BeamSums {
 public:
  void begin(std::size_t planes, std::size_t samples) {
    weights_.assign(samples, 1.0f);
    values_.resize(samples);
    of_weights_.assign(samples, 0.0);
    of_planes_.resize(planes);
    for (std::vector<double>& sums : of_planes_) sums.assign(samples, 0.0);
  }

  void add(const TraceSettings& settings, const BeamRays& beams, const BeamRay& ray,
           const LineTrace& trace, const Sampling& sampling, std::span<const Wanted> wanted) {
    if (beams.weighted()) beams.weights(ray, weights_);
    const std::size_t samples = weights_.size();
    const float* weight = weights_.data();
    const float* value = values_.data();
    double* of_weights = of_weights_.data();
    for (std::size_t k = 0; k < samples; ++k) of_weights[k] += static_cast<double>(weight[k]);
    for (std::size_t p = 0; p < wanted.size(); ++p) {
      const IntensityTerms& parts = wanted[p].parts;
      double* sums = of_planes_[p].data();
      if (parts.backscatter) {
        IntensityTerms scattered = parts;
        scattered.reflection = false;
        sampleIntensity(trace, sampling, scattered, values_);
        for (std::size_t k = 0; k < samples; ++k)
          sums[k] += static_cast<double>(weight[k]) * static_cast<double>(value[k]);
      }
      if (!parts.reflection) continue;
      for (const Echo& echo : trace.echoes) {
        const double lost = parts.attenuation ? std::exp(-echo.exponent) : 1.0;
        const double intensity =
            parts.echo_samples * parts.shown(echo.intensity, echo.intensity) * lost;
        overStratum(echo, ray, sampling, [&](std::size_t k, double share, double middle) {
          sums[k] += static_cast<double>(weight[k]) * intensity * share *
                     coherentPart(wanted[p].coherent, settings, sampling, echo, middle);
        });
      }
    }
  }

  void finish(std::size_t line, std::span<const Wanted> wanted) const {
    const std::size_t samples = weights_.size();
    for (std::size_t p = 0; p < wanted.size(); ++p) {
      float* out = wanted[p].plane->data() + line * samples;
      for (std::size_t k = 0; k < samples; ++k)
        out[k] = static_cast<float>(of_planes_[p][k] / of_weights_[k]);
    }
  }

 private:
  std::vector<float> weights_, values_;  // of one ray
  std::vector<double> of_weights_;
  std::vector<std::vector<double>> of_planes_;
};

// Data that the rays of a frame need, for all threads.
class BeamFrame {
 public:
  BeamFrame(const FrameGeometry& geometry, const Probe& probe, const TraceSettings& settings,
            const BeamRays& beams, int frame_index, std::vector<Wanted> wanted)
      : geometry_(geometry),
        probe_(probe),
        settings_(settings),
        beams_(beams),
        frame_index_(frame_index),
        wanted_(std::move(wanted)),
        sampling_(samplingOf(probe, settings)) {
    // A phased array's lines all start in one place.
    if (lineGeometry(probe, 0).origin == lineGeometry(probe, probe.lines - 1).origin)
      common_.emplace(geometry, settings, lineGeometry(probe, 0).origin, beams.elevation());
  }

  // Packets fill up across lines, so few rays per beam go together with their neighbours'.
  WorkCounts traceLines(std::size_t first, std::size_t last) const {
    thread_local BeamSums sums;
    const auto per_line = static_cast<std::size_t>(beams_.count());
    WorkCounts work;
    Packet packet;
    std::optional<LensStates> lens;
    for (std::size_t line = first; line < last; ++line) {
      const LineGeometry geometry = lineGeometry(probe_, static_cast<int>(line));
      if (!common_) {
        lens.emplace(geometry_, settings_, geometry.origin, beams_.elevation());
        work.rays += beams_.elevation() ? 2 : 0;
      }
      const std::uint64_t pattern = beams_.pattern(frame_index_, static_cast<int>(line));
      for (std::size_t i = 0; i < per_line; ++i) {
        const BeamRay ray = beams_.ray(geometry, pattern, static_cast<int>(i));
        packet.beam[packet.size] = ray;
        packet.line[packet.size] = line;
        packet.rays[packet.size++] = {ray.ray, (common_ ? *common_ : *lens).at(ray.lens_m),
                                      ray.start_m};
        const bool at_end = line + 1 == last && i + 1 == per_line;
        if (packet.size == kPacket || at_end) work += tracePacket(packet, sums);
      }
    }
    return work;
  }

 private:
  struct Packet {
    std::size_t size = 0;
    std::size_t done = 0;  // rays of the present line that are in the sums
    std::array<StartedRay, kPacket> rays;
    std::array<BeamRay, kPacket> beam;
    std::array<std::size_t, kPacket> line{};
  };

  // Traces a packet and adds it to its lines' sums, ray by ray in order; empties it.
  WorkCounts tracePacket(Packet& packet, BeamSums& sums) const {
    thread_local std::array<LineTrace, kPacket> traces;
    const WorkCounts work =
        walkTogether(geometry_, settings_, std::span(packet.rays).first(packet.size), traces);
    for (std::size_t i = 0; i < packet.size; ++i) {
      if (packet.done == 0) sums.begin(wanted_.size(), static_cast<std::size_t>(sampling_.samples));
      sums.add(settings_, beams_, packet.beam[i], traces[i], sampling_, wanted_);
      if (++packet.done < static_cast<std::size_t>(beams_.count())) continue;
      sums.finish(packet.line[i], wanted_);
      packet.done = 0;
    }
    packet.size = 0;
    return work;
  }

  const FrameGeometry& geometry_;
  const Probe& probe_;
  const TraceSettings& settings_;
  const BeamRays& beams_;
  const int frame_index_;
  const std::vector<Wanted> wanted_;
  const Sampling sampling_;
  std::optional<LensStates> common_;
};

// Along the lines themselves: labels and exponents.
WorkCounts traceCentres(const FrameGeometry& geometry, const Probe& probe,
                        const TraceSettings& settings, const PlaneRequest& request,
                        PolarFrame& frame) {
  PlaneRequest centres = request;
  centres.intensities = false;
  std::erase_if(centres.channels,
                [](Channel c) { return c != Channel::medium && c != Channel::attenuation; });
  if (!centres.channels.empty()) return traceFrame(geometry, probe, settings, centres, frame);
  WorkCounts work;
  work.bvh_updates = 1;
  return work;
}

WorkCounts sampledWork(const TraceSettings& settings, std::span<const Wanted> wanted,
                       std::uint64_t samples) {
  WorkCounts work;
  for (const Wanted& plane : wanted) {
    if (plane.parts.backscatter && settings.backscatter) work.samples_backscatter += samples;
    if (plane.parts.attenuation) work.samples_attenuated += samples;
  }
  return work;
}

}  // namespace

WorkCounts traceBeams(const FrameGeometry& geometry, const Probe& probe,
                      const TraceSettings& settings, const PlaneRequest& request,
                      const BeamRays& beams, int frame_index, LineRange range, PolarFrame& frame) {
  reservePlanes(probe, request, frame);
  WorkCounts work = traceCentres(geometry, probe, settings, request, frame);
  const std::vector<Wanted> wanted = intensityPlanes(settings, request, frame);
  if (wanted.empty()) return work;
  const BeamFrame shared(geometry, probe, settings, beams, frame_index, wanted);
  const auto first = static_cast<std::size_t>(range.first);
  const auto lines = static_cast<std::size_t>(range.count());
  const auto per_line = static_cast<std::size_t>(beams.count());
  const std::size_t grain = std::max<std::size_t>(kRaysOfBlock / per_line, 1);
  std::vector<WorkCounts> of_block((lines + grain - 1) / grain);
  parallelBlocks(lines, grain, [&](std::size_t begin, std::size_t end) {
    of_block[begin / grain] = shared.traceLines(first + begin, first + end);
  });
  for (const WorkCounts& w : of_block) work += w;
  return work += sampledWork(settings, wanted,
                             static_cast<std::uint64_t>(lines * per_line) *
                                 static_cast<std::uint64_t>(probe.samples));
}

}  // namespace echocine
