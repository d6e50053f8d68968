#pragma once
// M-mode: the echoes of one scan line over time.

#include <optional>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "frame/simulator.h"
#include "mmode/line_place.h"
#include "motion/cycle/frame_time.h"

namespace echocine {

struct MModeRequest {
  // One of them: the angle of the line (rad; linear probes: the offset, m), or a place of the
  // heart. Without either: the central line.
  std::optional<double> place;
  std::optional<MModeTarget> through;
  double rate_hz = 500;  // lines a second
};

// The border of a structure on the line, at one instant.
struct BorderCrossing {
  int column = 0;
  SurfaceId surface{};
  double depth_m = 0;  // path length from the face, as the picture shows it
};

// Motion of a ring along the line towards the probe, relative to the first column.
struct RingMotion {
  double start_depth_m = 0;
  std::vector<double> exact_m;  // by column: the ring's point in the imaging plane
  // By column up to the closure of the aortic valve in the first beat: measured in the picture.
  // Later the leaflets leave the ring, and a reader stops too.
  std::vector<double> traced_m;
  // Largest motion: exact, measured, and of the ring in space along the heart's axis (MAPSE,
  // TAPSE).
  double exact_mm = 0, traced_mm = 0, in_space_mm = 0;
};

// Column t has the index t * samples in intensities and greys.
struct MMode {
  int columns = 0, samples = 0, line = 0;
  double place = 0;  // of the line: angle, rad; linear probes: offset, m
  double white = 1;  // of the loop, relative to I_S
  std::vector<FrameTime> times;
  Intensities intensities;  // after time gain and the average over the beam, relative to I_S
  Greys greys;              // log-compressed, 0 black to 1 white
  std::vector<BorderCrossing> borders;  // by column, then by depth
  std::optional<RingMotion> ring;
};

// The scene with the outputs and the truth that an M-mode needs, without rolling lines and
// persistence: a pulse has its own instant, and columns are not averaged over time. Throws
// SceneError if the rate is not within 1 Hz and the pulse repetition limit c / (2 depth), or if a
// required structure has no role.
Scene mmodeScene(Scene scene, const MModeRequest& request);

// Throws SceneError as lineAt(), lineThrough(), if the plane does not cut the target, and for too
// many columns. Precondition: the simulator is of mmodeScene().
void checkMMode(const Simulator& simulator, const MModeRequest& request);

// The M-mode of the loop, one column every 1 / rate seconds from 0 s. Its columns equal the line of
// still frames at their instants. Precondition: the simulator is of mmodeScene(). Uses the threads
// of the enclosing withThreads(). Throws like checkMMode(); JobError if the monitor stops it.
MMode makeMMode(const Simulator& simulator, const MModeRequest& request,
                const Monitor& monitor = {});

}  // namespace echocine
