/// \file
/// Spheres that one contact problem moves together, step by step, without a simulation.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "response/course.h"
#include "ricochet/response/contact_solver/contact_island.h"

namespace ricochet::testing {

class Pile {
public:
    static constexpr double kGravity = 9.81;

    Pile(std::vector<ColliderDescription> colliders, const Material& material, const PairMaterial& law)
        : course_(std::move(colliders), material, {0, 0, -kGravity}),
          materials_(PairContactSettings{law.restitution, law.friction, law.rolling_friction}),
          island_(course_.response->rules(), materials_) {}

    /// Adds a sphere of density 2500 kg/m^3.
    void add(const Vec3& center, double radius, const Vec3& velocity = {}) {
        course_.world.prepare_radius(radius);
        MovingParticle particle;
        particle.state.position = center;
        particle.state.velocity = velocity;
        particle.state.mass = 2500.0 * 4.18879020478639 * radius * radius * radius;
        particle.state.radius = radius;
        particle.id = particles_.size();
        particles_.push_back(particle);
    }

    void step(double duration) {
        std::vector<ContactIslandMember> members;
        for (MovingParticle& particle : particles_)
            members.push_back({&particle, particle.state.radius, false, duration, {}});
        course_.scratch.segments.clear();
        course_.scratch.hits.clear();
        course_.scratch.record_segments = true;
        std::vector<double> reach;
        for (ContactIslandMember& member : members) reach.push_back(member.reach = island_.first_reach(member));
        const SolverReport report = island_.plan(members, pairs(reach), duration, 1.0, memory_, course_.scratch);
        unsolved += report.is_converged ? 0 : 1;
        sweeps += report.sweeps;
        memory_.replace(island_.entries());
        for (std::size_t i = 0; i < members.size(); ++i) {
            island_.move(i, members[i], course_.scratch);
            unsimulated += members[i].outcome.unsimulated_time;
        }
        measure();
    }
    void run(double time, double duration) {
        for (int k = 0; k * duration < time; ++k) step(duration);
    }

    [[nodiscard]] std::vector<MovingParticle>& particles() { return particles_; }
    [[nodiscard]] std::vector<Vec3> centers() const {
        std::vector<Vec3> all;
        for (const MovingParticle& particle : particles_) all.push_back(particle.state.position);
        return all;
    }
    [[nodiscard]] double fastest() const {
        double most = 0.0;
        for (const MovingParticle& particle : particles_) most = std::max(most, length(particle.state.velocity));
        return most;
    }
    [[nodiscard]] double energy() const {
        double sum = 0.0;
        for (const MovingParticle& p : particles_) {
            const double turning = 0.4 * p.state.radius * p.state.radius * length_squared(p.spin);
            sum += p.state.mass * (0.5 * (length_squared(p.state.velocity) + turning) + kGravity * p.state.position.z);
        }
        return sum;
    }

    double overlap = 0.0;  ///< largest overlap after the last step, over the smaller radius
    int unsolved = 0;
    int sweeps = 0;
    double unsimulated = 0.0;

private:
    /// Returns the pairs of near spheres, found by sorting along x.
    [[nodiscard]] std::vector<NeighbourPair> pairs(const std::vector<double>& reach) const {
        std::vector<std::pair<double, std::uint32_t>> begins;
        const auto half = [&](std::uint32_t i) { return particles_[i].state.radius + reach[i]; };
        for (std::uint32_t i = 0; i < particles_.size(); ++i) {
            begins.emplace_back(particles_[i].state.position.x - half(i), i);
        }
        std::sort(begins.begin(), begins.end());
        std::vector<NeighbourPair> found;
        for (std::size_t n = 0; n < begins.size(); ++n) {
            const std::uint32_t i = begins[n].second;
            const double end = particles_[i].state.position.x + half(i);
            for (std::size_t m = n + 1; m < begins.size() && begins[m].first <= end; ++m) {
                const std::uint32_t j = begins[m].second;
                const Vec3 apart = particles_[i].state.position - particles_[j].state.position;
                if (length(apart) < half(i) + half(j)) {
                    found.push_back({std::min(i, j), std::max(i, j)});
                }
            }
        }
        std::sort(found.begin(), found.end(), [](const NeighbourPair& a, const NeighbourPair& b) {
            return a.first != b.first ? a.first < b.first : a.second < b.second;
        });
        return found;
    }
    void measure() {
        overlap = 0.0;
        for (const auto& [i, j] : pairs(std::vector<double>(particles_.size(), 0.0))) {
            const ForceInput& a = particles_[i].state;
            const ForceInput& b = particles_[j].state;
            const double deep = a.radius + b.radius - length(a.position - b.position);
            overlap = std::max(overlap, deep / std::min(a.radius, b.radius));
        }
    }

    Course course_;
    PairMaterials materials_;
    ContactIsland island_;
    WarmStartMemory memory_;
    std::vector<MovingParticle> particles_;
};

}  // namespace ricochet::testing
