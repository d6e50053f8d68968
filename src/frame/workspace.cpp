#include "frame/workspace.h"

namespace echocine {

std::vector<ChannelPlane> channelPlanes(const OutputSettings& output, const Workspace& w) {
  const PolarFrame& polar = w.polar;
  std::vector<ChannelPlane> planes;
  for (const Channel channel : output.channels) {
    if (isTruth(channel)) continue;  // of another origin
    if (channel == Channel::medium)
      planes.push_back({channel, {}, polar.medium});
    else if (channel == Channel::display)
      planes.push_back({channel, w.greys, {}});
    else
      planes.push_back({channel, polar.planes.at(channel), {}});
  }
  return planes;
}

std::unique_ptr<Workspace> WorkspacePool::made() const {
  if (!plan_.slice)
    return std::make_unique<Workspace>(
        Workspace{-1, {}, {}, {}, FrameGeometry(surfaces_, plan_.left_out), {}});
  auto space = std::make_unique<Workspace>(
      Workspace{-1, {}, {}, {}, PlaneSlice(surfaces_, scene_.probe, plan_.left_out), {}});
  if (plan_.effects.elevation_slices > 1) space->sides.emplace(surfaces_, scene_, plan_.left_out);
  return space;
}

std::shared_ptr<Workspace> WorkspacePool::borrow() const {
  return list_.borrow([this] { return made(); });
}

}  // namespace echocine
