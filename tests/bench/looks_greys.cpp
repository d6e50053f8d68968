#include "looks_greys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "looks_labelled.h"
#include "metrics/statistics.h"
#include "motion/heart/heart_scene.h"
#include "scene/grey_curve.h"
#include "scene/view_names.h"

namespace echocine::bench {

namespace {

struct GreyMeasures : FibrousGreys {
  double black = 0, p1 = 0, p50 = 0, p95 = 0, p99 = 0,
         p999 = 0;  // of the sector; black: share under 10
  double lv = kNone, la = kNone, ra = kNone, rv = kNone, wall = kNone;
  double near_field = kNone;  // first 15 mm
  double lung = kNone;
  double lost = kNone;  // share of the endocardium that is less than 3 dB brighter than blood
};

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
  g.p95 = quantile(sector, 0.95), g.p99 = quantile(sector, 0.99), g.p999 = quantile(sector, 0.999);
  const auto median = [&](Role role) {
    return quantile(greysWhere(picture, [&](int x, int y) { return picture.role(x, y) == role; }),
                    0.5);
  };
  g.lv = median(Role::lv_cavity), g.la = median(Role::la), g.ra = median(Role::ra);
  g.rv = median(Role::rv_cavity), g.wall = median(Role::lv_wall);
  g.near_field =
      quantile(greysWhere(picture, [&](int x, int y) { return picture.depth_mm(x, y) < 15; }), 0.5);
  static_cast<FibrousGreys&>(g) = fibrousGreys(picture);
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
  double scale = 100;  // of a value with a digit: shares are percentages
};
constexpr GreyColumn kGreyColumns[] = {
    {"< 10, %", &GreyMeasures::black, 1},
    {"p1", &GreyMeasures::p1, 0},
    {"p50", &GreyMeasures::p50, 0},
    {"p95", &GreyMeasures::p95, 0},
    {"p99", &GreyMeasures::p99, 0},
    {"p99.9", &GreyMeasures::p999, 0},
    {"LV", &GreyMeasures::lv, 0},
    {"LA", &GreyMeasures::la, 0},
    {"RA", &GreyMeasures::ra, 0},
    {"RV", &GreyMeasures::rv, 0},
    {"wall", &GreyMeasures::wall, 0},
    {"pericardium p90", &GreyMeasures::pericardium, 0},
    {"pleura p90", &GreyMeasures::pleura, 0},
    {"hinge p90", &GreyMeasures::hinge, 0},
    {"brightest at these, %", &GreyMeasures::brightest, 1},
    {"pericardium / wall, dB", &GreyMeasures::above_wall_db, 1, 1},
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
    fmt::print(" {:.{}f} |", column.digits == 1 ? column.scale * median : median, column.digits);
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
    for (int h = options.first; h < options.first + options.hearts; ++h) {
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
