/// \file
/// Makes ropes, chains and cloth: particles and the springs between them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/dynamics/spring_network.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

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
    Vec3 to;                ///< m, last node, another place
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
/// Particles in the order of the vertices; springs along edges in the order of MeshTopology::edges, then those across
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

}  // namespace ricochet
