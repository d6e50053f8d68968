#include "trace/linked_echoes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// sin^2 of how far a chord may leave the tangent planes at its ends.
constexpr double kLeastFlat = 0.25;

bool inTangentPlane(Vec3d chord, const Echo& echo) {
  const double out = dot(chord, echo.tilt);
  return out * out <= kLeastFlat * dot(chord, chord) * dot(echo.tilt, echo.tilt);
}

bool ofOneWall(const Echo& a, const Echo& b) {
  if (a.surface != b.surface || a.before != b.before || a.after != b.after) return false;
  const Vec3d chord = b.point - a.point;
  return inTangentPlane(chord, a) && inTangentPlane(chord, b);
}

using Echoes = std::vector<Echo>;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// Finds which echoes of two neighbouring lines are of one wall. Its memory is used again.
class Pairing {
 public:
  // other[i]: the echo of `b` that is linked with a[i], or kNone.
  void find(const Echoes& a, const Echoes& b, std::vector<std::size_t>& other) {
    other.assign(a.size(), kNone);
    if (allAlike(a, b)) {
      for (std::size_t i = 0; i < a.size(); ++i) other[i] = i;
      return;
    }
    rate(a, b);
    const std::size_t width = b.size() + 1;
    for (std::size_t i = a.size(), j = b.size(); i > 0 && j > 0;) {
      const Rating& here = best_[i * width + j];
      if (here == best_[(i - 1) * width + j]) {
        --i;
      } else if (here == best_[i * width + j - 1]) {
        --j;
      } else {
        other[--i] = --j;
      }
    }
  }

 private:
  // The best way to link the first i of one line with the first j of the other.
  struct Rating {
    int links = 0;
    double apart_m = 0;
    bool operator==(const Rating&) const = default;
    bool operator<(const Rating& other) const {
      return links < other.links || (links == other.links && apart_m > other.apart_m);
    }
  };

  // Nearly always: both lines cross the same walls.
  static bool allAlike(const Echoes& a, const Echoes& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), ofOneWall);
  }

  void rate(const Echoes& a, const Echoes& b) {
    const std::size_t width = b.size() + 1;
    best_.assign((a.size() + 1) * width, {});
    for (std::size_t i = 1; i <= a.size(); ++i)
      for (std::size_t j = 1; j <= b.size(); ++j) {
        Rating& here = best_[i * width + j];
        here = std::max(best_[(i - 1) * width + j], best_[i * width + j - 1]);
        if (!ofOneWall(a[i - 1], b[j - 1])) continue;
        Rating linked = best_[(i - 1) * width + j - 1];
        ++linked.links;
        linked.apart_m += std::abs(a[i - 1].depth_m - b[j - 1].depth_m);
        here = std::max(here, linked);
      }
  }

  std::vector<Rating> best_;
};

// A wall between two lines, s = 0 at one and 1 at the other.
struct Chord {
  double place = 0, place_per_s = 0;  // ChordSampler::placeOf() its depth
  double intensity = 0, intensity_per_s = 0;
  double exponent = 0, exponent_per_s = 0;
  SurfaceId surface{};
};

// Puts stretches of wall into samples.
class ChordSampler {
 public:
  ChordSampler(const Probe& probe, const TraceSettings& settings, CellEchoes& echoes)
      : settings_(settings),
        echoes_(echoes),
        angular_(ScanGeometry(probe).angular()),
        width_(ScanGeometry(probe).cellWidth()),
        to_centre_m_(probe.face_radius_m),
        min_depth_m_(probe.min_depth_m),
        spacing_m_(probe.sampleSpacing()),
        samples_(probe.samples) {}

  Chord between(const Echo& a, const Echo& b) const {
    const double place = placeOf(a.depth_m);
    return {place,      placeOf(b.depth_m) - place, a.intensity, b.intensity - a.intensity,
            a.exponent, b.exponent - a.exponent,    a.surface};
  }

  // The tangent plane of an echo towards the next line, which lies to the side of the unit vector.
  Chord tangent(const Echo& a, Vec3d towards) const {
    const double lean = std::clamp(dot(towards, a.tilt), -kSteepestLean, kSteepestLean);
    const double across = angular_ ? width_ / (a.depth_m + to_centre_m_) : width_;
    return {placeOf(a.depth_m), -lean * across, a.intensity, 0, a.exponent, 0, a.surface};
  }

  // Adds the part of the chord with s in [from, to].
  void add(std::size_t line, const Chord& chord, double from, double to) {
    const double one = sampleAt(chord, from), other = sampleAt(chord, to);
    const bool deeper = other >= one;
    const double first = deeper ? one : other, last = deeper ? other : one;
    const double near = deeper ? from : to, far = deeper ? to : from;
    const auto reach = [&](double k) {  // s where sample k begins
      const double s = (placeOf(min_depth_m_ + k * spacing_m_) - chord.place) / chord.place_per_s;
      return std::clamp(s, from, to);
    };
    overSamples(first, last, [&](double k) {
      const double begin = k == first ? near : reach(k), end = k == last ? far : reach(k + 1);
      const double middle = (begin + end) / 2;
      const double filled = chord.intensity + middle * chord.intensity_per_s;
      put(line, k, std::abs(end - begin) * filled, filled,
          chord.exponent + middle * chord.exponent_per_s, chord.surface,
          placesAt(chord, middle) - k);
    });
  }

  // A wall that turns round at a depth.
  void addBend(std::size_t line, const Echo& echo, double turn_m) {
    const double reach_m = echo.depth_m - turn_m;
    const double first = sampleOf(std::min(echo.depth_m, turn_m)),
                 last = sampleOf(std::max(echo.depth_m, turn_m));
    const auto before = [&](double depth_m) {  // q^4
      const double q = std::clamp((depth_m - turn_m) / reach_m, 0.0, 1.0);
      return q * q * q * q;
    };
    overSamples(first, last, [&](double k) {
      const double begin_m = min_depth_m_ + k * spacing_m_;
      const double share =
          first == last ? 1 : std::abs(before(begin_m + spacing_m_) - before(begin_m));
      put(line, k, share / 3 * echo.intensity, echo.intensity, echo.exponent, echo.surface, 0.5);
    });
  }

 private:
  // A quantity that is linear in s along a chord and grows with depth.
  double placeOf(double depth_m) const {
    return angular_ ? -1 / (depth_m + to_centre_m_) : depth_m;
  }
  // In samples from the first one's beginning.
  double placesAt(const Chord& chord, double s) const {
    const double place = chord.place + s * chord.place_per_s;
    if (!angular_) return placesOf(place);
    return place < 0 ? placesOf(-1 / place - to_centre_m_) : samples_;  // else it is never met
  }
  double placesOf(double depth_m) const { return (depth_m - min_depth_m_) / spacing_m_; }
  double sampleAt(const Chord& chord, double s) const { return std::floor(placesAt(chord, s)); }
  double sampleOf(double depth_m) const { return std::floor(placesOf(depth_m)); }

  // The samples from first to last that are in the image.
  template <typename Each>
  void overSamples(double first, double last, const Each& each) {
    const double begin = std::max(first, 0.0), end = std::min(last, samples_ - 1.0);
    if (end < begin) return;
    echoes_.reserve(echoes_.count + static_cast<std::size_t>(end - begin) + 1);
    for (double k = begin; k <= end; ++k) each(k);
  }

  void put(std::size_t line, double k, double intensity, double filled, double exponent,
           SurfaceId surface, double place) {
    const std::size_t i = echoes_.count++;
    echoes_.at[i] = static_cast<std::uint32_t>(line * static_cast<std::size_t>(samples_)) +
                    static_cast<std::uint32_t>(k);
    echoes_.intensity[i] = intensity;
    echoes_.filled[i] = filled;
    echoes_.exponent[i] = exponent;
    echoes_.coherent_part[i] = static_cast<float>(settings_.surfaces[index(surface)].coherent_part);
    echoes_.place[i] = static_cast<float>(place);
  }

  const TraceSettings& settings_;
  CellEchoes& echoes_;
  bool angular_;
  double width_, to_centre_m_, min_depth_m_, spacing_m_;
  int samples_;
};

// Does a wall that line crosses twice, one after the other, turn round beside the line?
bool turnsRound(const Echo& a, const Echo& b) {
  const bool through = a.after == b.before || (a.before == b.before && a.after == b.after);
  const Vec3d chord = b.point - a.point;
  return a.surface == b.surface && a.depth_m < b.depth_m && through && inTangentPlane(chord, a) &&
         inTangentPlane(chord, b);
}

// The neighbours of a line's echoes on one side.
struct Side {
  std::vector<std::size_t> other;  // the neighbour's echo, or kNone
  Vec3d towards;                   // unit vector across the line to the neighbour
};

void addLonely(std::size_t line, const Echoes& echoes, const Side& side, ChordSampler& sampler,
               std::vector<std::size_t>& last_of_surface) {
  last_of_surface.assign(kMaxSurfaces, kNone);
  std::vector<std::size_t>& waiting = last_of_surface;
  const auto alone = [&](std::size_t e) {
    if (e != kNone) sampler.add(line, sampler.tangent(echoes[e], side.towards), 0, 0.5);
  };
  for (std::size_t e = 0; e < echoes.size(); ++e) {
    std::size_t& before = waiting[index(echoes[e].surface)];
    if (side.other[e] != kNone) {
      alone(before);
      before = kNone;
    } else if (before != kNone && turnsRound(echoes[before], echoes[e])) {
      const double turn_m = (echoes[before].depth_m + echoes[e].depth_m) / 2;
      sampler.addBend(line, echoes[before], turn_m);
      sampler.addBend(line, echoes[e], turn_m);
      before = kNone;
    } else {
      alone(before);
      before = e;
    }
  }
  for (const Echo& echo : echoes) {
    std::size_t& before = waiting[index(echo.surface)];
    alone(before);
    before = kNone;
  }
}

}  // namespace

void linkEchoes(const Probe& probe, const TraceSettings& settings, std::span<LineTrace> lines,
                CellEchoes& echoes) {
  echoes.count = 0;
  ChordSampler sampler(probe, settings, echoes);
  Pairing pairing;
  Side left, right;
  std::vector<std::size_t> waiting, next_left;
  const std::size_t count = lines.size();
  const bool full_turn = probe.isFullTurn();
  const Echoes none;
  // Links the echoes of a line with those of the next one, and notes what is linked on both sides.
  const auto link = [&](std::size_t i, const Echoes& next) {
    const Echoes& here = lines[i].echoes;
    pairing.find(here, next, right.other);
    next_left.assign(next.size(), kNone);
    for (std::size_t e = 0; e < here.size(); ++e)
      if (right.other[e] != kNone) next_left[right.other[e]] = e;
  };
  if (full_turn) {  // what the first line has on its left
    link(count - 1, lines[0].echoes);
    left.other = next_left;
  } else {
    left.other.assign(lines.empty() ? 0 : lines[0].echoes.size(), kNone);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool last = i + 1 == count;
    const std::size_t beside = last ? 0 : i + 1;
    const Echoes &here = lines[i].echoes, &next = last && !full_turn ? none : lines[beside].echoes;
    const Vec3d along = lineGeometry(probe, static_cast<int>(i)).direction;
    right.towards = cross(Vec3d{0, 1, 0}, along);
    left.towards = -right.towards;
    link(i, next);
    addLonely(i, here, left, sampler, waiting);
    addLonely(i, here, right, sampler, waiting);
    for (std::size_t e = 0; e < here.size(); ++e) {
      if (right.other[e] == kNone) continue;
      const Chord chord = sampler.between(here[e], next[right.other[e]]);
      sampler.add(i, chord, 0, 0.5);
      sampler.add(beside, chord, 0.5, 1);
    }
    std::swap(left.other, next_left);
  }
  for (LineTrace& line : lines) line.echoes.clear();
}

}  // namespace echocine
