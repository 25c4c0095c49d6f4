/// \file
/// Springs between particles: the network that they make, its forces, and how it tears.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// One damped spring between two particles.
struct Spring {
    std::uint64_t first = 0;   ///< particle id
    std::uint64_t second = 0;  ///< particle id, another one
    double rest_length = 0.0;  ///< m, >= 0
    double stiffness = 0.0;    ///< N/m, >= 0
    double damping = 0.0;      ///< N s/m along the spring, >= 0
    /// Stretch, relative to the rest length, beyond which it breaks for good: > 0; infinite where it never does. A
    /// spring without a rest length has no relative stretch and cannot break.
    double breaking_stretch = std::numeric_limits<double>::infinity();
    bool resists_bending = false;  ///< lies across an edge of cloth: a force like the others, but no thread to be shown
};

/// Force on the first end of a spring, N: (k (l - l0) + c l') along the unit vector towards the second end, with l the
/// distance of the ends and l' its rate of change. Where the ends coincide a spring has no direction: zero. The force
/// on the second end is exactly the opposite. Source: A. Witkin, D. Baraff, M. Kass, "Physically Based Modeling",
/// SIGGRAPH 2001 course notes, "Particle System Dynamics", damped spring.
[[nodiscard]] Vec3 spring_force(const Spring& spring, const Vec3& x_first, const Vec3& v_first, const Vec3& x_second,
                                const Vec3& v_second);

/// Springs over particles that are known by their ids. `bind` says in which order the particles stand; what is asked
/// about positions afterwards means that order. Asking is free of side effects and may happen from any thread.
class SpringNetwork {
public:
    SpringNetwork() = default;
    /// Every spring is intact at first; call bind before asking for forces. Throws InputError, naming the spring by its
    /// number, for values out of range and for a spring from a particle to itself.
    explicit SpringNetwork(std::vector<Spring> springs);

    /// True when there never was a spring.
    [[nodiscard]] bool empty() const { return springs_.empty(); }
    /// All springs ever, in their order.
    [[nodiscard]] const std::vector<Spring>& springs() const { return springs_; }
    /// True while spring number `spring` has neither broken nor lost an end.
    [[nodiscard]] bool is_intact(std::size_t spring) const { return states_[spring] == State::intact; }

    /// Compiles the intact springs for particles that stand in this order: entry i has the id ids[i], each id once.
    /// Springs one end of which is missing are removed for good and counted as lost. To be called whenever particles
    /// were added, removed or reordered.
    void bind(std::span<const std::uint64_t> ids);

    /// An intact spring and its ends, as indices of bind's order: `a` is the first end, `b` the second.
    struct Bond {
        std::uint32_t spring;
        std::uint32_t a;
        std::uint32_t b;
    };
    /// The intact springs, in the order of their numbers.
    [[nodiscard]] const std::vector<Bond>& bonds() const { return bonds_; }

    /// A spring as one of its ends sees it.
    struct Link {
        std::uint32_t spring;
        std::uint32_t other;  ///< the other end, an index of bind's order
    };
    /// The intact springs of particle i, in the order of their numbers.
    [[nodiscard]] std::span<const Link> links(std::uint32_t i) const {
        return {links_.data() + link_begin_[i], link_begin_[i + 1] - link_begin_[i]};
    }
    /// Particles with at least one intact spring, indices of bind's order, ascending.
    [[nodiscard]] const std::vector<std::uint32_t>& coupled() const { return coupled_; }

    /// Sum of the spring forces on particle i, N. Springs are added in the order of their numbers, so that the bits
    /// depend neither on threads nor on the order of the particles.
    [[nodiscard]] Vec3 force_on(std::uint32_t i, std::span<const Vec3> position, std::span<const Vec3> velocity) const;
    /// Energy stored in the intact springs, J: the sum of k/2 (l - l0)^2. Dampers store none.
    [[nodiscard]] double potential_energy(std::span<const Vec3> position) const;

    /// Breaks the springs that are longer than (1 + breaking_stretch) * rest_length; they stay broken. Returns how
    /// many.
    std::size_t break_overstretched(std::span<const Vec3> position);

    /// Springs that have broken so far.
    [[nodiscard]] std::size_t broken() const { return broken_; }
    /// Springs that have been removed so far because a particle at an end was gone.
    [[nodiscard]] std::size_t lost() const { return lost_; }

private:
    enum class State : std::uint8_t { intact, broken, lost };

    void compile_links();

    std::vector<Spring> springs_;
    std::vector<State> states_;  // per spring
    std::vector<Bond> bonds_;
    std::size_t particle_count_ = 0;         // of bind
    std::vector<std::uint32_t> link_begin_;  // per particle: its part of links_, and the end
    std::vector<Link> links_;
    std::vector<std::uint32_t> coupled_;
    std::size_t broken_ = 0;
    std::size_t lost_ = 0;
};

}  // namespace ricochet
