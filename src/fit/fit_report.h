#pragma once
// Where a model disagrees with a loop, with the loop's pictures: what pages and files show of it.

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
};

FitReport fitReport(const ModelLoop& model, const ModelDiscrepancy& discrepancy,
                    const echo::EchoLoop& real, const FitPose& pose);

// A scene held against the real loop, as it stands.
struct SceneFit {
  BeatFound beat;
  PoseFound found;
  FitReport where;
  std::optional<TiltFound> tilt;       // where one was asked for: found and where are of that plane
  std::string tilted_probe;            // that plane, as keys of a scene's [probe]
  std::vector<std::string> caveats{};  // caveats.h
};
// tilt_deg: by which the plane may be tilted and rotated, either way. Throws SceneError as
// ModelDiscrepancy does, JobError when the monitor wants to stop. Precondition: the scene's probe
// is placed.
SceneFit fitScene(const Scene& scene, const echo::EchoLoop& real, const echo::SideOptions& side,
                  double tilt_deg = 0, const Monitor& monitor = {});

// As files have them: {shift_mm, turn_deg, scale}; D, its terms and the pose; the beat's start; the
// tilt; curves of structures and of the left ventricle's segments.
nlohmann::ordered_json poseJson(const FitPose& pose);
nlohmann::ordered_json foundJson(const PoseFound& found);
nlohmann::ordered_json beatJson(const BeatFound& beat);
nlohmann::ordered_json tiltJson(const TiltFound& tilt);
nlohmann::ordered_json tiltJson(const SceneFit& fit);  // with the keys; precondition: it has a tilt
nlohmann::ordered_json structureCurvesJson(const FitReport& where);
nlohmann::ordered_json segmentCurvesJson(const FitReport& where);

// The look of a page of this name that shows where a model disagrees: its markup, its script, and
// fit_map.js before that.
PageLook fitPageLook(const std::string& title, const std::string& name);
// For fit_map.js: its pictures as a loop, and what is drawn over them. Throws JobError.
void addFitPictures(const FitReport& where, PageWriter& page, std::string_view loop = "fit");
nlohmann::ordered_json fitJson(const FitReport& where);
// The boundaries alone, by frame: [x, y] in pixels of the pictures.
nlohmann::ordered_json outlineJson(const FitReport& where);

}  // namespace echocine::fit
