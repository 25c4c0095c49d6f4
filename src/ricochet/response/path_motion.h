/// \file
/// Private to the exact response: moves a particle along a path, in free flight or along surfaces, up to the first
/// contact.
///
/// Each function finds the first contact, moves the particle there in certified segments, and advances its time. A path
/// whose numbers are too large cannot be followed: the particle is frozen.
#pragma once

#include <optional>
#include <span>

#include "ricochet/collision/contact_query.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// Follows a flight to its end or to the contact that is returned. With a look-ahead (null: none) the outcome says how
/// long the particle remains free. Afterwards the particle has its velocity of arrival, before the impact. candidates:
/// see ContactQuery.
std::optional<Contact> follow_flight(ParticleStep& step, const Flight& flight, const Integrator& integrator,
                                     const LookAhead* look_ahead, const ContactCandidates& candidates);

/// Reference to a function object that refines an approximate path. After a contact at a time on the path, the function
/// returns a shorter path. It returns nothing if the path is close enough to the true motion at that time. The function
/// object must outlive the reference.
class PathRefinement {
public:
    template <class Refine>
    PathRefinement(const Refine& refine)  // NOLINT(google-explicit-constructor): a lambda is passed in its place
        : object_(&refine), call_([](const void* object, double time, const Path& path) -> std::optional<Path> {
              return (*static_cast<const Refine*>(object))(time, path);
          }) {}
    [[nodiscard]] std::optional<Path> operator()(double time, const Path& path) const {
        return call_(object_, time, path);
    }

private:
    const void* object_;
    std::optional<Path> (*call_)(const void*, double, const Path&);
};

/// Follows a path. The particle gets the velocity of the path. supports: surfaces along which the path leads, see
/// ContactQuery.
std::optional<Contact> follow_path(ParticleStep& step, const Path& path, std::span<const SurfaceId> supports = {});
/// Follows an approximate path. After a contact it tries the refined path instead, as long as `refine` returns one.
std::optional<Contact> follow_path(ParticleStep& step, const Path& path, std::span<const SurfaceId> supports,
                                   const PathRefinement& refine);

/// Limits how often a path is refined. A cubic between two states approximates the true motion to the fourth power of
/// its duration, so few refinements suffice.
class RefinementBudget {
public:
    /// Returns true if the path should be refined. on_path and true_position: positions at the contact's time. offset:
    /// contact offset there, in m.
    [[nodiscard]] bool may_improve(const Vec3& on_path, const Vec3& true_position, double offset) {
        return length(true_position - on_path) > kTouchingOffsets * offset && ++refinements_ <= kMost;
    }

private:
    static constexpr int kMost = 12;
    int refinements_ = 0;
};

/// Follows a straight path that is known to touch nothing.
void follow_clear_path(ParticleStep& step, const Path& line);

/// Keeps the particle at its position for a duration, in s. Returns a contact if a collider moves to it. supports: see
/// ContactQuery.
std::optional<Contact> wait_in_place(ParticleStep& step, double duration, std::span<const SurfaceId> supports = {});

/// Returns the first contact of a ball of the given radius, in m, on a path in the world, among moving colliders. Moves
/// nothing.
[[nodiscard]] std::optional<Contact> first_contact_of_ball(ParticleStep& step, const Path& path, double radius,
                                                           std::span<const SurfaceId> supports);

}  // namespace ricochet
