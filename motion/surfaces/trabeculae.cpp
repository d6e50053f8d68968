#include "motion/surfaces/trabeculae.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/hash_random.h"
#include "core/nearest_vertex.h"
#include "core/normal_field.h"
#include "motion/surfaces/near_plane.h"
#include "scene/role.h"

namespace echocine {

namespace {

// Our choice: no ridges at the rings of valves, full height from 16 mm on, few on the left
// side of the septum.
constexpr float kNoneWithin_m = 6e-3f, kAllBeyond_m = 16e-3f;
constexpr float kOnSurface_m = 0.3e-3f;  // distance of shared vertices
constexpr std::size_t kEnough = 600;     // vertices of a surface that suffice for distances
constexpr int kPhases = 16;              // at which no face may be inverted
constexpr int kMostHalvings = 8;
constexpr std::uint64_t kPurpose = 0x7ab;

// Displaces each vertex at an instant along the sum of its faces' normals. `normals` are zero
// before and after; at least one per vertex.
template <typename Move>
void moveAll(const Relief& relief, const std::vector<Vec3f>& at_m, std::vector<Vec3f>& normals,
             const Move& move) {
  for (const Triangle& t : relief.about) {
    const Vec3f a = at_m[t[0]], n = cross(at_m[t[1]] - a, at_m[t[2]] - a);
    for (const std::uint32_t v : t) normals[v] = normals[v] + n;
  }
  for (const std::uint32_t v : relief.moved) {
    const float length2 = dot(normals[v], normals[v]);
    if (length2 > 0) move(v, (-relief.height_m[v] / std::sqrt(length2)) * normals[v]);
  }
  for (const Triangle& t : relief.about)
    for (const std::uint32_t v : t) normals[v] = {};
}

double meanEdge(const std::vector<Triangle>& faces, const std::vector<Vec3f>& at_m) {
  double sum = 0;
  for (const Triangle& t : faces)
    sum += length(toDouble(at_m[t[1]] - at_m[t[0]])) + length(toDouble(at_m[t[2]] - at_m[t[1]])) +
           length(toDouble(at_m[t[0]] - at_m[t[2]]));
  return faces.empty() ? 0 : sum / (3 * static_cast<double>(faces.size()));
}

// Vertices of all other structures that contain blood; for the right ventricle without the left,
// because the septum's right side is rough.
std::vector<Vec3f> otherBlood(const Scene& scene, const SurfaceFrame& frame, std::size_t but) {
  std::vector<Vec3f> places_m;
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    const Structure& structure = scene.structures[s];
    if (s == but || structure.membrane || !scene.medium(structure.medium).blood) continue;
    if (roleOf(scene.structures[but]) == Role::rv_cavity && roleOf(structure) == Role::lv_cavity)
      continue;
    const std::vector<Vec3f>& all_m = frame.positions_m[s];
    const std::size_t step = std::max<std::size_t>(all_m.size() / kEnough, 1);
    for (std::size_t v = 0; v < all_m.size(); v += step) places_m.push_back(all_m[v]);
  }
  return places_m;
}

float fadeAt(float distance_m) {
  const float f =
      std::clamp((distance_m - kNoneWithin_m) / (kAllBeyond_m - kNoneWithin_m), 0.0f, 1.0f);
  return f * f * (3 - 2 * f);
}

std::vector<float> heights(const Scene& scene, const SurfaceTopology& surface,
                           const SurfaceFrame& frame) {
  const TrabeculaeSettings& settings = scene.trabeculae;
  const std::size_t s = index(surface.id);
  const std::vector<Vec3f>& at_m = frame.positions_m[s];
  const double scale_m = std::max(settings.scale_m, 2 * meanEdge(surface.triangles, at_m));
  NormalField field(scale_m, hashOf(settings.seed, kPurpose, roleOf(scene.structures[s])));
  const std::vector<Vec3f> others_m = otherBlood(scene, frame, s);
  const std::optional<NearestVertex> nearest =
      others_m.empty() ? std::nullopt : std::optional<NearestVertex>(others_m);
  const double most = settings.most_m() / settings.deviation_m;
  std::vector<float> height_m;
  for (const Vec3f p : at_m) {
    const Vec3f own = toFloat(scene.probe.pose.toWorld(toDouble(p)));
    const std::optional<std::uint32_t> other =
        nearest ? nearest->numberOf(p, kAllBeyond_m) : std::nullopt;
    const float fade = other ? fadeAt(length(others_m[*other] - p)) : 1.0f;
    height_m.push_back(
        fade * static_cast<float>(settings.deviation_m * std::clamp(field.at(own), -most, most)));
  }
  return height_m;
}

// Halves the heights around inverted faces at an instant, until there are none.
void calm(const std::vector<Vec3f>& at_m, Relief& relief) {
  std::vector<Vec3f> normals(at_m.size()), raised_m;
  for (int halving = 0; halving <= kMostHalvings; ++halving) {
    raised_m = at_m;
    moveAll(relief, at_m, normals, [&](std::uint32_t v, Vec3f by) { raised_m[v] = at_m[v] + by; });
    bool turned = false;
    for (const Triangle& t : relief.about) {
      const auto normal = [&](const std::vector<Vec3f>& of) {
        return toDouble(cross(of[t[1]] - of[t[0]], of[t[2]] - of[t[0]]));
      };
      if (dot(normal(at_m), normal(raised_m)) > 0) continue;
      turned = true;
      for (const std::uint32_t v : t)
        relief.height_m[v] = halving < kMostHalvings ? 0.5f * relief.height_m[v] : 0;
    }
    if (!turned) return;
  }
}

// Only vertices whose faces the plane can cut are displaced, and all faces around them are marked.
void showAboutPlane(const SurfaceTopology& surface, Relief& relief) {
  const std::vector<bool> shown = verticesNearPlane(surface);
  const auto isShown = [&](std::uint32_t v) { return shown[v]; };
  std::erase_if(relief.moved, [&](std::uint32_t v) { return !shown[v]; });
  std::erase_if(relief.about,
                [&](const Triangle& t) { return std::none_of(t.begin(), t.end(), isShown); });
}

}  // namespace

Trabeculae::Trabeculae(const Scene& scene, const MeshMotion& motion, bool everywhere) {
  SurfaceFrame frame;
  motion.frameAt(0, frame, false);
  for (const SurfaceTopology& surface : motion.surfaces()) {
    if (!hasTrabeculae(scene, scene.structures[index(surface.id)])) continue;
    Relief relief{surface.id, heights(scene, surface, frame)};
    relief.moved.resize(surface.vertex_count);
    std::iota(relief.moved.begin(), relief.moved.end(), 0u);
    relief.about = surface.triangles;
    reliefs_.push_back(std::move(relief));
  }
  std::vector<SurfaceId> walls;
  for (const Relief& relief : reliefs_) walls.push_back(relief.surface);
  SurfaceFrame later;
  for (int i = 0; i < kPhases; ++i) {
    motion.positionsAt(static_cast<double>(i) / kPhases, walls, later);
    for (Relief& relief : reliefs_) calm(later.positions_m[index(relief.surface)], relief);
  }
  if (!everywhere)
    for (Relief& relief : reliefs_)
      showAboutPlane(motion.surfaces()[index(relief.surface)], relief);
  follow(scene, frame, motion);
}

void Trabeculae::follow(const Scene& scene, const SurfaceFrame& frame, const MeshMotion& motion) {
  std::vector<Vec3f> leaders_m;
  std::vector<std::pair<std::size_t, std::uint32_t>> leaders;
  for (std::size_t r = 0; r < reliefs_.size(); ++r)
    for (const std::uint32_t v : reliefs_[r].moved) {
      leaders_m.push_back(frame.positions_m[index(reliefs_[r].surface)][v]);
      leaders.emplace_back(r, v);
    }
  if (leaders.empty()) return;
  const NearestVertex nearest(leaders_m);
  for (const SurfaceTopology& surface : motion.surfaces()) {
    const Structure& structure = scene.structures[index(surface.id)];
    if (hasTrabeculae(scene, structure) || trabeculaeReach(scene, structure) == 0) continue;
    Followers followers{index(surface.id), {}};
    const std::vector<Vec3f>& at_m = frame.positions_m[followers.surface];
    for (std::uint32_t v = 0; v < at_m.size(); ++v) {
      const std::optional<std::uint32_t> leader = nearest.numberOf(at_m[v], kOnSurface_m);
      if (leader) followers.list.push_back({v, leaders[*leader].second, leaders[*leader].first});
    }
    if (!followers.list.empty()) followers_.push_back(std::move(followers));
  }
}

void Trabeculae::raise(SurfaceFrame& frame, Smooth& smooth) const {
  thread_local std::vector<Vec3f> normals;
  smooth.positions_m.resize(frame.positions_m.size());
  for (const Relief& relief : reliefs_) {
    std::vector<Vec3f>& shown_m = frame.positions_m[index(relief.surface)];
    std::vector<Vec3f>& smooth_m = smooth.positions_m[index(relief.surface)];
    smooth_m = shown_m;
    normals.resize(std::max(normals.size(), shown_m.size()));
    moveAll(relief, smooth_m, normals,
            [&](std::uint32_t v, Vec3f by) { shown_m[v] = smooth_m[v] + by; });
  }
  for (const Followers& followers : followers_) {
    std::vector<Vec3f>& shown_m = frame.positions_m[followers.surface];
    smooth.positions_m[followers.surface] = shown_m;
    for (const Follower& f : followers.list) {
      const std::size_t led = index(reliefs_[f.relief].surface);
      shown_m[f.vertex] = shown_m[f.vertex] +
                          (frame.positions_m[led][f.leader] - smooth.positions_m[led][f.leader]);
    }
  }
}

void Trabeculae::lower(SurfaceFrame& frame, Smooth& smooth) const {
  for (const Relief& relief : reliefs_)
    std::swap(frame.positions_m[index(relief.surface)], smooth.positions_m[index(relief.surface)]);
  for (const Followers& followers : followers_)
    std::swap(frame.positions_m[followers.surface], smooth.positions_m[followers.surface]);
}

}  // namespace echocine
