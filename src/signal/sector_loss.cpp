#include "signal/sector_loss.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/units.h"
#include "scene/scan_geometry.h"
#include "signal/chest_screen.h"

namespace echocine {

double dropoutFactor(double s, double loss_db) {
  return intensityFromDecibels(-loss_db * s * s * s * s);
}

// The path from (x', z') of the aperture to (x, z) passes the ribs' depth d at x' (1 - q) + x q,
// q = (d - z') / (z - z').
double RibGap::openPart(double start_x_m, double x_m, double z_m, double start_z_m) const {
  if (!(z_m > depth_m)) return 1;
  const double share = (depth_m - start_z_m) / (z_m - start_z_m), at_m = x_m * share,
               scale = 1 - share;
  const double left_m = (offset_m - width_m / 2 - at_m) / scale,
               right_m = (offset_m + width_m / 2 - at_m) / scale;
  const double first_m = start_x_m - aperture_m / 2, last_m = start_x_m + aperture_m / 2;
  const double open_m = std::min(right_m, last_m) - std::max(left_m, first_m);
  return std::clamp(open_m / aperture_m, 0.0, 1.0);
}

double RibGap::factor(double start_x_m, double x_m, double z_m, double start_z_m) const {
  const double open = openPart(start_x_m, x_m, z_m, start_z_m);
  const double amplitude = open + (1 - open) * intensityFromDecibels(-shadow_db / 4);
  return amplitude * amplitude * amplitude * amplitude;
}

std::vector<float> sectorLosses(const Probe& probe, const ArtefactSettings& settings,
                                const EffectPlan& plan) {
  if (!plan.dropout && !plan.acoustic_window && !plan.shading) return {};
  const RibGap gap{probe.aperture_m, settings.window_width_m, settings.window_offset_m,
                   settings.window_depth_m, settings.window_shadow_db};
  std::optional<ChestScreen> screen;
  if (plan.shading) screen.emplace(probe, settings);
  const ScanGeometry geometry(probe);
  std::vector<float> factors;
  for (int i = 0; i < probe.lines; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    const double start_z_m = line.origin.z - probe.face_radius_m;  // behind a curved face's middle
    const double s = probe.lines > 1 ? 2.0 * i / (probe.lines - 1) - 1 : 0;
    const double edge = plan.dropout ? dropoutFactor(s, settings.dropout_db) : 1;
    for (int k = 0; k < probe.samples; ++k) {
      const Vec3d at = line.origin + geometry.sampleDepth(k) * line.direction;
      const double x_m = at.x, z_m = at.z - probe.face_radius_m;
      const double ribs = plan.acoustic_window ? gap.factor(line.origin.x, x_m, z_m, start_z_m) : 1;
      const double patches = screen ? screen->factor(line.origin.x, x_m, z_m, start_z_m) : 1;
      factors.push_back(static_cast<float>(edge * ribs * patches));
    }
  }
  return factors;
}

void applySectorLosses(std::span<const float> factors, std::span<float> plane) {
  for (std::size_t i = 0; i < factors.size(); ++i) plane[i] *= factors[i];
}

}  // namespace echocine
