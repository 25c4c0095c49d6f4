/// \file
/// A ball (or ellipsoid) or a capped cylinder as the verifier sees it: fifty digits where doubles leave doubt.
///
/// The shape is the documented one (geometry/shapes/analytic_shape.h): its axes are the directions of the map's
/// columns, made orthonormal one after the other, its half axes the columns' lengths, rounded to doubles; half axes
/// that agree to rounding (2^-49) are equal. A point counts as on the surface when its value there is below kOnSurface.
#pragma once

#include <memory>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet::verify {

/// Immutable; safe from any number of threads.
class CheckedShape {
public:
    /// The image of the unit ball, or of the cylinder x^2 + y^2 <= 1, |z| <= 1 with its caps.
    CheckedShape(const AffineMap& world_from_unit, bool is_cylinder);
    ~CheckedShape();
    CheckedShape(CheckedShape&&) noexcept;
    CheckedShape& operator=(CheckedShape&&) noexcept;

    /// +1 outside, -1 inside, 0 on the surface.
    [[nodiscard]] int side(const Vec3& p) const;
    /// True when the closed segment [p, q] intersects the surface.
    [[nodiscard]] bool intersects(const Vec3& p, const Vec3& q) const;
    /// The same for a segment that starts on the surface: true when it intersects it again.
    [[nodiscard]] bool intersects_after_start(const Vec3& p, const Vec3& q) const;
    /// True when the distance of p from the surface is below `least` (m, > 0). Errs, on the side of true, by 1e-15 of
    /// the half axes at most.
    [[nodiscard]] bool is_nearer(const Vec3& p, double least) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet::verify
