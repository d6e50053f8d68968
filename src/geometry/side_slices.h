#pragma once
// The slices beside the imaging plane that stand for the beam's thickness across it: those of
// scene/elevation_slices.h but for the plane itself.
//
// A slice is curved, y = u sigma(z). Cutting it is cutting the plane y = 0 through surfaces that
// are bent by y - u sigma(z), as PlaneSlice does: vertices are moved, edges and facets stay
// straight between them. So contours close as those of the plane do. Angles of incidence are those
// of the bent facets, which are those of rays that follow the slice; with smooth normals they err
// by the slice's slope, 3 degrees at most.

#include <span>
#include <vector>

#include "geometry/plane_slice.h"
#include "scene/scene.h"

namespace echocine {

class SideSlices {
 public:
  // Of scene.accuracy.elevation_slices. Preconditions: those of PlaneSlice; surfaces know their
  // triangles within elevationReach() of the plane, or none.
  SideSlices(const std::vector<SurfaceTopology>& surfaces, const Scene& scene,
             const InsideSet& left_out = {});

  // Cuts the frame. Its positions are moved meanwhile and are what they were at the end.
  void update(SurfaceFrame& frame);

  double centreWeight() const { return centre_weight_; }  // of the imaging plane
  std::size_t size() const { return slices_.size(); }
  const PlaneSlice& slice(std::size_t k) const { return slices_[k]; }
  double weight(std::size_t k) const { return weights_[k]; }

 private:
  // What is moved of a surface, and by how much in the last frame.
  struct Moved {
    std::size_t surface;
    bool still;
    std::vector<std::uint32_t> vertices;
    std::vector<float> height_m, deviation_m;
  };
  void note(const SurfaceFrame& frame);

  Probe probe_;
  double centre_weight_;
  std::vector<double> places_, weights_;
  std::vector<PlaneSlice> slices_;
  std::vector<Moved> moved_;
  bool still_cut_ = false;  // those of surfaces that never move are cut once
};

}  // namespace echocine
