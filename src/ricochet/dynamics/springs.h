/// \file
/// Springs between particles: the network that they make, its forces, how it tears, and makers of ropes and cloth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

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
/// about positions afterwards means that order: one entry a particle. Asking is free of side effects and may happen
/// from any thread. Numbers past the end and lists of another length are InputErrors.
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
    [[nodiscard]] bool is_intact(std::size_t spring) const {
        require_index(spring, states_.size(), "spring");
        return states_[spring] == State::intact;
    }

    /// Compiles the intact springs for particles that stand in this order: entry i has the id ids[i]. Throws InputError
    /// for an id that is there twice.
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
        require_index(i, particle_count_, "particle of a spring");
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

    /// Saves or restores which springs are broken or lost; a: what a simulation saves to or restores from. Call bind
    /// after it.
    template <class Archive>
    void archive(Archive& a) {
        a(states_, springs_.size());
        a(broken_);
        a(lost_);
        if constexpr (Archive::kReads) require_states();
    }

    /// Springs that have broken so far.
    [[nodiscard]] std::size_t broken() const { return broken_; }
    /// Springs that have been removed so far because a particle at an end was gone.
    [[nodiscard]] std::size_t lost() const { return lost_; }

private:
    enum class State : std::uint8_t { intact, broken, lost };

    void compile_links();
    void require_states() const;
    void require_entries(std::span<const Vec3> values) const;

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

// Makes ropes, chains and cloth: particles and the springs between them.

/// A triangle of cloth between three particles, there as long as its three springs are. It is shown, and exerts no
/// force of its own.
struct SpringFace {
    std::array<std::uint64_t, 3> corners;  ///< particle ids, in the mesh's winding
    std::array<std::uint32_t, 3> springs;  ///< numbers of the springs along its edges
};

/// Particles with springs between them. Ids are positions in `particles`; entries of `springs` refer to these.
struct SpringBody {
    std::vector<Particle> particles;
    std::vector<Spring> springs;
    std::vector<SpringFace> faces;  ///< empty for ropes

    /// Adds another body behind this one; its ids and spring numbers are moved up.
    void append(const SpringBody& body);
};

/// A rope: nodes at equal distances along it, a spring between neighbours.
struct RopeSettings {
    Vec3 from;              ///< m, first node
    Vec3 to;                ///< m, last node, not where the first is
    std::size_t nodes = 2;  ///< >= 2
    /// Length at rest, m, > 0; default: the distance of the ends. A longer rope starts as a catenary that hangs in the
    /// direction `sag`, a shorter one as a straight line under tension.
    std::optional<double> length = {};
    Vec3 sag{0, 0, -1};   ///< direction in which a slack rope hangs at first, of any length but zero
    double mass = 1.0;    ///< kg in all, > 0; every segment gives half of its mass to each of its nodes
    double radius = 0.0;  ///< m, >= 0, of every node
    /// Exactly one of the two: stiffness of every segment, N/m, or that of the material, E A (modulus times cross
    /// section), N, from which a segment of rest length l has the stiffness E A / l.
    std::optional<double> stiffness = {};
    std::optional<double> axial_stiffness = {};
    double damping = 0.0;                                               ///< N s/m, >= 0, of every segment
    double breaking_stretch = std::numeric_limits<double>::infinity();  ///< of every segment, see Spring
    bool pin_from = false;                                              ///< the first node never moves
    bool pin_to = false;                                                ///< the last node never moves
};
/// Nodes in order, spring i between nodes i and i + 1. Throws InputError for values out of range.
[[nodiscard]] SpringBody make_rope(const RopeSettings& settings);

/// Cloth: a particle for every vertex of a triangle mesh, a spring along every edge.
struct ClothSettings {
    double mass_per_area = 1.0;  ///< kg/m^2, > 0; a vertex has a third of the mass of each triangle around it
    double radius = 0.0;         ///< m, >= 0, of every particle
    double stiffness = 0.0;      ///< N/m, >= 0, of the springs along edges
    double damping = 0.0;        ///< N s/m, >= 0, of all springs
    /// N/m, >= 0, of springs across every edge between two triangles, which join the corners that are not on the edge
    /// and so resist bending; 0: none are made.
    double bending_stiffness = 0.0;
    double breaking_stretch = std::numeric_limits<double>::infinity();  ///< of the springs along edges, see Spring
    std::vector<std::uint32_t> pinned = {};                             ///< vertices that never move
};
/// Particles in the order of the vertices; springs along edges in the order of their ends' numbers, then those across
/// edges. At rest as the mesh is. Across an edge at which the surface is not manifold there is no bending spring.
/// Throws InputError for values out of range, a mesh without triangles, and vertices that no triangle with an area
/// uses. Springs along edges and across them as resistance to stretching and bending: X. Provot, "Deformation
/// constraints in a mass-spring model to describe rigid cloth behavior", Graphics Interface 1995.
[[nodiscard]] SpringBody make_cloth(const TriangleMesh& mesh, const ClothSettings& settings);

/// A flat parallelogram as a mesh for make_cloth: cells_u by cells_v cells of two triangles each, whose diagonals
/// alternate so that no direction is stiffer. Vertex (i, j), which stands at corner + i/cells_u u + j/cells_v v, has
/// the number j * (cells_u + 1) + i. Throws InputError without a cell or for parallel sides.
[[nodiscard]] TriangleMesh sheet_mesh(const Vec3& corner, const Vec3& u, const Vec3& v, std::size_t cells_u,
                                      std::size_t cells_v);

// The longest steps that explicit methods can make with springs.

/// A step, s, that is short enough for every oscillation that these springs can make; longer ones may explode.
/// Infinite for the methods that need none (implicit_euler; dormand_prince chooses its own) and without springs.
/// particles: those that the springs name by their index as id; throws InputError for one that is not there, and for a
/// kind that does not exist.
///
/// By Gershgorin's theorem no oscillation is faster than omega^2 = 2 max sum(k) / m, nor damped faster than
/// gamma = 2 max sum(c) / m, sums over the springs of a particle. symplectic_euler, velocity_verlet and ballistic
/// (which becomes velocity_verlet) are stable while h^2 omega^2 + 2 h gamma < 4; the Runge-Kutta methods while h times
/// the largest eigenvalue stays within their region of stability; forward_euler needs dampers, h < c / k.
[[nodiscard]] double longest_stable_step(IntegratorKind kind, std::span<const Spring> springs,
                                         const std::vector<Particle>& particles);

}  // namespace ricochet
