/// \file
/// First contact of a moving ball with the surface of a convex body, from outside or from inside, by safe steps: each
/// step ends before the contact, by a bound that holds for every convex body, and the bounds are of second order, so
/// that the steps converge quadratically. Nothing can be skipped.
///
/// From outside: the body lies behind the tangent plane at the point nearest to the centre. The ball cannot touch the
/// body before it touches that plane, and that time is the root of a polynomial.
///
/// From inside: the depth is a concave function of the place. On a piece [s0, s1] of the path, which bends away from
/// its chord by at most A (s - s0) (s1 - s) / 2, A the largest acceleration, the depth is therefore at least the linear
/// interpolation between its ends less that bend: a quadratic in s, whose first root is a safe step whatever s1 is. It
/// is a long one for the s1 at which the gap closes, which Newton's method finds, from the other side.
///
/// Accuracy: the distance is evaluated as CentredEllipsoid::nearest says (to some 2^-50 of the radius) at places that
/// are exact to double-double; the time is right to that error over the normal speed, and to an ulp. Bounded: after
/// kMostMarchSteps steps the last safe time is the answer. From outside half a dozen are usual and 30 for a graze; from
/// inside it is one to three, and ten distances in all.
#pragma once

#include <optional>

#include "ricochet/geometry/shapes/local_shape.h"

namespace ricochet {

/// Steps of one march.
inline constexpr int kMostMarchSteps = 200;

/// A ball of a given radius on a path in the frame of a shape, coming from one side of its surface.
class ConvexMarch {
public:
    /// side: +1 outside, -1 inside.
    ConvexMarch(const LocalShape& shape, const LocalPath& path, double radius, int side);

    /// True when the gap is closed at the path's start, to rounding.
    [[nodiscard]] bool starts_in_overlap() const { return is_closed(gap_at(0.0)); }

    /// The first time after `from` at which the gap between ball and surface closes; there it must be open.
    [[nodiscard]] std::optional<double> first_closing(double from) const {
        return side_ > 0 ? first_from_outside(from) : first_from_inside(from);
    }

    /// How a start in overlap goes on.
    struct Overlap {
        bool is_stopped = false;  ///< from `time` on the gap shrinks, while it is not open
        double time = 0.0;        ///< otherwise the gap is open from here on; the duration's end when it never is
    };
    /// Looks at kOverlapPlaces equally spaced places of the path and finds the turn between two of them by halving.
    [[nodiscard]] Overlap follow_overlap() const;

private:
    /// The gap at one time and how fast it grows.
    struct Gap {
        double time;
        double size;  ///< m
        double rate;  ///< m/s
        Vec3 normal;  ///< outward
    };

    [[nodiscard]] Gap gap_at(double s) const;
    [[nodiscard]] bool is_closed(const Gap& gap) const { return gap.size <= closed_; }
    [[nodiscard]] bool approaches(const Gap& gap) const;
    [[nodiscard]] std::optional<double> first_from_outside(double from) const;
    [[nodiscard]] std::optional<double> first_from_inside(double from) const;
    [[nodiscard]] std::optional<double> time_to_plane(const Gap& gap) const;
    [[nodiscard]] Gap closing_between(const Gap& low, Gap& closed) const;
    [[nodiscard]] std::optional<double> safe_part(const Gap& low, const Gap& high) const;

    const LocalShape& shape_;
    const LocalPath& path_;
    double radius_;
    int side_;
    double closed_;  ///< m: what distances err by
};

}  // namespace ricochet
