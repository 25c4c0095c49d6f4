/// \file
/// Private to the library: the forces between particles of a simulation, each with the members of a system that it acts
/// on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/dynamics/particles.h"
#include "ricochet/dynamics/particles_force.h"

namespace ricochet {

class MutualForces {
public:
    MutualForces() = default;
    /// Throws InputError for a null pointer.
    explicit MutualForces(std::vector<ParticlesForceEntry> entries);

    [[nodiscard]] bool empty() const { return entries_.empty(); }
    /// Returns true if one of the forces acts on particle i.
    [[nodiscard]] bool act_on(const Particles& particles, std::size_t i) const;
    [[nodiscard]] bool depend_on_velocity() const;

    /// Sets the members of a system: ascending indices of particles; frozen particles are skipped. Throws InputError
    /// for an attribute that particles do not have.
    void assign(const Particles& particles, std::span<const std::uint32_t> members);
    /// Computes the acceleration of every member in this state, in m/s^2, as the sum of all forces in their order.
    void accelerations(double time, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                       std::span<Vec3> result) const;
    /// Returns the potential energy in a state of the members, in J; nothing if one force has no potential.
    [[nodiscard]] std::optional<double> potential_energy(double time, std::span<const Vec3> positions,
                                                         std::span<const Vec3> velocities) const;

private:
    /// View of a force on its members, except for their state.
    struct Seen {
        std::vector<std::uint32_t> slots;  // indices among the members, ascending
        bool is_all = false;               // true if slots lists all members
        std::vector<std::uint64_t> ids;
        std::vector<double> masses;
        std::vector<double> radii;
        std::vector<std::vector<double>> attributes;
    };
    /// Positions and velocities of the members of a force. Unused if it acts on all particles.
    struct Gathered {
        std::vector<Vec3> positions;
        std::vector<Vec3> velocities;
    };
    [[nodiscard]] bool acts_on(const ParticlesForceEntry& entry, const Particles& particles, std::size_t i) const;
    [[nodiscard]] Seen seen_by(const ParticlesForceEntry& entry, const Particles& particles,
                               std::span<const std::uint32_t> members) const;
    [[nodiscard]] static ParticlesView view_of(const Seen& seen, double time, std::span<const Vec3> positions,
                                               std::span<const Vec3> velocities, Gathered& gathered);

    std::vector<ParticlesForceEntry> entries_;  // lists of ids and emitters are sorted
    std::vector<Seen> seen_;                    // by entry
};

}  // namespace ricochet
