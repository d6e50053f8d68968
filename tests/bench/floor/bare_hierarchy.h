#pragma once
// The floor of the hierarchy: Embree refitted, and its rays. No rule for ties, no media, no echoes.

#include <embree3/rtcore.h>

#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "bench/bench_scene.h"
#include "geometry/frame_geometry.h"
#include "scene/scan_geometry.h"

namespace echocine::bench {

class BareHierarchy {
 public:
  explicit BareHierarchy(const BenchScene& scene) : scene_(scene) {
    rtcSetSceneFlags(rtc_,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST |
                                                RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    rtcSetSceneBuildQuality(rtc_, RTC_BUILD_QUALITY_LOW);
    for (const SurfaceTopology& surface : scene.topology) {
      RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_REFIT);
      vertices_.push_back(static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
          g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), surface.vertex_count)));
      std::memcpy(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          sizeof(Triangle), surface.triangles.size()),
                  surface.triangles.data(), surface.triangles.size() * sizeof(Triangle));
      rtcAttachGeometry(rtc_, g);
      geometries_.push_back(g);
    }
  }
  ~BareHierarchy() {
    for (RTCGeometry g : geometries_) rtcReleaseGeometry(g);
    rtcReleaseScene(rtc_);
    rtcReleaseDevice(device_);
  }
  BareHierarchy(const BareHierarchy&) = delete;
  BareHierarchy& operator=(const BareHierarchy&) = delete;

  void refit(const SurfaceFrame& frame) {
    for (std::size_t s = 0; s < geometries_.size(); ++s) {
      const std::vector<Vec3f>& from = frame.positions_m[s];
      std::memcpy(vertices_[s], from.data(), from.size() * sizeof(Vec3f));
      rtcUpdateGeometryBuffer(geometries_[s], RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometries_[s]);
    }
    rtcCommitScene(rtc_);
  }

  // All interfaces of all scan lines, one ray at a time.
  std::size_t singleRays() {
    std::size_t hits = 0;
    for (int i = 0; i < scene_.scene.probe.lines; ++i) {
      const LineGeometry line = lineGeometry(scene_.scene.probe, i);
      RTCRayHit ray;
      std::memset(&ray, 0, sizeof ray);
      ray.ray.dir_x = static_cast<float>(line.direction.x);
      ray.ray.dir_z = static_cast<float>(line.direction.z);
      ray.ray.tfar = std::numeric_limits<float>::infinity();
      ray.ray.mask = 0xffffffffu;
      ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      Collect context = collecting();
      rtcIntersect1(rtc_, &context.base, &ray);
      hits += found_[0].size();
    }
    return hits;
  }

  // The same rays as given, sixteen at a time.
  std::size_t packets(const std::vector<std::vector<RayQuery>>& queries) {
    std::size_t hits = 0;
    for (const std::vector<RayQuery>& rays : queries) {
      alignas(64) RTCRayHit16 packet;
      alignas(64) int valid[16] = {};
      std::memset(&packet, 0, sizeof packet);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3f o = toFloat(rays[i].ray.origin), d = toFloat(rays[i].ray.direction);
        valid[i] = -1;
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
      }
      Collect context = collecting();
      rtcIntersect16(valid, rtc_, &context.base, &packet);
      for (std::size_t i = 0; i < rays.size(); ++i) hits += found_[i].size();
    }
    return hits;
  }

 private:
  struct Hit {
    float distance;
    unsigned geometry, triangle;
  };
  using Found = std::array<std::vector<Hit>, 16>;
  struct Collect {
    RTCIntersectContext base;
    Found* found;
  };

  Collect collecting() {
    for (auto& hits : found_) hits.clear();
    Collect context;
    rtcInitIntersectContext(&context.base);
    context.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    context.base.filter = collect;
    context.found = &found_;
    return context;
  }
  static void collect(const RTCFilterFunctionNArguments* a) {
    Found& found = *reinterpret_cast<Collect*>(a->context)->found;
    for (unsigned i = 0; i < a->N; ++i) {
      if (a->valid[i] != -1) continue;
      found[RTCRayN_id(a->ray, a->N, i)].push_back({RTCRayN_tfar(a->ray, a->N, i),
                                                    RTCHitN_geomID(a->hit, a->N, i),
                                                    RTCHitN_primID(a->hit, a->N, i)});
      a->valid[i] = 0;
    }
  }

  const BenchScene& scene_;
  RTCDevice device_ = rtcNewDevice(nullptr);
  RTCScene rtc_ = rtcNewScene(device_);
  std::vector<RTCGeometry> geometries_;
  std::vector<Vec3f*> vertices_;
  Found found_;
};

}  // namespace echocine::bench
