/// \file
/// Free space around a particle: cheap proof that its path stays away from all surfaces, so that it needs no contact
/// query.
#pragma once

#include <limits>

#include "ricochet/collision/collision_world.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// A ball without surfaces that rests, or moves along a parabola from one time to another. A search finds a ball at
/// rest around the particle, a look-ahead a ball along the path that the particle is expected to take after its step.
struct ClearSpace {
    Vec3 center = {};             ///< in m, at the time `begin`
    Vec3 velocity = {};           ///< in m/s, at the time `begin`
    Vec3 half_acceleration = {};  ///< in m/s^2, half of the acceleration
    double begin = kUnknown;      ///< in s; kUnknown: no space has been searched
    double end = kForEver;        ///< in s; nothing is known about later times
    /// Distance from the centre, in m, within which no surface is; 0: no free space is known. The distances within
    /// which a contact query considers surfaces, and from a path to its chords, are already subtracted.
    double reach = 0.0;

    static constexpr double kForEver = std::numeric_limits<double>::infinity();
    static constexpr double kUnknown = -std::numeric_limits<double>::infinity();

    [[nodiscard]] bool is_known() const { return begin != kUnknown; }
    [[nodiscard]] bool is_at_rest() const { return end == kForEver; }  ///< also true if the space is not known
    /// Returns true if a particle of a radius, in m, certainly stays in the ball on a path that begins at a time, in s.
    /// It then touches no surface on the path, and none on the chord of the path. Reason: the difference of two
    /// polynomials lies in the convex hull of its Bezier control points.
    [[nodiscard]] bool contains(const Path& path, double time, double radius) const;
};

/// Returns the free space around the centre of a particle of a radius, in m. The ball rests. It leaves the particle at
/// most the distance `within`, in m. It leaves four fifths of that, or of the distances to planes and triangles, less
/// the distance within which a contact query considers surfaces. Beside shapes with a formula, the distance is halved
/// until they are certainly farther away, and can become 0. The centre must be finite.
[[nodiscard]] ClearSpace find_clear_ball(const CollisionWorld& world, const Vec3& center, double radius, double within);

}  // namespace ricochet
