/// \file
/// Private to block_cholesky.cpp: the dense part of the factorization.
#pragma once

#include <cstddef>
#include <span>

namespace ricochet {

/// Eliminates the first `columns` columns of a symmetric matrix of `rows` rows, of which the lower half is stored by
/// columns: they become those of L, and the rest what is left of the matrix. False where it is not positive definite.
[[nodiscard]] bool eliminate(std::span<double> matrix, std::size_t rows, std::size_t columns);

}  // namespace ricochet
