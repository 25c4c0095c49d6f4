/// \file
/// Private to block_cholesky.cpp: the dense part of the factorization.
#pragma once

#include <cstddef>
#include <span>

namespace ricochet {

/// Eliminates the first `columns` columns of a symmetric matrix of `rows` rows, whose lower half is stored by columns.
/// These columns become columns of L; the rest becomes the Schur complement. Returns false if the matrix is not
/// positive definite.
[[nodiscard]] bool eliminate(std::span<double> matrix, std::size_t rows, std::size_t columns);

}  // namespace ricochet
