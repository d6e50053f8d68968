#include "core/cholesky.h"

#include <cmath>

namespace echocine {

std::vector<double> choleskyFactor(const std::vector<double>& matrix, std::size_t size) {
  std::vector<double> factor(size * size, 0);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = matrix[i * size + j];
      for (std::size_t k = 0; k < j; ++k) rest -= factor[i * size + k] * factor[j * size + k];
      if (i == j && !(rest > 1e-12)) return {};
      factor[i * size + j] = i == j ? std::sqrt(rest) : rest / factor[j * size + j];
    }
  return factor;
}

}  // namespace echocine
