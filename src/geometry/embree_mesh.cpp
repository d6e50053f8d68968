#include "geometry/embree_mesh.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

#include "core/check.h"
#include "core/error.h"
#include "core/library_threads.h"
#include "core/parallel.h"

namespace echocine {

namespace {

// Embree's context with the place where the filter puts what it is shown.
struct CollectContext {
  RTCIntersectContext base;  // first member: Embree hands a pointer to it back
  EmbreeMesh::Candidates* found = nullptr;
};

// Notes every triangle that Embree reports and rejects it, so that the ray goes on to the next.
// Which rays hit cannot be foretold, so they are gathered without a branch first.
void collectHit(const RTCFilterFunctionNArguments* arguments) {
  auto& found = *reinterpret_cast<CollectContext*>(arguments->context)->found;
  const unsigned count = arguments->N;
  int* const valid = arguments->valid;
  unsigned hits = 0;
  for (unsigned i = 0; i < count; ++i) hits |= static_cast<unsigned>(valid[i] & 1) << i;
  for (; hits != 0; hits &= hits - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(hits));
    found[RTCRayN_id(arguments->ray, count, i)].push_back(RTCHitN_primID(arguments->hit, count, i));
    valid[i] = 0;
  }
}

// A coordinate of the origin for Embree's ray. Along an axis that the ray does not move on, Embree
// takes boxes that end exactly at the ray for missed, on one side. The crossing rule counts what
// lies exactly at the ray as above it, as if the ray were the least bit lower: so must Embree's ray
// be, where rounding has not already put it there.
float originForEmbree(double origin, double direction) {
  const auto rounded = static_cast<float>(origin);
  if (direction != 0 || static_cast<double>(rounded) < origin) return rounded;
  // Far below any coordinate that is not 0, far above what Embree's reciprocal of 0 (1e18) loses.
  constexpr float kBelowZero = -1e-15f;
  return rounded == 0 ? kBelowZero
                      : std::nextafter(rounded, -std::numeric_limits<float>::infinity());
}

RTCRayHit16 packetOf(std::span<const RayQuery> rays) {
  RTCRayHit16 packet;
  std::memset(&packet, 0, sizeof packet);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3d o = rays[i].ray.origin, direction = rays[i].ray.direction;
    const Vec3f d = toFloat(direction);
    packet.ray.org_x[i] = originForEmbree(o.x, direction.x);
    packet.ray.org_y[i] = originForEmbree(o.y, direction.y);
    packet.ray.org_z[i] = originForEmbree(o.z, direction.z);
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
  RTCDevice device = rtcNewDevice(fmt::format("threads={}", libraryThreads()).c_str());
  ~DeviceHandle() { rtcReleaseDevice(device); }
};

// One device for the program: it holds no state of a frame.
RTCDevice sharedDevice() {
  static const DeviceHandle handle;
  return handle.device;
}

void throwOnError(const char* doing) {
  const RTCError error = rtcGetDeviceError(sharedDevice());
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (error != RTC_ERROR_NONE)
    throw JobError(
        fmt::format("Embree failed while {} (error {})", doing, static_cast<int>(error)));
}

}  // namespace

EmbreeMesh::EmbreeMesh()
    : scene_(rtcNewScene(sharedDevice())),
      mesh_(rtcNewGeometry(sharedDevice(), RTC_GEOMETRY_TYPE_TRIANGLE)) {
  rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(
                               RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST |
                               RTC_SCENE_FLAG_COMPACT | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  // Only in scenes of low quality does Embree refit instead of building everything anew.
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
  rtcSetGeometryBuildQuality(mesh_, RTC_BUILD_QUALITY_REFIT);
  throwOnError("building the scene");
}

EmbreeMesh::~EmbreeMesh() {
  rtcReleaseGeometry(mesh_);
  rtcReleaseScene(scene_);
}

void EmbreeMesh::reserve(std::size_t vertices, std::size_t triangles) {
  if (triangles == 0) return;
  vertices_ = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
      mesh_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), vertices));
  triangles_ = static_cast<Triangle*>(rtcSetNewGeometryBuffer(
      mesh_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), triangles));
  throwOnError("reserving memory for the meshes");
  rtcAttachGeometry(scene_, mesh_);
  throwOnError("building the scene");
}

void EmbreeMesh::refit() {
  if (vertices_) {
    rtcUpdateGeometryBuffer(mesh_, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(mesh_);
  }
  // Embree waits for its own tasks here; outside work must not be taken up meanwhile.
  isolated([&] { rtcCommitScene(scene_); });
  throwOnError("updating the hierarchy");
}

void EmbreeMesh::candidates(std::span<const RayQuery> rays, Candidates& found) const {
  DCHECK_LE(rays.size(), kPacket);
  for (std::size_t i = 0; i < rays.size(); ++i) found[i].clear();
  CollectContext context;
  rtcInitIntersectContext(&context.base);
  context.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.base.filter = collectHit;
  context.found = &found;
  alignas(64) std::array<int, kPacket> valid{};
  std::fill_n(valid.begin(), rays.size(), -1);
  alignas(64) RTCRayHit16 packet = packetOf(rays);
  rtcIntersect16(valid.data(), scene_, &context.base, &packet);
}

}  // namespace echocine
