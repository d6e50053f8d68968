// Sweeping traces and markers.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "echo/ecg_time.h"

namespace echocine::echo {

namespace {

constexpr double kHidden = std::numeric_limits<double>::quiet_NaN();
constexpr double kSlowest_px = 0.3;  // per frame; our choice

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// left end of what changed at frame f = at + pace f, from frame `from` to `to`.
struct Pass {
  double at = 0, pace = 0;
  int from = 0, to = -1;
  int frames = 0;  // that it explains
  double leftAt(int frame) const { return at + pace * frame; }
};

double allowed(double pace) {
  return std::max(2.0, 0.6 * pace);
}

// The change of a frame whose left end is nearest to the pass; nothing beyond what is allowed.
const ChangedColumns* onPass(const Pass& pass, const std::vector<ChangedColumns>& changed,
                             int frame) {
  const ChangedColumns* best = nullptr;
  double least = allowed(pass.pace);
  for (const ChangedColumns& c : changed) {
    const double off = std::abs(c.first - pass.leftAt(frame));
    if (off <= least) least = off, best = &c;
  }
  return best;
}

// Frames within the band's columns.
void countFrames(const EcgCurve& curve, const std::vector<bool>& used, Pass& pass) {
  const int n = static_cast<int>(curve.changed.size());
  pass.frames = 0;
  pass.from = n, pass.to = -1;
  for (int f = 1; f < n; ++f) {
    if (used[static_cast<std::size_t>(f)] || pass.leftAt(f) < -allowed(pass.pace) ||
        pass.leftAt(f) > curve.band.columns())
      continue;
    if (onPass(pass, curve.changed[static_cast<std::size_t>(f)], f) == nullptr) continue;
    ++pass.frames;
    pass.from = std::min(pass.from, f);
    pass.to = std::max(pass.to, f);
  }
}

// Least squares through what it explains; the pace too where it is not known.
void settle(const EcgCurve& curve, const std::vector<bool>& used, bool pace_known, Pass& pass) {
  for (int round = 0; round < 4; ++round) {
    double n = 0, f_sum = 0, x_sum = 0, ff = 0, fx = 0;
    for (int f = 1; f < static_cast<int>(curve.changed.size()); ++f) {
      if (used[static_cast<std::size_t>(f)]) continue;
      const ChangedColumns* c = onPass(pass, curve.changed[static_cast<std::size_t>(f)], f);
      if (c == nullptr) continue;
      ++n, f_sum += f, x_sum += c->first, ff += double(f) * f, fx += double(f) * c->first;
    }
    const double spread = n * ff - f_sum * f_sum;
    const double fitted = spread > 0 ? (n * fx - f_sum * x_sum) / spread : 0;
    if (!pace_known && n > 2 && fitted >= kSlowest_px) pass.pace = fitted;
    if (n > 0) pass.at = (x_sum - pass.pace * f_sum) / n;
  }
  countFrames(curve, used, pass);
}

// The pass through two changes that explains most frames; `pace` where it is known.
Pass bestPass(const EcgCurve& curve, const std::vector<bool>& used, double pace) {
  constexpr int kMostFrames = 150, kMostPlaces = 4;
  const int n = static_cast<int>(curve.changed.size()), stride = 1 + n / kMostFrames;
  Pass best;
  const auto placesOf = [&](int f) {
    const auto& all = curve.changed[static_cast<std::size_t>(f)];
    return std::span<const ChangedColumns>(all).first(
        std::min<std::size_t>(all.size(), kMostPlaces));
  };
  const auto tryOne = [&](double at, double own_pace) {
    Pass pass{at, own_pace};
    countFrames(curve, used, pass);
    if (pass.frames > best.frames) best = pass;
  };
  for (int f = 1; f < n; f += stride) {
    if (used[static_cast<std::size_t>(f)]) continue;
    for (const ChangedColumns& a : placesOf(f)) {
      if (pace > 0) {
        tryOne(a.first - pace * f, pace);
        continue;
      }
      for (const int lag : {1, 2, 4, 8, 16}) {
        if (f + lag >= n) break;
        for (const ChangedColumns& b : placesOf(f + lag)) {
          const double own = static_cast<double>(b.first - a.first) / lag;
          if (own >= kSlowest_px && own <= curve.band.columns() / 6.0)
            tryOne(a.first - own * f, own);
        }
      }
    }
  }
  if (best.frames > 0) settle(curve, used, pace > 0, best);
  return best;
}

// Changes behind the head belong to the trace: the leftmost of adjacent passes counts.
void leaveErasing(const EcgCurve& curve, const std::vector<bool>& used, Pass& pass) {
  const Pass right = pass;
  for (double left = 1; left <= 0.3 * curve.band.columns(); ++left) {
    Pass other{right.at - left, right.pace};
    countFrames(curve, used, other);
    if (left > 2 * allowed(right.pace) && other.frames >= 0.8 * right.frames) {
      settle(curve, used, true, other);
      pass = other;
    }
  }
}

// One pace for all passes, by least squares about the middle of each. Changes that no head makes
// may fit a pace below the slowest, backwards too: then there are no passes.
void settleTogether(const EcgCurve& curve, std::vector<Pass>& passes) {
  double spread = 0, together = 0;
  for (const Pass& pass : passes) {
    double n = 0, f_sum = 0, x_sum = 0, ff = 0, fx = 0;
    for (int f = pass.from; f <= pass.to; ++f)
      if (const auto* c = onPass(pass, curve.changed[static_cast<std::size_t>(f)], f))
        ++n, f_sum += f, x_sum += c->first, ff += double(f) * f, fx += double(f) * c->first;
    if (n == 0) continue;
    spread += ff - f_sum * f_sum / n;
    together += fx - f_sum * x_sum / n;
  }
  if (!(spread > 0)) return;
  const double pace = together / spread;
  if (!(pace >= kSlowest_px)) return passes.clear();
  for (Pass& pass : passes) {  // turned about its middle frame
    const double middle = 0.5 * (pass.from + pass.to);
    pass.at += (pass.pace - pace) * middle;
    pass.pace = pace;
  }
}

// Every pass of the head, in time.
std::vector<Pass> passesOf(const EcgCurve& curve) {
  std::vector<bool> used(curve.changed.size(), false);
  std::vector<Pass> passes;
  constexpr std::size_t kMost = 40;
  while (passes.size() < kMost) {
    Pass pass = bestPass(curve, used, passes.empty() ? 0 : passes.front().pace);
    if (pass.frames < (passes.empty() ? 5 : 2)) break;
    leaveErasing(curve, used, pass);
    if (pass.to < pass.from) break;
    for (int f = pass.from; f <= pass.to; ++f) used[static_cast<std::size_t>(f)] = true;
    passes.push_back(pass);
  }
  std::sort(passes.begin(), passes.end(),
            [](const Pass& a, const Pass& b) { return a.from < b.from; });
  settleTogether(curve, passes);
  return passes;
}

// How wide the head is: what changes beyond its step.
double headWidth(const EcgCurve& curve, const std::vector<Pass>& passes, bool still) {
  std::vector<double> widths;
  for (const Pass& pass : passes)
    for (int f = pass.from; f <= pass.to; ++f)
      if (const auto* c = onPass(pass, curve.changed[static_cast<std::size_t>(f)], f))
        widths.push_back(c->width());
  const double width = medianOf(widths), pace = passes.front().pace;
  return width > pace ? width - pace : still ? width : 0;
}

class Heads {
 public:
  Heads(const EcgCurve& curve, std::vector<Pass> passes)
      : curve_(curve),
        passes_(std::move(passes)),
        last_(static_cast<int>(curve.changed.size()) - 1) {
    reach_ = std::max(2.0, headWidth(curve, passes_, true)) + 2;
    still_ = isStill();
    width_ = headWidth(curve, passes_, still_);
  }

  double pace() const { return passes_.front().pace; }
  bool still() const { return still_; }

  // Frames after the first in which something changed, and that a pass explains.
  double explained() const {
    double moved = 0, explained = 0;
    for (int f = 1; f <= last_; ++f) {
      if (curve_.changed[static_cast<std::size_t>(f)].empty()) continue;
      ++moved;
      for (const Pass& p : passes_)
        if (f >= p.from && f <= p.to && onPass(p, curve_.changed[static_cast<std::size_t>(f)], f)) {
          ++explained;
          break;
        }
    }
    return moved > 0 ? explained / moved : 0;
  }

  // The columns at the head of a frame change in the next one: the last drawn column lies before
  // their left end, the middle of a marker half its width behind it.
  double instantOf(const Pass& pass, double column) const {
    return (column + 0.5 - 0.5 * width_ - pass.at) / pass.pace - 1;
  }

  EcgSignal signal() const {
    EcgSignal out;
    out.kind = still_ ? "still, with a marker" : "sweeping";
    out.px_per_frame = pace();
    out.confidence = explained();
    const int columns = curve_.band.columns();
    if (still_) {
      for (int x = 0; x < columns; ++x) out.height_px.push_back(usualHeight(x));
      out.first_frame = instantOf(passes_.front(), 0);
      return out;
    }
    // Passes follow one another without a gap in time; what one leaves out the next has not.
    out.first_frame = instantOf(passes_.front(), 0);
    for (const Pass& pass : passes_) {
      const Pass* next = &pass == &passes_.back() ? nullptr : &pass + 1;
      for (int x = 0; x < columns; ++x) {
        const double instant = instantOf(pass, x);
        if (instant > last_ || (next != nullptr && instant >= instantOf(*next, 0))) break;
        const auto at = static_cast<std::ptrdiff_t>(
            std::lround((instant - out.first_frame) * out.px_per_frame));
        if (at < static_cast<std::ptrdiff_t>(out.height_px.size())) continue;
        out.height_px.resize(static_cast<std::size_t>(at) + 1, kHidden);
        out.height_px.back() = newHeight(x, instant);
      }
    }
    return out;
  }

 private:
  double heightAt(int x, int frame) const {
    const float h = curve_.height_px[static_cast<std::size_t>(frame)][static_cast<std::size_t>(x)];
    return std::isnan(h) ? kHidden : static_cast<double>(h);
  }
  // Once the head has left.
  double newHeight(int x, double instant) const {
    const double clear = std::ceil(instant + 1 + reach_ / pace());
    return heightAt(x, std::clamp(static_cast<int>(clear), 0, last_));
  }
  double usualHeight(int x) const {
    std::vector<double> values;
    for (int f = 0; f <= last_; ++f)
      if (const double h = heightAt(x, f); !std::isnan(h)) values.push_back(h);
    return 2 * values.size() > curve_.height_px.size() ? medianOf(values) : kHidden;
  }
  // The same before the head came and after it left, in 95 % of the columns that it passed. Our
  // choice.
  bool isStill() const {
    double passed = 0, other = 0;
    const double step = std::max(2.5, 2 * curve_.thickness_px);
    for (const Pass& pass : passes_)
      for (int x = 0; x < curve_.band.columns(); ++x) {
        const double instant = instantOf(pass, x);
        const auto before = static_cast<int>(std::floor(instant - 1 - 2 * reach_ / pace())),
                   after = static_cast<int>(std::ceil(instant + 1 + 2 * reach_ / pace()));
        if (before < 0 || after > last_) continue;
        const double a = heightAt(x, before), b = heightAt(x, after);
        ++passed;
        if (std::isnan(a) != std::isnan(b) || std::abs(a - b) > step) ++other;
      }
    return passed > 0 && other < 0.05 * passed;
  }

  const EcgCurve& curve_;
  std::vector<Pass> passes_;
  int last_;
  double reach_ = 2, width_ = 0;
  bool still_ = false;
};

}  // namespace

std::optional<EcgSignal> signalOfHead(const EcgCurve& curve) {
  std::vector<Pass> passes = passesOf(curve);
  if (passes.empty()) return std::nullopt;
  return Heads(curve, std::move(passes)).signal();
}

}  // namespace echocine::echo
