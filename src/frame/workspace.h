#pragma once
// Buffers of one frame.

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "core/beam_plane.h"
#include "core/free_list.h"
#include "geometry/frame_geometry.h"
#include "geometry/plane_slice.h"
#include "geometry/side_slices.h"
#include "motion/surfaces/leaflet_bodies.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/trabeculae.h"
#include "plan/loop_plan.h"
#include "signal/picture.h"
#include "trace/channel_plane.h"
#include "trace/polar_frame.h"

namespace echocine {

struct Workspace {
  double phase = -1;  // of surfaces and geometry
  SurfaceFrame surfaces;
  Trabeculae::Smooth smooth{};                       // smooth surfaces, while others are displayed
  LeafletBodies::Sheets sheets{};                    // leaflets without thickness, likewise
  std::variant<PlaneSlice, FrameGeometry> geometry;  // by the planned tracer
  PolarFrame polar;
  std::optional<SideSlices> sides{};  // of a beam with several elevation slices
  PolarFrame side{};
  PolarFrame rolled{};  // lines of a rolling frame, as they are acquired
  Greys greys{};
  GreyImage image{};
  std::uint64_t crossings = 0;  // of interfaces, in the frame that was traced last
};

// The planes of a frame for its EXR, in the order of the scene's channels.
std::vector<ChannelPlane> channelPlanes(const OutputSettings& output, const Workspace& workspace);

// A pool of workspaces: one per frame in flight.
class WorkspacePool {
 public:
  // References are kept. `surfaces`: those that the picture shows.
  WorkspacePool(const Scene& scene, const std::vector<SurfaceTopology>& surfaces,
                const LoopPlan& plan)
      : scene_(scene), surfaces_(surfaces), plan_(plan) {}

  // Borrowed for the lifetime of the pointer, which must end before the pool's. Thread-safe.
  std::shared_ptr<Workspace> borrow() const;

 private:
  std::unique_ptr<Workspace> made() const;

  const Scene& scene_;
  const std::vector<SurfaceTopology>& surfaces_;
  const LoopPlan& plan_;
  mutable FreeList<Workspace> list_;
};

}  // namespace echocine
