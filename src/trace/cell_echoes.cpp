#include "trace/cell_echoes.h"

#include <algorithm>
#include <cmath>

#include "scene/scan_geometry.h"
#include "trace/clip_interfaces.h"
#include "trace/echo_rows.h"
#include "trace/interface_lanes.h"

namespace echocine {

namespace {

constexpr double kFar_m = 1e9;  // beyond every image

class CellEchoMaker {
 public:
  CellEchoMaker(const Probe& probe, const TraceSettings& settings, std::span<const LineTrace> lines,
                double cell_width, CellEchoes& echoes)
      : settings_(settings),
        echoes_(echoes),
        angular_(ScanGeometry(probe).angular()),
        face_radius_m_(probe.face_radius_m),
        width_(cell_width),
        per_width_(1 / cell_width),
        min_depth_m_(probe.min_depth_m),
        spacing_m_(probe.sampleSpacing()),
        per_spacing_(1 / spacing_m_),
        samples_(probe.samples) {
    for (const SurfaceTraits& surface : settings.surfaces)
      any_power_ |= surface.exponent != 0 && surface.exponent != 1 && surface.exponent != 2;
    for (const LineTrace& line : lines) {
      const double end_m = line.segments.back().end_depth_m;
      const double half_m = cell_width / 2 * (angular_ ? end_m + face_radius_m_ : 1.0);
      // A wall that ends its line by total reflection still fills the line's cell, on one side
      // deeper than the line goes: as deep as the steepest lean makes it.
      samples_lit_.push_back({samplesBefore(end_m), samplesBefore(end_m + kSteepestLean * half_m)});
    }
  }

  void add(const EdgeClips& clips, const InterfaceRows& interfaces) {
    Ints4 most{};
    for (std::size_t i = 0; i < clips.count; i += kDoubleLanes)
      most +=
          angular_ ? echoesOf<true>(clips, interfaces, i) : echoesOf<false>(clips, interfaces, i);
    echoes_.reserve(echoes_.count + clips.count +
                    static_cast<std::size_t>(most[0] + most[1] + most[2] + most[3]));
    std::array<std::uint32_t, 2 * kClips> longer;
    const std::size_t count = addSingles(clips, interfaces, longer);
    for (std::size_t i = 0; i < count; ++i)
      intoSamples(longer[i], clips.line[longer[i]], interfaces);
    takeShares();
  }

 private:
  // Samples whose centres lie before a depth.
  int samplesBefore(double end_m) const {
    const auto lit = [&](int k) { return min_depth_m_ + (k + 0.5) * spacing_m_ < end_m; };
    int n = static_cast<int>(
        std::clamp((end_m - min_depth_m_) * per_spacing_, 0.0, static_cast<double>(samples_)));
    while (n < samples_ && lit(n)) ++n;
    while (n > 0 && !lit(n - 1)) --n;
    return n;
  }

  // cos^2 of the angle of incidence. Straight rays carry Snell's direction: what the cell's line
  // has of it turns with the direction in which the clip is seen, and where it would not meet this
  // side the line's own counts, as in the walk.
  Doubles4 incidence(const EdgeClips& clips, const InterfaceRows& f, std::size_t i) const {
    const Doubles4 to_x = lanesAt(&clips.to_x[i]), to_z = lanesAt(&clips.to_z[i]);
    const Doubles4 n_x = lanesAt(&clips.normal_x[i]), n_z = lanesAt(&clips.normal_z[i]);
    const Doubles4 along = to_x * n_x + to_z * n_z, to_square = to_x * to_x + to_z * to_z;
    const Doubles4 squares = to_square * lanesAt(&clips.normal_square[i]);
    const Doubles4 straight = smaller(along * along / squares, 1);
    if (!settings_.snell_angles) return straight;
    const Doubles4 across = lanesAt(&f.wave_across[i]), out = lanesAt(&f.wave_out[i]);
    if (!any((across != 0) | (out != 0))) return straight;
    const Doubles4 turned = along * lanesAt(&f.wave_along[i]) + (to_z * n_x - to_x * n_z) * across +
                            squareRoot(to_square) * out * lanesAt(&clips.normal_y[i]);
    return turned * along > 0 ? smaller(turned * turned / squares, 1) : straight;
  }

  Doubles4 lobeOf(Doubles4 n, Doubles4 cos_square) const {
    const Doubles4 cos_i = squareRoot(cos_square);
    Doubles4 lobe = n == 2 ? cos_square : n == 1 ? cos_i : Doubles4{} + 1;
    for (std::size_t j = 0; any_power_ && j < kDoubleLanes; ++j)
      if (n[j] != 0 && n[j] != 1 && n[j] != 2) lobe[j] = std::pow(cos_i[j], n[j]);
    return lobe;
  }

  // As the walk along a line does it: Eq. 1 and the lobe; a membrane echoes twice, each time by its
  // own angle, the second time by (1 - R)/(1 + R) of the first. Mostly the angle counts in the lobe
  // cos^2 alone, which needs no root.
  Doubles4 strengthOf(const EdgeClips& clips, const InterfaceRows& f, std::size_t i) const {
    const Doubles4 cos_square = incidence(clips, f, i);
    const Doubles4 Z_1 = lanesAt(&f.Z_1[i]), Z_2 = lanesAt(&f.Z_2[i]), r = lanesAt(&f.r[i]);
    const Doubles4 n = lanesAt(&f.lobe[i]), passed = lanesAt(&f.passed[i]),
                   membrane = lanesAt(&f.membrane[i]);
    const Doubles4 upright = reflectedAtEqualSpeeds(Z_1, Z_2);
    const auto second = [&](Doubles4 R) {
      return settings_.transmission_loss ? (1 - R) / (1 + R) : Doubles4{} + 1;
    };
    if (!any((r != 1) | (n != 2)))
      return passed * upright * (1 + membrane * second(upright)) * cos_square;
    const Doubles4 turn = lanesAt(&f.turn[i]);
    const Doubles4 R = reflectedShares(Z_1, Z_2, r, turn, squareRoot(cos_square));
    const Doubles4 back = settings_.reflection_cap ? smaller(R, upright) : R;
    Doubles4 lobes = lobeOf(n, cos_square);
    if (any(membrane != 0)) {
      const Doubles4 cos_t_square = clamped(turn + r * r * cos_square, Doubles4{}, Doubles4{} + 1);
      lobes += membrane * second(R) * lobeOf(n, cos_t_square);
    }
    return passed * back * lobes;
  }

  // Fills the rows for four clips; returns how many samples each spans.
  template <bool kAngular>
  Ints4 echoesOf(const EdgeClips& clips, const InterfaceRows& f, std::size_t i) {
    const Doubles4 a_x = lanesAt(&clips.a_x[i]), a_z = lanesAt(&clips.a_z[i]),
                   b_x = lanesAt(&clips.b_x[i]), b_z = lanesAt(&clips.b_z[i]);
    const Doubles4 dx = b_x - a_x, dz = b_z - a_z;
    const Doubles4 strength = strengthOf(clips, f, i) * per_width_;
    Doubles4 path_a = a_z, path_b = b_z, place_a{}, place_b = dz, p, flat{}, whole, zero_m = -a_z;
    if constexpr (kAngular) {
      path_a = squareRoot(a_x * a_x + a_z * a_z) - face_radius_m_;
      path_b = squareRoot(b_x * b_x + b_z * b_z) - face_radius_m_;
      const Doubles4 size = squareRoot(dx * dx + dz * dz), per_size = 1 / larger(size, kTiny);
      place_a = larger((a_x * dx + a_z * dz) * per_size, 0);
      place_b = place_a + size;
      p = magnitude(a_x * dz - a_z * dx) * per_size;
      whole = anglesBetween(place_a, place_b, p);
      zero_m = Doubles4{} + face_radius_m_;
    } else {
      p = magnitude(dx) / larger(dz, kTiny);
      flat = dz > kTiny ? Doubles4{} : magnitude(dx);
      whole = magnitude(dx);
    }
    const Doubles4 path_m = lanesAt(&f.path_m[i]), path_per_depth = lanesAt(&f.path_per_depth[i]);
    const Doubles4 step_m = spacing_m_ * path_per_depth;
    const Doubles4 per_path =
        settings_.travel_time ? per_spacing_ / path_per_depth : Doubles4{} + per_spacing_;
    const Doubles4 k_hit = (lanesAt(&f.depth_m[i]) - min_depth_m_) * per_spacing_;
    const Doubles4 samples = Doubles4{} + samples_;
    const Doubles4 k_a = clamped(k_hit + (path_a - path_m) * per_path, Doubles4{} - 1, samples);
    const Doubles4 k_b = clamped(k_hit + (path_b - path_m) * per_path, Doubles4{} - 1, samples + 1);
    const Doubles4 first = wholeOf(larger(k_a, 0)), below = wholeOf(larger(k_b, 0));
    const Doubles4 end = larger(below < k_b ? below + 1 : below, first + 1);
    const Mask4 seen = masksAt(&f.seen[i]);
    const Mask4 single = seen & (end == first + 1) & (first <= k_a) & (end >= k_b);
    const Doubles4 exponent_step = step_m * lanesAt(&f.exponent_per_path[i]);
    store(strength, &rows_.strength[i]);
    store(strength * whole, &rows_.whole[i]);
    store(k_a, &rows_.k_a[i]);
    store(k_b, &rows_.k_b[i]);
    store(zero_m + path_m - k_hit * step_m, &rows_.zero_m[i]);
    store(step_m, &rows_.step_m[i]);
    store(lanesAt(&f.exponent[i]) + (first + 0.5 - k_hit) * exponent_step, &rows_.exponent[i]);
    store(exponent_step, &rows_.exponent_step[i]);
    store(place_a, &rows_.place_a[i]);
    store(place_b, &rows_.place_b[i]);
    store(p, &rows_.p[i]);
    store(flat, &rows_.flat[i]);
    const Ints4 from = __builtin_convertvector(first, Ints4),
                to = __builtin_convertvector(seen ? end : first, Ints4);
    store(from, &rows_.first[i]);
    store(to, &rows_.end[i]);
    store(-__builtin_convertvector(single, Ints4), &rows_.single[i]);
    return to - from;
  }

  // Parts within one sample; the numbers of the others into `longer`. Without branches, which no
  // processor would foresee.
  std::size_t addSingles(const EdgeClips& clips, const InterfaceRows& interfaces,
                         std::array<std::uint32_t, 2 * kClips>& longer) {
    std::uint32_t* at = echoes_.at.data() + echoes_.count;
    double* intensity = echoes_.intensity.data() + echoes_.count;
    double* exponent = echoes_.exponent.data() + echoes_.count;
    double* filled = echoes_.filled.data() + echoes_.count;
    std::size_t singles = 0, others = 0;
    for (std::size_t i = 0; i < clips.count; ++i) {
      const std::uint32_t line = clips.line[i];
      const int first = rows_.first[i];
      const std::uint32_t lit =
          first < std::min(samples_lit_[line][interfaces.ends[i]], rows_.end[i]) ? 1 : 0;
      at[singles] = line * static_cast<std::uint32_t>(samples_) + static_cast<std::uint32_t>(first);
      intensity[singles] = rows_.whole[i];
      exponent[singles] = std::max(rows_.exponent[i], 0.0);
      filled[singles] = rows_.strength[i] * width_;
      longer[others] = static_cast<std::uint32_t>(i);
      if (settings_.coherent_echoes) {
        echoes_.coherent_part[echoes_.count + singles] = interfaces.coherent_part[i];
        echoes_.place[echoes_.count + singles] =
            static_cast<float>((rows_.k_a[i] + rows_.k_b[i]) / 2 - first);
      }
      singles += lit & rows_.single[i];
      others += lit & ~rows_.single[i];
    }
    echoes_.count += singles;
    return others;
  }

  // An interval for each sample that a clip spans.
  void intoSamples(std::size_t clip, std::uint32_t line, const InterfaceRows& interfaces) {
    const int first = rows_.first[clip],
              end = std::min(rows_.end[clip], samples_lit_[line][interfaces.ends[clip]]);
    const double k_a = rows_.k_a[clip], k_b = rows_.k_b[clip];
    const double zero_m = rows_.zero_m[clip], step_m = rows_.step_m[clip];
    const std::uint32_t line_at = line * static_cast<std::uint32_t>(samples_);
    for (int k = first; k < end; ++k) {
      if (intervals_.count == IntervalRows::kMost) takeShares();
      const std::size_t i = intervals_.count++, to = echoes_.count + i;
      intervals_.begin_m[i] = k <= k_a ? 0 : zero_m + k * step_m;
      intervals_.end_m[i] = k + 1 >= k_b ? kFar_m : zero_m + (k + 1) * step_m;
      intervals_.strength[i] = rows_.strength[clip];
      intervals_.place_a[i] = rows_.place_a[clip];
      intervals_.place_b[i] = rows_.place_b[clip];
      intervals_.p[i] = rows_.p[clip];
      intervals_.flat[i] = rows_.flat[clip];
      echoes_.at[to] = line_at + static_cast<std::uint32_t>(k);
      echoes_.filled[to] = rows_.strength[clip] * width_;
      echoes_.exponent[to] =
          std::max(rows_.exponent[clip] + (k - first) * rows_.exponent_step[clip], 0.0);
      if (!settings_.coherent_echoes) continue;
      echoes_.coherent_part[to] = interfaces.coherent_part[clip];
      echoes_.place[to] =
          static_cast<float>((std::max<double>(k, k_a) + std::min<double>(k + 1, k_b)) / 2 - k);
    }
  }

  // The share of the cell that each interval covers.
  void takeShares() {
    for (std::size_t i = 0; i < intervals_.count; i += kDoubleLanes) {
      const Doubles4 share = angular_ ? anglesOf(i) : widthsOf(i);
      store(lanesAt(&intervals_.strength[i]) * share, &echoes_.intensity[echoes_.count + i]);
    }
    echoes_.count += intervals_.count;
    intervals_.count = 0;
  }
  Doubles4 anglesOf(std::size_t i) const {
    const Doubles4 p = lanesAt(&intervals_.p[i]), place_a = lanesAt(&intervals_.place_a[i]),
                   place_b = lanesAt(&intervals_.place_b[i]);
    const auto place = [&](Doubles4 r) {
      return clamped(squareRoot(larger((r - p) * (r + p), 0)), place_a, place_b);
    };
    return anglesBetween(place(lanesAt(&intervals_.begin_m[i])),
                         place(lanesAt(&intervals_.end_m[i])), p);
  }
  Doubles4 widthsOf(std::size_t i) const {
    const Doubles4 place_a = lanesAt(&intervals_.place_a[i]),
                   place_b = lanesAt(&intervals_.place_b[i]);
    const Doubles4 begin = clamped(lanesAt(&intervals_.begin_m[i]), place_a, place_b),
                   end = clamped(lanesAt(&intervals_.end_m[i]), place_a, place_b);
    return (end - begin) * lanesAt(&intervals_.p[i]) + lanesAt(&intervals_.flat[i]);
  }

  const TraceSettings& settings_;
  CellEchoes& echoes_;
  bool angular_;
  double face_radius_m_, width_, per_width_, min_depth_m_, spacing_m_, per_spacing_;
  int samples_;
  bool any_power_ = false;
  // By line: samples before its end; and before what the wall that ended it fills of its cell.
  std::vector<std::array<int, 2>> samples_lit_;
  EchoRows rows_{};
  IntervalRows intervals_{};
};

}  // namespace

void addCellEchoes(std::span<const ContourEdge> edges, std::span<const EdgeNormals> normals,
                   const Probe& probe, const TraceSettings& settings,
                   std::span<const LineTrace> lines, CellEchoes& echoes) {
  echoes.count = 0;
  if (!settings.reflection) return;
  EdgeClipper cutter(probe, edges);
  const ClipInterfaces interfaces(probe, settings, lines);
  CellEchoMaker maker(probe, settings, lines, cutter.width(), echoes);
  EdgeClips clips{};
  InterfaceRows rows{};
  for (cutter.next(clips); clips.count > 0; cutter.next(clips)) {
    interfaces.find(edges, normals, clips, rows);
    maker.add(clips, rows);
  }
}

}  // namespace echocine
