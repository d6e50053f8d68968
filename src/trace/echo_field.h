#pragma once
// The field of a frame behind its intensities, for stages that add other fields to it.

#include <vector>

namespace echocine {

// Line-major like the intensities; all are empty without speckle. With A = real + j imaginary,
// E|A|^2 = mean over seeds, and the intensities are the smoothed |A|^2.
struct EchoField {
  std::vector<float> mean, real, imaginary;

  bool empty() const { return mean.empty(); }
  void resize(std::size_t size) {
    for (std::vector<float>* plane : {&mean, &real, &imaginary}) plane->resize(size);
  }
};

}  // namespace echocine
