/// \file
/// Forces between the particles of a simulation. Each force has a list of the members of a system that it acts on.
/// Private to the library.
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
    /// Returns true if any of the forces acts on particle i.
    [[nodiscard]] bool act_on(const Particles& particles, std::size_t i) const;
    [[nodiscard]] bool depend_on_velocity() const;

    /// Sets the members of a system. members: ascending indices of particles. Frozen particles are skipped. Throws
    /// InputError if a force reads an attribute that the particles do not have.
    void assign(const Particles& particles, std::span<const std::uint32_t> members);
    /// Computes the acceleration of every member in the given state, in m/s^2. Forces are added in their order.
    void accelerations(double time, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                       std::span<Vec3> result) const;
    /// Returns the potential energy of the members in the given state, in J; nothing if any force has no potential.
    [[nodiscard]] std::optional<double> potential_energy(double time, std::span<const Vec3> positions,
                                                         std::span<const Vec3> velocities) const;

private:
    /// Data of the members that a force acts on, without positions and velocities.
    struct Seen {
        std::vector<std::uint32_t> slots;  // indices among the members, ascending
        bool is_all = false;               // true if slots lists all members
        std::vector<std::uint64_t> ids;
        std::vector<double> masses;
        std::vector<double> radii;
        std::vector<std::vector<double>> attributes;
    };
    /// Positions and velocities of the members that a force acts on. Unused if the force acts on all members.
    struct Gathered {
        std::vector<Vec3> positions;
        std::vector<Vec3> velocities;
    };
    [[nodiscard]] bool acts_on(const ParticlesForceEntry& entry, const Particles& particles, std::size_t i) const;
    [[nodiscard]] Seen seen_by(const ParticlesForceEntry& entry, const Particles& particles,
                               std::span<const std::uint32_t> members) const;
    [[nodiscard]] static ParticlesView view_of(const Seen& seen, double time, std::span<const Vec3> positions,
                                               std::span<const Vec3> velocities, Gathered& gathered);

    std::vector<ParticlesForceEntry> entries_;  // forces, with sorted lists of ids and emitters
    std::vector<Seen> seen_;                    // members of each entry
};

}  // namespace ricochet
