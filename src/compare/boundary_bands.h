#pragma once
// Bands around the model's boundaries, where a comparison matters most.

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "echo/beam_grid.h"
#include "truth/contour.h"

namespace echocine::compare {

class BoundaryBands {
 public:
  // The scene from which `synthetic` was rendered. Its contours are cut exactly at any phase.
  // Throws SceneError if the scene does not belong to the loop, or the loop is not a render folder.
  BoundaryBands(const std::filesystem::path& scene, const echo::EchoLoop& synthetic,
                const echo::BeamGrid& grid, double width_m);
  ~BoundaryBands();
  BoundaryBands(BoundaryBands&&) noexcept;

  // Weights for each structure that the plane cuts anywhere in the loop, and for "all" structures.
  // The weight is 0 beyond half the width from the boundary. Thread-safe.
  std::vector<std::pair<std::string, std::vector<float>>> weightsAt(
      double phase, const std::vector<float>& weights) const;

  // The contours at a phase, metres in the probe frame.
  std::vector<Contour> contoursAt(double phase) const;
  const Scene& scene() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace echocine::compare
