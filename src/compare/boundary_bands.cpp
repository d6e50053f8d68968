#include "compare/boundary_bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/scene_reader.h"

namespace echocine::compare {

struct BoundaryBands::State {
  Scene scene;
  MeshMotion motion;
  echo::BeamGrid grid;
  double half_width_m;

  State(const std::filesystem::path& file, const echo::BeamGrid& g, double width_m)
      : scene(placed(readScene(file))), motion(scene), grid(g), half_width_m(width_m / 2) {}
};

BoundaryBands::BoundaryBands(const std::filesystem::path& scene, const echo::EchoLoop& synthetic,
                             const echo::BeamGrid& grid, double width_m) {
  // Contours are cut anew from the scene, so the loop must be one that was rendered.
  if (synthetic.scene_sha256.empty())
    throw SceneError(
        fmt::format("--scene: {} is not a render folder; bands need one", synthetic.video.name));
  if (!grid.metric)
    throw SceneError(
        "--scene: bands are in mm, and the real loop has no length scale; give --scale");
  state_ = std::make_unique<State>(scene, grid, width_m);
  const Probe& p = state_->scene.probe;
  // The sum of all that two sectors can differ in, in rad and in parts of the radius: 1e-6 is what
  // the manifest's decimals lose.
  const double off = std::abs(p.first_angle_rad - synthetic.sector().first_rad) +
                     std::abs(p.last_angle_rad - synthetic.sector().last_rad) +
                     std::abs((p.face_radius_m + p.max_depth_m) / *synthetic.metres_per_pixel /
                                  synthetic.sector().r_max -
                              1);
  if (!(off < 1e-6))
    throw SceneError(
        fmt::format("--scene: the sectors of {} and {} differ; give the scene it was rendered from",
                    scene.string(), synthetic.video.name));
}

BoundaryBands::~BoundaryBands() = default;
BoundaryBands::BoundaryBands(BoundaryBands&&) noexcept = default;

const Scene& BoundaryBands::scene() const {
  return state_->scene;
}

std::vector<Contour> BoundaryBands::contoursAt(double phase) const {
  return echocine::contoursAt(state_->motion, state_->scene.probe, phase);
}

namespace {

// In the imaging plane, x and z; to the nearer end where the foot lies outside the edge.
double distanceToEdge(double x, double z, Vec3d a, Vec3d b) {
  const double ux = b.x - a.x, uz = b.z - a.z, length2 = ux * ux + uz * uz;
  const double t =
      length2 > 0 ? std::clamp(((x - a.x) * ux + (z - a.z) * uz) / length2, 0.0, 1.0) : 0;
  return std::hypot(x - a.x - t * ux, z - a.z - t * uz);
}

// Marks the samples nearer to an edge than the half width. Only those in its box are looked at.
void markEdge(const echo::BeamGrid& g, Vec3d a, Vec3d b, double half, std::vector<char>& near) {
  const double reach_a = std::hypot(a.x, a.z), reach_b = std::hypot(b.x, b.z),
               edge = std::hypot(b.x - a.x, b.z - a.z);
  const double r_lo = std::max(1e-6, std::min(reach_a, reach_b) - edge - half),
               r_hi = std::max(reach_a, reach_b) + half;
  // The angle under which half a band shows at the nearest depth; a quarter turn at the apex.
  const double margin = std::asin(std::min(1.0, (half + edge) / std::max(r_lo, half + edge)));
  const double angle_a = std::atan2(a.x, a.z), angle_b = std::atan2(b.x, b.z);
  const double per_line = (g.last_rad - g.first_rad) / std::max(1, g.lines - 1),
               per_sample = (g.far - g.near) / g.samples;
  const auto line = [&](double angle) { return (angle - g.first_rad) / per_line; };
  const int i_lo = std::max(
                0, static_cast<int>(std::floor(line(std::min(angle_a, angle_b) - margin)))),
            i_hi = std::min(g.lines - 1,
                            static_cast<int>(std::ceil(line(std::max(angle_a, angle_b) + margin))));
  const int k_lo = std::max(0, static_cast<int>((r_lo - g.near) / per_sample - 1)),
            k_hi = std::min(g.samples - 1, static_cast<int>((r_hi - g.near) / per_sample + 1));
  for (int i = i_lo; i <= i_hi; ++i)
    for (int k = k_lo; k <= k_hi; ++k) {
      char& mark = near[static_cast<std::size_t>(i) * static_cast<std::size_t>(g.samples) +
                        static_cast<std::size_t>(k)];
      if (mark != 0) continue;
      const double r = g.depth(k), angle = g.angle(i);
      if (distanceToEdge(r * std::sin(angle), r * std::cos(angle), a, b) <= half) mark = 1;
    }
}

}  // namespace

std::vector<std::pair<std::string, std::vector<float>>> BoundaryBands::weightsAt(
    double phase, const std::vector<float>& weights) const {
  const auto& structures = state_->scene.structures;
  std::vector<std::vector<char>> near(structures.size() + 1, std::vector<char>(weights.size(), 0));
  for (const Contour& c : contoursAt(phase))
    for (std::size_t i = c.closed ? 0 : 1; i < c.points_m.size(); ++i) {
      const Vec3d a = c.points_m[i == 0 ? c.points_m.size() - 1 : i - 1], b = c.points_m[i];
      markEdge(state_->grid, a, b, state_->half_width_m, near[index(c.surface)]);
    }
  for (std::size_t s = 0; s < structures.size(); ++s)
    for (std::size_t i = 0; i < weights.size(); ++i) near.back()[i] |= near[s][i];
  std::vector<std::pair<std::string, std::vector<float>>> out;
  for (std::size_t s = 0; s <= structures.size(); ++s) {
    std::vector<float> own(weights.size(), 0);
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (near[s][i] != 0) own[i] = weights[i];
    out.emplace_back(s < structures.size() ? structures[s].name : "all", std::move(own));
  }
  return out;
}

}  // namespace echocine::compare
