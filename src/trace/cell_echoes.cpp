#include "trace/cell_echoes.h"

#include <algorithm>
#include <cmath>

#include "trace/interface_law.h"

namespace echocine {

namespace {

struct Point {
  double x, z;
};

// A straight piece of contour inside one cell, on which the path length grows from a to b.
struct CellPiece {
  Point a, b;
};

class CellIntegrator {
 public:
  CellIntegrator(const Probe& probe, const TraceSettings& settings, std::span<LineTrace> lines)
      : probe_(probe),
        settings_(settings),
        lines_(lines),
        angular_(probe.kind != ProbeKind::linear),
        first_(angular_ ? probe.first_angle_rad : probe.first_offset_m),
        width_(lineWidth(probe)) {}

  void add(const ContourPiece& piece) {
    Point a{piece.cut.from.x, piece.cut.from.z}, b{piece.cut.to.x, piece.cut.to.z};
    if (!clipToFront(a, b)) return;
    const double qa = cell(a), qb = cell(b);
    if (qa > qb) std::swap(a, b);
    const double q0 = std::min(qa, qb), q1 = std::max(qa, qb);
    const int begin = static_cast<int>(std::max(std::floor(q0), 0.0));
    const int end = static_cast<int>(std::min(std::floor(q1), lines_.size() - 1.0));
    for (int i = begin; i <= end; ++i) {
      const Point from = i > q0 ? atBoundary(a, b, i) : a;
      const Point to = i + 1 < q1 ? atBoundary(a, b, i + 1) : b;
      addToLine(piece, from, to, lines_[static_cast<std::size_t>(i)]);
    }
  }

 private:
  // Width of a cell: an angle, or a length for a linear probe.
  static double lineWidth(const Probe& p) {
    if (p.lines < 2) return 0;
    return (p.kind == ProbeKind::linear ? p.last_offset_m - p.first_offset_m
                                        : p.last_angle_rad - p.first_angle_rad) / (p.lines - 1);
  }

  // Lines never point backwards, so what lies behind z = 0 is in no cell.
  static bool clipToFront(Point& a, Point& b) {
    if (a.z < 0 && b.z < 0) return false;
    const auto atZero = [&] { return Point{a.x + (b.x - a.x) * (a.z / (a.z - b.z)), 0}; };
    if (a.z < 0) a = atZero();
    else if (b.z < 0) b = atZero();
    return true;
  }

  // Position among the cells: line i has the cell i..i+1.
  double cell(Point p) const {
    return ((angular_ ? std::atan2(p.x, p.z) : p.x) - first_) / width_ + 0.5;
  }

  // Where the straight line a-b passes the boundary between two cells.
  Point atBoundary(Point a, Point b, int boundary) const {
    const double at = first_ + (boundary - 0.5) * width_;
    const double s = angular_ ? std::sin(at) : at, c = angular_ ? std::cos(at) : 1;
    const double ua = angular_ ? a.x * c - a.z * s : a.x - s;
    const double ub = angular_ ? b.x * c - b.z * s : b.x - s;
    const double t = ua == ub ? 0.5 : std::clamp(ua / (ua - ub), 0.0, 1.0);
    return {a.x + t * (b.x - a.x), a.z + t * (b.z - a.z)};
  }

  double pathLength(Point p) const {
    return angular_ ? std::hypot(p.x, p.z) - probe_.face_radius_m : p.z;
  }

  // Share of a cell between two points on one straight piece.
  double share(Point a, Point b) const {
    if (!angular_) return std::abs(b.x - a.x) / width_;
    const double across = std::abs(a.x * b.z - a.z * b.x), along = a.x * b.x + a.z * b.z;
    return std::atan2(across, along) / width_;
  }

  // The same surface crossed the same way on the line itself, nearest in depth.
  static const InterfacePass* nearestPass(const LineTrace& line, const ContourPiece& piece,
                                          bool entering, double path_m) {
    const InterfacePass* best = nullptr;
    for (const InterfacePass& pass : line.passes)
      if (pass.surface == piece.surface && pass.entering == entering &&
          (!best || std::abs(pass.path_m - path_m) < std::abs(best->path_m - path_m)))
        best = &pass;
    return best;
  }

  void addToLine(const ContourPiece& piece, Point from, Point to, LineTrace& line) {
    const Point middle{(from.x + to.x) / 2, (from.z + to.z) / 2};
    const double reach = std::hypot(middle.x, middle.z);
    const Vec3d direction =
        angular_ && reach > 0 ? Vec3d{middle.x / reach, 0, middle.z / reach} : Vec3d{0, 0, 1};
    const double along = dot(direction, piece.normal);
    const InterfacePass* pass = nearestPass(line, piece, along < 0, pathLength(middle));
    if (!pass || !pass->seen) return;
    const double echo = echoAt(*pass, std::min(std::abs(along), 1.0));
    if (echo > 0) split(from, to, [&](CellPiece part) { deposit(part, *pass, echo, line); });
  }

  // As the walk along a line does it: Eq. 1 and the lobe; a membrane echoes twice.
  double echoAt(const InterfacePass& pass, double cos_i) const {
    const SurfaceTraits& surface = settings_.surfaces[index(pass.surface)];
    const Medium& from = settings_.media[index(pass.before)];
    const Medium& to = settings_.media[index(pass.after)];
    const double R = interfaceLaw(from.impedance_kg_m2_s, from.sound_speed_m_s,
                                  to.impedance_kg_m2_s, to.sound_speed_m_s, cos_i).R;
    const double second =
        surface.membrane ? (settings_.transmission_loss ? (1 - R) * (1 - R) : 1) * R : 0;
    return pass.passed * nonSpecularReturn(surface.gain * (R + second), cos_i, surface.exponent);
  }

  // At the foot of the perpendicular from the centre the path length turns round.
  template <typename F>
  void split(Point a, Point b, F&& part) const {
    const double dx = b.x - a.x, dz = b.z - a.z, size = dx * dx + dz * dz;
    const double t = angular_ && size > 0 ? -(a.x * dx + a.z * dz) / size : 0;
    const auto ordered = [&](Point p, Point q) {
      if (pathLength(p) <= pathLength(q)) part(CellPiece{p, q});
      else part(CellPiece{q, p});
    };
    if (!(t > 0 && t < 1)) return ordered(a, b);
    const Point foot{a.x + t * dx, a.z + t * dz};
    ordered(a, foot);
    ordered(foot, b);
  }

  // The point of a piece at a path length, from the one at a: along the piece the squared distance to the centre
  // grows as p^2 + t^2 from the foot of the perpendicular.
  Point atPath(const CellPiece& piece, double path_m) const {
    const double dx = piece.b.x - piece.a.x, dz = piece.b.z - piece.a.z;
    double s = 0;
    if (angular_) {
      const double length = std::hypot(dx, dz);
      const double r = path_m + probe_.face_radius_m;
      const double ta = (piece.a.x * dx + piece.a.z * dz) / length;
      const double p2 = piece.a.x * piece.a.x + piece.a.z * piece.a.z - ta * ta;
      s = (std::sqrt(std::max(r * r - p2, 0.0)) - ta) / length;
    } else {
      s = (path_m - piece.a.z) / dz;
    }
    s = std::clamp(s, 0.0, 1.0);
    return {piece.a.x + s * dx, piece.a.z + s * dz};
  }

  // Spreads a piece over the samples it spans, each with its share of the cell.
  void deposit(const CellPiece& piece, const InterfacePass& pass, double echo, LineTrace& line) {
    const double end_depth_m = line.stretches.back().end_depth_m;
    const auto depthOf = [&](double path_m) {
      return pass.depth_m + (path_m - pass.path_m) / pass.path_per_depth;
    };
    const double spacing = probe_.sampleSpacing();
    const double path_a = pathLength(piece.a), path_b = pathLength(piece.b);
    const double k_a = (depthOf(path_a) - probe_.min_depth_m) / spacing;
    const double k_b = (depthOf(path_b) - probe_.min_depth_m) / spacing;
    Point begin = piece.a;
    for (double k = std::floor(k_a); k <= k_b; ++k) {
      const bool last = k + 1 >= k_b;
      const double depth_end = probe_.min_depth_m + (k + 1) * spacing;
      const double path_end = pass.path_m + (depth_end - pass.depth_m) * pass.path_per_depth;
      const Point end = last ? piece.b : atPath(piece, path_end);
      const double depth_m = depth_end - spacing / 2;
      if (depth_m < end_depth_m && depth_m > 0) {
        const double path_m = path_end - spacing / 2 * pass.path_per_depth;
        line.echoes.push_back({depth_m, echo * share(begin, end),
                               std::max(pass.exponent + (path_m - pass.path_m) * pass.exponent_per_path, 0.0)});
      }
      begin = end;
    }
  }

  const Probe& probe_;
  const TraceSettings& settings_;
  std::span<LineTrace> lines_;
  bool angular_;
  double first_, width_;
};

}  // namespace

void addCellEchoes(std::span<const ContourPiece> pieces, const Probe& probe,
                   const TraceSettings& settings, std::span<LineTrace> lines) {
  if (!settings.reflection) return;
  CellIntegrator integrator(probe, settings, lines);
  for (const ContourPiece& piece : pieces) integrator.add(piece);
}

}  // namespace echocine
