/// \file
/// Particles that act on each other as one system of ordinary differential equations: the interface that classical
/// solvers ask for.
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

/// The phase-space vector of a system of particles, its dimension, and its derivative at a time: all that a solver of
/// ordinary differential equations needs to know. Entries 6 i to 6 i + 5 are x, y, z (m) and vx, vy, vz (m/s) of member
/// i; the derivative holds the velocity and the acceleration at the same indices, zeros for pinned members.
///
/// Source of the interface: A. Witkin, "Physically Based Modeling: Particle System Dynamics", SIGGRAPH course notes,
/// 2001 (dimension, get state, set state, derivative).
class ParticleSystem {
public:
    /// A spring of the system; both ends are member numbers.
    struct Bond {
        std::uint32_t spring = 0;
        std::uint32_t first = 0;
        std::uint32_t second = 0;
    };

    /// Both must outlive the system. The springs must be bound to the particles of assign().
    ParticleSystem(const ForceField& forces, const SpringNetwork& springs) : forces_(forces), springs_(springs) {}
    /// With forces between the members, which must outlive it too and have the same members assigned.
    ParticleSystem(const ForceField& forces, const SpringNetwork& springs, const MutualForces& mutual)
        : forces_(forces), springs_(springs), mutual_(&mutual) {}

    /// Takes these particles, by index and ascending, as its members, in the state that they have. Throws InputError
    /// for members that are not there or do not ascend, as all functions do for members past the end and lists that do
    /// not have size() entries.
    void assign(const Particles& particles, std::span<const std::uint32_t> members, double time);

    // The classical interface.

    /// Length of the phase-space vector: six for each member.
    [[nodiscard]] std::size_t dimension() const { return 6 * size(); }
    [[nodiscard]] double time() const { return time_; }  ///< s
    void set_time(double time) { time_ = time; }
    /// Copies the state to a vector of dimension() entries; throws InputError for another length, as all three do.
    void get_state(std::span<double> state) const;
    /// The opposite. Positions and velocities of pinned members stay as they are.
    void set_state(std::span<const double> state);
    /// The derivative of the present state at a time, s.
    void derivative(double time, std::span<double> result) const;
    /// The derivative of any state at a time, for solvers that keep the state themselves.
    void derivative(double time, std::span<const double> state, std::span<double> result) const;

    // The same as vectors, for solvers that know positions from velocities.

    [[nodiscard]] std::size_t size() const { return members_.size(); }  ///< members
    /// Index of every member among the particles.
    [[nodiscard]] std::span<const std::uint32_t> members() const { return members_; }
    [[nodiscard]] const std::vector<Vec3>& positions() const { return position_; }   ///< m
    [[nodiscard]] const std::vector<Vec3>& velocities() const { return velocity_; }  ///< m/s
    /// What surfaces are expected to give each member in this step, m/s^2: a part of all accelerations from now on,
    /// until the next assign().
    void expect_pushes(std::span<const Vec3> pushes);
    /// That of member i.
    [[nodiscard]] const Vec3& expected_push(std::size_t i) const { return constants(i).push; }
    void set_phase(std::span<const Vec3> positions, std::span<const Vec3> velocities);
    /// Accelerations of all members in a state, m/s^2; zero for pinned ones.
    void accelerations(double time, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                       std::span<Vec3> result) const;
    /// What forces between the members do to each in a state, m/s^2; empty where there are none.
    [[nodiscard]] std::vector<Vec3> mutual_accelerations(double time, std::span<const Vec3> positions,
                                                         std::span<const Vec3> velocities) const;
    /// accelerations() where mutual_accelerations() of that state is known.
    void accelerations(double time, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                       std::span<const Vec3> mutual, std::span<Vec3> result) const;
    /// True when forces between the members depend on velocities.
    [[nodiscard]] bool has_mutual_damping() const;
    /// What the springs do to member i, N.
    [[nodiscard]] Vec3 spring_force_on(std::size_t i, std::span<const Vec3> positions,
                                       std::span<const Vec3> velocities) const;
    /// The same in the state that state_of(k) says of every member k: anything with a position and a velocity.
    template <class StateOf>
    [[nodiscard]] Vec3 spring_force_in(std::size_t i, const StateOf& state_of) const;
    /// What forces on single particles do to member i, m/s^2.
    [[nodiscard]] Vec3 own_acceleration(std::size_t i, double time, const Vec3& position, const Vec3& velocity) const;
    /// Derivative of own_acceleration() at the end of a backward Euler step by the velocity there, see
    /// acceleration_slope(): three columns, 1/s.
    [[nodiscard]] std::array<Vec3, 3> own_slope(std::size_t i, const Vec3& end_velocity, double duration) const;
    /// Energy stored in the springs, J.
    [[nodiscard]] double spring_energy(std::span<const Vec3> positions) const;
    [[nodiscard]] const std::vector<Bond>& bonds() const { return bonds_; }
    [[nodiscard]] const Spring& spring_of(const Bond& bond) const {
        require_index(bond.spring, springs_.springs().size(), "spring");
        return springs_.springs()[bond.spring];
    }
    [[nodiscard]] bool is_pinned(std::size_t i) const { return constants(i).pinned; }
    [[nodiscard]] double mass(std::size_t i) const { return constants(i).mass; }  ///< kg
    [[nodiscard]] std::uint64_t id(std::size_t i) const { return constants(i).id; }
    /// What a force sees of member i in this state.
    [[nodiscard]] ForceInput input(std::size_t i, double time, const Vec3& position, const Vec3& velocity) const;
    /// True when the forces on single particles depend on neither position, velocity nor time.
    [[nodiscard]] bool has_uniform_forces() const { return forces_.is_uniform(); }

private:
    /// What does not change within a step.
    struct Constants {
        std::uint64_t id = 0;
        double mass = 1.0;
        double radius = 0.0;
        bool pinned = false;
        Vec3 push{};  // m/s^2, expected of surfaces
    };
    struct Link {
        std::uint32_t spring = 0;
        std::uint32_t other = 0;
        bool is_first = true;  // the member is the spring's first end
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
    std::vector<std::uint32_t> first_link_;  // size() + 1 entries into links_
    std::vector<Link> links_;
    double time_ = 0.0;
};

// Every member gathers for itself, in the order of the springs: no two threads write to one entry.
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

/// An own solver: advances the system by `duration` seconds, through the classical interface. It must be a pure
/// function of the system's state.
using SystemSolver = std::function<void(ParticleSystem& system, double duration)>;

}  // namespace ricochet
