#include "compare/view_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "compare/wall_edges.h"
#include "core/parallel.h"
#include "core/units.h"

namespace echocine::compare {

namespace {

// A shift in parts of the outer radius, and a turn.
struct Pose {
  double x = 0, y = 0, rotation_rad = 0;
};

const double kMostRotation_rad = radiansFromDegrees(kSearchRotation_deg);

// The lattice's outermost poses lie on the limits within rounding, and are allowed.
bool withinLimits(const Pose& p) {
  constexpr double kRounding = 1e-9;
  return std::abs(p.x) <= kSearchShift + kRounding && std::abs(p.y) <= kSearchShift + kRounding &&
         std::abs(p.rotation_rad) <= kMostRotation_rad + kRounding;
}

// The mean over the loop: where walls run on the whole, without what moves, so time need not be
// known yet.
std::vector<float> meanOf(const std::vector<std::vector<float>>& frames) {
  std::vector<float> mean(frames.front().size(), 0);
  const float share = 1 / static_cast<float>(frames.size());
  for (const std::vector<float>& frame : frames)
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += share * frame[i];
  return mean;
}

class ViewSearch {
 public:
  ViewSearch(const BeamGrid& grid, const BeamLoop& synthetic, const Loop& real)
      : real_(real), edges_(grid, areaWeights(grid, synthetic.valid, synthetic.valid)) {
    synthetic_ = edges_(meanOf(synthetic.frames));
    smoothMean(kSmoothingShare * edges_.depth() * pixelsPerUnit(grid, real));
    std::vector<float> greys, weights;
    sample({}, greys, weights);
    for (const float w : weights) as_given_ += w;
  }

  Placement placement(const Pose& p) const {
    const double radius = real_.sector().r_max;
    return {p.x * radius, p.y * radius, 1, p.rotation_rad};
  }

  // c G; least where too little is left in sight.
  double operator()(const Pose& pose) const {
    std::vector<float> greys, weights;
    sample(pose, greys, weights);
    double in_sight = 0;
    for (const float w : weights) in_sight += w;
    const double share = as_given_ > 0 ? std::min(1.0, in_sight / as_given_) : 0;
    // Half of the sector must stay: a pose that shows a corner alone may fit it by chance.
    if (share < 0.5) return -1;
    return share *
           edgeCorrelation(synthetic_, edgesOf(edges_.lattice(), greys, weights, edges_.depth()));
  }

 private:
  // The mean of the real loop, smoothed within its sector.
  void smoothMean(double sigma_px) {
    const Video& v = real_.video;
    cv::Mat sum = cv::Mat::zeros(v.height, v.width, CV_32F), mask(v.height, v.width, CV_32F);
    for (const PixelPlane& frame : v.frames)
      cv::accumulate(cv::Mat(v.height, v.width, CV_8U, const_cast<std::uint8_t*>(frame.data())),
                     sum);
    inside_.resize(real_.overlay.size());
    for (int y = 0; y < v.height; ++y)
      for (int x = 0; x < v.width; ++x) {
        const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(v.width) +
                        static_cast<std::size_t>(x);
        inside_[at] = real_.sector().contains(x + 0.5, y + 0.5) && real_.overlay[at] == 0 ? 1 : 0;
        mask.at<float>(y, x) = inside_[at];
      }
    sum = sum.mul(mask, 1.0 / static_cast<double>(v.frames.size()));
    // Greys and mask are smoothed alike and divided: the sector's own edge makes no edge.
    for (cv::Mat* m : {&sum, &mask})
      cv::GaussianBlur(*m, *m, {0, 0}, sigma_px, sigma_px, cv::BORDER_CONSTANT);
    mean_ = sum / cv::max(mask, 1e-6);
  }

  void sample(const Pose& pose, std::vector<float>& greys, std::vector<float>& weights) const {
    const BeamGrid& g = edges_.lattice();
    const Video& v = real_.video;
    const Placement p = placement(pose);
    greys.assign(g.size(), 0);
    weights.assign(g.size(), 0);
    const double unit = pixelsPerUnit(g, real_), x0 = real_.sector().apex_x + p.shift_x_px,
                 y0 = real_.sector().apex_y + p.shift_y_px;
    std::size_t at = 0;
    for (int i = 0; i < g.lines; ++i) {
      const double angle = g.angle(i) + p.rotation_rad, sine = std::sin(angle),
                   cosine = std::cos(angle);
      for (int k = 0; k < g.samples; ++k, ++at) {
        const double r = unit * g.depth(k), x = x0 + r * sine, y = y0 + r * cosine;
        if (!(x >= 0 && y >= 0 && x < v.width && y < v.height)) continue;
        if (inside_[static_cast<std::size_t>(y) * static_cast<std::size_t>(v.width) +
                    static_cast<std::size_t>(x)] == 0)
          continue;
        greys[at] = greyAt(mean_.ptr<float>(), v.width, v.height, x, y);
        weights[at] = static_cast<float>(g.depth(k) / edges_.depth());
      }
    }
  }

  const Loop& real_;
  WallEdges edges_;
  EdgeField synthetic_;
  cv::Mat mean_;
  PixelPlane inside_;
  double as_given_ = 0;
};

struct ViewCandidate {
  Pose pose;
  double value = -2;
};

// Every pose of the lattice, in a fixed order.
std::vector<ViewCandidate> wholeLattice(const ViewSearch& search) {
  constexpr int kShifts = 5, kRotations = 3;  // each way
  std::vector<ViewCandidate> all;
  for (int r = -kRotations; r <= kRotations; ++r)
    for (int y = -kShifts; y <= kShifts; ++y)
      for (int x = -kShifts; x <= kShifts; ++x)
        all.push_back({{kSearchShift * x / kShifts, kSearchShift * y / kShifts,
                        kMostRotation_rad * r / kRotations}});
  parallelBlocks(all.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) all[i].value = search(all[i].pose);
  });
  return all;
}

// Steps that halve, each taken as long as any direction gains: down to 0.2 % of the radius, a
// pixel.
void climb(const ViewSearch& search, ViewCandidate& best) {
  for (double step = kSearchShift / 10; step > 0.002; step /= 2)
    for (bool better = true; better;) {
      better = false;
      const Pose from = best.pose;
      for (const auto& [x, y, turn] :
           {std::array{step, 0.0, 0.0}, std::array{-step, 0.0, 0.0}, std::array{0.0, step, 0.0},
            std::array{0.0, -step, 0.0}, std::array{0.0, 0.0, 2 * step},
            std::array{0.0, 0.0, -2 * step}}) {
        const Pose pose{from.x + x, from.y + y, from.rotation_rad + turn};
        if (!withinLimits(pose)) continue;
        const double value = search(pose);
        if (value > best.value + 1e-9) best = {pose, value}, better = true;
      }
    }
}

}  // namespace

SpaceAlignment searchView(const BeamGrid& grid, const BeamLoop& synthetic, const Loop& real) {
  const ViewSearch search(grid, synthetic, real);
  std::vector<ViewCandidate> all = wholeLattice(search);
  SpaceAlignment out;
  out.correlation_before = search({});
  // Several hills are climbed, for the highest point of the lattice need not stand on the highest.
  constexpr std::size_t kBest = 6;
  std::stable_sort(all.begin(), all.end(),
                   [](const ViewCandidate& a, const ViewCandidate& b) { return a.value > b.value; });
  all.resize(kBest);
  parallelBlocks(kBest, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) climb(search, all[i]);
  });
  const ViewCandidate best =
      *std::max_element(all.begin(), all.end(),
                        [](const ViewCandidate& a, const ViewCandidate& b) { return a.value < b.value; });
  // Our choice: a search always gains a little by chance.
  constexpr double kLeastGain = 0.02;
  out.correlation_after = best.value;
  out.used = best.value > out.correlation_before + kLeastGain;
  if (out.used) out.method = "search for the view";
  out.placement = search.placement(best.pose);
  constexpr double kNearLimit = 0.99;
  out.at_limit = std::abs(best.pose.x) > kNearLimit * kSearchShift ||
                 std::abs(best.pose.y) > kNearLimit * kSearchShift ||
                 std::abs(best.pose.rotation_rad) > kNearLimit * kMostRotation_rad;
  out.confidence = std::clamp(best.value, 0.0, 1.0);
  return out;
}

}  // namespace echocine::compare
