#include "fit/model_plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/lanes.h"
#include "core/parallel.h"
#include "core/rough_angle.h"
#include "scene/names.h"
#include "truth/contour.h"

namespace echocine::fit {

namespace {

Scene withCoarseLines(Scene scene) {
  scene.probe.lines = kCellLines;
  scene.probe.samples = kCellsAlong * kSamplesPerCell;
  return scene;
}

// Tissues at places of the plane, by the sample nearest to each; -1 outside the sector.
class TissueAt {
 public:
  TissueAt(const Probe& p, const std::vector<std::uint32_t>& ids,
           const std::vector<std::uint8_t>& tissue_of)
      : ids_(ids),
        tissue_of_(tissue_of),
        lines_(p.lines),
        samples_(p.samples),
        first_rad_(p.first_angle_rad),
        lines_per_rad_((p.lines - 1) / (p.last_angle_rad - p.first_angle_rad)),
        near_m_(p.face_radius_m + p.min_depth_m),
        samples_per_m_(1 / p.sampleSpacing()) {}

  // An angle's error of 1e-5 rad is a thousandth of the lines' spacing at most.
  Ints4 operator()(Doubles4 x_m, Doubles4 z_m) const {
    const Doubles4 line = (roughAngle(x_m, z_m) - first_rad_) * lines_per_rad_ + 0.5,
                   sample = (squareRoot(x_m * x_m + z_m * z_m) - near_m_) * samples_per_m_;
    const Mask4 inside = (line >= 0) & (sample >= 0) & (line < lines_) & (sample < samples_);
    const Doubles4 at = inside ? wholeOf(line) * samples_ + wholeOf(sample) : Doubles4{};
    Ints4 out;
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane)
      out[lane] = inside[lane] ? tissue_of_[ids_[static_cast<std::size_t>(at[lane])]] : -1;
    return out;
  }

 private:
  const std::vector<std::uint32_t>& ids_;
  const std::vector<std::uint8_t>& tissue_of_;
  double lines_, samples_, first_rad_, lines_per_rad_, near_m_, samples_per_m_;
};

bool allEqual(const std::uint32_t* ids) {
  static_assert(kSamplesPerCell == sizeof(Uints8) / sizeof(std::uint32_t));
  Uints8 lanes;
  std::memcpy(&lanes, ids, sizeof lanes);
  return bitsOf(lanes == Uints8{} + ids[0]) == 0xff;
}

// The two tissues of most samples.
void fill(TissueCell& cell, const std::uint32_t* ids, const std::vector<std::uint8_t>& tissue_of) {
  if (allEqual(ids)) {
    cell.first = cell.second = tissue_of[ids[0]];
    return;
  }
  std::uint8_t tissues[kSamplesPerCell], counts[kSamplesPerCell];
  int kinds = 0;
  for (int s = 0; s < kSamplesPerCell; ++s) {
    const std::uint8_t tissue = tissue_of[ids[s]];
    int at = 0;
    while (at < kinds && tissues[at] != tissue) ++at;
    if (at == kinds) tissues[kinds] = tissue, counts[kinds++] = 0;
    ++counts[at];
  }
  int first = 0, second = -1;
  for (int i = 1; i < kinds; ++i)
    if (counts[i] > counts[first]) first = i;
  for (int i = 0; i < kinds; ++i)
    if (i != first && (second < 0 || counts[i] > counts[second])) second = i;
  cell.first = cell.second = tissues[first];
  if (second < 0) return;
  cell.second = tissues[second];
  cell.share =
      static_cast<float>(counts[first]) / static_cast<float>(counts[first] + counts[second]);
}

// The cells without their tissues.
std::vector<TissueCell> cellsAt(const Probe& p) {
  std::vector<TissueCell> cells;
  cells.reserve(static_cast<std::size_t>(kCellLines) * kCellsAlong);
  const double near = p.face_radius_m + p.min_depth_m, step = p.sampleSpacing() * kSamplesPerCell;
  for (int i = 0; i < kCellLines; ++i) {
    const double angle =
        p.first_angle_rad + (p.last_angle_rad - p.first_angle_rad) * i / (kCellLines - 1);
    const double across = std::sin(angle), down = std::cos(angle);
    for (int k = 0; k < kCellsAlong; ++k) {
      const double r = near + (k + 0.5) * step;
      TissueCell cell;
      cell.x_m = static_cast<float>(r * across);
      cell.z_m = static_cast<float>(r * down);
      cell.area = static_cast<float>(r / (p.face_radius_m + p.max_depth_m));
      cells.push_back(cell);
    }
  }
  return cells;
}

// How far a facet's middle moves, in the plane.
Vec3d displacementOf(const Triangle& t, const std::vector<Vec3f>& now,
                     const std::vector<Vec3f>& next) {
  Vec3d sum{};
  for (const std::uint32_t v : t) sum = sum + toDouble(next[v]) - toDouble(now[v]);
  return (1.0 / 3) * sum;
}

}  // namespace

// The share of blood, smoothed by kNearBlood_m: a half above an even wall, 0.16 at one standard
// deviation from it, where the weight has just reached 1, and 0.02 at two.
void weighByBlood(const ModelLoop& loop, ModelFrame& frame) {
  cv::Mat blood(loop.cells_across, loop.cells_along, CV_32F);
  for (std::size_t i = 0; i < frame.cells.size(); ++i) {
    const TissueCell& cell = frame.cells[i];
    blood.ptr<float>()[i] =
        (loop.blood[cell.first] ? cell.share : 0) + (loop.blood[cell.second] ? 1 - cell.share : 0);
  }
  const auto at = [&](int i, int k) {
    const TissueCell& cell = frame.cells[static_cast<std::size_t>(i * loop.cells_along + k)];
    return Vec3d{cell.x_m, 0, cell.z_m};
  };
  // Across the beams at half the depth; it widens with depth as beams do.
  const int i = loop.cells_across / 2, k = loop.cells_along / 2;
  const double along = kNearBlood_m / length(at(i, k + 1) - at(i, k)),
               across = kNearBlood_m / length(at(i + 1, k) - at(i, k));
  cv::GaussianBlur(blood, blood, {0, 0}, along, across, cv::BORDER_CONSTANT);
  constexpr float kFull = 0.16f, kNone = 0.02f;
  for (std::size_t c = 0; c < frame.cells.size(); ++c)
    frame.cells[c].area *=
        std::clamp((blood.ptr<float>()[c] - kNone) / (kFull - kNone), 0.0f, 1.0f);
}

ModelPlane::ModelPlane(const Scene& scene, const std::vector<SurfaceTopology>& surfaces,
                       std::optional<WallSegments> segments)
    : surfaces_(surfaces),
      segments_(std::move(segments)),
      coarse_(withCoarseLines(scene)),
      labels_(coarse_, PictureGrid{}),
      cells_(cellsAt(coarse_.probe)) {
  if (!scene.probe.isSector())
    throw SceneError(
        fmt::format("a {} probe has no sector to compare; give a phased or curvilinear one",
                    nameOf(scene.probe.kind)));
  const auto tissue = [&](MediumId id) {
    const std::string& name = scene.medium(id).name;
    const auto at = std::find(empty_.tissues.begin(), empty_.tissues.end(), name);
    if (at == empty_.tissues.end()) {
      empty_.tissues.push_back(name);
      empty_.blood.push_back(scene.medium(id).blood);
      return static_cast<std::uint8_t>(empty_.tissues.size() - 1);
    }
    return static_cast<std::uint8_t>(at - empty_.tissues.begin());
  };
  tissue_of_.push_back(tissue(scene.background));
  for (const Structure& structure : scene.structures) {
    tissue_of_.push_back(tissue(structure.medium));
    empty_.structures.push_back(structure.name);
  }
  empty_.far_m = scene.probe.face_radius_m + scene.probe.max_depth_m;
  empty_.cells_across = kCellLines;
  empty_.cells_along = kCellsAlong;
}

namespace {

// A place on a contour and the unit normal of its facet in the plane.
struct Place {
  const ContourEdge* cut;
  double x_m, z_m, length_m, nx, nz;
};

// Adds places at even steps along a contour. A sum over them is the integral along the contour to
// far better than the step, wherever the first one lies.
void stepAlong(const Contour& c, std::span<const ContourEdge> edges, std::vector<Place>& places) {
  const std::size_t cuts = c.edges.size();
  thread_local std::vector<double> lengths;
  lengths.clear();
  double length = 0;
  const auto from = [&](std::size_t i) { return c.points_m[i]; };
  const auto to = [&](std::size_t i) { return c.points_m[i + 1 < c.points_m.size() ? i + 1 : 0]; };
  for (std::size_t i = 0; i < cuts; ++i) {
    const double dx = to(i).x - from(i).x, dz = to(i).z - from(i).z;
    lengths.push_back(std::sqrt(dx * dx + dz * dz));
    length += lengths.back();
  }
  const double pieces = std::max(1.0, std::round(length / kBoundaryPiece_m)),
               piece = length / pieces;
  double next = piece / 2, so_far = 0;
  for (std::size_t i = 0; i < cuts; ++i) {
    const ContourEdge& cut = edges[c.edges[i]];
    const Vec3d n = cut.area_normal;
    for (; next < so_far + lengths[i]; next += piece) {
      const double across = std::sqrt(n.x * n.x + n.z * n.z);
      if (!(across > 0)) continue;
      const Vec3d at = from(i) + (next - so_far) / lengths[i] * (to(i) - from(i));
      places.push_back({&cut, at.x, at.z, piece, n.x / across, n.z / across});
    }
    so_far += lengths[i];
  }
}

// Steps to both sides of four places and calls body(place, inner, outer) where two tissues of the
// sector differ: there a boundary is visible.
template <typename Body>
void whereTissuesDiffer(std::span<const Place> four, const TissueAt& tissueAt, const Body& body) {
  constexpr double kStep_m = 1.2e-3;  // to either side: beyond a sample, within any wall
  Doubles4 x{}, z{}, nx{}, nz{};
  for (std::size_t i = 0; i < four.size(); ++i) {
    x[i] = four[i].x_m, z[i] = four[i].z_m;
    nx[i] = kStep_m * four[i].nx, nz[i] = kStep_m * four[i].nz;
  }
  const Ints4 inner = tissueAt(x - nx, z - nz), outer = tissueAt(x + nx, z + nz);
  for (std::size_t i = 0; i < four.size(); ++i)
    if (inner[i] >= 0 && outer[i] >= 0 && inner[i] != outer[i]) body(four[i], inner[i], outer[i]);
}

}  // namespace

ModelFrame ModelPlane::cutOne(const SurfaceFrame& now, const SurfaceFrame& next,
                              PlaneSlice& slice) const {
  slice.update(now);
  std::vector<std::uint32_t> ids;
  labels_.samples(slice.lines(), ids);
  ModelFrame frame;
  frame.cells = cells_;
  for (std::size_t c = 0; c < cells_.size(); ++c)
    fill(frame.cells[c], ids.data() + c * kSamplesPerCell, tissue_of_);
  weighByBlood(empty_, frame);
  const TissueAt tissueAt(coarse_.probe, ids, tissue_of_);
  thread_local std::vector<Place> places;
  places.clear();
  for (const Contour& contour : chainContours(slice.edges(), surfaces_, now))
    if (!surfaces_[index(contour.surface)].membrane) stepAlong(contour, slice.edges(), places);
  frame.boundary.reserve(places.size());
  for (std::size_t first = 0; first < places.size(); first += kDoubleLanes)
    whereTissuesDiffer(
        std::span(places).subspan(first, std::min(kDoubleLanes, places.size() - first)), tissueAt,
        [&](const Place& place, int inner, int outer) {
          frame.boundary.push_back(pieceAt(*place.cut, inner, outer, now, next));
          BoundaryPoint& p = frame.boundary.back();
          const double sign = p.of_blood && p.blood == outer ? -1 : 1;
          p.x_m = static_cast<float>(place.x_m), p.z_m = static_cast<float>(place.z_m);
          p.nx = static_cast<float>(sign * place.nx), p.nz = static_cast<float>(sign * place.nz);
          p.length_m = static_cast<float>(place.length_m);
        });
  return frame;
}

// All but the place along the cut and its normal.
BoundaryPoint ModelPlane::pieceAt(const ContourEdge& cut, int inner, int outer,
                                  const SurfaceFrame& now, const SurfaceFrame& next) const {
  const bool blood_in = empty_.blood[static_cast<std::size_t>(inner)],
             blood_out = empty_.blood[static_cast<std::size_t>(outer)];
  const std::size_t s = index(cut.surface);
  const Triangle& t = surfaces_[s].triangles[cut.triangle];
  const Vec3d d = displacementOf(t, now.positions_m[s], next.positions_m[s]);
  BoundaryPoint p;
  p.dx_m = static_cast<float>(d.x), p.dz_m = static_cast<float>(d.z);
  p.surface = static_cast<std::uint16_t>(s);
  p.of_blood = blood_in != blood_out;
  if (segments_ && segments_->surface == s && p.of_blood) p.segment = segments_->of_vertex[t[0]];
  p.blood = static_cast<std::uint8_t>(blood_in ? inner : outer);
  p.beside = static_cast<std::uint8_t>(blood_in ? outer : inner);
  return p;
}

ModelLoop ModelPlane::cut(const std::vector<SurfaceFrame>& frames) const {
  ModelLoop loop = empty_;
  loop.frames.resize(frames.size());
  // A few frames share a slice, whose memory serves them all.
  parallelBlocks(frames.size(), 5, [&](std::size_t begin, std::size_t end) {
    PlaneSlice slice(surfaces_, coarse_.probe);
    for (std::size_t i = begin; i < end; ++i)
      loop.frames[i] = cutOne(frames[i], frames[(i + 1) % frames.size()], slice);
  });
  return loop;
}

}  // namespace echocine::fit
