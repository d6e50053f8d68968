#include "trace/cell_parts.h"

#include <algorithm>
#include <cmath>

#include "core/rough_angle.h"
#include "geometry/smooth_normal.h"

namespace echocine {

double cellWidth(const Probe& p) {
  if (p.lines < 2) return 0;
  return (p.kind == ProbeKind::linear ? p.last_offset_m - p.first_offset_m
                                      : p.last_angle_rad - p.first_angle_rad) /
         (p.lines - 1);
}

CellCutter::CellCutter(const Probe& probe, const TraceSettings& settings,
                       std::span<const LineTrace> lines)
    : probe_(probe),
      settings_(settings),
      lines_(lines),
      angular_(probe.kind != ProbeKind::linear),
      first_(angular_ ? probe.first_angle_rad : probe.first_offset_m),
      per_width_(1 / cellWidth(probe)) {
  const double width = cellWidth(probe);
  for (std::size_t i = 0; i <= lines.size(); ++i) {
    const double at = first_ + (static_cast<double>(i) - 0.5) * width;
    boundaries_.push_back(angular_ ? Point{std::sin(at), std::cos(at)} : Point{at, 1});
  }
  linkPasses();
}

// The passes of each line by surface and way of crossing: mostly there is one.
void CellCutter::linkPasses() {
  heads_.assign(lines_.size() * 2 * settings_.surfaces.size(), 0);
  for (std::size_t line = 0; line < lines_.size(); ++line)
    for (std::size_t k = lines_[line].passes.size(); k-- > 0;) {
      const InterfacePass& pass = lines_[line].passes[k];
      std::uint32_t& head = heads_[keyOf(line, pass.surface, pass.entering)];
      links_.push_back({&pass, head});
      head = static_cast<std::uint32_t>(links_.size());
    }
}

std::size_t CellCutter::keyOf(std::size_t line, SurfaceId surface, bool entering) const {
  return 2 * (line * settings_.surfaces.size() + index(surface)) + (entering ? 1 : 0);
}

// The same surface crossed the same way on the line itself, nearest in depth.
const InterfacePass* CellCutter::nearestPass(std::size_t line, SurfaceId surface, bool entering,
                                             Point p) const {
  std::uint32_t at = heads_[keyOf(line, surface, entering)];
  if (at == 0) return nullptr;
  const InterfacePass* best = links_[at - 1].pass;
  if (links_[at - 1].next == 0) return best;
  const double path_m = angular_ ? std::sqrt(p.x * p.x + p.z * p.z) - probe_.face_radius_m : p.z;
  while ((at = links_[at - 1].next) != 0) {
    const InterfacePass* pass = links_[at - 1].pass;
    if (std::abs(pass->path_m - path_m) < std::abs(best->path_m - path_m)) best = pass;
  }
  return best;
}

// How far a point lies to the right of a boundary between cells.
double CellCutter::rightOf(Point p, int boundary) const {
  const Point& at = boundaries_[static_cast<std::size_t>(boundary)];
  return angular_ ? p.x * at.z - p.z * at.x : p.x - at.x;
}

// The cell that holds a point; -1 left of the first and the number of lines right of the last.
int CellCutter::cellOf(Point p) const {
  const int boundaries = static_cast<int>(boundaries_.size());
  const double place = angular_ ? roughAngle(p.x, p.z) : p.x;
  int n = static_cast<int>(
      std::clamp((place - first_) * per_width_ + 1.5, 0.0, static_cast<double>(boundaries)));
  while (n < boundaries && rightOf(p, n) >= 0) ++n;
  while (n > 0 && rightOf(p, n - 1) < 0) --n;
  return n - 1;
}

// Where the straight line a-b passes a boundary between two cells.
CellCutter::Point CellCutter::atBoundary(Point a, Point b, int boundary) const {
  const double ua = rightOf(a, boundary), ub = rightOf(b, boundary);
  const double t = ua == ub ? 0.5 : std::clamp(ua / (ua - ub), 0.0, 1.0);
  return {a.x + t * (b.x - a.x), a.z + t * (b.z - a.z)};
}

void CellCutter::cut(const ContourPiece& piece, const PieceNormals* normals,
                     CellParts& parts) const {
  Point a{piece.cut.from.x, piece.cut.from.z}, b{piece.cut.to.x, piece.cut.to.z};
  // Lines never point backwards, so what lies behind z = 0 is in no cell.
  if (a.z < 0 && b.z < 0) return;
  const auto atZero = [&] { return Point{a.x + (b.x - a.x) * (a.z / (a.z - b.z)), 0}; };
  if (a.z < 0)
    a = atZero();
  else if (b.z < 0)
    b = atZero();
  int begin = cellOf(a), end = cellOf(b);
  if (begin > end) {
    std::swap(a, b);
    std::swap(begin, end);
  }
  const int last = static_cast<int>(lines_.size()) - 1;
  if (end < 0 || begin > last) return;
  Seen seen{piece, normals, piece.area_normal, dot(piece.area_normal, piece.area_normal)};
  if (!(seen.normal_square > 0)) {
    seen.normal = unitNormal(piece);
    seen.normal_square = 1;
  }
  Point from = begin < 0 ? atBoundary(a, b, 0) : a;
  for (int i = std::max(begin, 0); i <= std::min(end, last); ++i) {
    const Point to = i < end ? atBoundary(a, b, i + 1) : b;
    addToLine(seen, from, to, static_cast<std::size_t>(i), parts);
    from = to;
  }
}

namespace {

// Of the point at which a piece is seen along a direction; smooth normals run linearly from end to
// end.
Vec3d smoothNormal(const ContourPiece& piece, const PieceNormals& normals, Vec3d point,
                   Vec3d direction, Vec3d facet_normal) {
  const Vec3d along = piece.cut.to - piece.cut.from;
  const double size = dot(along, along);
  const double t = size > 0 ? dot(point - piece.cut.from, along) / size : 0.5;
  const Vec3d value = normals.from + t * (normals.to - normals.from);
  return facingNormal(value, direction, facet_normal);
}

}  // namespace

// Which way the piece is crossed is the facet's business, the angle of incidence the normal's.
void CellCutter::addToLine(const Seen& seen, Point a, Point b, std::size_t line,
                           CellParts& parts) const {
  const Point middle{(a.x + b.x) / 2, (a.z + b.z) / 2};
  const bool turns = angular_ && (middle.x != 0 || middle.z != 0);
  const Vec3d to = turns ? Vec3d{middle.x, 0, middle.z} : Vec3d{0, 0, 1};
  const bool entering = dot(to, seen.normal) < 0;
  const InterfacePass* pass = nearestPass(line, seen.piece.surface, entering, middle);
  if (!pass || !pass->seen) return;
  Sight sight{to, seen.normal, seen.normal_square, *pass, static_cast<std::uint32_t>(line)};
  if (seen.smooth) {
    sight.normal = smoothNormal(seen.piece, *seen.smooth, {middle.x, 0, middle.z}, to, seen.normal);
    sight.normal_square = dot(sight.normal, sight.normal);
  }
  if (!angular_) return a.z <= b.z ? addPart(sight, a, b, parts) : addPart(sight, b, a, parts);
  // At the foot of the perpendicular from the centre the path length turns round.
  const double dx = b.x - a.x, dz = b.z - a.z, size = dx * dx + dz * dz;
  const double towards_foot = -(a.x * dx + a.z * dz);
  if (towards_foot <= 0) return addPart(sight, a, b, parts);
  if (towards_foot >= size) return addPart(sight, b, a, parts);
  const double t = towards_foot / size;
  const Point foot{a.x + t * dx, a.z + t * dz};
  addPart(sight, foot, a, parts);
  addPart(sight, foot, b, parts);
}

void CellCutter::addPart(const Sight& sight, Point a, Point b, CellParts& parts) const {
  const std::size_t lane = parts.count % kLanes;
  if (parts.count / kLanes == parts.groups.size()) parts.groups.emplace_back();
  PartGroup& g = parts.groups[parts.count++ / kLanes];
  const InterfacePass& pass = sight.pass;
  const SurfaceTraits& surface = settings_.surfaces[index(pass.surface)];
  const Medium& before = settings_.media[index(pass.before)];
  const Medium& after = settings_.media[index(pass.after)];
  g.a_x[lane] = a.x;
  g.a_z[lane] = a.z;
  g.b_x[lane] = b.x;
  g.b_z[lane] = b.z;
  g.to_x[lane] = sight.to.x;
  g.to_z[lane] = sight.to.z;
  g.n_x[lane] = sight.normal.x;
  g.n_z[lane] = sight.normal.z;
  g.n_square[lane] = sight.normal_square;
  g.Z_1[lane] = before.impedance_kg_m2_s;
  g.c_1[lane] = before.sound_speed_m_s;
  g.Z_2[lane] = after.impedance_kg_m2_s;
  g.c_2[lane] = after.sound_speed_m_s;
  g.passed[lane] = pass.passed * surface.gain;
  g.lobe[lane] = surface.exponent;
  g.membrane[lane] = surface.membrane ? 1 : 0;
  g.pass_path_m[lane] = pass.path_m;
  g.pass_depth_m[lane] = pass.depth_m;
  g.path_per_depth[lane] = pass.path_per_depth;
  g.exponent[lane] = pass.exponent;
  g.exponent_per_path[lane] = pass.exponent_per_path;
  g.line[lane] = sight.line;
}

}  // namespace echocine
