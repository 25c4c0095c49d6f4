/// \file
/// Particles that act on each other, as one system of ordinary differential equations.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/dynamics/springs.h"

namespace ricochet {

class MutualForces;

/// System of particles for a solver of ordinary differential equations. Entries 6 i to 6 i + 5 of the phase-space
/// vector are x, y, z (m) and vx, vy, vz (m/s) of member i. The derivative is zero for pinned members. Source of the
/// interface: A. Witkin, "Physically Based Modeling: Particle System Dynamics", SIGGRAPH course notes, 2001.
class ParticleSystem {
public:
    /// Spring of the system. `first` and `second` are member indices of its ends.
    struct Bond {
        std::uint32_t spring = 0;
        std::uint32_t first = 0;
        std::uint32_t second = 0;
    };

    /// Both arguments must outlive the system. The springs must be bound to the particles that assign() receives.
    ParticleSystem(const ForceField& forces, const SpringNetwork& springs) : forces_(forces), springs_(springs) {}
    /// Creates a system with forces between the members. `mutual` must outlive the system and have the same members.
    ParticleSystem(const ForceField& forces, const SpringNetwork& springs, const MutualForces& mutual)
        : forces_(forces), springs_(springs), mutual_(&mutual) {}

    /// Sets the members and copies their current state. members: ascending indices of particles. Throws InputError for
    /// members that do not exist or are not ascending. All functions throw InputError for a member index past the end
    /// and for lists whose length is not size().
    void assign(const Particles& particles, std::span<const std::uint32_t> members, double time);

    // The usual interface of solvers.

    /// Returns the length of the phase-space vector: six for each member.
    [[nodiscard]] std::size_t dimension() const { return 6 * size(); }
    [[nodiscard]] double time() const { return time_; }  ///< in s
    void set_time(double time) { time_ = time; }
    /// Copies the state to a vector of dimension() entries. This function and the functions below throw InputError for
    /// a vector of another length.
    void get_state(std::span<double> state) const;
    /// Sets the state from a vector. Pinned members do not change.
    void set_state(std::span<const double> state);
    /// Computes the derivative of the current state at a time, in s.
    void derivative(double time, std::span<double> result) const;
    /// Computes the derivative of the given state at a time, in s, for solvers that store the state themselves.
    void derivative(double time, std::span<const double> state, std::span<double> result) const;

    // The same data as vectors, for solvers that separate positions from velocities.

    [[nodiscard]] std::size_t size() const { return members_.size(); }  ///< number of members
    /// Returns the particle index of every member.
    [[nodiscard]] std::span<const std::uint32_t> members() const { return members_; }
    [[nodiscard]] const std::vector<Vec3>& positions() const { return position_; }   ///< in m
    [[nodiscard]] const std::vector<Vec3>& velocities() const { return velocity_; }  ///< in m/s
    /// Sets the acceleration of each member that is expected from surfaces in this step, in m/s^2. These values are
    /// included in all accelerations until the next assign().
    void expect_reactions(std::span<const Vec3> reactions);
    /// Returns the acceleration of member i that is expected from surfaces, in m/s^2.
    [[nodiscard]] const Vec3& expected_reaction(std::size_t i) const { return constants(i).reaction; }
    void set_phase(std::span<const Vec3> positions, std::span<const Vec3> velocities);
    /// Computes the accelerations of all members in the given state, in m/s^2. Accelerations of pinned members are
    /// zero.
    void accelerations(double time, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                       std::span<Vec3> result) const;
    /// Returns the accelerations of all members by forces between members other than springs, in m/s^2. The list is
    /// empty if there are no such forces.
    [[nodiscard]] std::vector<Vec3> mutual_accelerations(double time, std::span<const Vec3> positions,
                                                         std::span<const Vec3> velocities) const;
    /// Computes the accelerations in the given state. mutual: result of mutual_accelerations() in the same state.
    void accelerations(double time, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                       std::span<const Vec3> mutual, std::span<Vec3> result) const;
    /// Returns true if forces between the members depend on velocities.
    [[nodiscard]] bool has_mutual_damping() const;
    /// Returns the sum of the spring forces on member i, in N.
    [[nodiscard]] Vec3 spring_force_on(std::size_t i, std::span<const Vec3> positions,
                                       std::span<const Vec3> velocities) const;
    /// Returns the sum of the spring forces on member i, in N. state_of(k) returns an object with the position and
    /// velocity of member k.
    template <class StateOf>
    [[nodiscard]] Vec3 spring_force_in(std::size_t i, const StateOf& state_of) const;
    /// Returns the acceleration of member i by forces on single particles, in m/s^2.
    [[nodiscard]] Vec3 own_acceleration(std::size_t i, double time, const Vec3& position, const Vec3& velocity) const;
    /// Returns the derivative of own_acceleration() at the end of a backward Euler step with respect to the end
    /// velocity. The three columns are in 1/s, see acceleration_slope().
    [[nodiscard]] std::array<Vec3, 3> own_slope(std::size_t i, const Vec3& end_velocity, double duration) const;
    /// Returns the energy stored in the springs, in J.
    [[nodiscard]] double spring_energy(std::span<const Vec3> positions) const;
    [[nodiscard]] const std::vector<Bond>& bonds() const { return bonds_; }
    [[nodiscard]] const Spring& spring_of(const Bond& bond) const {
        require_index(bond.spring, springs_.springs().size(), "spring");
        return springs_.springs()[bond.spring];
    }
    [[nodiscard]] bool is_pinned(std::size_t i) const { return constants(i).pinned; }
    [[nodiscard]] double mass(std::size_t i) const { return constants(i).mass; }  ///< in kg
    [[nodiscard]] std::uint64_t id(std::size_t i) const { return constants(i).id; }
    /// Returns the force input of member i in the given state.
    [[nodiscard]] ForceInput input(std::size_t i, double time, const Vec3& position, const Vec3& velocity) const;
    /// Returns true if the forces on single particles depend on neither position, velocity nor time.
    [[nodiscard]] bool has_uniform_forces() const { return forces_.is_uniform(); }

private:
    /// Data that does not change within a step.
    struct Constants {
        std::uint64_t id = 0;
        double mass = 1.0;
        double radius = 0.0;
        bool pinned = false;
        Vec3 reaction{};  // acceleration expected from surfaces, in m/s^2
    };
    struct Link {
        std::uint32_t spring = 0;
        std::uint32_t other = 0;
        bool is_first = true;  // true if the member is the spring's first end
    };
    [[nodiscard]] const Constants& constants(std::size_t i) const {
        require_index(i, constants_.size(), "member of a system");
        return constants_[i];
    }
    void require_state(std::span<const Vec3> positions, std::span<const Vec3> velocities) const;
    void link(std::size_t particle_count);

    const ForceField& forces_;
    const SpringNetwork& springs_;
    const MutualForces* mutual_ = nullptr;
    std::vector<std::uint32_t> members_;
    std::vector<Constants> constants_;
    std::vector<Vec3> position_;
    std::vector<Vec3> velocity_;
    std::vector<Bond> bonds_;
    std::vector<std::uint32_t> first_link_;  // offset of each member in links_; size() + 1 entries
    std::vector<Link> links_;
    double time_ = 0.0;
};

// The forces on a member are summed in the order of its springs.
template <class StateOf>
Vec3 ParticleSystem::spring_force_in(std::size_t i, const StateOf& state_of) const {
    require_index(i, size(), "member of a system");
    const auto own = state_of(i);
    Vec3 sum;
    for (std::uint32_t k = first_link_[i]; k < first_link_[i + 1]; ++k) {
        const Link& link = links_[k];
        const auto other = state_of(link.other);
        const Spring& spring = springs_.springs()[link.spring];
        if (link.is_first) {
            sum += spring_force(spring, own.position, own.velocity, other.position, other.velocity);
        } else {
            sum += -spring_force(spring, other.position, other.velocity, own.position, own.velocity);
        }
    }
    return sum;
}

/// User-defined solver. It advances the system by `duration` seconds through the solver interface of ParticleSystem. It
/// must be a pure function of the system's state.
using SystemSolver = std::function<void(ParticleSystem& system, double duration)>;

}  // namespace ricochet
