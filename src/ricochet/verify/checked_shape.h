/// \file
/// A ball (or ellipsoid) or a capped cylinder for the verifier. The tests use numbers with fifty digits if the error
/// bound of doubles leaves doubt.
///
/// The shape is defined as in geometry/shapes/analytic_shape.h. Its axes are the directions of the map's columns, made
/// orthonormal one after the other. The half axes are the lengths of the columns, rounded to doubles. Half axes that
/// differ by at most 2^-49, relative to their length, are treated as equal. A point is on the surface if the magnitude
/// of its value (see checked_shape.cpp) is below kOnSurface.
#pragma once

#include <memory>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet::verify {

/// A shape that the verifier checks. It is immutable and thread-safe.
class CheckedShape {
public:
    /// Creates the image of the unit ball, or of the cylinder x^2 + y^2 <= 1, |z| <= 1 with its caps, under the map.
    CheckedShape(const AffineMap& world_from_unit, bool is_cylinder);
    ~CheckedShape();
    CheckedShape(CheckedShape&&) noexcept;
    CheckedShape& operator=(CheckedShape&&) noexcept;

    /// Returns +1 if p is outside, -1 if it is inside, and 0 if it is on the surface.
    [[nodiscard]] int side(const Vec3& p) const;
    /// Returns true if the closed segment [p, q] intersects the surface.
    [[nodiscard]] bool intersects(const Vec3& p, const Vec3& q) const;
    /// Returns true if the segment [p, q] intersects the surface after its start. p must be on the surface.
    [[nodiscard]] bool intersects_after_start(const Vec3& p, const Vec3& q) const;
    /// Returns true if the distance of p from the surface is below `least` (in m, > 0). The result may also be true if
    /// the distance exceeds `least` by up to 1e-15 of the half axes.
    [[nodiscard]] bool is_nearer(const Vec3& p, double least) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet::verify
