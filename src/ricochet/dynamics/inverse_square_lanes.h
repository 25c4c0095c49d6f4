/// \file
/// Innermost loops of the sums, written so that compilers vectorize them. Private to inverse_square.cpp. Each lane
/// accumulates its own sum in the order of the calls.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "ricochet/core/tolerances.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/inverse_square.h"

namespace ricochet {

/// Number of points whose sums are computed in parallel lanes.
inline constexpr std::size_t kLanes = 8;

/// Fields at up to kLanes points.
class FieldLanes {
public:
    explicit FieldLanes(std::span<const Vec3> points) {
        for (std::size_t l = 0; l < kLanes; ++l) {
            const Vec3& p = points[l < points.size() ? l : 0];
            x_[l] = p.x;
            y_[l] = p.y;
            z_[l] = p.z;
        }
    }

    /// Adds the fields of source points. softening: square of the softening length.
    void add_points(std::span<const Vec3> positions, std::span<const double> weights, double softening) {
        for (std::size_t j = 0; j < positions.size(); ++j) {
            const Vec3 p = positions[j];
            const double w = weights[j];
            for (std::size_t l = 0; l < kLanes; ++l) {
                const double dx = p.x - x_[l];
                const double dy = p.y - y_[l];
                const double dz = p.z - z_[l];
                const double square = dx * dx + dy * dy + dz * dz;
                const double u = square + softening;
                const double pull = w / (u * std::sqrt(u));
                const double g = square > kCoincidentDistance * kCoincidentDistance ? pull : 0.0;
                gx_[l] += g * dx;
                gy_[l] += g * dy;
                gz_[l] += g * dz;
            }
        }
    }

    /// Adds the field of a group. The softened potential is expanded to second order in the distances of the group's
    /// points from its centre. With d = x - centre, u = |d|^2 + e^2, weight W and moments D and M, the potential is:
    ///
    ///     f = W u^(-1/2) + D.d u^(-3/2) + (3 d.M d u^(-5/2) - tr M u^(-3/2)) / 2.
    ///
    /// The field is its gradient with respect to x.
    void add_group(const GroupMoments& group, double softening) {
        const SymmetricMatrix& m = group.second;
        const double trace = m.trace();
        for (std::size_t l = 0; l < kLanes; ++l) {
            const double dx = x_[l] - group.center.x;
            const double dy = y_[l] - group.center.y;
            const double dz = z_[l] - group.center.z;
            const double inverse = 1.0 / (dx * dx + dy * dy + dz * dz + softening);
            const double cube = inverse * std::sqrt(inverse);
            const double first = group.first.x * dx + group.first.y * dy + group.first.z * dz;
            const double mx = m.xx * dx + m.xy * dy + m.xz * dz;
            const double my = m.xy * dx + m.yy * dy + m.yz * dz;
            const double mz = m.xz * dx + m.yz * dy + m.zz * dz;
            const double second = mx * dx + my * dy + mz * dz;
            const double three = 3.0 * inverse;
            const double along = (1.5 * trace - 3.0 * first - 7.5 * second * inverse) * inverse - group.weight;
            gx_[l] += cube * (along * dx + group.first.x + three * mx);
            gy_[l] += cube * (along * dy + group.first.y + three * my);
            gz_[l] += cube * (along * dz + group.first.z + three * mz);
        }
    }

    void store(std::span<Vec3> sums) const {
        for (std::size_t l = 0; l < sums.size(); ++l) sums[l] = {gx_[l], gy_[l], gz_[l]};
    }

private:
    std::array<double, kLanes> x_;
    std::array<double, kLanes> y_;
    std::array<double, kLanes> z_;
    std::array<double, kLanes> gx_{};
    std::array<double, kLanes> gy_{};
    std::array<double, kLanes> gz_{};
};

/// Returns the potential of source points at the position `at`.
inline double point_potential(const Vec3& at, std::span<const Vec3> positions, std::span<const double> weights,
                              double softening) {
    double sum = 0.0;
    for (std::size_t j = 0; j < positions.size(); ++j) {
        const double u = length_squared(positions[j] - at) + softening;
        if (u > kCoincidentDistance * kCoincidentDistance) sum += weights[j] / std::sqrt(u);
    }
    return sum;
}

/// Returns the potential of a group at the position `at`, outside the group.
inline double group_potential(const GroupMoments& group, const Vec3& at, double softening) {
    const Vec3 d = at - group.center;
    const double inverse = 1.0 / (length_squared(d) + softening);
    const double first = dot(group.first, d);
    const double second = dot(d, group.second * d);
    return std::sqrt(inverse) *
           (group.weight + inverse * (first + 0.5 * (3.0 * second * inverse - group.second.trace())));
}

}  // namespace ricochet
