#include "geometry/side_slices.h"

#include <numeric>

#include "motion/surfaces/near_plane.h"
#include "scene/elevation_slices.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Vertices of the triangles that a slice can reach.
std::vector<std::uint32_t> verticesOf(const SurfaceTopology& surface) {
  const std::vector<bool> near = verticesNearPlane(surface);
  std::vector<std::uint32_t> vertices(surface.vertex_count);
  std::iota(vertices.begin(), vertices.end(), 0u);
  std::erase_if(vertices, [&](std::uint32_t v) { return !near[v]; });
  return vertices;
}

}  // namespace

SideSlices::SideSlices(const std::vector<SurfaceTopology>& surfaces, const Scene& scene,
                       const InsideSet& left_out)
    : probe_(scene.probe) {
  const std::span<const ElevationNode> nodes = elevationNodes(scene.accuracy.elevation_slices);
  centre_weight_ = nodes.front().weight;
  for (const ElevationNode& node : nodes.subspan(1)) {
    places_.push_back(node.place);
    weights_.push_back(node.weight);
    slices_.emplace_back(surfaces, scene.probe, left_out);
  }
  for (const SurfaceTopology& surface : surfaces)
    if (!left_out[index(surface.id)])
      moved_.push_back({index(surface.id), surface.still, verticesOf(surface), {}, {}});
}

void SideSlices::note(const SurfaceFrame& frame) {
  const ScanGeometry geometry(probe_);
  const ElevationBell bell(probe_);
  for (Moved& moved : moved_) {
    moved.height_m.clear();
    moved.deviation_m.clear();
    if (moved.still && still_cut_) continue;
    for (const std::uint32_t v : moved.vertices) {
      const Vec3f& p = frame.positions_m[moved.surface][v];
      moved.height_m.push_back(p.y);
      const double path_m = geometry.pathOf({toDouble(p).x, 0, toDouble(p).z});
      moved.deviation_m.push_back(static_cast<float>(bell.deviation(path_m)));
    }
  }
}

void SideSlices::update(SurfaceFrame& frame) {
  note(frame);
  const auto bend = [&](double place) {
    for (const Moved& moved : moved_)
      for (std::size_t i = 0; i < moved.height_m.size(); ++i)
        frame.positions_m[moved.surface][moved.vertices[i]].y =
            place == 0 ? moved.height_m[i]
                       : moved.height_m[i] - static_cast<float>(place) * moved.deviation_m[i];
  };
  for (std::size_t k = 0; k < slices_.size(); ++k) {
    bend(places_[k]);
    slices_[k].update(frame);
  }
  bend(0);
  still_cut_ = true;
}

}  // namespace echocine
