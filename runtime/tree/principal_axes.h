#pragma once
#include <array>

#include "math/vector_functions.h"

namespace orchard::runtime::detail {

// Returns the eigenvectors of a symmetric matrix {xx, yy, zz, xy, xz, yz} by Jacobi rotations, that of the largest
// eigenvalue first.
std::array<Vec3, 3> axes_of(const std::array<double, 6>& matrix) noexcept;

}  // namespace orchard::runtime::detail
