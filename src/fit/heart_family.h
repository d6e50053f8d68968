#pragma once
// Parametric hearts between recorded ones: a dial's change in milliseconds instead of seconds.

#include <map>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "fit/plane_tilt.h"
#include "motion/heart/recording.h"

namespace echocine::fit {

// A dial and the values between which it may be asked for.
struct DialRange {
  std::string key;  // of heart::dials()
  double low = 0, high = 0;
};

// Hearts recorded at Chebyshev-Lobatto nodes of each dial: once for all views.
class HeartNodes {
 public:
  // `given`: dials that stay. Records nodes^(number of ranges) hearts. Runs in parallel. Throws
  // SceneError for hearts that cannot be, JobError when the monitor wants to stop.
  HeartNodes(const std::map<std::string, double>& given, const std::vector<DialRange>& ranges,
             int frames, int nodes, const Monitor& monitor = {});

  const std::vector<DialRange>& ranges() const { return ranges_; }
  int nodes() const { return nodes_; }  // of each dial
  int frames() const { return frames_; }
  std::size_t size() const { return hearts_.size(); }
  // A heart as a scene of a view, recorded at the very phases of the frames.
  Scene sceneOf(std::size_t heart, heart::View view) const;

 private:
  struct Heart {
    heart::Parameters parameters;
    heart::Recording beat;  // without what lies around it
  };
  std::vector<DialRange> ranges_;
  int nodes_, frames_;
  std::vector<Heart> hearts_;  // the first dial fastest
};

// Between recorded hearts every point of a surface is the polynomial through its nodes, in the
// probe's frame. Views are aimed by each heart, so the plane moves with the dials as `echocine
// heart` would move it.
class HeartFamily {
 public:
  // tilt_deg: by which the plane may be tilted and rotated, either way. Throws JobError when the
  // monitor wants to stop.
  HeartFamily(const HeartNodes& hearts, heart::View view, const Monitor& monitor = {},
              double tilt_deg = 0);
  // Of one view: records its hearts, 0.8 s of one core each. Throws as HeartNodes does.
  HeartFamily(const std::map<std::string, double>& given, const std::vector<DialRange>& ranges,
              heart::View view, int frames, int nodes, const Monitor& monitor = {},
              double tilt_deg = 0);

  // A beat of the heart at one value for each range, in its order. Thread-safe. Precondition: the
  // tilt is within the tilt_deg that it was made for, either angle.
  ModelLoop at(const std::vector<double>& values, const PlaneTilt& tilt = {}) const;
  // What it is cut from: the surfaces' vertices near the plane.
  std::vector<SurfaceFrame> surfacesAt(const std::vector<double>& values) const;

  const Scene& scene() const { return scene_; }
  const std::vector<DialRange>& ranges() const { return ranges_; }
  int nodes() const { return nodes_; }

 private:
  using Node = std::vector<SurfaceFrame>;  // a recorded heart
  std::vector<float> shares(const std::vector<double>& values) const;
  std::vector<char> nearPlane(const SurfaceTopology& surface,
                              const std::vector<Node>& recorded) const;
  void keepNearPlane(const std::vector<SurfaceTopology>& all, const std::vector<Node>& recorded);
  void keepCoordinates(const std::vector<Node>& recorded);

  std::vector<DialRange> ranges_;
  std::vector<double> systoles_;  // end-systole of each recorded heart, as a part of its beat
  int nodes_;
  double tilt_rad_;  // the plane may be tilted and rotated by so much, either way
  Scene scene_;      // of the first node, without meshes
  std::vector<SurfaceTopology> surfaces_;
  std::vector<std::vector<std::uint32_t>> kept_;  // vertices, by surface
  // By frame and surface: eight coordinates of the first node, the same of the next, and so on to
  // the last; then the next eight. A blend reads them once, in order.
  std::vector<std::vector<std::vector<float>>> coordinates_;
};

}  // namespace echocine::fit
