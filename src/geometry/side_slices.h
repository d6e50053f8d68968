#pragma once
// The slices beside the imaging plane that represent the beam's thickness: those of
// scene/elevation_slices.h except the plane itself.
//
// A slice is curved, y = u sigma(z). Cutting it equals cutting the plane y = 0 through surfaces
// displaced by y - u sigma(z), as PlaneSlice does: vertices are moved; edges and facets stay
// straight between them. So contours close like those of the plane. Angles of incidence are those
// of the displaced facets, which are those of rays that follow the slice. With smooth normals their
// error is the slope of the slice, at most 3 degrees.

#include <span>
#include <vector>

#include "geometry/plane_slice.h"
#include "scene/scene.h"

namespace echocine {

class SideSlices {
 public:
  // For scene.accuracy.elevation_slices. Preconditions: those of PlaneSlice; surfaces have
  // near_plane within elevationReach(), or none.
  SideSlices(const std::vector<SurfaceTopology>& surfaces, const Scene& scene,
             const InsideSet& left_out = {});

  // Cuts the frame. Its positions are modified temporarily and restored.
  void update(SurfaceFrame& frame);

  double centreWeight() const { return centre_weight_; }  // of the imaging plane
  std::size_t size() const { return slices_.size(); }
  const PlaneSlice& slice(std::size_t k) const { return slices_[k]; }
  double weight(std::size_t k) const { return weights_[k]; }

 private:
  // Displaced vertices of a surface, and their displacement in the last frame.
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
  bool still_cut_ = false;  // static surfaces have been cut
};

}  // namespace echocine
