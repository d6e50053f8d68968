#pragma once
// The square root of a covariance.

#include <cstddef>
#include <vector>

namespace echocine {

// The lower Cholesky factor of a symmetric matrix, row by row; empty if it is not positive
// definite. Precondition: size * size entries.
std::vector<double> choleskyFactor(const std::vector<double>& matrix, std::size_t size);

}  // namespace echocine
