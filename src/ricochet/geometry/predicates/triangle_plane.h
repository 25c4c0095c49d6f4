/// \file
/// Predicates of one triangle for several queries. Common intermediate results are cached.
#pragma once

#include <optional>

#include "ricochet/geometry/predicates/exact_arithmetic.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

/// Predicates of the triangle (a, b, c). The functions give the same bits as the free functions with the same names.
/// The class is not thread-safe, because const functions fill the cache.
class TrianglePlane {
public:
    TrianglePlane() = default;
    TrianglePlane(const Vec3& a, const Vec3& b, const Vec3& c)
        : a_(a), b_(b), c_(c), cross_(detail::filtered_cross(b - a, c - a)) {}
    /// unit_normal: unit_normal(a, b, c), if the caller has it.
    TrianglePlane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& unit_normal) : TrianglePlane(a, b, c) {
        unit_normal_ = unit_normal;
    }

    [[nodiscard]] const Vec3& a() const { return a_; }
    [[nodiscard]] const Vec3& b() const { return b_; }
    [[nodiscard]] const Vec3& c() const { return c_; }
    /// Returns (b - a) x (c - a) in plain doubles.
    [[nodiscard]] const detail::FilteredCross& cross() const { return cross_; }

    /// Returns orient3d(a, b, c, p) if the filter decides it, else 0.
    [[nodiscard]] int filtered_side(const Vec3& p) const { return detail::filtered_sign(cross_, p - a_); }
    /// Returns orient3d(a, b, c, p). Exact.
    [[nodiscard]] int side(const Vec3& p) const {
        const int filtered = filtered_side(p);
        return filtered != 0 ? filtered : detail::orient3d_beyond_filter(a_, b_, c_, p);
    }
    /// Returns segment_intersects_triangle(p, q, a, b, c). Exact.
    [[nodiscard]] bool intersects_segment(const Vec3& p, const Vec3& q) const {
        const int p_side = filtered_side(p);
        const int q_side = filtered_side(q);
        return p_side * q_side <= 0 &&
               detail::segment_intersects_triangle_beyond_filter(p, q, a_, b_, c_, p_side, q_side);
    }
    /// See crossing_fraction().
    [[nodiscard]] double crossing_fraction(const Vec3& p, const Vec3& q) const;
    /// See unit_normal().
    [[nodiscard]] const Vec3& unit_normal() const;
    /// See signed_distance() in point_sweep.h. The distance is in m.
    [[nodiscard]] double signed_distance(const Vec3& p) const;

private:
    struct Precise {
        ExactDifference u;
        ExactDifference v;
        BoundedCross normal;
    };
    [[nodiscard]] const Precise& precise() const;
    [[nodiscard]] DoubleDouble volume(const Vec3& p, double relative_error) const;

    Vec3 a_;
    Vec3 b_;
    Vec3 c_;
    detail::FilteredCross cross_;
    mutable std::optional<Precise> precise_;
    mutable std::optional<Vec3> unit_normal_;
};

}  // namespace ricochet
