/// \file
/// Points of the unit circle. The C library's sine and cosine are not used, because their last bit differs between
/// systems.
#pragma once

#include <cmath>

namespace ricochet::meshes {

/// Cosine and sine of one angle.
struct CirclePoint {
    double cos = 1.0;
    double sin = 0.0;
};

namespace detail {

/// Taylor sums about 0, with an error below 1e-16 for |angle| <= pi / 4.
[[nodiscard]] inline CirclePoint small_angle(double angle) {
    const double q = angle * angle;
    double sine = 1.0;
    double cosine = 1.0;
    for (int n = 9; n >= 1; --n) {
        sine = 1.0 - sine * q / static_cast<double>(2 * n * (2 * n + 1));
        cosine = 1.0 - cosine * q / static_cast<double>(2 * n * (2 * n - 1));
    }
    return {cosine, angle * sine};
}

}  // namespace detail

/// Returns the point at the given number of turns (1 = a full circle) from the x axis, counter-clockwise. Multiples of
/// a quarter turn are exact.
[[nodiscard]] inline CirclePoint point_on_circle(double turns) {
    constexpr double kTwoPi = 6.283185307179586;
    const double t = turns - std::floor(turns);
    const int quarter = static_cast<int>(4.0 * t) % 4;
    const double rest = t - 0.25 * quarter;
    const CirclePoint small = detail::small_angle(kTwoPi * (rest > 0.125 ? 0.25 - rest : rest));
    const CirclePoint first = rest > 0.125 ? CirclePoint{small.sin, small.cos} : small;
    switch (quarter) {
        case 0:
            return first;
        case 1:
            return {-first.sin, first.cos};
        case 2:
            return {-first.cos, -first.sin};
        default:
            return {first.sin, -first.cos};
    }
}

}  // namespace ricochet::meshes
