#include "motion/surfaces/leaflet_bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/surfaces/leaflet_share.h"
#include "scene/role.h"

namespace echocine {

namespace {

constexpr int kMostThinnings = 8;
constexpr float kOutline = 0.5f;  // of the thickness: a rounded edge. Our choice

// Unit normals by vertex; zero where the faces cancel.
void vertexNormals(const std::vector<Triangle>& faces, const std::vector<Vec3f>& at_m,
                   std::vector<Vec3f>& normals) {
  normals.assign(at_m.size(), {});
  for (const Triangle& t : faces) {
    const Vec3f n = cross(at_m[t[1]] - at_m[t[0]], at_m[t[2]] - at_m[t[0]]);
    for (const std::uint32_t v : t) normals[v] = normals[v] + n;
  }
  for (Vec3f& n : normals)
    if (dot(n, n) > 0) n = normalised(n);
}

// Halves the thickness at faces of the body that would be inverted against their sheet.
bool thinOut(const std::vector<Triangle>& faces, const std::vector<Vec3f>& at_m,
             std::vector<float>& half_m) {
  std::vector<Vec3f> normals;
  vertexNormals(faces, at_m, normals);
  std::vector<bool> thinner(at_m.size());
  for (const Triangle& t : faces) {
    const Vec3f flat = cross(at_m[t[1]] - at_m[t[0]], at_m[t[2]] - at_m[t[0]]);
    for (const float side : {1.0f, -1.0f}) {
      const auto at = [&](std::size_t k) {
        return at_m[t[k]] + (side * half_m[t[k]]) * normals[t[k]];
      };
      const Vec3f face = cross(at(1) - at(0), at(2) - at(0));
      // At least a quarter of the sheet's area, seen along its normal.
      if (dot(face, flat) >= 0.25f * dot(flat, flat)) continue;
      for (const std::uint32_t v : t) thinner[v] = true;
    }
  }
  for (std::size_t v = 0; v < thinner.size(); ++v)
    if (thinner[v]) half_m[v] *= 0.5f;
  return std::find(thinner.begin(), thinner.end(), true) != thinner.end();
}

}  // namespace

LeafletBodies::LeafletBodies(const Scene& scene, const MeshMotion& motion)
    : surfaces_(motion.surfaces()), sheets_(surfaces_.size()), half_m_(surfaces_.size()) {
  std::vector<SurfaceId> leaflets;
  for (const SurfaceTopology& surface : motion.surfaces())
    if (hasThickness(scene, scene.structures[index(surface.id)])) leaflets.push_back(surface.id);
  const std::vector<SurfaceFrame> frames = instantsOfBeat(motion, leaflets);
  for (const SurfaceId leaflet : leaflets) {
    const std::size_t s = index(leaflet);
    const SurfaceTopology& surface = motion.surfaces()[s];
    const SheetOutline outline = outlineOf(surface.triangles);
    if (outline.empty()) continue;
    std::vector<const std::vector<Vec3f>*> instants;
    for (const SurfaceFrame& frame : frames) instants.push_back(&frame.positions_m[s]);
    const auto hinge_m = static_cast<float>(0.5 * leafletThickness(scene, scene.structures[s]));
    for (const float share : shareOfMotion(frames, s))
      half_m_[s].push_back(hinge_m * (1 + share * share));
    for (const auto& [from, to] : outline) half_m_[s][from] *= kOutline;
    for (int round = 0; round < kMostThinnings; ++round) {
      bool thinned = false;
      for (const std::vector<Vec3f>* at_m : instants)
        thinned |= thinOut(surface.triangles, *at_m, half_m_[s]);
      if (!thinned) break;
    }
    addBody(surface, outline);
  }
}

// Front, back and rim. Normals of the rim are those of its facets: that of index 2 n is zero.
void LeafletBodies::addBody(const SurfaceTopology& sheet, const SheetOutline& outline) {
  const std::uint32_t n = sheet.vertex_count;
  SurfaceTopology& body = surfaces_[index(sheet.id)];
  body.membrane = false;
  body.near_plane.reset();
  body.vertex_count = 2 * n;
  body.triangles = body.normal_corners = sheet.triangles;  // the front
  for (const Triangle& t : sheet.triangles) {
    body.triangles.push_back({t[0] + n, t[2] + n, t[1] + n});
    body.normal_corners.push_back(body.triangles.back());
  }
  for (const auto& [from, to] : outline) {
    body.triangles.push_back({to, from, from + n});
    body.triangles.push_back({to, from + n, to + n});
    body.normal_corners.insert(body.normal_corners.end(), 2, Triangle{2 * n, 2 * n, 2 * n});
  }
  sheets_[index(sheet.id)] = sheet.triangles;
}

void LeafletBodies::toFront(SurfaceId surface, const std::vector<Vec3f>& sheet_m,
                            std::vector<Vec3f>& front_m) const {
  const std::vector<float>& half_m = half_m_[index(surface)];
  vertexNormals(sheets_[index(surface)], sheet_m, front_m);
  for (std::size_t v = 0; v < front_m.size(); ++v) front_m[v] = half_m[v] * front_m[v];
}

void LeafletBodies::thicken(SurfaceFrame& frame, Sheets& sheets) const {
  thread_local std::vector<Vec3f> front_m;
  sheets.positions_m.resize(frame.positions_m.size());
  sheets.normals.resize(frame.normals.size());
  for (std::size_t s = 0; s < half_m_.size(); ++s) {
    if (half_m_[s].empty()) continue;
    std::swap(frame.positions_m[s], sheets.positions_m[s]);
    const std::vector<Vec3f>& sheet_m = sheets.positions_m[s];
    toFront(static_cast<SurfaceId>(s), sheet_m, front_m);
    const std::size_t n = sheet_m.size();
    std::vector<Vec3f>& body_m = frame.positions_m[s];
    body_m.resize(2 * n);
    for (std::size_t v = 0; v < n; ++v) {
      body_m[v] = sheet_m[v] + front_m[v];
      body_m[v + n] = sheet_m[v] - front_m[v];
    }
    if (frame.normals.empty()) continue;
    std::swap(frame.normals[s], sheets.normals[s]);
    std::vector<Vec3f>& normals = frame.normals[s];
    normals.assign(2 * n + 1, {});
    for (std::size_t v = 0; v < n; ++v) {
      if (dot(front_m[v], front_m[v]) > 0) normals[v] = normalised(front_m[v]);
      normals[v + n] = -normals[v];
    }
  }
}

void LeafletBodies::thin(SurfaceFrame& frame, Sheets& sheets) const {
  for (std::size_t s = 0; s < half_m_.size(); ++s) {
    if (half_m_[s].empty()) continue;
    std::swap(frame.positions_m[s], sheets.positions_m[s]);
    if (!frame.normals.empty()) std::swap(frame.normals[s], sheets.normals[s]);
  }
}

}  // namespace echocine
