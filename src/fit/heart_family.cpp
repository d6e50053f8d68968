#include "fit/heart_family.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "fit/blended_beat.h"
#include "fit/searched_dials.h"
#include "motion/heart/coarse_surfaces.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/recording.h"

namespace echocine::fit {

namespace {

void checkAngle(const char* argument, double angle_rad, double most_rad) {
  if (!(std::abs(angle_rad) <= most_rad * (1 + 1e-12)))
    throw SceneError(fmt::format("{}: is {:g}, accepted: up to {:g} either way, the family's limit",
                                 argument, degreesFromRadians(angle_rad),
                                 degreesFromRadians(most_rad)));
}

}  // namespace

HeartNodes::HeartNodes(const std::map<std::string, double>& dials,
                       const std::vector<DialRange>& ranges, int frames, int nodes,
                       const Monitor& monitor)
    : frames_(frames) {
  checkRanges(dials, ranges);
  checkNodes(ranges, nodes);
  design_ = HeartDesign::grid(ranges, nodes);
  HeartCache none;
  compute(dials, monitor, none);
}

HeartNodes::HeartNodes(const std::map<std::string, double>& dials, HeartDesign design, int frames,
                       const Monitor& monitor, HeartCache cache)
    : design_(std::move(design)), frames_(frames) {
  checkRanges(dials, design_.ranges());
  compute(dials, monitor, cache);
  cache.prune();
}

void HeartNodes::compute(const std::map<std::string, double>& dials, const Monitor& monitor,
                         HeartCache& cache) {
  constexpr int kMostMoves = 6;
  bool moved = false;
  for (std::size_t n = 0; n < design_.size(); ++n) {
    if (!monitor.keep_going()) throw JobError("stopped while hearts were computed");
    for (int moves = 0;; ++moves) {
      try {
        hearts_.push_back(computed(dials, n, cache));
        break;
      } catch (const SceneError&) {
        if (design_.nodes() > 0 || moves == kMostMoves) throw;
        design_.moveIn(n);
        moved = true;
      }
    }
    monitor.tell({Task::hearts, n + 1, design_.size()});
  }
  if (moved) design_.settle();
}

HeartNodes::Heart HeartNodes::computed(const std::map<std::string, double>& dials,
                                       std::size_t place, HeartCache& cache) const {
  std::map<std::string, double> here = dials;
  const std::vector<double> values = design_.at(place);
  for (std::size_t r = 0; r < values.size(); ++r) here[ranges()[r].key] = values[r];
  addFollowers(here);
  const heart::Parameters parameters = heart::parametersFrom(here);
  if (const std::string fault = heart::faultOf(parameters); !fault.empty())
    throw SceneError("heart: " + fault);
  if (auto kept = cache.find(here, frames_)) return {parameters, std::move(*kept)};
  // Its view is that of the probe alone, which sceneOf() aims anew.
  Heart made{parameters, heart::recordBeat(heart::ParametricHeart(parameters), heart::View::a4c,
                                           frames_, heart::KeyframeSpacing::even)};
  cache.keep(here, frames_, made.beat);
  return made;
}

Scene HeartNodes::sceneOf(std::size_t heart, heart::View view) const {
  const Heart& h = hearts_[heart];
  const heart::ParametricHeart model(h.parameters);
  heart::Recording recording = h.beat;
  recording.pose = heart::poseOf(view, recording);
  heart::surround(view, recording.pose, model, recording);
  return heart::sceneOf(view, h.parameters, heart::coarseSurfaces(std::move(recording)));
}

HeartFamily::HeartFamily(const std::map<std::string, double>& dials,
                         const std::vector<DialRange>& ranges, heart::View view, int frames,
                         int nodes, const Monitor& monitor, double tilt_deg)
    : HeartFamily(HeartNodes(dials, ranges, frames, nodes, monitor), view, monitor, tilt_deg) {}

HeartFamily::HeartFamily(const HeartNodes& hearts, heart::View view, const Monitor& monitor,
                         double tilt_deg, bool segments)
    : design_(hearts.design()), tilt_rad_(radiansFromDegrees(tilt_deg)) {
  if (!(tilt_deg >= 0 && tilt_deg <= kMostTilt_deg))
    throw SceneError(
        fmt::format("tilt_deg: is {:g}, accepted: 0 to {:g}", tilt_deg, kMostTilt_deg));
  const int frames = hearts.frames();
  std::vector<SurfaceTopology> all;
  std::vector<Node> recorded(hearts.size(), Node(static_cast<std::size_t>(frames)));
  systoles_.resize(hearts.size());
  parallelBlocks(hearts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      if (!monitor.keep_going()) throw JobError("stopped while hearts were computed");
      const Scene scene = hearts.sceneOf(n, view);
      const MeshMotion motion(scene);
      if (n == 0) {
        scene_ = scene;
        all = motion.surfaces();
        if (segments) segments_ = wallSegments(scene, motion);
      }
      systoles_[n] = scene.motion.end_systole_phase.value_or(0);
      for (int i = 0; i < frames; ++i)
        motion.frameAt(static_cast<double>(i) / frames, recorded[n][static_cast<std::size_t>(i)],
                       false);
      CHECK_EQ(recorded[n].front().positions_m.size(), motion.surfaces().size());
    }
  });
  for (Structure& structure : scene_.structures) structure.keyframes.clear();
  keepNearPlane(all, recorded);
  keepModes(std::move(recorded));
}

// The triangles that some heart between the recorded ones has on the plane: their corners' heights
// are polynomials, which the recorded heights bound. Planes tilted by t and rotated by r
// lie at y = x tan r + z tan t / cos r: a corner may be nearer to one of them by this.
std::vector<char> HeartFamily::nearPlane(const SurfaceTopology& surface,
                                         const std::vector<Node>& recorded) const {
  const auto reach = static_cast<float>(design_.overshoot());
  constexpr float kRounding_m = 1e-6f;
  const auto aside = static_cast<float>(std::tan(tilt_rad_)),
             below = static_cast<float>(std::tan(tilt_rad_) / std::cos(tilt_rad_));
  std::vector<char> near(surface.triangles.size(), 0);
  std::vector<float> low(surface.vertex_count), high(surface.vertex_count);
  for (std::size_t f = 0; f < recorded.front().size(); ++f) {
    for (std::size_t v = 0; v < low.size(); ++v) {
      float least = recorded.front()[f].positions_m[index(surface.id)][v].y, most = least;
      for (const Node& node : recorded) {
        const float y = node[f].positions_m[index(surface.id)][v].y;
        least = std::min(least, y), most = std::max(most, y);
      }
      float farthest = 0;
      for (const Node& node : recorded) {
        const Vec3f p = node[f].positions_m[index(surface.id)][v];
        farthest = std::max(farthest, aside * std::abs(p.x) + below * std::abs(p.z));
      }
      const float middle = 0.5f * (least + most),
                  half = 0.5f * reach * (most - least) + reach * farthest;
      low[v] = middle - half - kRounding_m;
      high[v] = middle + half + kRounding_m;
    }
    for (std::size_t t = 0; t < near.size(); ++t) {
      const auto [a, b, c] = surface.triangles[t];
      if (std::min({low[a], low[b], low[c]}) <= 0 && std::max({high[a], high[b], high[c]}) >= 0)
        near[t] = 1;
    }
  }
  return near;
}

// Hearts far from the plane are no business of its slice.
void HeartFamily::keepNearPlane(const std::vector<SurfaceTopology>& all,
                                const std::vector<Node>& recorded) {
  for (const SurfaceTopology& whole : all) {
    const std::vector<char> near = nearPlane(whole, recorded);
    SurfaceTopology surface{whole.id, {}, 0, whole.membrane, false};
    std::vector<std::uint32_t> kept;
    for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
      if (near[t] == 0) continue;
      surface.triangles.push_back(whole.triangles[t]);
      kept.insert(kept.end(), whole.triangles[t].begin(), whole.triangles[t].end());
    }
    orderByPlace(recorded.front().front().positions_m[index(whole.id)], kept);
    std::vector<std::uint32_t> number(whole.vertex_count);
    for (std::uint32_t i = 0; i < kept.size(); ++i) number[kept[i]] = i;
    for (Triangle& triangle : surface.triangles)
      for (std::uint32_t& v : triangle) v = number[v];
    surface.vertex_count = static_cast<std::uint32_t>(kept.size());
    if (segments_ && index(whole.id) == segments_->surface) {
      std::vector<std::uint8_t> of_kept;
      for (const std::uint32_t v : kept) of_kept.push_back(segments_->of_vertex[v]);
      segments_->of_vertex = std::move(of_kept);
    }
    surfaces_.push_back(std::move(surface));
    kept_.push_back(std::move(kept));
  }
}

// Frees each frame of the hearts once its modes are known.
void HeartFamily::keepModes(std::vector<Node> recorded) {
  std::vector<std::optional<SurfaceModes>> modes(recorded.front().size());
  const SurfacePatches patches = patchesOf(surfaces_);
  std::vector<std::vector<double>> at_places;
  for (std::size_t n = 0; n < design_.size(); ++n) {
    const std::vector<float> shares = design_.shares(design_.at(n));
    at_places.emplace_back(shares.begin(), shares.end());
  }
  parallelBlocks(modes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      std::vector<const SurfaceFrame*> hearts;
      for (const Node& node : recorded) hearts.push_back(&node[f]);
      modes[f].emplace(hearts, kept_, patches, at_places);
      for (Node& node : recorded) node[f] = {};
    }
  });
  for (std::optional<SurfaceModes>& frame : modes) modes_.push_back(std::move(*frame));
}

std::vector<SurfaceFrame> HeartFamily::surfacesAt(const std::vector<double>& values) const {
  checkValues(ranges(), values);
  const std::vector<float> shares = design_.shares(values);
  std::vector<SurfaceFrame> frames;
  for (const SurfaceModes& modes : modes_) frames.push_back(modes.blend(shares));
  return frames;
}

ModelLoop HeartFamily::at(const std::vector<double>& values, const PlaneTilt& tilt,
                          Focus focus) const {
  checkAngle("tilt_deg", tilt.tilt_rad, tilt_rad_);
  checkAngle("rotate_deg", tilt.rotate_rad, tilt_rad_);
  checkValues(ranges(), values);
  const std::vector<float> share = design_.shares(values);
  const BlendedBeat beat(modes_, share, tilt);
  ModelLoop loop =
      ModelPlane(scene_, surfaces_, segments_, focus)
          .cut(modes_.size(), [&](std::size_t f, SurfaceFrame& frame) { beat.frameAt(f, frame); });
  for (std::size_t n = 0; n < share.size(); ++n)
    loop.systole += static_cast<double>(share[n]) * systoles_[n];
  return loop;
}

}  // namespace echocine::fit
