/// \file
/// The project response: take the whole step, test where it has led to, put a particle that is behind a surface back
/// onto it and turn its velocity ("pretend that we are in contact now").
///
/// Source: A. Witkin, D. Baraff, "Physically Based Modeling", SIGGRAPH 2001 course notes, part C (a particle within an
/// epsilon of a plane that moves towards it is in contact; velocity check); projection onto the surface as in T.
/// Jakobsen, "Advanced character physics", GDC 2001. Sides of meshes: angle-weighted pseudonormals (signed_distance.h).
///
/// A particle within ProjectSettings::offset of a surface, or behind it, is in contact. One that has come behind (a
/// sphere: that overlaps) is moved along the shortest path to the offset above the surface. If it moves towards the
/// surface its velocity is reflected with the material's restitution and friction. A rebound slower than the resting
/// speed, not counting what the forces have added in this step, is none.
///
/// What it does not guarantee: that a wall is noticed at all that is thinner than a step is long (what ends on the far
/// side of a plate is projected to the far side, what ends beyond it is not seen); that an impact happens where and
/// when it does (both are of first order in the step); energy (an elastic bounce gains m g (depth + offset), the lift);
/// rest without creep (a particle held by friction on a slope creeps by the forces' half step squared, with the
/// symplectic Euler step by the whole); that a corner of several colliders is solved (kMaxProjections passes).
#pragma once

#include "ricochet/collision/signed_distance.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// See the top of this file.
class ProjectResponse final : public Response {
public:
    explicit ProjectResponse(const ResponseRules& rules) : Response(rules), distance_(rules.world) {}

    MoveOutcome move(MovingParticle& particle, double duration, MoveScratch& scratch) const override;
    [[nodiscard]] SupportedAcceleration supported_acceleration(const MovingParticle& particle,
                                                               const Vec3& pull) const override;
    [[nodiscard]] bool keeps_sides() const override { return true; }
    void first_sides(const Vec3& position, std::span<SideMemory> sides) const override;
    void inherit_sides(const ChildStart& start, std::span<SideMemory> sides) const override;

private:
    SignedDistance distance_;
};

}  // namespace ricochet
