#pragma once
// Disagreement of a model with a loop, with the loop's pictures, for pages and files.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "fit/plane_tilt.h"
#include "page/page.h"
#include "signal/picture.h"

namespace echocine::fit {

struct FitReport {
  FitMap map;
  std::vector<std::string> structures;
  std::vector<GreyImage> pictures;  // of the real loop, nearest to each frame of the beat
  double apex_x_px = 0, apex_y_px = 0, metres_per_pixel = 1;
  double systole = 0;  // end-systole of the model, as a fraction of the beat
};

FitReport fitReport(const ModelLoop& model, const ModelDiscrepancy& discrepancy,
                    const echo::EchoLoop& real, const FitPose& pose);

// A scene compared with the real loop.
struct SceneFit {
  BeatFound beat;
  PoseFound found;
  FitReport where;
  std::optional<TiltFound> tilt;       // if requested; found and where are then of that plane
  std::string tilted_probe;            // that plane as keys of [probe]
  std::vector<std::string> caveats{};  // caveats.h
};
// tilt_deg: limit of tilt and rotation of the plane, either way. Throws SceneError like
// ModelDiscrepancy, JobError when the monitor requests a stop. Precondition: the scene's probe is
// placed.
SceneFit fitScene(const Scene& scene, const echo::EchoLoop& real, const echo::SideOptions& side,
                  double tilt_deg = 0, const Monitor& monitor = {});

// JSON for files: {shift_mm, turn_deg, scale}; D, its terms and the pose; the start of the beat;
// the tilt; curves of structures and of the left ventricle's segments.
nlohmann::ordered_json poseJson(const FitPose& pose);
nlohmann::ordered_json foundJson(const PoseFound& found);
nlohmann::ordered_json beatJson(const BeatFound& beat);
nlohmann::ordered_json tiltJson(const TiltFound& tilt);
nlohmann::ordered_json tiltJson(const SceneFit& fit);  // with the keys; precondition: it has a tilt
nlohmann::ordered_json structureCurvesJson(const FitReport& where);
nlohmann::ordered_json segmentCurvesJson(const FitReport& where);

// Look of a page of this name that shows the disagreement of a model: its markup and its script,
// preceded by fit_map.js.
PageLook fitPageLook(const std::string& title, const std::string& name);
// Data for fit_map.js: its pictures as a loop, and the overlays. Throws JobError.
void addFitPictures(const FitReport& where, PageWriter& page, std::string_view loop = "fit");
nlohmann::ordered_json fitJson(const FitReport& where);
// Boundaries only, by frame: [x, y] in pixels of the pictures.
nlohmann::ordered_json outlineJson(const FitReport& where);

}  // namespace echocine::fit
