#pragma once
// Where the interfaces of a picture stand, and how far that is from where they ought to.

#include <vector>

#include "scene/probe.h"
#include "trace/polar_frame.h"

namespace echocine {

// An interface on a scan line, where the depth axis of the image has it.
struct InterfacePlace {
  SurfaceId surface{};
  bool entering = false;
  double depth_m = 0;
};

// The interfaces that a frame shows, line by line.
struct InterfaceMap {
  Probe probe;
  std::vector<std::vector<InterfacePlace>> lines;
};

// Precondition: the traces hold passes (TraceSettings::note_hits).
InterfaceMap interfaceMap(const Probe& probe, const std::vector<LineTrace>& traces);

// Every interface that the reference sees on one of its lines, at its exact depth, is looked for in
// the setting's two lines about the same angle: the crossing of the same surface, in the same
// sense, nearest in depth. The picture draws it through these two, each at the centre of its
// sample; the error is the distance, in the imaging plane, from the reference's point to the
// straight edge between them (or to the one that was found). What is not found within 5 mm (our
// choice) is missed.
class InterfaceError {
 public:
  void add(const InterfaceMap& setting, const InterfaceMap& reference);

  // Over all frames that were added; 0 where no interface was found. Distances in m.
  double rms_m() const;
  double percentile95_m() const;  // the smallest error that 95 % of the interfaces do not exceed
  double missedShare() const;     // 0..1, of the reference's interfaces

 private:
  std::vector<double> errors_m_;
  std::size_t missed_ = 0;
};

}  // namespace echocine
