/// \file
/// Three-component double vector: the only vector type of the public interface.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace ricochet {

/// A point, direction or velocity. The components have the unit of the quantity.
struct Vec3 {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;

    constexpr Vec3() = default;
    constexpr Vec3(double x_value, double y_value, double z_value) : x(x_value), y(y_value), z(z_value) {}

    /// Returns component 0, 1 or 2.
    [[nodiscard]] constexpr double operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }
    constexpr double& operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }

    constexpr Vec3& operator+=(const Vec3& b) {
        x += b.x;
        y += b.y;
        z += b.z;
        return *this;
    }
    constexpr Vec3& operator-=(const Vec3& b) {
        x -= b.x;
        y -= b.y;
        z -= b.z;
        return *this;
    }
    constexpr Vec3& operator*=(double s) {
        x *= s;
        y *= s;
        z *= s;
        return *this;
    }
    friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

[[nodiscard]] constexpr Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
[[nodiscard]] constexpr Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
[[nodiscard]] constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
[[nodiscard]] constexpr Vec3 operator*(Vec3 a, double s) { return a *= s; }
[[nodiscard]] constexpr Vec3 operator*(double s, Vec3 a) { return a *= s; }
[[nodiscard]] constexpr Vec3 operator/(const Vec3& a, double s) { return {a.x / s, a.y / s, a.z / s}; }

[[nodiscard]] constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] constexpr double length_squared(const Vec3& a) { return dot(a, a); }
[[nodiscard]] inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }
/// Returns the unit vector along a. Undefined for the zero vector, which callers must exclude.
[[nodiscard]] inline Vec3 normalized(const Vec3& a) { return a / length(a); }
/// Return the componentwise minimum and maximum.
[[nodiscard]] constexpr Vec3 min(const Vec3& a, const Vec3& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
[[nodiscard]] constexpr Vec3 max(const Vec3& a, const Vec3& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
/// Returns the componentwise absolute value.
[[nodiscard]] inline Vec3 abs(const Vec3& a) { return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}; }
/// Returns the largest absolute component (the infinity norm).
[[nodiscard]] inline double max_abs(const Vec3& a) {
    return std::max(std::fabs(a.x), std::max(std::fabs(a.y), std::fabs(a.z)));
}
[[nodiscard]] inline bool is_finite(const Vec3& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Returns two unit vectors that complete the unit vector n to a right-handed orthonormal frame (first, second, n).
/// Method: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
[[nodiscard]] inline std::array<Vec3, 2> tangent_frame(const Vec3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {Vec3{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, Vec3{b, sign + n.y * n.y * a, -n.y}};
}

}  // namespace ricochet
