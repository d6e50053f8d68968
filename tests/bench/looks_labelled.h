#pragma once
// A simulated picture with the structure of each pixel, and quantiles of its greys.

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "frame/simulator.h"
#include "scene/role.h"
#include "signal/signal_chain.h"

namespace echocine::bench {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A picture with the structure of each pixel, and places in it by mm.
struct Labelled {
  const Simulator& simulator;
  const GreyImage& image;
  const std::vector<std::uint16_t>& ids;

  double mm() const { return 1e3 * simulator.chain().geometry().metres_per_pixel; }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x);
  }
  bool inside(int x, int y) const {
    return x >= 0 && y >= 0 && x < image.width && y < image.height;
  }
  const Structure* structure(int x, int y) const {
    const std::uint16_t id = ids[at(x, y)];
    return id == 0 ? nullptr : &simulator.scene().structures[id - 1u];
  }
  Role role(int x, int y) const {
    const Structure* s = structure(x, y);
    return s ? roleOf(*s) : Role::none;
  }
  double depth_mm(int x, int y) const {
    const PictureGeometry& g = simulator.chain().geometry();
    return mm() * std::hypot(x + 0.5 - g.origin_x_px, y + 0.5 - g.origin_y_px);
  }
  bool inSector(int x, int y) const {
    const PictureGeometry& g = simulator.chain().geometry();
    const Probe& p = simulator.scene().probe;
    const double angle = std::atan2(x + 0.5 - g.origin_x_px, y + 0.5 - g.origin_y_px);
    const double r = depth_mm(x, y);
    return angle > p.first_angle_rad && angle < p.last_angle_rad && r > 1e3 * p.min_depth_m &&
           r < 1e3 * p.max_depth_m;
  }
};

// NaN for fewer than 50 values.
double quantile(std::vector<double> values, double q);

// Greys of the sector's pixels that count.
std::vector<double> greysWhere(const Labelled& picture,
                               const std::function<bool(int, int)>& counts);

// The brightest structures of clinical pictures. Pleura: the last 2 mm before the lung, from 20 mm
// of depth on. Hinges of the mitral valve: all but blood within 4 mm of the left atrium, the
// ventricle and its wall. NaN with hardly any pixels.
struct FibrousGreys {
  double pericardium = kNone, pleura = kNone, hinge = kNone;  // 0.9 quantiles
  double brightest = kNone;  // share of the sector's brightest 1 % that lies within 2 mm of these
  double above_wall_db = kNone;  // mean intensity of the pericardium over that of the left wall
};
FibrousGreys fibrousGreys(const Labelled& picture);

}  // namespace echocine::bench
