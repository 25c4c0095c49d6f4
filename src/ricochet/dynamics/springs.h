/// \file
/// Springs between particles: the network of springs, and functions that make ropes and cloth.
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
    std::uint64_t second = 0;  ///< particle id, different from the first
    double rest_length = 0.0;  ///< rest length, in m, >= 0
    double stiffness = 0.0;    ///< spring stiffness, in N/m, >= 0
    double damping = 0.0;      ///< damping constant along the spring, in N s/m, >= 0
    /// Stretch, relative to the rest length, above which the spring breaks permanently. > 0; infinite if the spring
    /// never breaks. A spring with the rest length 0 has no relative stretch and cannot break.
    double breaking_stretch = std::numeric_limits<double>::infinity();
    bool resists_bending = false;  ///< true if the spring crosses an edge of cloth; it is not shown as a thread
};

/// Returns the force on the first end of a spring, in N: k (l - l0) + c l' in the direction of the second end. l is the
/// distance of the ends, and l' is its rate of change. If the ends coincide, the spring has no direction and the force
/// is zero. The force on the second end is exactly the opposite. Source: A. Witkin, D. Baraff, M. Kass, "Physically
/// Based Modeling", SIGGRAPH 2001 course notes, "Particle System Dynamics", damped spring.
[[nodiscard]] Vec3 spring_force(const Spring& spring, const Vec3& x_first, const Vec3& v_first, const Vec3& x_second,
                                const Vec3& v_second);

/// Springs between particles that are identified by their ids. `bind` sets the order of the particles in lists of
/// positions and velocities. Queries are thread-safe. Functions throw InputError for an index past the end and for a
/// list of the wrong length.
class SpringNetwork {
public:
    SpringNetwork() = default;
    /// Creates the network with all springs intact. Call bind before computing forces. Throws InputError for values out
    /// of range and for a spring from a particle to itself. The message contains the index of the spring.
    explicit SpringNetwork(std::vector<Spring> springs);

    /// Returns true if the network was created without springs.
    [[nodiscard]] bool empty() const { return springs_.empty(); }
    /// Returns all springs in their order, including broken and lost springs.
    [[nodiscard]] const std::vector<Spring>& springs() const { return springs_; }
    /// Returns true if spring number `spring` has neither broken nor lost an end.
    [[nodiscard]] bool is_intact(std::size_t spring) const {
        require_index(spring, states_.size(), "spring");
        return states_[spring] == State::intact;
    }

    /// Prepares the intact springs for particles with these ids, after particles were added, removed or reordered.
    /// Springs with a missing end are removed permanently and counted as lost. Throws InputError for a duplicate id.
    void bind(std::span<const std::uint64_t> ids);

    /// An intact spring and the indices of its ends in the order of bind(). `a` is the first end, `b` the second.
    struct Bond {
        std::uint32_t spring;
        std::uint32_t a;
        std::uint32_t b;
    };
    /// Returns the intact springs, in the order of their numbers.
    [[nodiscard]] const std::vector<Bond>& bonds() const { return bonds_; }

    /// A spring as seen from one of its ends.
    struct Link {
        std::uint32_t spring;
        std::uint32_t other;  ///< index of the other end in the order of bind()
    };
    /// Returns the intact springs of particle i, in the order of their numbers.
    [[nodiscard]] std::span<const Link> links(std::uint32_t i) const {
        require_index(i, particle_count_, "particle of a spring");
        return {links_.data() + link_begin_[i], link_begin_[i + 1] - link_begin_[i]};
    }
    /// Returns the particles with at least one intact spring, as ascending indices in the order of bind().
    [[nodiscard]] const std::vector<std::uint32_t>& coupled() const { return coupled_; }

    /// Returns the sum of the spring forces on particle i, in N. Springs are added in the order of their numbers, so
    /// the bits depend neither on threads nor on the order of the particles.
    [[nodiscard]] Vec3 force_on(std::uint32_t i, std::span<const Vec3> position, std::span<const Vec3> velocity) const;
    /// Returns the energy stored in the intact springs, in J: the sum of k/2 (l - l0)^2. Dampers store no energy.
    [[nodiscard]] double potential_energy(std::span<const Vec3> position) const;

    /// Permanently breaks all springs that are longer than (1 + breaking_stretch) * rest_length. Returns the number of
    /// springs that broke.
    std::size_t break_overstretched(std::span<const Vec3> position);

    /// Saves or restores the sets of broken and lost springs. Call bind after restoring.
    template <class Archive>
    void archive(Archive& a) {
        a(states_, springs_.size());
        a(broken_);
        a(lost_);
        if constexpr (Archive::kReads) require_states();
    }

    /// Returns the number of springs that have broken so far.
    [[nodiscard]] std::size_t broken() const { return broken_; }
    /// Returns the number of springs removed so far because the particle at one end no longer existed.
    [[nodiscard]] std::size_t lost() const { return lost_; }

private:
    enum class State : std::uint8_t { intact, broken, lost };

    void compile_links();
    void require_states() const;
    void require_entries(std::span<const Vec3> values) const;

    std::vector<Spring> springs_;
    std::vector<State> states_;  // state of each spring
    std::vector<Bond> bonds_;
    std::size_t particle_count_ = 0;         // number of particles in bind()
    std::vector<std::uint32_t> link_begin_;  // offset of each particle's range in links_; the last entry is the end
    std::vector<Link> links_;
    std::vector<std::uint32_t> coupled_;
    std::size_t broken_ = 0;
    std::size_t lost_ = 0;
};

// Functions that make ropes, chains and cloth from particles and springs.

/// Triangle of cloth between three particles. It is shown as long as its three springs are intact.
struct SpringFace {
    std::array<std::uint64_t, 3> corners;  ///< particle ids, in the mesh's winding
    std::array<std::uint32_t, 3> springs;  ///< numbers of the springs along its edges
};

/// Particles with springs between them. Ids are indices into `particles`.
struct SpringBody {
    std::vector<Particle> particles;
    std::vector<Spring> springs;
    std::vector<SpringFace> faces;  ///< empty for ropes

    /// Appends another body. The ids and spring numbers of the appended body are shifted.
    void append(const SpringBody& body);
};

/// Settings of a rope: nodes at equal distances along the rope, with springs between neighbours.
struct RopeSettings {
    Vec3 from;              ///< first node, in m
    Vec3 to;                ///< last node, in m, different from the first
    std::size_t nodes = 2;  ///< >= 2
    /// Rest length, in m, > 0; nothing: the distance of the ends. A longer rope starts as a catenary that hangs in the
    /// direction `sag`. A shorter rope starts straight, under tension.
    std::optional<double> length = {};
    Vec3 sag{0, 0, -1};   ///< initial direction in which a slack rope hangs; any nonzero length
    double mass = 1.0;    ///< total mass, in kg, > 0; half of a segment's mass is assigned to each of its nodes
    double radius = 0.0;  ///< radius of every node, in m, >= 0
    /// Stiffness of every segment, in N/m, or the elastic modulus E times the cross section A, in N. A segment with the
    /// rest length l then has the stiffness E A / l. Exactly one of the two members must be set.
    std::optional<double> stiffness = {};
    std::optional<double> axial_stiffness = {};
    double damping = 0.0;  ///< damping of every segment, in N s/m, >= 0
    /// Breaking stretch of every segment, see Spring.
    double breaking_stretch = std::numeric_limits<double>::infinity();
    bool pin_from = false;  ///< true: the first node never moves
    bool pin_to = false;    ///< true: the last node never moves
};
/// Makes a rope. Spring i joins nodes i and i + 1. Throws InputError for values out of range.
[[nodiscard]] SpringBody make_rope(const RopeSettings& settings);

/// Settings of cloth: a particle for every vertex of a triangle mesh, and a spring along every edge.
struct ClothSettings {
    /// Mass per area, in kg/m^2, > 0; a vertex has a third of the mass of each adjacent triangle.
    double mass_per_area = 1.0;
    double radius = 0.0;     ///< radius of every particle, in m, >= 0
    double stiffness = 0.0;  ///< stiffness of the springs along edges, in N/m, >= 0
    double damping = 0.0;    ///< damping of all springs, in N s/m, >= 0
    /// Stiffness, in N/m, >= 0, of the springs that resist bending: they join the two corners opposite to an edge. If
    /// it is 0, no such springs are made.
    double bending_stiffness = 0.0;
    /// Breaking stretch of the springs along edges, see Spring.
    double breaking_stretch = std::numeric_limits<double>::infinity();
    std::vector<std::uint32_t> pinned = {};  ///< indices of vertices that never move
};
/// Makes a cloth at rest in the shape of the mesh. Particles are in the order of the vertices. The springs along edges
/// come first, in the order of the indices of their ends. The springs across manifold edges follow. Throws InputError
/// for values out of range, a mesh without triangles, and vertices without an adjacent triangle of nonzero area.
/// Source: X. Provot, "Deformation constraints in a mass-spring model to describe rigid cloth behavior", Graphics
/// Interface 1995.
[[nodiscard]] SpringBody make_cloth(const TriangleMesh& mesh, const ClothSettings& settings);

/// Returns a flat parallelogram as a mesh for make_cloth, with cells_u by cells_v cells of two triangles each. The
/// diagonals of the cells alternate, so that both diagonal directions are equally stiff. Vertex (i, j) has the index j
/// * (cells_u + 1) + i. Throws InputError for zero cells or parallel sides.
[[nodiscard]] TriangleMesh sheet_mesh(const Vec3& corner, const Vec3& u, const Vec3& v, std::size_t cells_u,
                                      std::size_t cells_v);

// The longest stable steps of explicit methods with springs.

/// Returns a step, in s, for which every oscillation of these springs is stable. It is infinite without springs, for
/// implicit_euler, and for dormand_prince, which chooses its own steps. particles: the ids in `springs` are indices
/// into this list. Throws InputError for a particle that does not exist and for an unknown kind.
///
/// By Gershgorin's theorem, omega^2 = 2 max sum(k) / m is an upper bound of the squared frequencies, and gamma = 2 max
/// sum(c) / m is an upper bound of the damping rates. The sums are over the springs of a particle. The stability limits
/// of the methods are:
/// - symplectic_euler, velocity_verlet and ballistic (replaced by velocity_verlet): h^2 omega^2 + 2 h gamma < 4.
/// - Runge-Kutta methods: h times the largest eigenvalue must lie in their region of stability.
/// - forward_euler: h < c / k for every spring, so every spring needs a damper.
[[nodiscard]] double longest_stable_step(IntegratorKind kind, std::span<const Spring> springs,
                                         const std::vector<Particle>& particles);

}  // namespace ricochet
