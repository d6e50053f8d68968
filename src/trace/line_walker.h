#pragma once
// Follows one scan line through the media: which medium, which loss, which echo, where it bends.

#include "geometry/frame_geometry.h"
#include "trace/interface_law.h"
#include "trace/layer_echoes.h"
#include "trace/line_trace.h"
#include "trace/ruling_surface.h"
#include "trace/trace_settings.h"

namespace echocine {

class LineWalker {
 public:
  // Starts at the transducer. `inside`: the closed surfaces that hold the start. Path lengths count
  // from start_m along the ray, and what it crosses before that is no interface. `trace` is
  // cleared.
  LineWalker(const TraceSettings& settings, const Ray& start, const InsideSet& inside,
             LineTrace& trace, double start_m = 0);

  // The ray to be asked next; alive() is false when the line has ended.
  const RayQuery& query() const { return query_; }
  bool alive() const { return at_.alive; }

  // Goes along the crossings of query() to the depth of the image, to total reflection, or to the
  // next bend, after which query() is a new ray.
  void advance(const RayCrossings& met);

 private:
  using Group = std::span<const Crossing>;  // crossings of one interface, nearest first

  // How far the line has come, and what is left of its wave there.
  struct Progress {
    double walked_m = 0;  // along the present ray
    double path_m = 0;    // l since the transducer
    double depth_m = 0;   // on the image's axis
    double exponent = 0;  // A since the transducer
    double passed = 1;    // prod (1-R)^2
    MediumId medium{};    // that it is in
    Vec3d wave;           // unit: by which angles of incidence are taken
    int bends = 0;
    bool alive = true;
  };

  // A total reflection behind which the line still looks for the layer's other face: the speed
  // before it, which goes with the wave, its l, and what the trace held then.
  struct Mirror {
    bool met = false;
    double speed_before_m_s = 0, path_m = 0;
    std::size_t segments = 0, echoes = 0, hits = 0;
  };

  std::size_t crossAtFace(Group crossings, InsideSet& inside) const;
  void walkTo(double distance_m);
  void passInterface(Group group, MediumId after, std::size_t first_hit);
  void passMembrane(const Crossing& crossing);
  void noteHits(Group group, MediumId after);
  // For a crossing: Snell's direction there, and the interface law for it.
  Vec3d incidentAt(const Crossing& crossing);
  InterfaceLaw lawAt(const Crossing& crossing, const Medium& from, const Medium& to);
  void addEcho(double reflected, double passed, double cos_i, const Crossing& crossing,
               MediumId after);
  double sentBack(const InterfaceLaw& law, const Medium& from, const Medium& to) const;
  void loseAt(const InterfaceLaw& law, double through);
  void reflectAll(double speed_before_m_s);
  void endAtMirror();
  bool mirrored() const { return mirror_.met && !settings_.beyond_mirrors; }
  LayerEchoes::Meeting meetingAt(const Crossing& crossing, const InterfaceLaw& law,
                                 const Medium& from, const Medium& to) const;
  void joinLayer(const LayerEchoes::Meeting& meeting, const InterfaceLaw& law,
                 std::size_t first_hit, std::size_t first_echo);
  void bend(Group group, Vec3d direction);
  const Crossing& deciding(Group group) const;

  const TraceSettings& settings_;
  LineTrace& trace_;
  RayQuery query_;
  RulingSurface ruling_;
  Progress at_;
  LayerEchoes layer_;  // the faces that the pulse still holds
  Mirror mirror_{};
};

}  // namespace echocine
