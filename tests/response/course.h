/// \file
/// A course for single particles: colliders, forces and materials to move one through.
#pragma once

#include <list>
#include <memory>
#include <utility>
#include <vector>

#include "ricochet/response/response.h"

namespace ricochet::testing {

/// One particle among colliders of one material.
struct Course {
    /// Creates a course with the exact response.
    Course(std::vector<ColliderDescription> colliders, Material material, const Vec3& gravity,
           IntegratorKind integrator = IntegratorKind::ballistic, std::uint32_t budget = 1000)
        : Course(std::move(colliders), std::move(material), gravity, ResponseKind::exact,
                 settings_of(integrator, budget)) {}

    /// Creates a course with any response.
    Course(std::vector<ColliderDescription> colliders, Material material, const Vec3& gravity, ResponseKind kind,
           const ResponseSettings& settings)
        : world(std::move(colliders)),
          forces(field(gravity)),
          materials{std::move(material)},
          response(make_response(kind, {world, bodies, forces, materials, settings})) {}

    static ResponseSettings settings_of(IntegratorKind integrator, std::uint32_t budget) {
        ResponseSettings settings;
        settings.integrator = integrator;
        settings.bounce_budget = budget;
        return settings;
    }
    static ForceField field(const Vec3& gravity) {
        std::vector<std::unique_ptr<Force>> list;
        if (gravity != Vec3{}) list.push_back(make_gravity(gravity));
        return ForceField(std::move(list));
    }
    /// Moves a point. The contact state is kept if the point is where the last move left it. Hits and records contain
    /// this move only.
    MoveOutcome move(ForceInput& state, double duration) {
        const bool goes_on = state.position == last_position && state.velocity == last_velocity;
        MovingParticle particle{state, {}, 0, 0, goes_on ? last_contact : ContactState{}};
        if (goes_on) particle.sides = last_sides;
        const MoveOutcome outcome = move(particle, duration);
        state = particle.state;
        last_position = state.position;
        last_velocity = state.velocity;
        last_contact = particle.contact;
        last_sides = particle.sides;
        return outcome;
    }
    /// Moves any particle. A new particle gets the sides of its current position.
    MoveOutcome move(MovingParticle& particle, double duration) {
        scratch.hits.clear();
        scratch.records.clear();
        scratch.segments.clear();
        scratch.record_contacts = true;
        world.prepare_radius(particle.state.radius);
        if (particle.sides.empty()) enrol(particle);
        return response->move(particle, duration, scratch);
    }
    /// Assigns memory of sides to the particle, if the response keeps it.
    void enrol(MovingParticle& particle) {
        if (!response->keeps_sides()) return;
        particle.sides = sides.emplace_back(world.colliders().size());
        response->first_sides(particle.state.position, particle.sides);
    }
    /// Returns the times of the impacts of the last move.
    [[nodiscard]] std::vector<double> impact_times() const {
        std::vector<double> times;
        for (const ContactRecord& record : scratch.records) times.push_back(record.time);
        return times;
    }

    CollisionWorld world;
    MovingColliders bodies{world};
    ForceField forces;
    std::vector<Material> materials;
    std::unique_ptr<Response> response;
    MoveScratch scratch;
    Vec3 last_position;
    Vec3 last_velocity;
    ContactState last_contact;
    std::span<SideMemory> last_sides;
    std::list<std::vector<SideMemory>> sides;  ///< one list per particle
};

}  // namespace ricochet::testing
