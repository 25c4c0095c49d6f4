/// \file
/// From a case to its mesh, its particles and its simulation.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bench/cases.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/simulation.h"

namespace ricochet::bench {

/// A place that sees every point inside the ground in a straight line; nothing where the ground has no inside.
[[nodiscard]] std::optional<Vec3> heart_of(Ground ground);

/// The case's mesh, with about as many triangles as it wants.
[[nodiscard]] std::shared_ptr<const TriangleMesh> make_mesh(const Case& c);

/// The case's particles on its mesh, those inside clear of it by their radius; the same every time, whatever the
/// machine and its threads.
[[nodiscard]] std::vector<Particle> make_particles(const Case& c, const TriangleMesh& mesh);

/// Everything for a simulation but the particles: the case's response, ballistic steps, as many as the case has.
[[nodiscard]] SimulationSetup make_setup(const Case& c, const std::shared_ptr<const TriangleMesh>& mesh);

// Which points are inside a closed mesh that has a heart: a place that sees its whole inside in straight lines.

/// The inside of one mesh. Safe from any number of threads.
class Insides {
public:
    /// The mesh must be closed, star-shaped about the heart, and outlive this.
    Insides(const TriangleMesh& mesh, const Vec3& heart);

    /// Exact: true when the straight line from the heart to p meets no triangle.
    [[nodiscard]] bool contains(const Vec3& p) const;
    /// The same for a ball's middle, which must be at least the radius (m, >= 0) away from every triangle, to rounding.
    [[nodiscard]] bool contains_ball(const Vec3& middle, double radius) const;

private:
    const TriangleMesh& mesh_;
    Vec3 heart_;
    TriangleBvh bvh_;
};

}  // namespace ricochet::bench
