#pragma once
// One loop of a dataset in memory: pictures and truth of every frame, and all its numbers.

#include <string>
#include <utility>
#include <vector>

#include "dataset/draws.h"
#include "motion/cycle/cardiac_clock.h"
#include "signal/picture.h"
#include "truth/frame_truth.h"
#include "truth/simpson.h"

namespace echocine::dataset {

struct LoopFrame {
  FrameTime time;
  GreyImage image;                   // without ECG and ticks
  std::vector<std::uint8_t> labels;  // CAMUS's: 0 background, 1 LV cavity, 2 LV wall, 3 left atrium
  // Those of structure_labels.h if nnU-Net shows all structures, at the two instants; else empty.
  std::vector<std::uint8_t> structure_labels{};
  double lv_ml = 0;       // exact, from the mesh
  double biplane_ml = 0;  // at the two instants: Simpson's rule in two planes through the long axis
  double single_plane_ml = 0;  // the same in the imaging plane only
  // At the two instants, as traced: widths of the discs, and the axis in the imaging plane.
  std::vector<double> disc_widths_m{};
  double traced_length_m = 0;
  std::vector<Contour> contours;  // of structures with a role among kContourRoles
  std::optional<FunctionFrame> function;
  std::vector<Vec3f> tracks_m;
};

// Long axis and cavity as traced by an echo laboratory, in pixels.
struct Tracing {
  PixelPoint apex, base;                                  // of the long axis
  std::vector<std::pair<PixelPoint, PixelPoint>> chords;  // from the apex to the base
};

inline constexpr Role kContourRoles[] = {Role::lv_cavity, Role::lv_wall, Role::la};

// End-diastole and end-systole: the frames of the largest and the smallest ventricle of a beat.
struct Instants {
  int ed = 0, es = 0;
};

struct LoopSample {
  std::string id;  // "ec000012_a4c": unique, without dots
  View view = View::a4c;
  Scene scene;
  PictureGeometry geometry;
  std::vector<LoopFrame> frames;
  Instants instants;
  Tracing ed_tracing, es_tracing;  // empty in short axes
  std::vector<TruthMaker::Tracked> tracked;
  std::optional<ViewOffset> offset;
  std::vector<double> ecg;  // amplitude at each frame
  Values values;            // all drawn values
  int width() const { return scene.output.width; }
  int height() const { return scene.output.height; }
};

struct Heart {
  int number = 0;   // from 1, like patients
  int attempt = 0;  // impossible draws before this one
  std::string population;
  Split split = Split::train;
  std::vector<LoopSample> loops;          // one for each view of the spec
  std::vector<std::string> impossible{};  // reasons of the impossible draws
};

// Is a place near the imaging plane in the picture? It is if it lies within the sector, and no
// farther from the plane than half the beam's thickness there (full width at half maximum).
bool isShown(const LoopSample& loop, Vec3f place_m);

std::string loopId(int heart_number, View view);

}  // namespace echocine::dataset
