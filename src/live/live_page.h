#pragma once
// The page of a session, and the parts of its data that also accompany later answers.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "frame/simulator.h"
#include "live/heart_dials.h"
#include "live/live_scene.h"
#include "view/scene_view.h"

namespace echocine::live {

// HTML. Simulator and view are those of the session's first pose; `dials`: of a parametric heart,
// null: none.
std::string pageOf(const Simulator& simulator, const SceneView& view, const LiveScene& scene,
                   const HeartDials* dials);

// Full key -> value, in the units of scene files, of all keys that can be changed live and have an
// effect in this scene; null without a value. Lists such as the pose are left out.
nlohmann::ordered_json keyValues(const Scene& scene);

// The sector in the imaging plane (mm), its picture, and the pose, for the 3-D view.
nlohmann::ordered_json sectorJson(const Scene& scene);

// The loop of the scene's heart rate and beats: frames, frame_rate_hz, and its ECG as evenly spaced
// values.
nlohmann::ordered_json loopJson(const Scene& scene);

}  // namespace echocine::live
