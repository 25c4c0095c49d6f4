/// \file
/// The project response. It takes the whole step and then tests the new position. A particle behind a surface is put
/// back onto it, and its velocity is reversed ("pretend that we are in contact now").
///
/// Source: A. Witkin, D. Baraff, "Physically Based Modeling", SIGGRAPH 2001 course notes, part C (a particle within an
/// epsilon of a plane that moves towards it is in contact; velocity check); projection onto the surface as in T.
/// Jakobsen, "Advanced character physics", GDC 2001. Sides of meshes: angle-weighted pseudonormals (signed_distance.h).
///
/// A particle behind a surface, or within ProjectSettings::offset of it, is in contact. A particle behind a surface (a
/// sphere: one that overlaps it) is moved along the shortest path to the offset above the surface. If the particle
/// moves towards the surface, the material's restitution and friction reflect its velocity. A rebound slower than the
/// resting speed is suppressed. The impact speed does not include the velocity that forces have added in this step.
///
/// Limits:
/// - Walls thinner than a step is long may be missed. A particle that ends in the far half of a plate is projected to
///   the far side. A particle that ends beyond the plate is not detected.
/// - Position and time of an impact are of first order in the step.
/// - An elastic bounce gains the energy m g (depth + offset) by the lift.
/// - A particle that friction holds on a slope creeps in each step h by a h^2 / 2, the displacement by the forces'
///   acceleration a. With the symplectic Euler step, it creeps by a h^2.
/// - Corners of several colliders may stay unsolved after kMaxProjections passes.
#pragma once

#include "ricochet/response/side_watch.h"

namespace ricochet {

/// See the top of this file.
class ProjectResponse final : public SidedResponse {
public:
    using SidedResponse::SidedResponse;

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
    [[nodiscard]] SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                               const Vec3& pull) const override;
};

}  // namespace ricochet
