#pragma once
// A loop in beam space with its truth, as research archives keep it.

#include <optional>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "loop/loop.h"

namespace echocine {

// Arrays have time first, then depth, then line.
struct BeamLoop {
  Scene scene;
  std::string scene_sha256;
  int frames = 0, samples = 0, lines = 0;
  std::vector<float> times_s;
  std::vector<float> greys;     // channel display.Y, 0 to 1
  std::vector<float> beam_m_s;  // channel velocity.beam; NaN where no motion is defined
  // The lead, R wave = 1, at kEcgRate_hz. It starts kEcgMargin_s before the first frame and ends as
  // long after the last one's interval, so the R waves at both ends of a beat are whole.
  std::vector<float> ecg;
  std::optional<View> view;  // the standard view of the imaging plane, if it is one
  // The endocardium of the left ventricle from the left mitral hinge over the apex to the right
  // one: kContourPoints places evenly along it, T x P x 2, lateral and depth, m. Empty if the plane
  // does not cut both hinges.
  std::vector<float> contour_m;
  // Longitudinal strain in the view, per frame, %; empty without a left ventricle.
  std::vector<float> strain_percent;
};

inline constexpr double kEcgRate_hz = 500, kEcgMargin_s = 0.1;
inline constexpr int kContourPoints = 65;  // our choice

// Renders the loop with the channels and truth that an archive needs, into memory. Throws
// SceneError, JobError.
BeamLoop makeBeamLoop(const Scene& scene, int threads, const Monitor& monitor);

// Bytes of display.Y: round(255 g).
std::vector<std::uint8_t> bytesOfGreys(const BeamLoop& loop);

}  // namespace echocine
