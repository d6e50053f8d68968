#include "geometry/frame_geometry.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "core/check.h"
#include "core/error.h"
#include "core/parallel.h"
#include "geometry/crossing_rule.h"

namespace echocine {

namespace {

constexpr std::size_t kPacket = 16;

struct Box {
  Vec3d lo, hi;
  bool contains(Vec3d p) const {
    return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x <= hi.x && p.y <= hi.y && p.z <= hi.z;
  }
};

Box boxOf(const std::vector<Vec3f>& positions) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Vec3f lo{kFar, kFar, kFar}, hi{-kFar, -kFar, -kFar};
  for (const Vec3f p : positions) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  return {toDouble(lo), toDouble(hi)};
}

struct Candidate {
  std::uint32_t surface, triangle;
};

// Embree's context with the place where the filter puts what it is shown.
struct CollectContext {
  RTCIntersectContext base;  // first member: Embree hands a pointer to it back
  std::array<std::vector<Candidate>, kPacket>* found = nullptr;
};

// Notes every triangle that Embree reports and rejects it, so that the ray goes on to the next.
void collectHit(const RTCFilterFunctionNArguments* arguments) {
  auto& found = *reinterpret_cast<CollectContext*>(arguments->context)->found;
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] != -1) continue;
    const unsigned ray = RTCRayN_id(arguments->ray, arguments->N, i);
    found[ray].push_back({RTCHitN_geomID(arguments->hit, arguments->N, i),
                          RTCHitN_primID(arguments->hit, arguments->N, i)});
    arguments->valid[i] = 0;
  }
}

RTCRayHit16 packetOf(std::span<const RayQuery> rays) {
  RTCRayHit16 packet;
  std::memset(&packet, 0, sizeof packet);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3f o = toFloat(rays[i].ray.origin), d = toFloat(rays[i].ray.direction);
    packet.ray.org_x[i] = o.x;
    packet.ray.org_y[i] = o.y;
    packet.ray.org_z[i] = o.z;
    packet.ray.dir_x[i] = d.x;
    packet.ray.dir_y[i] = d.y;
    packet.ray.dir_z[i] = d.z;
    packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.ray.mask[i] = 0xffffffffu;
    packet.ray.id[i] = static_cast<unsigned>(i);
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  return packet;
}

struct DeviceHandle {
  RTCDevice device = rtcNewDevice(nullptr);
  ~DeviceHandle() { rtcReleaseDevice(device); }
};

// One device for the program: it holds no state of a frame.
RTCDevice sharedDevice() {
  static const DeviceHandle handle;
  return handle.device;
}

void throwOnError(const char* doing) {
  const RTCError error = rtcGetDeviceError(sharedDevice());
  if (error != RTC_ERROR_NONE)
    throw JobError(fmt::format("Embree failed while {} (error {}{})", doing, static_cast<int>(error),
                               error == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory" : ""));
}

}  // namespace

struct FrameGeometry::State {
  const std::vector<SurfaceTopology>& surfaces;
  RTCScene scene = nullptr;
  std::vector<Vec3f*> vertices;  // Embree's own buffers
  std::vector<RTCGeometry> geometries;
  std::vector<Box> boxes;

  explicit State(const std::vector<SurfaceTopology>& topology);
  ~State() {
    for (RTCGeometry geometry : geometries) rtcReleaseGeometry(geometry);
    rtcReleaseScene(scene);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void addSurface(const SurfaceTopology& surface);
  std::optional<Crossing> cross(const RayPlanes& ray, std::uint32_t surface,
                                std::uint32_t triangle) const;
  void crossAll(const RayPlanes& ray, std::uint32_t surface, std::vector<Crossing>& out) const;
  void crossCandidates(const RayQuery& query, std::vector<Candidate>& found,
                       RayCrossings& out) const;
  void proveStates(const RayQuery& query, RayCrossings& out) const;
};

FrameGeometry::State::State(const std::vector<SurfaceTopology>& topology) : surfaces(topology) {
  CHECK_LE(topology.size(), kMaxSurfaces);
  scene = rtcNewScene(sharedDevice());
  rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST |
                                                     RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  // Low scene quality means one hierarchy per mesh under a small one over all meshes; only then does Embree
  // refit the meshes' hierarchies instead of building everything anew.
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_LOW);
  for (const SurfaceTopology& surface : topology) addSurface(surface);
  boxes.resize(topology.size());
  throwOnError("building the scene");
}

void FrameGeometry::State::addSurface(const SurfaceTopology& surface) {
  RTCGeometry geometry = rtcNewGeometry(sharedDevice(), RTC_GEOMETRY_TYPE_TRIANGLE);
  geometries.push_back(geometry);
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
  auto* v = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                        RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                                        surface.vertex_count));
  auto* t = static_cast<Triangle*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                           RTC_FORMAT_UINT3, sizeof(Triangle),
                                                           surface.triangles.size()));
  throwOnError("reserving memory for the meshes");
  std::copy(surface.triangles.begin(), surface.triangles.end(), t);
  vertices.push_back(v);
  rtcAttachGeometry(scene, geometry);  // its geomID is the surface's index
}

std::optional<Crossing> FrameGeometry::State::cross(const RayPlanes& ray, std::uint32_t surface,
                                                    std::uint32_t triangle) const {
  const Triangle& t = surfaces[surface].triangles[triangle];
  const Vec3f* v = vertices[surface];
  return crossTriangle(ray, v[t[0]], v[t[1]], v[t[2]], SurfaceId(surface), triangle);
}

// Every triangle of a surface against the rule, without the hierarchy.
void FrameGeometry::State::crossAll(const RayPlanes& ray, std::uint32_t surface,
                                    std::vector<Crossing>& out) const {
  const auto count = static_cast<std::uint32_t>(surfaces[surface].triangles.size());
  for (std::uint32_t triangle = 0; triangle < count; ++triangle)
    if (const std::optional<Crossing> c = cross(ray, surface, triangle)) out.push_back(*c);
}

// Embree's candidates, each decided by the rule: Embree reports a hit on a shared edge for both triangles.
void FrameGeometry::State::crossCandidates(const RayQuery& query, std::vector<Candidate>& found,
                                           RayCrossings& out) const {
  const auto key = [](const Candidate& c) { return std::pair(c.surface, c.triangle); };
  std::sort(found.begin(), found.end(),
            [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); });
  found.erase(std::unique(found.begin(), found.end(),
                          [&](const Candidate& a, const Candidate& b) { return key(a) == key(b); }),
              found.end());
  const RayPlanes planes(query.ray);
  out.crossings.clear();
  for (const Candidate& candidate : found) {
    const std::pair here(SurfaceId(candidate.surface), candidate.triangle);
    if (std::find(query.left_behind.begin(), query.left_behind.end(), here) !=
        query.left_behind.end())
      continue;
    if (const std::optional<Crossing> c = cross(planes, candidate.surface, candidate.triangle))
      out.crossings.push_back(*c);
  }
}

namespace {

bool nearer(const Crossing& a, const Crossing& b) {
  if (a.distance_m != b.distance_m) return a.distance_m < b.distance_m;
  if (a.surface != b.surface) return a.surface < b.surface;
  return a.triangle < b.triangle;
}

// Entries less exits of one closed surface.
int balance(const std::vector<Crossing>& crossings, SurfaceId surface) {
  int sum = 0;
  for (const Crossing& c : crossings)
    if (c.surface == surface) sum += c.entering ? 1 : -1;
  return sum;
}

// Leaves of one surface's crossings only those that change its state. `depth` counts how often the start is
// inside; where the counts cannot be right the states must at least alternate.
void keepChanges(std::vector<Crossing>& crossings, SurfaceId surface, int depth, bool counts_right) {
  std::erase_if(crossings, [&](const Crossing& c) {
    if (c.surface != surface) return false;
    const int before = depth;
    depth += c.entering ? 1 : -1;
    if (!counts_right) depth = std::clamp(depth, 0, 1);
    return (before > 0) == (depth > 0);
  });
}

}  // namespace

// A closed surface's entries and exits balance with the state at the start. Where they do not, Embree has
// lost a crossing (a ray within rounding of an edge), the start lies on the surface, or a refracted ray has met
// the neighbour of the triangle it starts from: then every triangle is asked.
void FrameGeometry::State::proveStates(const RayQuery& query, RayCrossings& out) const {
  std::sort(out.crossings.begin(), out.crossings.end(), nearer);
  out.inside = query.inside;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (surfaces[s].membrane) continue;
    const SurfaceId id{static_cast<std::uint32_t>(s)};
    int inside = query.inside[s] ? 1 : 0;
    bool right = balance(out.crossings, id) == -inside;
    if (!right) {
      std::erase_if(out.crossings, [id](const Crossing& c) { return c.surface == id; });
      crossAll(RayPlanes(query.ray), static_cast<std::uint32_t>(s), out.crossings);
      for (const auto& [left_surface, left_triangle] : query.left_behind)
        std::erase_if(out.crossings, [&](const Crossing& c) {
          return c.surface == left_surface && c.triangle == left_triangle;
        });
      std::sort(out.crossings.begin(), out.crossings.end(), nearer);
      if (query.left_behind.empty()) inside = -balance(out.crossings, id);
      right = inside >= 0 && balance(out.crossings, id) == -inside;
      inside = std::max(inside, 0);
      out.inside[s] = inside > 0;
    }
    keepChanges(out.crossings, id, inside, right);
  }
}

FrameGeometry::FrameGeometry(const std::vector<SurfaceTopology>& surfaces)
    : state_(std::make_unique<State>(surfaces)) {}
FrameGeometry::~FrameGeometry() = default;
FrameGeometry::FrameGeometry(FrameGeometry&&) noexcept = default;

void FrameGeometry::update(const SurfaceFrame& frame) {
  State& s = *state_;
  for (std::size_t i = 0; i < s.surfaces.size(); ++i) {
    std::copy(frame.positions_m[i].begin(), frame.positions_m[i].end(), s.vertices[i]);
    s.boxes[i] = boxOf(frame.positions_m[i]);
    rtcUpdateGeometryBuffer(s.geometries[i], RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(s.geometries[i]);
  }
  // Embree waits for its own tasks here; outside work must not be taken up meanwhile.
  isolated([&] { rtcCommitScene(s.scene); });
  throwOnError("updating the hierarchy");
}

InsideSet FrameGeometry::insideAt(Vec3d point) const {
  InsideSet inside;
  std::vector<Crossing> met;
  const RayPlanes depthwards(Ray{point, {0, 0, 1}});
  for (std::uint32_t i = 0; i < state_->surfaces.size(); ++i) {
    if (state_->surfaces[i].membrane || !state_->boxes[i].contains(point)) continue;
    met.clear();
    state_->crossAll(depthwards, i, met);
    inside[i] = balance(met, SurfaceId{i}) < 0;
  }
  return inside;
}

void FrameGeometry::crossings(std::span<const RayQuery> rays, std::span<RayCrossings> out) const {
  DCHECK_LE(rays.size(), kPacket);
  thread_local std::array<std::vector<Candidate>, kPacket> found;
  for (std::size_t i = 0; i < rays.size(); ++i) found[i].clear();

  CollectContext context;
  rtcInitIntersectContext(&context.base);
  context.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.base.filter = collectHit;
  context.found = &found;
  alignas(64) std::array<int, kPacket> valid{};
  std::fill_n(valid.begin(), rays.size(), -1);
  alignas(64) RTCRayHit16 packet = packetOf(rays);
  rtcIntersect16(valid.data(), state_->scene, &context.base, &packet);

  for (std::size_t i = 0; i < rays.size(); ++i) {
    state_->crossCandidates(rays[i], found[i], out[i]);
    state_->proveStates(rays[i], out[i]);
  }
}

}  // namespace echocine
