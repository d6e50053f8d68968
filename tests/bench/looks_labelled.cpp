#include "looks_labelled.h"

#include <algorithm>

#include "core/units.h"
#include "scene/grey_curve.h"

namespace echocine::bench {

double quantile(std::vector<double> values, double q) {
  if (values.size() < 50) return kNone;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

std::vector<double> greysWhere(const Labelled& picture,
                               const std::function<bool(int, int)>& counts) {
  std::vector<double> greys;
  for (int y = 0; y < picture.image.height; ++y)
    for (int x = 0; x < picture.image.width; ++x)
      if (picture.inSector(x, y) && counts(x, y))
        greys.push_back(picture.image.pixels[picture.at(x, y)]);
  return greys;
}

namespace {

using Mask = std::vector<char>;  // by pixel

// The pixels within a box of some millimetres to each side of a pixel that counts.
Mask within(const Labelled& picture, double mm, const std::function<bool(int, int)>& counts) {
  const int reach = static_cast<int>(std::lround(mm / picture.mm()));
  const int width = picture.image.width, height = picture.image.height;
  Mask rows(picture.ids.size()), out(picture.ids.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (counts(x, y))
        for (int i = std::max(x - reach, 0); i <= std::min(x + reach, width - 1); ++i)
          rows[picture.at(i, y)] = 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (rows[picture.at(x, y)])
        for (int j = std::max(y - reach, 0); j <= std::min(y + reach, height - 1); ++j)
          out[picture.at(x, j)] = 1;
  return out;
}

Mask withinRole(const Labelled& picture, double mm, Role role) {
  return within(picture, mm, [&](int x, int y) { return picture.role(x, y) == role; });
}

// Mean intensity over black, where a pixel counts.
double meanIntensity(const Labelled& picture, const std::function<bool(int, int)>& counts) {
  const SignalSettings& signal = picture.simulator.scene().signal;
  const GreyCurve curve(signal);
  double sum = 0;
  const std::vector<double> greys = greysWhere(picture, counts);
  for (const double grey : greys)
    sum += intensityFromDecibels(signal.dynamic_range_db * curve.inverse(grey / 255));
  return greys.size() < 50 ? kNone : sum / static_cast<double>(greys.size());
}

}  // namespace

FibrousGreys fibrousGreys(const Labelled& picture) {
  const auto isLung = [&](int x, int y) {
    const Structure* s = picture.structure(x, y);
    return s && s->name.starts_with("lung");
  };
  const Mask by_lung = within(picture, 2, isLung), by_la = withinRole(picture, 4, Role::la),
             by_lv = withinRole(picture, 4, Role::lv_cavity),
             by_wall = withinRole(picture, 4, Role::lv_wall);
  const auto isPericardium = [&](int x, int y) { return picture.role(x, y) == Role::pericardium; };
  const auto isPleura = [&](int x, int y) {
    return by_lung[picture.at(x, y)] && !isLung(x, y) && picture.depth_mm(x, y) > 20;
  };
  const auto isHinge = [&](int x, int y) {
    const std::size_t i = picture.at(x, y);
    const Role role = picture.role(x, y);
    return by_la[i] && by_lv[i] && by_wall[i] && role != Role::la && role != Role::lv_cavity;
  };
  FibrousGreys out;
  out.pericardium = quantile(greysWhere(picture, isPericardium), 0.9);
  out.pleura = quantile(greysWhere(picture, isPleura), 0.9);
  out.hinge = quantile(greysWhere(picture, isHinge), 0.9);
  const Mask all = within(picture, 2, [&](int x, int y) {
    return isPericardium(x, y) || isPleura(x, y) || isHinge(x, y);
  });
  const double bright = quantile(greysWhere(picture, [](int, int) { return true; }), 0.99);
  const auto isBright = [&](int x, int y) {
    return picture.image.pixels[picture.at(x, y)] >= bright;
  };
  const auto isBoth = [&](int x, int y) { return isBright(x, y) && all[picture.at(x, y)] != 0; };
  out.brightest = static_cast<double>(greysWhere(picture, isBoth).size()) /
                  static_cast<double>(greysWhere(picture, isBright).size());
  // Muscle without the fibrous ring.
  const Mask at_ring = withinRole(picture, 10, Role::la);
  const auto isMuscle = [&](int x, int y) {
    return picture.role(x, y) == Role::lv_wall && !at_ring[picture.at(x, y)];
  };
  out.above_wall_db = decibelsFromIntensity(meanIntensity(picture, isPericardium) /
                                            meanIntensity(picture, isMuscle));
  return out;
}

}  // namespace echocine::bench
