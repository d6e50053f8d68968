#pragma once
// Parametric hearts interpolated between computed ones: a dial changes in milliseconds instead of
// seconds.

#include <map>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "fit/heart_cache.h"
#include "fit/heart_design.h"
#include "fit/plane_tilt.h"
#include "fit/surface_modes.h"
#include "motion/heart/recording.h"

namespace echocine::fit {

// Hearts computed at the places of a design, shared by all views.
class HeartNodes {
 public:
  // `dials`: fixed dials. Computes nodes^(number of ranges) hearts. Runs in parallel. Throws
  // SceneError like checkFamily() and for impossible hearts, JobError when the monitor requests a
  // stop.
  HeartNodes(const std::map<std::string, double>& dials, const std::vector<DialRange>& ranges,
             int frames, int nodes, const Monitor& monitor = {});

  // Hearts at the places of a polynomial; an impossible one moves towards the centre. Hearts that
  // the cache has are read, others are kept there. Throws like the other.
  HeartNodes(const std::map<std::string, double>& dials, HeartDesign design, int frames,
             const Monitor& monitor = {}, HeartCache cache = {});

  const HeartDesign& design() const { return design_; }
  const std::vector<DialRange>& ranges() const { return design_.ranges(); }
  int frames() const { return frames_; }
  std::size_t size() const { return hearts_.size(); }
  // A heart as a scene of a view, computed at the phases of the frames.
  Scene sceneOf(std::size_t heart, heart::View view) const;

 private:
  struct Heart {
    heart::Parameters parameters;
    heart::Recording beat;  // without the surroundings of the heart
  };
  void compute(const std::map<std::string, double>& dials, const Monitor& monitor,
               HeartCache& cache);
  Heart computed(const std::map<std::string, double>& dials, std::size_t place,
                 HeartCache& cache) const;

  HeartDesign design_;
  int frames_;
  std::vector<Heart> hearts_;  // by place of the design
};

// Between nodes, every surface point is the design's polynomial, in the probe's frame. The
// view follows each heart, so the plane moves with the dials as in `echocine heart`.
class HeartFamily {
 public:
  // tilt_deg: limit of tilt and rotation of the plane, either way, 0 to kMostTilt_deg. segments:
  // of the left ventricle's wall are known too, which takes a second of one core. Throws
  // SceneError for another limit, JobError when the monitor requests a stop.
  HeartFamily(const HeartNodes& hearts, heart::View view, const Monitor& monitor = {},
              double tilt_deg = 0, bool segments = false);
  // A family of one view; computes its hearts, 0.3 s of one core each. Throws like HeartNodes.
  HeartFamily(const std::map<std::string, double>& dials, const std::vector<DialRange>& ranges,
              heart::View view, int frames, int nodes, const Monitor& monitor = {},
              double tilt_deg = 0);

  // A beat of the heart at one value per range, in the order of the ranges. Thread-safe. Throws
  // SceneError like checkValues(), and for an angle beyond the tilt_deg of the constructor.
  ModelLoop at(const std::vector<double>& values, const PlaneTilt& tilt = {},
               Focus focus = Focus::all) const;
  // The surfaces' vertices near the plane, from which `at` cuts the beat.
  std::vector<SurfaceFrame> surfacesAt(const std::vector<double>& values) const;

  const Scene& scene() const { return scene_; }
  const std::vector<DialRange>& ranges() const { return design_.ranges(); }
  int nodes() const { return design_.nodes(); }  // of each dial in a grid; 0: a polynomial

 private:
  using Node = std::vector<SurfaceFrame>;  // a computed heart
  std::vector<char> nearPlane(const SurfaceTopology& surface,
                              const std::vector<Node>& recorded) const;
  void keepNearPlane(const std::vector<SurfaceTopology>& all, const std::vector<Node>& recorded);
  void keepModes(std::vector<Node> recorded);

  HeartDesign design_;
  std::vector<double> systoles_;  // end-systole of each computed heart, as a fraction of its beat
  double tilt_rad_;               // limit of tilt and rotation, either way
  Scene scene_;                   // of the first node, without meshes
  std::optional<WallSegments> segments_;  // of the first node's material, which all share
  std::vector<SurfaceTopology> surfaces_;
  std::vector<std::vector<std::uint32_t>> kept_;  // vertices, by surface
  std::vector<SurfaceModes> modes_;               // by frame
};

}  // namespace echocine::fit
