#include "motion/surfaces/valve_rings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "motion/surfaces/leaflet_share.h"
#include "scene/role.h"

namespace echocine {

namespace {

Vec3f unitOr(Vec3f v, Vec3f fallback) {
  return dot(v, v) > 0 ? normalised(v) : fallback;
}

// Our choice; the curtain is about half the distance of the fibrous trigones.
constexpr float kFar = 0.7f;       // of the outline's largest distance from the middle
constexpr float kHinged = 0.25f;   // of the largest change of height over the ring's plane
constexpr float kStill_m = 1e-3f;  // a leaflet whose outline moves less is hinged all round
constexpr int kRounds = 3;
constexpr float kCurtain_m = 7e-3f;
constexpr std::array kValves{Role::mitral_valve, Role::tricuspid_valve};

using Outlines = std::vector<std::pair<SurfaceId, SheetOutline>>;  // of the leaflets of a valve
using Hinged = std::vector<std::vector<bool>>;                     // by leaflet and vertex

template <typename Call>  // (leaflet, vertex, next vertex, their places)
void forEdges(const SurfaceFrame& frame, const Outlines& leaflets, Call&& call) {
  for (std::size_t i = 0; i < leaflets.size(); ++i) {
    const std::vector<Vec3f>& at_m = frame.positions_m[index(leaflets[i].first)];
    for (const auto& [from, to] : leaflets[i].second) call(i, from, to, at_m[from], at_m[to]);
  }
}

// The mean of the hinged vertices.
Vec3f middleOf(const SurfaceFrame& frame, const Outlines& leaflets, const Hinged& hinged) {
  Vec3f sum_m{};
  float count = 0;
  forEdges(frame, leaflets, [&](std::size_t i, std::uint32_t v, std::uint32_t, Vec3f p, Vec3f) {
    if (hinged[i][v]) sum_m = sum_m + p, ++count;
  });
  return count > 0 ? (1 / count) * sum_m : sum_m;
}

// The normal of the ring's plane: the sum of the areas between its middle and hinged edges, with
// all leaflets turned like the first.
Vec3f normalOf(const SurfaceFrame& frame, const Outlines& leaflets, const Hinged& hinged,
               Vec3f middle_m) {
  std::vector<Vec3f> areas(leaflets.size());
  forEdges(frame, leaflets, [&](std::size_t i, std::uint32_t v, std::uint32_t w, Vec3f p, Vec3f q) {
    if (hinged[i][v] && hinged[i][w]) areas[i] = areas[i] + cross(p - middle_m, q - middle_m);
  });
  Vec3f sum{};
  for (const Vec3f area : areas) sum = dot(area, sum) < 0 ? sum - area : sum + area;
  return unitOr(sum, {});
}

// Where the outline is far from the middle of what was hinged so far, at the first instant. Not
// beyond `within`, unless that is empty.
Hinged farFromMiddle(const SurfaceFrame& frame, const Outlines& leaflets, Hinged hinged,
                     const Hinged& within) {
  const Vec3f middle_m = middleOf(frame, leaflets, hinged);
  float most_m = 0;
  forEdges(frame, leaflets, [&](std::size_t, std::uint32_t, std::uint32_t, Vec3f p, Vec3f) {
    most_m = std::max(most_m, length(p - middle_m));
  });
  forEdges(frame, leaflets, [&](std::size_t i, std::uint32_t v, std::uint32_t, Vec3f p, Vec3f) {
    hinged[i][v] = length(p - middle_m) >= kFar * most_m && (within.empty() || within[i][v]);
  });
  return hinged;
}

// Where the outline stays at one height over the plane of what was hinged so far.
Hinged atOneHeight(const std::vector<SurfaceFrame>& frames, const Outlines& leaflets,
                   Hinged hinged) {
  std::vector<std::vector<float>> low_m, high_m;
  for (const std::vector<bool>& of_leaflet : hinged) {
    low_m.emplace_back(of_leaflet.size(), std::numeric_limits<float>::infinity());
    high_m.emplace_back(of_leaflet.size(), -std::numeric_limits<float>::infinity());
  }
  Vec3f before{};
  for (const SurfaceFrame& frame : frames) {
    const Vec3f middle_m = middleOf(frame, leaflets, hinged);
    Vec3f normal = normalOf(frame, leaflets, hinged, middle_m);
    if (dot(normal, before) < 0) normal = -normal;
    before = normal;
    forEdges(frame, leaflets, [&](std::size_t i, std::uint32_t v, std::uint32_t, Vec3f p, Vec3f) {
      const float height_m = dot(normal, p - middle_m);
      low_m[i][v] = std::min(low_m[i][v], height_m);
      high_m[i][v] = std::max(high_m[i][v], height_m);
    });
  }
  float most_m = 0;
  const auto changes = [&](auto&& call) {
    forEdges(frames.front(), leaflets,
             [&](std::size_t i, std::uint32_t v, std::uint32_t, Vec3f, Vec3f) {
               call(i, v, high_m[i][v] - low_m[i][v]);
             });
  };
  changes([&](std::size_t, std::uint32_t, float m) { most_m = std::max(most_m, m); });
  changes([&](std::size_t i, std::uint32_t v, float m) {
    hinged[i][v] = m <= std::max(kHinged * most_m, kStill_m);
  });
  return hinged;
}

// Vertices of a mitral leaflet within kCurtain_m of the place of the valve's hinge that is nearest
// to the aorta are not hinged: the leaflet continues into the aortic root there.
void openCurtain(const SurfaceFrame& first, const Outlines& leaflets,
                 const std::vector<SurfaceId>& aorta, Hinged& hinged) {
  Vec3f nearest_m{};
  float least_m = std::numeric_limits<float>::infinity();
  forEdges(first, leaflets, [&](std::size_t i, std::uint32_t v, std::uint32_t, Vec3f at_m, Vec3f) {
    if (!hinged[i][v]) return;
    for (const SurfaceId a : aorta)
      for (const Vec3f p : first.positions_m[index(a)])
        if (length(p - at_m) < least_m) {
          least_m = length(p - at_m);
          nearest_m = at_m;
        }
  });
  if (!(least_m < kCurtain_m)) return;
  forEdges(first, leaflets, [&](std::size_t i, std::uint32_t v, std::uint32_t, Vec3f at_m, Vec3f) {
    if (length(at_m - nearest_m) < kCurtain_m) hinged[i][v] = false;
  });
}

}  // namespace

ValveRings::ValveRings(const Scene& scene, const MeshMotion& motion)
    : radius_m_(0.5 * scene.leaflets.annulus_m) {
  std::vector<SurfaceId> ends, aorta;
  std::array<Outlines, kValves.size()> valves;
  for (const SurfaceTopology& surface : motion.surfaces()) {
    const Role role = roleOf(scene.structures[index(surface.id)]);
    const auto valve = std::find(kValves.begin(), kValves.end(), role) - kValves.begin();
    if (role == Role::aorta) aorta.push_back(surface.id);
    if (role != Role::aorta && (!surface.membrane || valve == kValves.size())) continue;
    ends.push_back(surface.id);
    if (role != Role::aorta)
      valves[static_cast<std::size_t>(valve)].emplace_back(surface.id,
                                                           outlineOf(surface.triangles));
  }
  const std::vector<SurfaceFrame> frames = instantsOfBeat(motion, ends);
  for (std::size_t valve = 0; valve < valves.size(); ++valve) {
    Hinged hinged;
    for (const auto& [leaflet, outline] : valves[valve])
      hinged.emplace_back(frames.front().positions_m[index(leaflet)].size(), true);
    hinged = farFromMiddle(frames.front(), valves[valve], std::move(hinged), {});
    for (int round = 0; round < kRounds; ++round)
      hinged = atOneHeight(frames, valves[valve], std::move(hinged));
    hinged = farFromMiddle(frames.front(), valves[valve], hinged, hinged);
    if (kValves[valve] == Role::mitral_valve)
      openCurtain(frames.front(), valves[valve], aorta, hinged);
    for (std::size_t i = 0; i < hinged.size(); ++i) {
      const auto& [leaflet, outline] = valves[valve][i];
      addHinge({leaflet, valve}, outline, hinged[i], frames.front().positions_m[index(leaflet)]);
    }
  }
}

void ValveRings::addHinge(const Place& leaflet, const SheetOutline& outline,
                          const std::vector<bool>& hinged, const std::vector<Vec3f>& first_m) {
  std::map<std::uint32_t, std::uint32_t> section_of;
  const auto sectionOf = [&](std::uint32_t v) {
    const auto [found, is_new] =
        section_of.try_emplace(v, static_cast<std::uint32_t>(hinges_.size()));
    if (is_new) hinges_.push_back({leaflet, v, v, v});
    return found->second;
  };
  for (const auto& [from, to] : outline) {
    if (!hinged[from] || !hinged[to]) continue;
    const std::uint32_t a = sectionOf(from), b = sectionOf(to);
    hinges_[a].next = to;
    hinges_[b].before = from;
    stretches_.push_back(
        {leaflet.leaflet, a, b, static_cast<double>(length(first_m[to] - first_m[from]))});
  }
}

void ValveRings::at(const SurfaceFrame& frame, std::vector<Section>& sections) const {
  sections.clear();
  if (frame.positions_m.empty()) return;
  std::array<Vec3f, kValves.size()> middle_m{};
  std::array<float, kValves.size()> count{};
  for (const Hinge& h : hinges_) {
    middle_m[h.of.valve] = middle_m[h.of.valve] + frame.positions_m[index(h.of.leaflet)][h.vertex];
    count[h.of.valve] += 1;
  }
  for (std::size_t v = 0; v < kValves.size(); ++v)
    if (count[v] > 0) middle_m[v] = (1 / count[v]) * middle_m[v];
  const auto radius_m = static_cast<float>(radius_m_);
  for (const Hinge& h : hinges_) {
    const std::vector<Vec3f>& at_m = frame.positions_m[index(h.of.leaflet)];
    const Vec3f along = unitOr(at_m[h.next] - at_m[h.before], {0, 1, 0});
    const Vec3f from_middle = at_m[h.vertex] - middle_m[h.of.valve];
    const Vec3f out = unitOr(from_middle - dot(from_middle, along) * along, {});
    sections.push_back({at_m[h.vertex] + radius_m * out, out, cross(along, out)});
  }
}

Vec3f ValveRings::place(const Section& section, float a, float b) const {
  const auto radius_m = static_cast<float>(radius_m_);
  return section.middle_m + (a * radius_m) * section.outward + (b * radius_m) * section.axis;
}

}  // namespace echocine
