/// \file
/// Moves a particle along a path, in free flight or along surfaces, up to the first contact.
///
/// Each function finds the first contact, moves the particle there in certified segments, and advances its time. A path
/// whose numbers are too large cannot be followed: the particle is frozen.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "ricochet/collision/contact_query.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// Follows a flight to its end or to the contact that is returned. With a look-ahead (null: none) the outcome says how
/// long the particle remains free. The particle gets its velocity before the impact. candidates: see ContactQuery.
std::optional<Contact> follow_flight(ParticleStep& step, const Flight& flight, const Integrator& integrator,
                                     const LookAhead* look_ahead, const ContactCandidates& candidates);

/// Refines an approximate path. After a contact at a time on the path, in s, it returns a shorter path, or nothing if
/// the path is close enough.
using PathRefinement = std::function<std::optional<Path>(double time, const Path& path)>;

/// Follows a path. The particle gets the path's velocity. supports: see ContactQuery. After a contact it tries the path
/// that `refine` returns instead, as long as there is one.
std::optional<Contact> follow_path(ParticleStep& step, const Path& path, std::span<const SurfaceId> supports = {},
                                   const PathRefinement& refine = nullptr);

/// Limits how often a path is refined. The error of a cubic is of fourth order in time, so few refinements suffice.
class RefinementBudget {
public:
    /// Returns true if a path should be refined, by its position and the true one at a contact. offset: contact offset,
    /// in m.
    [[nodiscard]] bool may_improve(const Vec3& on_path, const Vec3& true_position, double offset) {
        return length(true_position - on_path) > kTouchingOffsets * offset && ++refinements_ <= kMost;
    }

private:
    static constexpr int kMost = 12;
    int refinements_ = 0;
};

/// Follows a straight path that is known to touch nothing.
void follow_clear_path(ParticleStep& step, const Path& line);

/// Keeps the particle at its position for a duration, in s, or until a collider moves to it.
std::optional<Contact> wait_in_place(ParticleStep& step, double duration, std::span<const SurfaceId> supports = {});

/// Returns the first contact of a ball of a radius, in m, on a path in the world, among moving colliders.
[[nodiscard]] std::optional<Contact> first_contact_of_ball(ParticleStep& step, const Path& path, double radius,
                                                           std::span<const SurfaceId> supports);

}  // namespace ricochet
