#pragma once
// Hearts with a defect of the septum: without motion, thicker by a bump, or with a hole.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "fit/fit_regions.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/recording.h"
#include "support/view_loops.h"

namespace echocine::support {

enum class Defect { none, still, thick, hole };
inline constexpr Defect kDefects[] = {Defect::none, Defect::still, Defect::thick, Defect::hole};
inline const char* nameOf(Defect defect) {
  return defect == Defect::none    ? "none"
         : defect == Defect::still ? "still septum"
         : defect == Defect::thick ? "thick septum"
                                   : "hole in the septum";
}

// Septal segments of the left ventricle: basal, mid, apical.
inline constexpr int kSeptum[] = {2, 3, 8, 9, 14};

// Moves the inner surface of the septum by `height_m` into the cavity (negative: into the wall), in
// a bell of this radius about the middle of the septum. The same material moves at all times.
inline void bulge(heart::Recording& recording, double height_m, double radius_m) {
  for (heart::RecordedPart& part : recording.parts) {
    if (part.kind.name != "lv_cavity") continue;
    const std::vector<Vec3d>& rest = part.control_m.front();
    double base = rest.front().z, apex = base;
    for (const Vec3d p : rest) base = std::min(base, p.z), apex = std::max(apex, p.z);
    // The septum lies on the side of negative x.
    Vec3d centre = rest.front();
    double least = 1;
    for (const Vec3d p : rest) {
      const double off = std::hypot(p.z - (0.55 * base + 0.45 * apex), p.y) - 0.5 * p.x;
      if (p.x < 0 && off < least) least = off, centre = p;
    }
    for (std::vector<Vec3d>& control : part.control_m)
      for (std::size_t i = 0; i < control.size(); ++i) {
        const double away = length(rest[i] - centre) / radius_m;
        if (rest[i].x < 0) control[i].x += height_m * std::exp(-away * away);
      }
  }
}

// A scene of a heart of these dials with a defect. The other dials are unchanged: the ejection
// fraction of a heart with a still septum is lower.
inline Scene defectScene(const std::map<std::string, double>& dials, Defect defect, View view,
                         int keyframes, Look look) {
  heart::Parameters parameters = heart::parametersFrom(dials);
  if (defect == Defect::still)
    for (const int segment : kSeptum)
      parameters.segments[static_cast<std::size_t>(segment - 1)].amplitude = 0;
  heart::Recording recording = heart::record(heart::ParametricHeart(parameters), view, keyframes);
  if (defect == Defect::thick) bulge(recording, 5e-3, 15e-3);
  if (defect == Defect::hole) bulge(recording, -14e-3, 8e-3);
  return heart::sceneOf(view, parameters, recording, look);
}

// A perfect model of a scene: its beat, and maps against its own loops.
struct PerfectModel {
  fit::ModelLoop model;
  std::vector<fit::FitMap> twins;

  explicit PerfectModel(const Scene& scene) : model(modelOf(scene)) {
    fit::RenderedBeats rendered(scene, fit::kFitFrames);
    for (int twin = 0; twin < fit::kTwins; ++twin) {
      const echo::EchoLoop own = rendered.loop(71 + twin);
      const fit::ModelDiscrepancy d(own, knownBeat(), model);
      twins.push_back(d.map(model, d.refine(model, {fit::FitPose{}}).pose));
    }
  }
  // The pose is sought; dials and beat are known.
  std::vector<fit::RegionFinding> against(const echo::EchoLoop& loop) const {
    const fit::ModelDiscrepancy d(loop, knownBeat(), model);
    fit::FitReport report;
    report.map = d.map(model, d.search(model).pose);
    report.structures = model.structures;
    report.systole = model.systole;
    return fit::regionFindings(report, twins, fit::kKnownDials);
  }

 private:
  static fit::ModelLoop modelOf(const Scene& scene) {
    const MeshMotion motion(scene);
    return fit::modelLoop(scene, motion, fit::kFitFrames, fit::wallSegments(scene, motion));
  }
  echo::SideOptions knownBeat() const {
    echo::SideOptions side;
    side.ed_frame = 0;
    side.es_frame = model.systole * fit::kFitFrames;
    return side;
  }
};

// Detection of a defect of the septum by the findings.
struct Detected {
  int significant = 0;     // regions
  bool in_septum = false;  // the segment of the largest deviation is septal, and significant
};
inline Detected detectedBy(const std::vector<fit::RegionFinding>& regions) {
  Detected out;
  const fit::RegionFinding* largest = nullptr;
  for (const fit::RegionFinding& r : regions) {
    out.significant += r.significant ? 1 : 0;
    if (r.segment > 0 && r.significant && (!largest || r.deviations() > largest->deviations()))
      largest = &r;
  }
  out.in_septum = largest && std::find(std::begin(kSeptum), std::end(kSeptum),
                                       static_cast<int>(largest->segment)) != std::end(kSeptum);
  return out;
}

}  // namespace echocine::support
