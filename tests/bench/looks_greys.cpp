#include "looks_greys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/hash_random.h"
#include "metrics/statistics.h"
#include "motion/heart/heart_scene.h"
#include "scene/grey_curve.h"
#include "scene/role.h"
#include "scene/view_names.h"
#include "signal/signal_chain.h"

namespace echocine::bench {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct GreyMeasures {
  double black = 0, p1 = 0, p50 = 0, p95 = 0, p999 = 0;  // of the sector; black: share under 10
  double lv = kNone, la = kNone, ra = kNone, rv = kNone, wall = kNone, pericardium = kNone;
  double near_field = kNone;  // first 15 mm
  double lung = kNone;
  double lost = kNone;  // share of the endocardium that is less than 3 dB brighter than blood
};

double quantile(std::vector<double> values, double q) {
  if (values.size() < 50) return kNone;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

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

std::vector<double> greysWhere(const Labelled& picture,
                               const std::function<bool(int, int)>& counts) {
  std::vector<double> greys;
  for (int y = 0; y < picture.image.height; ++y)
    for (int x = 0; x < picture.image.width; ++x)
      if (picture.inSector(x, y) && counts(x, y))
        greys.push_back(picture.image.pixels[picture.at(x, y)]);
  return greys;
}

// Mean level, dB above black, of the pixels within 1 mm that have the role; NaN with hardly any.
double levelAround(const Labelled& picture, double x, double y, Role role) {
  const GreyCurve curve(picture.simulator.scene().signal);
  const int reach = std::max(1, static_cast<int>(std::lround(1 / picture.mm())));
  double sum = 0;
  int count = 0;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i) {
      const int px = static_cast<int>(x) + i, py = static_cast<int>(y) + j;
      if (!picture.inside(px, py) || !picture.inSector(px, py) || picture.role(px, py) != role)
        continue;
      sum += curve.inverse(picture.image.pixels[picture.at(px, py)] / 255.0);
      ++count;
    }
  const int whole = (2 * reach + 1) * (2 * reach + 1);
  return 2 * count < whole ? kNone
                           : sum / count * picture.simulator.scene().signal.dynamic_range_db;
}

// Along the normal of the border at a cavity pixel: how much the wall's first 2.5 mm exceed blood.
double stepAt(const Labelled& picture, int x, int y) {
  const int reach = std::max(2, static_cast<int>(std::lround(3 / picture.mm())));
  double nx = 0, ny = 0;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i)
      if (picture.inside(x + i, y + j) && picture.role(x + i, y + j) == Role::lv_wall)
        nx += i, ny += j;
  const double length = std::hypot(nx, ny);
  if (length == 0) return kNone;
  const double step = 1.5 / picture.mm() / length;
  return levelAround(picture, x + nx * step, y + ny * step, Role::lv_wall) -
         levelAround(picture, x - 2 * nx * step, y - 2 * ny * step, Role::lv_cavity);
}

double lostBorder(const Labelled& picture) {
  int lost = 0, all = 0;
  for (int y = 1; y + 1 < picture.image.height; ++y)
    for (int x = 1; x + 1 < picture.image.width; ++x) {
      if (picture.role(x, y) != Role::lv_cavity) continue;
      if (picture.role(x - 1, y) != Role::lv_wall && picture.role(x + 1, y) != Role::lv_wall &&
          picture.role(x, y - 1) != Role::lv_wall && picture.role(x, y + 1) != Role::lv_wall)
        continue;
      const double step = stepAt(picture, x, y);
      if (std::isnan(step)) continue;
      ++all;
      lost += step < 3;
    }
  return all < 50 ? kNone : static_cast<double>(lost) / all;
}

GreyMeasures greysOf(const Labelled& picture) {
  GreyMeasures g;
  const std::vector<double> sector = greysWhere(picture, [](int, int) { return true; });
  g.black = static_cast<double>(
                std::count_if(sector.begin(), sector.end(), [](double v) { return v < 10; })) /
            static_cast<double>(sector.size());
  g.p1 = quantile(sector, 0.01), g.p50 = quantile(sector, 0.5);
  g.p95 = quantile(sector, 0.95), g.p999 = quantile(sector, 0.999);
  const auto median = [&](Role role) {
    return quantile(greysWhere(picture, [&](int x, int y) { return picture.role(x, y) == role; }),
                    0.5);
  };
  g.lv = median(Role::lv_cavity), g.la = median(Role::la), g.ra = median(Role::ra);
  g.rv = median(Role::rv_cavity), g.wall = median(Role::lv_wall);
  g.near_field =
      quantile(greysWhere(picture, [&](int x, int y) { return picture.depth_mm(x, y) < 15; }), 0.5);
  g.pericardium = quantile(greysWhere(picture,
                                      [&](int x, int y) {
                                        const Structure* s = picture.structure(x, y);
                                        return s && s->name == "grooves";
                                      }),
                           0.9);
  g.lung = quantile(greysWhere(picture,
                               [&](int x, int y) {
                                 const Structure* s = picture.structure(x, y);
                                 return s && s->name.starts_with("lung");
                               }),
                    0.5);
  g.lost = lostBorder(picture);
  return g;
}

struct GreyColumn {
  const char* name;
  double GreyMeasures::*value;
  int digits;
};
constexpr GreyColumn kGreyColumns[] = {{"< 10, %", &GreyMeasures::black, 1},
                                       {"p1", &GreyMeasures::p1, 0},
                                       {"p50", &GreyMeasures::p50, 0},
                                       {"p95", &GreyMeasures::p95, 0},
                                       {"p99.9", &GreyMeasures::p999, 0},
                                       {"LV", &GreyMeasures::lv, 0},
                                       {"LA", &GreyMeasures::la, 0},
                                       {"RA", &GreyMeasures::ra, 0},
                                       {"RV", &GreyMeasures::rv, 0},
                                       {"wall", &GreyMeasures::wall, 0},
                                       {"grooves p90", &GreyMeasures::pericardium, 0},
                                       {"near field", &GreyMeasures::near_field, 0},
                                       {"lung", &GreyMeasures::lung, 0},
                                       {"border lost, %", &GreyMeasures::lost, 1}};

void printRow(const std::string& name, const std::vector<GreyMeasures>& hearts) {
  fmt::print("| {} |", name);
  for (const GreyColumn& column : kGreyColumns) {
    std::vector<double> values;
    for (const GreyMeasures& g : hearts)
      if (!std::isnan(g.*column.value)) values.push_back(g.*column.value);
    if (values.empty()) {
      fmt::print(" |");
      continue;
    }
    const double median = quartilesOf(values).median;
    fmt::print(" {:.{}f} |", column.digits == 1 ? 100 * median : median, column.digits);
  }
  fmt::print("\n");
}

}  // namespace

void printGreys(const LookHearts& options) {
  fmt::print("| view |");
  for (const GreyColumn& column : kGreyColumns) fmt::print(" {} |", column.name);
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < std::size(kGreyColumns); ++i) fmt::print("---|");
  fmt::print("\n");
  for (const ViewName& view : viewNames()) {
    if (!options.view.empty() && options.view != view.key) continue;
    std::vector<GreyMeasures> columns[2];
    for (int h = 0; h < options.hearts; ++h) {
      Scene scene = heart::heartScene(parametersOf(h), view.view, 12);
      takeTables(options, scene);
      seedScene(h, scene);
      const double es_s =
          scene.motion.end_systole_phase.value_or(0.35) / scene.acquisition.heart_rate_hz;
      const Simulator simulator(std::move(scene));
      for (const int instant : {0, 1}) {
        const Frame frame = simulator.frame(instant == 0 ? 0 : es_s);
        if (!options.save.empty())
          savePgm(fmt::format("{}/{}_{}_{}.pgm", options.save, view.key, instant, h), frame.image);
        columns[instant].push_back(
            greysOf({simulator, frame.image, idsOf(simulator, frame.time.phase)}));
      }
    }
    printRow(fmt::format("{} ED", view.key), columns[0]);
    printRow(fmt::format("{} ES", view.key), columns[1]);
    std::fflush(stdout);
  }
}

}  // namespace echocine::bench
