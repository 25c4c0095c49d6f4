/// \file
/// A ball (or ellipsoid) or a capped cylinder for the verifier. It computes with fifty digits if doubles leave doubt.
///
/// The shape follows the documentation (geometry/shapes/analytic_shape.h). Its axes are the directions of the map's
/// columns, made orthonormal one after the other. Its half axes are the columns' lengths, rounded to doubles. Half axes
/// that agree to rounding (2^-49) are equal. A point counts as on the surface if its value there is below kOnSurface.
#pragma once

#include <memory>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet::verify {

/// A checked shape. Immutable; safe from any number of threads.
class CheckedShape {
public:
    /// Creates the image of the unit ball, or of the cylinder x^2 + y^2 <= 1, |z| <= 1 with its caps.
    CheckedShape(const AffineMap& world_from_unit, bool is_cylinder);
    ~CheckedShape();
    CheckedShape(CheckedShape&&) noexcept;
    CheckedShape& operator=(CheckedShape&&) noexcept;

    /// Returns +1 outside, -1 inside, 0 on the surface.
    [[nodiscard]] int side(const Vec3& p) const;
    /// Returns true if the closed segment [p, q] intersects the surface.
    [[nodiscard]] bool intersects(const Vec3& p, const Vec3& q) const;
    /// Returns true if a segment that starts on the surface intersects it again.
    [[nodiscard]] bool intersects_after_start(const Vec3& p, const Vec3& q) const;
    /// Returns true if the distance of p from the surface is below `least` (in m, > 0). May err towards true, by at
    /// most 1e-15 of the half axes.
    [[nodiscard]] bool is_nearer(const Vec3& p, double least) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet::verify
