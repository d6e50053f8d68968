#pragma once
// Positions of the interfaces of a picture, and their error.

#include <vector>

#include "scene/probe.h"
#include "trace/polar_frame.h"

namespace echocine {

// An interface on a scan line, on the depth axis of the image.
struct InterfacePlace {
  SurfaceId surface{};
  bool entering = false;
  double depth_m = 0;
};

// The visible interfaces of a frame, line by line.
struct InterfaceMap {
  Probe probe;
  std::vector<std::vector<InterfacePlace>> lines;
};

// Precondition: the traces contain hits (TraceSettings::note_hits).
InterfaceMap interfaceMap(const Probe& probe, const std::vector<LineTrace>& traces);

// For every interface of the reference on one of its lines, at its exact depth, the setting's two
// adjacent lines are searched for the crossing of the same surface, in the same sense, nearest in
// depth. The picture draws the interface through these two, each at the centre of its sample. The
// error is the distance, in the imaging plane, from the reference's point to the straight edge
// between them (or to the single one found). An interface without a match within 5 mm (our choice)
// is missed.
class InterfaceError {
 public:
  void add(const InterfaceMap& setting, const InterfaceMap& reference);

  // Over all added frames; 0 without interfaces. Distances in m.
  double rms_m() const;
  double percentile95_m() const;  // 95th percentile of the errors
  double missedShare() const;     // 0..1, relative to the reference's interfaces

 private:
  std::vector<double> errors_m_;
  std::size_t missed_ = 0;
};

}  // namespace echocine
