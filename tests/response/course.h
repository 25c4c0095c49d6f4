/// \file
/// A course for single particles: colliders, forces and materials ready to move one through.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "ricochet/response/exact.h"

namespace ricochet::testing {

/// One particle among colliders of one material.
struct Course {
    Course(std::vector<ColliderDescription> colliders, Material material, const Vec3& gravity,
           IntegratorKind integrator = IntegratorKind::ballistic, std::uint32_t budget = 1000)
        : world(std::move(colliders)),
          forces(field(gravity)),
          materials{std::move(material)},
          response(world, forces, materials, {integrator, 1e-3, budget}) {}

    static ForceField field(const Vec3& gravity) {
        std::vector<std::unique_ptr<Force>> list;
        if (gravity != Vec3{}) list.push_back(make_gravity(gravity));
        return ForceField(std::move(list));
    }
    /// Moves a point, which goes on in contact when it is where the last move left it; hits and records are those of
    /// this move.
    MoveOutcome move(ForceInput& state, double duration) {
        const bool goes_on = state.position == last_position && state.velocity == last_velocity;
        MovingParticle particle{state, {}, 0, 0, goes_on ? last_support : Support{}};
        const MoveOutcome outcome = move(particle, duration);
        state = particle.state;
        last_position = state.position;
        last_velocity = state.velocity;
        last_support = particle.support;
        return outcome;
    }
    MoveOutcome move(MovingParticle& particle, double duration) {
        scratch.hits.clear();
        scratch.records.clear();
        scratch.record_contacts = true;
        world.prepare_radius(particle.state.radius);
        return response.move(particle, duration, scratch);
    }
    /// Times of the impacts of the last move.
    [[nodiscard]] std::vector<double> impact_times() const {
        std::vector<double> times;
        for (const ContactRecord& record : scratch.records) times.push_back(record.time);
        return times;
    }

    CollisionWorld world;
    ForceField forces;
    std::vector<Material> materials;
    ExactResponse response;
    MoveScratch scratch;
    Vec3 last_position;
    Vec3 last_velocity;
    Support last_support;
};

}  // namespace ricochet::testing
