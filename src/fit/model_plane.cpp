#include "fit/model_plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/lanes.h"
#include "core/parallel.h"
#include "core/rough_angle.h"
#include "fit/plane_cells.h"
#include "fit/second_edges.h"
#include "scene/names.h"
#include "scene/role.h"
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

// How far a facet's middle moves, in the plane.
Vec3d displacementOf(const Triangle& t, const std::vector<Vec3f>& now,
                     const std::vector<Vec3f>& next) {
  Vec3d sum{};
  for (const std::uint32_t v : t) sum = sum + toDouble(next[v]) - toDouble(now[v]);
  return (1.0 / 3) * sum;
}

}  // namespace

ModelPlane::ModelPlane(const Scene& scene, const std::vector<SurfaceTopology>& surfaces,
                       std::optional<WallSegments> segments, Focus focus)
    : surfaces_(surfaces),
      segments_(std::move(segments)),
      weight_of_(scene.structures.size(), 1),
      coarse_(withCoarseLines(scene)),
      labels_(coarse_, PictureGrid{}),
      cells_(planeCells(coarse_.probe)) {
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
  if (focus == Focus::all) return;
  left_ = structureOf(scene, Role::lv_cavity);
  inside_m_ = static_cast<float>(kInside_m);
  for (std::size_t s = 0; s < weight_of_.size(); ++s) {
    const Role role = roleOf(scene.structures[s]);
    if (role != Role::lv_cavity && role != Role::papillary_muscle)
      weight_of_[s] = static_cast<float>(kOtherChambers);
  }
}

namespace {

// A place on a contour and the unit normal of its facet in the plane.
struct Place {
  const ContourEdge* cut;
  double x_m, z_m, length_m, nx, nz;
  bool end = false;  // of an open contour
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
  const std::size_t before = places.size();
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
  if (c.closed || places.size() == before) return;
  places[before].end = places.back().end = true;
}

std::vector<SheetPoint> sheetsAt(const std::vector<Place>& places) {
  std::vector<SheetPoint> out;
  for (const Place& p : places)
    out.push_back({static_cast<float>(p.x_m), static_cast<float>(p.z_m), static_cast<float>(p.nx),
                   static_cast<float>(p.nz), p.end});
  return out;
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
    setTissues(frame.cells[c], ids.data() + c * kSamplesPerCell, tissue_of_);
  weigh(ids, frame);
  const TissueAt tissueAt(coarse_.probe, ids, tissue_of_);
  thread_local std::vector<Place> places, sheets;
  places.clear(), sheets.clear();
  for (const Contour& contour : chainContours(slice.edges(), surfaces_, now))
    stepAlong(contour, slice.edges(), surfaces_[index(contour.surface)].membrane ? sheets : places);
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
  findSecondEdges(sheetsAt(sheets), frame);
  return frame;
}

// ids: the structure of each sample, by number from 1.
void ModelPlane::weigh(const std::vector<std::uint32_t>& ids, ModelFrame& frame) const {
  weighByBlood(empty_, frame);
  if (!left_) return;
  std::vector<float> left(frame.cells.size());
  const auto number = static_cast<std::uint32_t>(index(*left_) + 1);
  for (std::size_t c = 0; c < left.size(); ++c) {
    const auto first = ids.begin() + static_cast<std::ptrdiff_t>(c * kSamplesPerCell);
    left[c] =
        static_cast<float>(std::count(first, first + kSamplesPerCell, number)) / kSamplesPerCell;
  }
  weighByLeftVentricle(empty_, left, frame);
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
  p.weight = weight_of_[s];
  p.inside_m = inside_m_;
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

// A frame is cut while it is in the processor's cache. The first one of each block is made twice.
ModelLoop ModelPlane::cut(std::size_t count, const MakeFrame& make) const {
  constexpr std::size_t kTogether = 10;
  ModelLoop loop = empty_;
  loop.frames.resize(count);
  parallelBlocks(count, kTogether, [&](std::size_t begin, std::size_t end) {
    PlaneSlice slice(surfaces_, coarse_.probe);
    SurfaceFrame now, next;
    make(begin, now);
    for (std::size_t i = begin; i < end; ++i) {
      make((i + 1) % count, next);
      loop.frames[i] = cutOne(now, next, slice);
      std::swap(now, next);
    }
  });
  return loop;
}

}  // namespace echocine::fit
