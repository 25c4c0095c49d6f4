/// \file
/// Slow oracles for analytic shapes, with 50 digits, by bisection.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "ricochet/core/transform.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet::testing {

using Real = boost::multiprecision::cpp_bin_float_50;
using RealVector = std::array<Real, 3>;

[[nodiscard]] RealVector real(const Vec3& v);
[[nodiscard]] Real dot(const RealVector& u, const RealVector& v);
[[nodiscard]] Real length(const RealVector& v);
/// Returns u + s v.
[[nodiscard]] RealVector sum(const RealVector& u, const Real& s, const RealVector& v);

/// Returns the position at s on the polynomial with the path's stored coefficients.
[[nodiscard]] RealVector position(const Path& path, const Real& s);

/// The shape as documented for AnalyticShape. Its axes are the columns of the map, orthonormalised in their order. Its
/// half axes are the lengths of the columns, rounded to doubles. Lengths that differ by at most 2^-49, relatively,
/// count as equal.
class ShapeOracle {
public:
    ShapeOracle(const AffineMap& world_from_local, bool is_capped);

    struct Nearest {
        Real distance;      ///< signed, positive outside
        RealVector normal;  ///< outward, in world coordinates
    };
    [[nodiscard]] Nearest nearest(const RealVector& p) const;
    /// Returns a signed value: negative inside, positive outside, 0 on the surface. The value is a smooth function of p
    /// except at the edge of a cap.
    [[nodiscard]] Real value(const RealVector& p) const;
    /// Returns true if the closed segment has a point on the surface.
    [[nodiscard]] bool intersects(const RealVector& p, const RealVector& q) const;

    [[nodiscard]] const std::array<double, 3>& half_axes() const { return half_; }
    /// Returns the world coordinates of a point given in the shape's frame.
    [[nodiscard]] RealVector world(const RealVector& local) const;

private:
    [[nodiscard]] RealVector local(const RealVector& p) const;
    [[nodiscard]] Real form(const RealVector& y) const;
    /// Returns the nearest point of the ellipsoid or ellipse, in the shape's frame.
    [[nodiscard]] Nearest nearest_around(const RealVector& y) const;

    std::array<RealVector, 3> axes_;
    RealVector center_;
    std::array<double, 3> half_{};
    std::size_t round_axes_;  ///< number of axes of the ellipsoid or ellipse: 3, or 2 for a cylinder
};

}  // namespace ricochet::testing
