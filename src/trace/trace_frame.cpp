#include "trace/trace_frame.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/parallel.h"
#include "core/units.h"
#include "scene/scan_geometry.h"
#include "scene/white_rule.h"
#include "trace/cell_echoes.h"
#include "trace/line_walker.h"
#include "trace/linked_echoes.h"
#include "trace/packet_walk.h"

namespace echocine {

namespace {

// Where a line starts, and the closed surfaces that hold it there.
struct Start {
  Vec3d origin;
  InsideSet inside;
};

// Neighbouring lines of one frame. `start`: of another line; to find the surfaces around a point
// takes all their triangles, and most lines start in one place.
WorkCounts walkPacket(const FrameGeometry& geometry, const Probe& probe,
                      const TraceSettings& settings, Start start, int first_line,
                      std::span<LineTrace> lines) {
  std::array<StartedRay, kPacket> rays;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const LineGeometry line = lineGeometry(probe, first_line + static_cast<int>(i));
    if (!(line.origin == start.origin)) start = {line.origin, geometry.insideAt(line.origin)};
    rays[i] = {{line.origin, line.direction}, start.inside};
  }
  return walkTogether(geometry, settings, std::span(rays).first(lines.size()), lines);
}

}  // namespace

Sampling samplingOf(const Probe& probe, const TraceSettings& settings) {
  return {probe.min_depth_m, probe.sampleSpacing(), probe.samples, settings.wavelength_m};
}

IntensityTerms partsOf(Channel channel, bool attenuation, double spread_undone_at_m) {
  IntensityTerms parts;
  parts.spread_undone_at_m = spread_undone_at_m;
  parts.attenuation = attenuation && channel != Channel::unattenuated;
  parts.backscatter = channel != Channel::reflection;
  parts.reflection = channel != Channel::backscatter;
  return parts;
}

// An echo is as long as the pulse, L = N wavelengths / 2, and no shorter than a sample.
double echoSamples(const Scene& scene) {
  const double pulse_m = scene.signal.pulse_cycles * ScanGeometry(scene.probe).wavelength() / 2;
  return std::max(pulse_m / scene.probe.sampleSpacing(), 1.0);
}

namespace {

// Samples one line into every plane that is asked for.
class LineSampler {
 public:
  LineSampler(const Probe& probe, const TraceSettings& settings, const PlaneRequest& request,
              const NeededSamples* needed, PolarFrame& frame)
      : sampling_(samplingOf(probe, settings)),
        settings_(settings),
        request_(request),
        needed_(needed),
        frame_(frame) {}

  // After all lines.
  void addCellEchoes() const {
    for (const Channel channel : request_.channels)
      if (channel != Channel::medium && channel != Channel::attenuation)
        addToSamples(frame_.cell_echoes, termsOfChannel(channel), frame_.planes.at(channel));
    if (request_.intensities)
      addToSamples(frame_.cell_echoes, request_.intensity_terms, frame_.intensities);
  }

  void sample(int line, const LineTrace& trace) const {
    const bool taken = !needed_ || (line >= needed_->lines.first && line < needed_->lines.end);
    sampleChannels(line, trace, taken);
    if (!request_.intensities) return;
    const std::span<float> values = column(frame_.intensities.values, line);
    Sampling first = sampling_;
    if (needed_) first.samples = needed_->intensities[static_cast<std::size_t>(line)];
    const auto count = static_cast<std::size_t>(first.samples);
    sampleIntensity(trace, first, request_.intensity_terms, values.first(count));
    std::fill(values.begin() + first.samples, values.end(), 0.0f);
  }

  // Echoes of lung need the media of each line that the average over the beam takes in.
  void sampleChannels(int line, const LineTrace& trace, bool taken) const {
    for (const Channel channel : request_.channels) {
      if (channel == Channel::medium && (taken || request_.intensities))
        sampleMedium(trace, sampling_, column(frame_.medium, line));
      if (channel == Channel::medium || !taken) continue;
      if (channel == Channel::attenuation)
        sampleExponent(trace, sampling_, column(frame_.planes.at(channel), line));
      else
        sampleIntensity(trace, sampling_, termsOfChannel(channel),
                        column(frame_.planes.at(channel), line));
    }
  }

  // Work of all lines, by the planes that they fill.
  WorkCounts work() const {
    WorkCounts work;
    const int lines = needed_ ? needed_->lines.count() : frame_.lines;
    const auto of_channel =
        static_cast<std::uint64_t>(lines) * static_cast<std::uint64_t>(frame_.samples);
    const auto add = [&](const IntensityTerms& parts, std::uint64_t size) {
      if (parts.backscatter && settings_.backscatter) work.samples_backscatter += size;
      if (parts.attenuation) work.samples_attenuated += size;
    };
    for (const Channel channel : request_.channels) {
      if (channel == Channel::attenuation)
        add({.reflection = false, .backscatter = false}, of_channel);
      else if (channel != Channel::medium)
        add(termsOfChannel(channel), of_channel);
    }
    if (!request_.intensities) return work;
    add(request_.intensity_terms,
        needed_ ? std::accumulate(needed_->intensities.begin(), needed_->intensities.end(),
                                  std::uint64_t{0})
                : of_channel);
    return work;
  }

 private:
  IntensityTerms termsOfChannel(Channel channel) const {
    IntensityTerms parts = partsOf(channel, settings_.attenuation, request_.spread_undone_at_m);
    parts.echo_samples = request_.echo_samples;
    return parts;
  }
  template <typename T>
  std::span<T> column(std::vector<T>& plane, int line) const {
    const auto samples = static_cast<std::size_t>(sampling_.samples);
    return std::span(plane).subspan(static_cast<std::size_t>(line) * samples, samples);
  }

  Sampling sampling_;
  const TraceSettings& settings_;
  const PlaneRequest& request_;
  const NeededSamples* needed_;
  PolarFrame& frame_;
};

}  // namespace

void reservePlanes(const Probe& probe, const PlaneRequest& request, PolarFrame& frame) {
  frame.lines = probe.lines;
  frame.samples = probe.samples;
  frame.traces.resize(static_cast<std::size_t>(probe.lines));
  const std::size_t size =
      static_cast<std::size_t>(probe.lines) * static_cast<std::size_t>(probe.samples);
  for (const Channel channel : request.channels) {
    if (channel == Channel::medium)
      frame.medium.resize(size);
    else
      frame.planes[channel].resize(size);
  }
  if (request.intensities) frame.intensities.resize(size);
}

TraceSettings::TraceSettings(const Scene& scene, const EffectPlan& plan, EchoCells integrated)
    : media(scene.media),
      background(scene.background),
      unit_volume_m3(scene.unit_volume_m3),
      max_depth_m(scene.probe.max_depth_m),
      thin_layer_m(1e-4 * ScanGeometry(scene.probe).wavelength()),
      face_m(1e-3 * ScanGeometry(scene.probe).wavelength()),
      frequency_hz(scene.probe.frequency_hz),
      wavelength_m(ScanGeometry(scene.probe).wavelength()),
      pulse_cycles(std::max(scene.signal.pulse_cycles, 1.0)),  // no pulse is shorter than a cycle
      reflection(plan.reflection),
      transmission_loss(plan.transmission_loss),
      refraction(plan.refraction),
      attenuation(plan.attenuation),
      backscatter(plan.backscatter),
      travel_time(plan.travel_time),
      snell_angles(plan.snell_angles),
      reflection_cap(plan.reflection_cap),
      thin_layers(plan.thin_layers),
      cells(integrated),
      coherent_echoes(plan.coherent_echoes),
      note_hits(integrated == EchoCells::contours) {
  for (const Structure& s : scene.structures)
    surfaces.push_back({s.medium, s.priority, s.membrane, s.reflection_gain,
                        plan.lobe ? s.reflection_exponent : 0,
                        s.coherent_share / (1 + s.coherent_share)});
}

PlaneRequest planeRequest(const Scene& scene, const EffectPlan& plan) {
  PlaneRequest request;
  for (const Channel channel : scene.output.channels)
    if (scene.output.exr && channel != Channel::display && !isTruth(channel))
      request.channels.push_back(channel);
  request.intensities = wantsPicture(scene);
  const auto asked = [&](Channel c) {
    return std::find(request.channels.begin(), request.channels.end(), c) != request.channels.end();
  };
  // White goes by the samples of muscle, lung by those of air.
  if (request.intensities && (plan.lung || isWhiteByMuscle(scene)) && !asked(Channel::medium))
    request.channels.push_back(Channel::medium);
  request.intensity_terms.attenuation = plan.attenuation && scene.signal.tgc != Tgc::perfect;
  request.echo_samples = echoSamples(scene);
  // Without the average over the pulse a sample of the picture shows the echo's peak.
  if (plan.beam_width) request.intensity_terms.echo_samples = request.echo_samples;
  request.intensity_terms.echo_gain = intensityFromDecibels(scene.signal.interface_gain_db);
  if (scene.signal.interface_limit_db)
    request.intensity_terms.echo_limit = intensityFromDecibels(*scene.signal.interface_limit_db);
  request.spread_undone_at_m = plan.spread ? 0 : scene.probe.middleDepth();
  request.intensity_terms.spread_undone_at_m =
      !plan.spread || scene.signal.spread == Spread::compensate ? scene.probe.middleDepth() : 0;
  return request;
}

namespace {

// Samples all lines into the planes of the frame.
void sampleLines(const Probe& probe, const TraceSettings& settings, const PlaneRequest& request,
                 const NeededSamples* needed, PolarFrame& frame, WorkCounts& work) {
  const LineSampler sampler(probe, settings, request, needed, frame);
  parallelBlocks(frame.traces.size(), kPacket, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sampler.sample(static_cast<int>(i), frame.traces[i]);
  });
  if (settings.cells != EchoCells::none) sampler.addCellEchoes();
  if (settings.coherent_echoes && request.intensities) {
    frame.coherent.clear(frame.intensities.size());
    addCoherent(frame.traces, frame.cell_echoes, settings, samplingOf(probe, settings),
                request.intensity_terms, frame.coherent);
  }
  work += sampler.work();
}

}  // namespace

WorkCounts walkLines(const FrameGeometry& geometry, const Probe& probe,
                     const TraceSettings& settings, std::vector<LineTrace>& traces) {
  traces.resize(static_cast<std::size_t>(probe.lines));
  std::vector<WorkCounts> of_packet((traces.size() + kPacket - 1) / kPacket);
  const Vec3d origin = lineGeometry(probe, 0).origin;
  const Start start{origin, geometry.insideAt(origin)};
  parallelBlocks(traces.size(), kPacket, [&](std::size_t begin, std::size_t end) {
    of_packet[begin / kPacket] =
        walkPacket(geometry, probe, settings, start, static_cast<int>(begin),
                   std::span(traces).subspan(begin, end - begin));
  });
  WorkCounts work;
  for (const WorkCounts& w : of_packet) work += w;
  return work;
}

WorkCounts traceFrame(const FrameGeometry& geometry, const Probe& probe,
                      const TraceSettings& settings, const PlaneRequest& request, PolarFrame& frame,
                      const NeededSamples* needed) {
  reservePlanes(probe, request, frame);
  WorkCounts work = walkLines(geometry, probe, settings, frame.traces);
  work.bvh_updates = 1;  // the one that this frame's rays went through
  if (settings.cells == EchoCells::links)
    linkEchoes(probe, settings, frame.traces, frame.cell_echoes);
  sampleLines(probe, settings, request, needed, frame, work);
  return work;
}

WorkCounts traceFrame(const PlaneSlice& slice, const Probe& probe, const TraceSettings& settings,
                      const PlaneRequest& request, PolarFrame& frame, const NeededSamples* needed) {
  reservePlanes(probe, request, frame);
  WorkCounts work;
  for (int i = 0; i < probe.lines; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    const RayCrossings& met = slice.lines()[static_cast<std::size_t>(i)];
    LineWalker walker(settings, Ray{line.origin, line.direction}, met.inside,
                      frame.traces[static_cast<std::size_t>(i)]);
    walker.advance(met);
    work.rays += 1;
    work.crossings += met.crossings.size();
  }
  work.facets_sliced = slice.edges().size();
  if (settings.cells == EchoCells::contours)
    addCellEchoes(slice.edges(), slice.normals(), probe, settings, frame.traces, frame.cell_echoes);
  sampleLines(probe, settings, request, needed, frame, work);
  return work;
}

}  // namespace echocine
