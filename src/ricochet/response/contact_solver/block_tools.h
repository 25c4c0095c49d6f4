/// \file
/// Sums and products of 3 x 3 blocks.
#pragma once

#include <cstddef>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/block_cholesky.h"

namespace ricochet {

inline void add(Block3& block, double factor, const Block3& more) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) block[i][j] += factor * more[i][j];
    }
}

inline void add_identity(Block3& block, double value) {
    for (std::size_t i = 0; i < 3; ++i) block[i][i] += value;
}

inline void add_square(Block3& block, double factor, const Vec3& v) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            block[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] += factor * v[i] * v[j];
    }
}

[[nodiscard]] inline Block3 product(const Block3& a, const Block3& b) {
    Block3 result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
        }
    }
    return result;
}

/// Returns the matrix of the map from w to n x w.
[[nodiscard]] inline Block3 cross_matrix(const Vec3& n) {
    return {{{0.0, -n.z, n.y}, {n.z, 0.0, -n.x}, {-n.y, n.x, 0.0}}};
}

[[nodiscard]] inline Block3 transposed(const Block3& a) {
    Block3 result{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) result[i][j] = a[j][i];
    }
    return result;
}

}  // namespace ricochet
