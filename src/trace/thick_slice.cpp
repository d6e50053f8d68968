#include "trace/thick_slice.h"

#include <algorithm>

#include "core/parallel.h"

namespace echocine {

namespace {

constexpr std::size_t kSamplesOfBlock = 16384;

bool isOfPlane(Channel channel) {
  return channel == Channel::medium || channel == Channel::attenuation;
}

// Runs over all planes of intensities of both frames.
template <typename Each>
void overPlanes(const PlaneRequest& request, PolarFrame& frame, PolarFrame& side,
                const Each& each) {
  for (const Channel channel : request.channels)
    if (!isOfPlane(channel)) each(frame.planes.at(channel), side.planes[channel]);
  if (!request.intensities) return;
  each(frame.intensities.values, side.intensities.values);
  each(frame.coherent.intensity, side.coherent.intensity);
  each(frame.coherent.real, side.coherent.real);
  each(frame.coherent.imaginary, side.coherent.imaginary);
}

// to = a to + b from
void blend(float a, std::vector<float>& to, float b, const std::vector<float>& from) {
  parallelBlocks(to.size(), kSamplesOfBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) to[i] = a * to[i] + b * from[i];
  });
}

}  // namespace

WorkCounts traceThick(const PlaneSlice& plane, const SideSlices& sides, const Probe& probe,
                      const TraceSettings& settings, const PlaneRequest& request, PolarFrame& frame,
                      PolarFrame& side, const NeededSamples* needed) {
  WorkCounts work = traceFrame(plane, probe, settings, request, frame, needed);
  PlaneRequest beside = request;
  std::erase_if(beside.channels, isOfPlane);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    work += traceFrame(sides.slice(k), probe, settings, beside, side, needed);
    // The plane's own weight goes in with the first of the others.
    const auto own = static_cast<float>(k == 0 ? sides.centreWeight() : 1.0);
    const auto weight = static_cast<float>(sides.weight(k));
    overPlanes(request, frame, side, [&](std::vector<float>& to, const std::vector<float>& from) {
      blend(own, to, weight, from);
    });
  }
  return work;
}

}  // namespace echocine
