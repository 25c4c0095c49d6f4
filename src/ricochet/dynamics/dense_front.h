/// \file
/// Dense part of the block Cholesky factorization. Private to block_cholesky.cpp.
#pragma once

#include <cstddef>
#include <span>

namespace ricochet {

/// Eliminates the first `columns` columns of a symmetric matrix with `rows` rows. The matrix stores its lower half by
/// columns. The eliminated columns become columns of L. The rest of the matrix becomes the Schur complement. Returns
/// false if the matrix is not positive definite.
[[nodiscard]] bool eliminate(std::span<double> matrix, std::size_t rows, std::size_t columns);

}  // namespace ricochet
