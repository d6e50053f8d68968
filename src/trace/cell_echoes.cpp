#include "trace/cell_echoes.h"

#include <algorithm>
#include <cmath>

#include "core/rough_angle.h"
#include "geometry/smooth_normal.h"
#include "trace/interface_law.h"

namespace echocine {

namespace {

struct Point {
  double x, z;
};

// A straight piece of contour inside one cell, on which the path length grows from a to b.
struct CellPiece {
  Point a, b;
  double path_a_m, path_b_m;
};

class CellIntegrator {
 public:
  CellIntegrator(const Probe& probe, const TraceSettings& settings, std::span<LineTrace> lines)
      : probe_(probe),
        settings_(settings),
        lines_(lines),
        angular_(probe.kind != ProbeKind::linear),
        first_(angular_ ? probe.first_angle_rad : probe.first_offset_m),
        width_(lineWidth(probe)),
        per_width_(1 / width_),
        spacing_m_(probe.sampleSpacing()),
        per_spacing_(1 / spacing_m_) {
    for (std::size_t i = 0; i <= lines.size(); ++i) {
      const double at = first_ + (static_cast<double>(i) - 0.5) * width_;
      boundaries_.push_back(angular_ ? Point{std::sin(at), std::cos(at)} : Point{at, 1});
    }
    linkPasses();
  }

  // normals: of the piece, or nothing where the facet's own counts.
  void add(const ContourPiece& piece, const PieceNormals* normals) {
    Point a{piece.cut.from.x, piece.cut.from.z}, b{piece.cut.to.x, piece.cut.to.z};
    if (!clipToFront(a, b)) return;
    int begin = cellOf(a), end = cellOf(b);
    if (begin > end) {
      std::swap(a, b);
      std::swap(begin, end);
    }
    const int last = static_cast<int>(lines_.size()) - 1;
    if (end < 0 || begin > last) return;
    const Vec3d normal = unitNormal(piece);
    Point from = begin < 0 ? atBoundary(a, b, 0) : a;
    double path_m = pathLength(from);
    for (int i = std::max(begin, 0); i <= std::min(end, last); ++i) {
      const Point to = i < end ? atBoundary(a, b, i + 1) : b;
      const double next_path_m = pathLength(to);
      addToLine(piece, {normal, normals}, {from, to, path_m, next_path_m},
                static_cast<std::size_t>(i));
      from = to;
      path_m = next_path_m;
    }
  }

 private:
  // Width of a cell: an angle, or a length for a linear probe.
  static double lineWidth(const Probe& p) {
    if (p.lines < 2) return 0;
    return (p.kind == ProbeKind::linear ? p.last_offset_m - p.first_offset_m
                                        : p.last_angle_rad - p.first_angle_rad) /
           (p.lines - 1);
  }

  // Lines never point backwards, so what lies behind z = 0 is in no cell.
  static bool clipToFront(Point& a, Point& b) {
    if (a.z < 0 && b.z < 0) return false;
    const auto atZero = [&] { return Point{a.x + (b.x - a.x) * (a.z / (a.z - b.z)), 0}; };
    if (a.z < 0)
      a = atZero();
    else if (b.z < 0)
      b = atZero();
    return true;
  }

  // How far a point lies to the right of a boundary between cells.
  double rightOf(Point p, int boundary) const {
    const Point& at = boundaries_[static_cast<std::size_t>(boundary)];
    return angular_ ? p.x * at.z - p.z * at.x : p.x - at.x;
  }

  // The cell that holds a point; -1 left of the first and the number of lines right of the last.
  int cellOf(Point p) const {
    const int boundaries = static_cast<int>(boundaries_.size());
    const double place = angular_ ? roughAngle(p.x, p.z) : p.x;
    int n = static_cast<int>(
        std::clamp((place - first_) / width_ + 1.5, 0.0, static_cast<double>(boundaries)));
    while (n < boundaries && rightOf(p, n) >= 0) ++n;
    while (n > 0 && rightOf(p, n - 1) < 0) --n;
    return n - 1;
  }

  // Where the straight line a-b passes a boundary between two cells.
  Point atBoundary(Point a, Point b, int boundary) const {
    const double ua = rightOf(a, boundary), ub = rightOf(b, boundary);
    const double t = ua == ub ? 0.5 : std::clamp(ua / (ua - ub), 0.0, 1.0);
    return {a.x + t * (b.x - a.x), a.z + t * (b.z - a.z)};
  }

  double pathLength(Point p) const {
    return angular_ ? std::sqrt(p.x * p.x + p.z * p.z) - probe_.face_radius_m : p.z;
  }

  // Share of a cell between two points on one straight piece.
  double share(Point a, Point b) const {
    if (!angular_) return std::abs(b.x - a.x) * per_width_;
    const double across = std::abs(a.x * b.z - a.z * b.x), along = a.x * b.x + a.z * b.z;
    const double q = across / along, q2 = q * q;
    // Inside a cell the angle is small: three terms of the arctangent leave under 1e-13.
    const double angle =
        along > 0 && q < 0.02 ? q * (1 - q2 * (1.0 / 3 - q2 / 5)) : std::atan2(across, along);
    return angle * per_width_;
  }

  // The passes of each line by surface and way of crossing: mostly there is one.
  void linkPasses() {
    heads_.assign(lines_.size() * keysOfLine(), 0);
    for (std::size_t line = 0; line < lines_.size(); ++line)
      for (std::size_t k = lines_[line].passes.size(); k-- > 0;) {
        const InterfacePass& pass = lines_[line].passes[k];
        std::uint32_t& head = heads_[keyOf(line, pass.surface, pass.entering)];
        links_.push_back({&pass, head});
        head = static_cast<std::uint32_t>(links_.size());
      }
  }
  std::size_t keysOfLine() const { return 2 * settings_.surfaces.size(); }
  std::size_t keyOf(std::size_t line, SurfaceId surface, bool entering) const {
    return line * keysOfLine() + 2 * index(surface) + (entering ? 1 : 0);
  }

  // The same surface crossed the same way on the line itself, nearest in depth.
  const InterfacePass* nearestPass(std::size_t line, const ContourPiece& piece, bool entering,
                                   double path_m) const {
    std::uint32_t at = heads_[keyOf(line, piece.surface, entering)];
    if (at == 0) return nullptr;
    const InterfacePass* best = links_[at - 1].pass;
    while ((at = links_[at - 1].next) != 0) {
      const InterfacePass* pass = links_[at - 1].pass;
      if (std::abs(pass->path_m - path_m) < std::abs(best->path_m - path_m)) best = pass;
    }
    return best;
  }

  struct Normal {
    Vec3d of_facet;
    const PieceNormals* smooth;
  };

  // Of the point of a piece, seen along a direction; smooth normals run linearly from end to end.
  static Vec3d normalAt(const ContourPiece& piece, const Normal& normal, Point p, Vec3d direction) {
    if (!normal.smooth) return normal.of_facet;
    const Vec3d along = piece.cut.to - piece.cut.from;
    const double size = dot(along, along);
    const double t = size > 0 ? dot(Vec3d{p.x, 0, p.z} - piece.cut.from, along) / size : 0.5;
    const Vec3d value = normal.smooth->from + t * (normal.smooth->to - normal.smooth->from);
    return facingNormal(value, direction, normal.of_facet);
  }

  // Which way the piece is crossed is the facet's business, the angle of incidence the normal's.
  void addToLine(const ContourPiece& piece, const Normal& normal, const CellPiece& part,
                 std::size_t line) {
    const Point middle{(part.a.x + part.b.x) / 2, (part.a.z + part.b.z) / 2};
    const double reach = std::sqrt(middle.x * middle.x + middle.z * middle.z);
    const double per_reach = 1 / reach;
    const Vec3d direction = angular_ && reach > 0
                                ? Vec3d{middle.x * per_reach, 0, middle.z * per_reach}
                                : Vec3d{0, 0, 1};
    const bool entering = dot(direction, normal.of_facet) < 0;
    const double path_m = angular_ ? reach - probe_.face_radius_m : middle.z;
    const InterfacePass* pass = nearestPass(line, piece, entering, path_m);
    if (!pass || !pass->seen) return;
    const double along = dot(direction, normalAt(piece, normal, middle, direction));
    const double echo = echoAt(*pass, std::min(std::abs(along), 1.0));
    if (echo > 0)
      split(part, [&](const CellPiece& half) { deposit(half, *pass, echo, lines_[line]); });
  }

  // As the walk along a line does it: Eq. 1 and the lobe; a membrane echoes twice.
  double echoAt(const InterfacePass& pass, double cos_i) const {
    const SurfaceTraits& surface = settings_.surfaces[index(pass.surface)];
    const Medium& from = settings_.media[index(pass.before)];
    const Medium& to = settings_.media[index(pass.after)];
    const InterfaceLaw law = interfaceLaw(from.impedance_kg_m2_s, from.sound_speed_m_s,
                                          to.impedance_kg_m2_s, to.sound_speed_m_s, cos_i);
    const double lost = settings_.transmission_loss ? law.through * law.through : 1;
    const double second = surface.membrane ? lost * law.R : 0;
    return pass.passed *
           nonSpecularReturn(surface.gain * (law.R + second), cos_i, surface.exponent);
  }

  // At the foot of the perpendicular from the centre the path length turns round.
  template <typename F>
  void split(const CellPiece& piece, F&& part) const {
    const Point a = piece.a, b = piece.b;
    const double dx = b.x - a.x, dz = b.z - a.z, size = dx * dx + dz * dz;
    const double towards_foot = -(a.x * dx + a.z * dz);
    const auto ordered = [&](const CellPiece& p) {
      part(p.path_a_m <= p.path_b_m ? p : CellPiece{p.b, p.a, p.path_b_m, p.path_a_m});
    };
    if (!angular_ || !(towards_foot > 0 && towards_foot < size)) return ordered(piece);
    const double t = towards_foot / size;
    const Point foot{a.x + t * dx, a.z + t * dz};
    const double foot_path_m = pathLength(foot);
    ordered({a, foot, piece.path_a_m, foot_path_m});
    ordered({foot, b, foot_path_m, piece.path_b_m});
  }

  // Finds the points of a piece by their path length. Along the piece the squared distance to the
  // centre grows as p^2 + |d|^2 (s - s_0)^2 from the foot of the perpendicular, at s_0.
  class PathPoints {
   public:
    PathPoints(const CellPiece& piece, bool angular, double face_radius_m)
        : a_(piece.a),
          dx_(piece.b.x - piece.a.x),
          dz_(piece.b.z - piece.a.z),
          angular_(angular),
          centre_m_(angular ? face_radius_m : -piece.a.z) {
      const double size = angular ? dx_ * dx_ + dz_ * dz_ : dz_;
      per_size_ = std::isnormal(size) ? 1 / size : 0;  // a point: anywhere on it
      if (!angular) return;
      const double along = a_.x * dx_ + a_.z * dz_, across = a_.x * dz_ - a_.z * dx_;
      foot_ = -along * per_size_;
      p2_ = across * across * per_size_;
    }

    Point at(double path_m) const {
      const double r = path_m + centre_m_;
      const double s =
          angular_ ? foot_ + std::sqrt(std::max(r * r - p2_, 0.0) * per_size_) : r * per_size_;
      const double inside = std::clamp(s, 0.0, 1.0);
      return {a_.x + inside * dx_, a_.z + inside * dz_};
    }

   private:
    Point a_;
    double dx_, dz_;
    bool angular_;
    double centre_m_, per_size_ = 0, foot_ = 0, p2_ = 0;
  };

  // Spreads a piece over the samples it spans, each with its share of the cell.
  void deposit(const CellPiece& piece, const InterfacePass& pass, double echo, LineTrace& line) {
    const double end_depth_m = line.stretches.back().end_depth_m;
    // Where the line passes the interface, in samples, and samples to a metre of path before it.
    const double k_pass = (pass.depth_m - probe_.min_depth_m) * per_spacing_;
    const double per_path =
        pass.path_per_depth == 1 ? per_spacing_ : per_spacing_ / pass.path_per_depth;
    const double path_step = spacing_m_ * pass.path_per_depth;
    const double k_a = k_pass + (piece.path_a_m - pass.path_m) * per_path;
    const double k_b = k_pass + (piece.path_b_m - pass.path_m) * per_path;
    const auto pathAtEnd = [&](double k) { return pass.path_m + (k + 1 - k_pass) * path_step; };
    // A piece may be far longer than the image is deep.
    const double first = std::max(std::floor(k_a), 0.0);
    const double last = std::min(std::max(std::ceil(k_b) - 1, first), probe_.samples - 1.0);
    const auto add = [&](double k, Point begin, Point end) {
      const double depth_m = probe_.min_depth_m + (k + 0.5) * spacing_m_;
      if (!(depth_m < end_depth_m)) return;
      const double beyond_m = (k + 0.5 - k_pass) * path_step;
      line.echoes.push_back({depth_m, echo * share(begin, end),
                             std::max(pass.exponent + beyond_m * pass.exponent_per_path, 0.0)});
    };
    if (first > last) return;
    const bool begins = first <= k_a, ends = last + 1 >= k_b;  // inside the image
    if (begins && ends && first == last) return add(first, piece.a, piece.b);
    const PathPoints points(piece, angular_, probe_.face_radius_m);
    Point begin = begins ? piece.a : points.at(pathAtEnd(first - 1));
    for (double k = first; k < last; ++k) {
      const Point end = points.at(pathAtEnd(k));
      add(k, begin, end);
      begin = end;
    }
    add(last, begin, ends ? piece.b : points.at(pathAtEnd(last)));
  }

  const Probe& probe_;
  const TraceSettings& settings_;
  std::span<LineTrace> lines_;
  bool angular_;
  double first_, width_, per_width_, spacing_m_, per_spacing_;
  struct PassLink {
    const InterfacePass* pass;
    std::uint32_t next;  // 1 + position in links_, or 0
  };
  std::vector<PassLink> links_;
  std::vector<std::uint32_t> heads_;  // by keyOf(): as PassLink::next
  std::vector<Point>
      boundaries_;  // sine and cosine, or the offset of a linear probe; one more than lines
};

}  // namespace

void addCellEchoes(std::span<const ContourPiece> pieces, std::span<const PieceNormals> normals,
                   const Probe& probe, const TraceSettings& settings, std::span<LineTrace> lines) {
  if (!settings.reflection) return;
  CellIntegrator integrator(probe, settings, lines);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    integrator.add(pieces[i], normals.empty() ? nullptr : &normals[i]);
}

}  // namespace echocine
