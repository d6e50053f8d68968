#include "trace/clip_interfaces.h"

#include <cmath>

#include "geometry/smooth_normal.h"

namespace echocine {

namespace {

Vec3d middleOf(const EdgeClips& p, std::size_t i) {
  return {(p.a_x[i] + p.b_x[i]) / 2, 0, (p.a_z[i] + p.b_z[i]) / 2};
}

// Smooth normals run linearly from end to end of an edge.
void takeSmoothNormal(const ContourEdge& edge, const EdgeNormals& normals, EdgeClips& p,
                      std::size_t i) {
  const Vec3d along = edge.cut.to - edge.cut.from;
  const double size = dot(along, along);
  const double t = size > 0 ? dot(middleOf(p, i) - edge.cut.from, along) / size : 0.5;
  const Vec3d value = normals.from + t * (normals.to - normals.from);
  const Vec3d normal = facingNormal(value, {p.to_x[i], 0, p.to_z[i]}, unitNormal(edge));
  p.normal_x[i] = normal.x;
  p.normal_y[i] = normal.y;
  p.normal_z[i] = normal.z;
  p.normal_square[i] = dot(normal, normal);
}

// From the foot of the perpendicular from the centre the path length grows to both ends.
void splitAtFoot(EdgeClips& p, std::size_t i) {
  const std::size_t j = p.count++;
  const double dx = p.b_x[i] - p.a_x[i], dz = p.b_z[i] - p.a_z[i];
  const double t = -(p.a_x[i] * dx + p.a_z[i] * dz) / (dx * dx + dz * dz);
  const double foot_x = p.a_x[i] + t * dx, foot_z = p.a_z[i] + t * dz;
  p.b_x[j] = p.a_x[i];
  p.b_z[j] = p.a_z[i];
  p.a_x[j] = p.a_x[i] = foot_x;
  p.a_z[j] = p.a_z[i] = foot_z;
  for (const auto row : {&EdgeClips::to_x, &EdgeClips::to_z, &EdgeClips::normal_x,
                         &EdgeClips::normal_y, &EdgeClips::normal_z, &EdgeClips::normal_square})
    (p.*row)[j] = (p.*row)[i];
  p.line[j] = p.line[i];
}

}  // namespace

ClipInterfaces::ClipInterfaces(const Probe& probe, const TraceSettings& settings,
                               std::span<const LineTrace> lines)
    : geometry_(probe),
      lines_(probe.lines),
      settings_(settings),
      table_(lines, settings.surfaces.size()) {
  for (const Medium& from : settings.media)
    for (const Medium& to : settings.media)
      speeds_.push_back(speedRatio(from.sound_speed_m_s, to.sound_speed_m_s));
}

// The facet decides in which direction an edge is crossed. The nearest of several hits counts.
void ClipInterfaces::find(std::span<const ContourEdge> edges, std::span<const EdgeNormals> normals,
                          EdgeClips& clips, InterfaceRows& rows) const {
  const std::size_t count = clips.count;
  for (std::size_t i = 0; i < count; ++i) {
    const ContourEdge& edge = edges[clips.edge[i]];
    const InterfaceHit* hit = table_.nearest(clips.line[i], edge.surface, clips.entering[i] != 0,
                                             [&] { return geometry_.pathOf(middleOf(clips, i)); });
    if (!hit) hit = besideTheLine(edge, clips, i);
    takeOver(hit, rows, i);
    if (!normals.empty()) takeSmoothNormal(edge, normals[clips.edge[i]], clips, i);
    if (clips.turns[i] == 0) continue;
    takeOver(hit, rows, clips.count);
    splitAtFoot(clips, i);
  }
}

// The tip of a contour may lie between two lines: then it takes over what a neighbour met.
const InterfaceHit* ClipInterfaces::besideTheLine(const ContourEdge& edge, const EdgeClips& clips,
                                                  std::size_t i) const {
  const double path_m = geometry_.pathOf(middleOf(clips, i));
  const InterfaceHit* best = nullptr;
  for (const int side : {-1, 1}) {
    int line = static_cast<int>(clips.line[i]) + side;
    if (geometry_.fullTurn()) line = (line + lines_) % lines_;
    if (line < 0 || line >= lines_) continue;
    const InterfaceHit* hit = table_.nearest(static_cast<std::size_t>(line), edge.surface,
                                             clips.entering[i] != 0, [&] { return path_m; });
    if (hit && (!best || std::abs(hit->path_m - path_m) < std::abs(best->path_m - path_m)))
      best = hit;
  }
  return best;
}

inline void ClipInterfaces::takeOver(const InterfaceHit* hit, InterfaceRows& rows,
                                     std::size_t i) const {
  const bool seen = hit && hit->seen;
  rows.seen[i] = seen ? -1 : 0;
  rows.ends[i] = seen && hit->ends ? 1 : 0;
  if (!seen) return;
  const SurfaceTraits& surface = settings_.surfaces[index(hit->surface)];
  const Medium& before = settings_.media[index(hit->before)];
  const Medium& after = settings_.media[index(hit->after)];
  const SpeedRatio& speeds =
      speeds_[index(hit->before) * settings_.media.size() + index(hit->after)];
  rows.Z_1[i] = before.impedance_kg_m2_s;
  rows.Z_2[i] = after.impedance_kg_m2_s;
  rows.r[i] = speeds.r;
  rows.turn[i] = speeds.turn;
  rows.passed[i] = hit->passed * surface.gain;
  rows.lobe[i] = surface.exponent;
  rows.membrane[i] = surface.membrane ? 1 : 0;
  rows.coherent_part[i] = static_cast<float>(surface.coherent_part);
  rows.wave_along[i] = hit->wave.x;
  rows.wave_across[i] = hit->wave.y;
  rows.wave_out[i] = hit->wave.z;
  rows.path_m[i] = hit->path_m;
  rows.depth_m[i] = hit->depth_m;
  rows.path_per_depth[i] = hit->path_per_depth;
  rows.exponent[i] = hit->exponent;
  rows.exponent_per_path[i] = hit->exponent_per_path;
}

}  // namespace echocine
