#include "trace/trace_frame.h"

#include <array>
#include <atomic>
#include <optional>

#include "core/parallel.h"
#include "trace/line_walker.h"

namespace echocine {

namespace {

constexpr std::size_t kPacket = 16;  // lines that go through the hierarchy together

struct Packet {
  std::array<LineTrace, kPacket> lines;
  std::array<RayCrossings, kPacket> met;
  WorkCounts work;
};

// Follows a packet of neighbouring lines, one round per straight piece.
void walkPacket(const FrameGeometry& geometry, const Probe& probe, const TraceSettings& settings,
                int first_line, std::size_t count, Packet& packet) {
  std::array<std::optional<LineWalker>, kPacket> walkers;
  std::array<RayQuery, kPacket> queries;
  InsideSet inside;
  Vec3d origin{};
  for (std::size_t i = 0; i < count; ++i) {
    const LineGeometry line = lineGeometry(probe, first_line + static_cast<int>(i));
    if (i == 0 || !(line.origin == origin)) inside = geometry.insideAt(line.origin);
    origin = line.origin;
    walkers[i].emplace(settings, Ray{line.origin, line.direction}, inside, packet.lines[i]);
  }
  for (;;) {
    std::array<std::size_t, kPacket> who{};
    std::size_t alive = 0;
    for (std::size_t i = 0; i < count; ++i)
      if (walkers[i]->alive()) {
        who[alive] = i;
        queries[alive++] = walkers[i]->query();
      }
    if (alive == 0) return;
    geometry.crossings(std::span(queries).first(alive), std::span(packet.met).first(alive));
    packet.work.rays += alive;
    for (std::size_t i = 0; i < alive; ++i) {
      packet.work.crossings += packet.met[i].crossings.size();
      walkers[who[i]]->advance(packet.met[i]);
    }
  }
}

IntensityParts partsOf(Channel channel, bool attenuation) {
  IntensityParts parts;
  parts.attenuation = attenuation && channel != Channel::unattenuated;
  parts.backscatter = channel != Channel::reflection;
  parts.reflection = channel != Channel::backscatter;
  return parts;
}

// Samples one line into every plane that is asked for.
class LineSampler {
 public:
  LineSampler(const Probe& probe, const TraceSettings& settings, const PlaneRequest& request,
              PolarFrame& frame)
      : sampling_{probe.min_depth_m, probe.sampleSpacing(), probe.samples},
        settings_(settings), request_(request), frame_(frame) {}

  void sample(int line, const LineTrace& trace, WorkCounts& work) const {
    for (const Channel channel : request_.channels) {
      if (channel == Channel::medium)
        sampleMedium(trace, sampling_, column(frame_.medium, line));
      else if (channel == Channel::attenuation)
        sampleExponent(trace, sampling_, column(frame_.planes.at(channel), line));
      else
        intensity(trace, partsOf(channel, settings_.attenuation),
                  column(frame_.planes.at(channel), line), work);
    }
    if (request_.signal) intensity(trace, request_.signal_parts, column(frame_.signal, line), work);
  }

 private:
  template <typename T>
  std::span<T> column(std::vector<T>& plane, int line) const {
    const auto samples = static_cast<std::size_t>(sampling_.samples);
    return std::span(plane).subspan(static_cast<std::size_t>(line) * samples, samples);
  }

  void intensity(const LineTrace& trace, const IntensityParts& parts, std::span<float> values,
                 WorkCounts& work) const {
    sampleIntensity(trace, sampling_, parts, values);
    const bool backscatter = parts.backscatter && settings_.backscatter;
    if (backscatter) work.samples_backscatter += values.size();
    if (parts.attenuation) work.samples_attenuated += values.size();
  }

  Sampling sampling_;
  const TraceSettings& settings_;
  const PlaneRequest& request_;
  PolarFrame& frame_;
};

void reserve(const Probe& probe, const PlaneRequest& request, PolarFrame& frame) {
  frame.lines = probe.lines;
  frame.samples = probe.samples;
  const std::size_t size = static_cast<std::size_t>(probe.lines) * static_cast<std::size_t>(probe.samples);
  for (const Channel channel : request.channels) {
    if (channel == Channel::medium)
      frame.medium.resize(size);
    else
      frame.planes[channel].resize(size);
  }
  if (request.signal) frame.signal.resize(size);
}

}  // namespace

TraceSettings::TraceSettings(const Scene& scene, const EffectPlan& plan)
    : media(scene.media),
      background(scene.background),
      unit_volume_m3(scene.unit_volume_m3),
      max_depth_m(scene.probe.max_depth_m),
      thin_layer_m(1e-3 * kScannerSpeed / scene.probe.frequency_hz),
      reflection(plan.reflection),
      transmission_loss(plan.transmission_loss),
      refraction(plan.refraction),
      attenuation(plan.attenuation),
      backscatter(plan.backscatter),
      travel_time(plan.travel_time) {
  for (const Structure& s : scene.structures)
    surfaces.push_back({s.medium, s.priority, s.membrane, s.reflection_gain, s.reflection_exponent});
}

PlaneRequest planeRequest(const Scene& scene, const EffectPlan& plan) {
  PlaneRequest request;
  for (const Channel channel : scene.output.channels)
    if (scene.output.exr && channel != Channel::display) request.channels.push_back(channel);
  request.signal = scene.output.cine || scene.output.png || wants(scene, Channel::display);
  request.signal_parts.attenuation = plan.attenuation && scene.signal.tgc != Tgc::perfect;
  request.signal_parts.spread_undone_at_m =
      scene.signal.spread == Spread::compensate ? scene.probe.middleDepth() : 0;
  return request;
}

WorkCounts traceFrame(const FrameGeometry& geometry, const Probe& probe,
                     const TraceSettings& settings, const PlaneRequest& request,
                     PolarFrame& frame) {
  reserve(probe, request, frame);
  const LineSampler sampler(probe, settings, request, frame);
  const std::size_t packets = (static_cast<std::size_t>(probe.lines) + kPacket - 1) / kPacket;
  std::vector<WorkCounts> work(packets);
  parallelBlocks(static_cast<std::size_t>(probe.lines), kPacket,
                 [&](std::size_t begin, std::size_t end) {
                   thread_local Packet packet;
                   packet.work = {};
                   const int first_line = static_cast<int>(begin);
                   walkPacket(geometry, probe, settings, first_line, end - begin, packet);
                   for (std::size_t i = 0; i < end - begin; ++i)
                     sampler.sample(first_line + static_cast<int>(i), packet.lines[i], packet.work);
                   work[begin / kPacket] = packet.work;
                 });
  WorkCounts sum;
  for (const WorkCounts& w : work) sum += w;
  return sum;
}

}  // namespace echocine
