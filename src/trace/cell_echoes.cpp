#include "trace/cell_echoes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "trace/cell_parts.h"
#include "trace/interface_lanes.h"

namespace echocine {

namespace {

// Pieces that go through all steps together, so that what lies between these stays in the
// first-level cache.
constexpr std::size_t kPieces = 64;

constexpr double kTiny = 1e-300;  // instead of 0 in a denominator
constexpr double kFar_m = 1e9;    // beyond every image

// What four parts send back, and where. Along a part `place` grows from place_a to place_b: the
// distance from the foot of the perpendicular from the centre; of a linear probe the depth from a.
struct PartEchoes {
  Lanes strength;  // of the part as if it filled the cell
  Lanes k_a, k_b;  // its ends, in samples
  Lanes k_pass;    // where the line passes the interface, in samples
  Lanes pass_m;    // there the distance from the centre; of a linear probe the depth from a
  Lanes step_m;    // path of one sample
  Lanes exponent, exponent_step;  // A where the line passes, and of one sample before it
  Lanes place_a, place_b;
  Lanes p;     // distance of the foot from the centre; of a linear probe |dx / dz|
  Lanes flat;  // of a linear probe: |dx| of a part without extent in depth
};

// Four intervals of a sample on a part each.
struct IntervalGroup {
  Lanes begin_m, end_m;  // as PartEchoes::pass_m
  Lanes strength, place_a, place_b, p, flat;
};

// angle with 0 <= tan(angle) < 0.02 by three terms of the arctangent: to 1e-13.
constexpr double kSmallTangent = 0.02;
Lanes smallAngle(Lanes tangent) {
  const Lanes t2 = tangent * tangent;
  return tangent * (1 - t2 * (1.0 / 3 - t2 / 5));
}

class CellEchoMaker {
 public:
  CellEchoMaker(const Probe& probe, const TraceSettings& settings, std::span<const LineTrace> lines,
                CellEchoes& echoes)
      : settings_(settings),
        echoes_(echoes),
        angular_(probe.kind != ProbeKind::linear),
        face_radius_m_(probe.face_radius_m),
        per_width_(1 / cellWidth(probe)),
        min_depth_m_(probe.min_depth_m),
        spacing_m_(probe.sampleSpacing()),
        per_spacing_(1 / spacing_m_),
        samples_(probe.samples) {
    for (const SurfaceTraits& surface : settings.surfaces)
      any_power_ |= surface.exponent != 0 && surface.exponent != 1 && surface.exponent != 2;
    for (const LineTrace& line : lines) samples_lit_.push_back(samplesLit(line));
  }

  void add(const CellParts& parts) {
    count_ = 0;
    for (std::size_t first = 0; first < parts.count; first += kLanes) {
      const PartGroup& group = parts.groups[first / kLanes];
      const PartEchoes part = angular_ ? echoesOf<true>(group) : echoesOf<false>(group);
      const std::size_t lanes = std::min(kLanes, parts.count - first);
      for (std::size_t lane = 0; lane < lanes; ++lane) intoSamples(part, lane, group.line[lane]);
    }
    takeShares();
  }

 private:
  // Samples whose centres lie before the line's end.
  int samplesLit(const LineTrace& line) const {
    const double end_m = line.stretches.back().end_depth_m;
    const auto lit = [&](int k) { return min_depth_m_ + (k + 0.5) * spacing_m_ < end_m; };
    int n = static_cast<int>(
        std::clamp((end_m - min_depth_m_) * per_spacing_, 0.0, static_cast<double>(samples_)));
    while (n < samples_ && lit(n)) ++n;
    while (n > 0 && !lit(n - 1)) --n;
    return n;
  }

  // As the walk along a line does it: Eq. 1 and the lobe; a membrane echoes twice.
  Lanes strengthOf(const PartGroup& g) const {
    const Lanes to_square = g.to_x * g.to_x + g.to_z * g.to_z;
    const Lanes cos_i =
        smaller(magnitude(g.to_x * g.n_x + g.to_z * g.n_z) / squareRoot(to_square * g.n_square), 1);
    const Lanes R = reflectedShares(g.Z_1, g.c_1, g.Z_2, g.c_2, cos_i);
    const Lanes second = settings_.transmission_loss ? (1 - R) * (1 - R) * R : R;
    Lanes lobe = (g.lobe == 2 ? cos_i * cos_i : g.lobe == 1 ? cos_i : Lanes{} + 1);
    if (any_power_)
      for (std::size_t j = 0; j < kLanes; ++j)
        if (g.lobe[j] != 0 && g.lobe[j] != 1 && g.lobe[j] != 2)
          lobe[j] = std::pow(cos_i[j], g.lobe[j]);
    return g.passed * (R + g.membrane * second) * lobe;
  }

  template <bool kAngular>
  PartEchoes echoesOf(const PartGroup& g) const {
    PartEchoes e;
    e.strength = strengthOf(g);
    const Lanes per_path = per_spacing_ / g.path_per_depth;
    e.step_m = spacing_m_ * g.path_per_depth;
    e.k_pass = (g.pass_depth_m - min_depth_m_) * per_spacing_;
    e.exponent = g.exponent;
    e.exponent_step = e.step_m * g.exponent_per_path;
    const Lanes dx = g.b_x - g.a_x, dz = g.b_z - g.a_z;
    Lanes path_a = g.a_z, path_b = g.b_z;
    if constexpr (kAngular) {
      path_a = squareRoot(g.a_x * g.a_x + g.a_z * g.a_z) - face_radius_m_;
      path_b = squareRoot(g.b_x * g.b_x + g.b_z * g.b_z) - face_radius_m_;
      const Lanes size = squareRoot(dx * dx + dz * dz), per_size = 1 / larger(size, kTiny);
      e.place_a = larger((g.a_x * dx + g.a_z * dz) * per_size, 0);
      e.place_b = e.place_a + size;
      e.p = magnitude(g.a_x * dz - g.a_z * dx) * per_size;
      e.pass_m = g.pass_path_m + face_radius_m_;
      e.flat = Lanes{};
    } else {
      e.place_a = Lanes{};
      e.place_b = dz;
      e.p = magnitude(dx) / larger(dz, kTiny);
      e.flat = dz > kTiny ? Lanes{} : magnitude(dx);
      e.pass_m = g.pass_path_m - g.a_z;
    }
    e.k_a = e.k_pass + (path_a - g.pass_path_m) * per_path;
    e.k_b = e.k_pass + (path_b - g.pass_path_m) * per_path;
    return e;
  }

  // An interval for each sample that the part spans. It may be far longer than the image is deep.
  void intoSamples(const PartEchoes& part, std::size_t lane, std::uint32_t line) {
    const double k_a = part.k_a[lane], k_b = part.k_b[lane];
    const int first = static_cast<int>(std::clamp(k_a, 0.0, samples_ * 1.0));
    const int end =
        std::min(std::max(static_cast<int>(std::ceil(std::min(k_b, samples_ * 1.0))), first + 1),
                 samples_lit_[line]);
    if (first >= end) return;
    reserve(static_cast<std::size_t>(end - first));
    const double k_pass = part.k_pass[lane], step_m = part.step_m[lane];
    const double zero_m = part.pass_m[lane] - k_pass * step_m;
    for (int k = first; k < end; ++k) {
      const std::size_t i = count_++;
      IntervalGroup& g = intervals_[i / kLanes];
      const std::size_t j = i % kLanes;
      g.begin_m[j] = k <= k_a ? 0 : zero_m + k * step_m;
      g.end_m[j] = k + 1 >= k_b ? kFar_m : zero_m + (k + 1) * step_m;
      g.strength[j] = part.strength[lane];
      g.place_a[j] = part.place_a[lane];
      g.place_b[j] = part.place_b[lane];
      g.p[j] = part.p[lane];
      g.flat[j] = part.flat[lane];
      echoes_.at[echoes_.count + i] =
          line * static_cast<std::uint32_t>(samples_) + static_cast<std::uint32_t>(k);
      echoes_.exponent[echoes_.count + i] =
          std::max(part.exponent[lane] + (k + 0.5 - k_pass) * part.exponent_step[lane], 0.0);
    }
  }

  void reserve(std::size_t more) {
    const std::size_t groups = (count_ + more + kLanes - 1) / kLanes;
    if (groups > intervals_.size()) intervals_.resize(2 * groups);
    const std::size_t needed = echoes_.count + (groups + 1) * kLanes;
    if (needed > echoes_.at.size()) echoes_.resize(2 * needed);
  }

  void takeShares() {
    for (std::size_t i = 0; i * kLanes < count_; ++i) {
      const IntervalGroup& g = intervals_[i];
      const Lanes intensity = g.strength * ((angular_ ? anglesOf(g) : widthsOf(g)) * per_width_);
      store(intensity, &echoes_.intensity[echoes_.count + i * kLanes]);
    }
    echoes_.count += count_;
  }

  // Of the intervals' ends, seen from the centre.
  static Lanes anglesOf(const IntervalGroup& g) {
    const auto place = [&](Lanes r) {
      return clamped(squareRoot(larger((r - g.p) * (r + g.p), 0)), g.place_a, g.place_b);
    };
    const Lanes begin = place(g.begin_m), end = place(g.end_m);
    const Lanes across = g.p * (end - begin), along = g.p * g.p + begin * end;
    const Lanes tangent = across / larger(along, kTiny);
    Lanes angle = smallAngle(tangent);
    for (std::size_t j = 0; j < kLanes; ++j)
      if (tangent[j] >= kSmallTangent) angle[j] = std::atan2(across[j], along[j]);
    return angle;
  }
  static Lanes widthsOf(const IntervalGroup& g) {
    const Lanes begin = clamped(g.begin_m, g.place_a, g.place_b),
                end = clamped(g.end_m, g.place_a, g.place_b);
    return (end - begin) * g.p + g.flat;
  }

  const TraceSettings& settings_;
  CellEchoes& echoes_;
  bool angular_;
  double face_radius_m_, per_width_, min_depth_m_, spacing_m_, per_spacing_;
  int samples_;
  bool any_power_ = false;
  std::vector<int> samples_lit_;  // by line
  std::vector<IntervalGroup> intervals_;
  std::size_t count_ = 0;  // of intervals
};

}  // namespace

void addCellEchoes(std::span<const ContourPiece> pieces, std::span<const PieceNormals> normals,
                   const Probe& probe, const TraceSettings& settings,
                   std::span<const LineTrace> lines, CellEchoes& echoes) {
  echoes.count = 0;
  if (!settings.reflection) return;
  const CellCutter cutter(probe, settings, lines);
  CellEchoMaker maker(probe, settings, lines, echoes);
  CellParts parts;
  for (std::size_t first = 0; first < pieces.size(); first += kPieces) {
    parts.count = 0;
    for (std::size_t i = first; i < std::min(first + kPieces, pieces.size()); ++i)
      cutter.cut(pieces[i], normals.empty() ? nullptr : &normals[i], parts);
    maker.add(parts);
  }
}

}  // namespace echocine
