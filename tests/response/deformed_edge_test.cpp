// Compares the curvature of the distance to the edge of a deforming mesh with finite differences of the distance.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/collision/deforming_colliders.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_motion.h"
#include "ricochet/response/deformed_surface.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns a triangle behind the edge from its corner a to its corner b. All corners move.
DeformingColliders triangle_of(const std::vector<Vec3>& corners, const std::vector<Vec3>& velocities) {
    TriangleMesh mesh;
    mesh.vertices = corners;
    mesh.triangles = {{0, 1, 2}};
    MeshShape shape{std::make_shared<const TriangleMesh>(mesh), {}, "", {}};
    const auto positions_at = [&](double time) {
        std::vector<Vec3> positions = corners;
        for (std::size_t k = 0; k < positions.size(); ++k) positions[k] += time * velocities[k];
        return positions;
    };
    shape.motion = std::make_shared<const MeshMotion>(sampled_motion(positions_at, {0.0, 1.0}, MeshEnds::hold));
    return DeformingColliders(std::make_shared<ColliderList>(std::vector<ColliderDescription>{{"triangle", shape, 0}}));
}

TEST(TheBendAtADeformingEdge, CurvatureIsTheSecondDerivativeOfTheDistance) {
    constexpr double kTime = 0.5;
    constexpr double kStep = 1e-3;
    constexpr double kRadius = 0.5;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomSequence random(91, 2, seed);
        const auto any = [&] {
            const double x = random.uniform_around(0, 1);
            const double y = random.uniform_around(0, 1);
            return Vec3{x, y, random.uniform_around(0, 1)};
        };
        // At kTime the edge is near the x axis, and the rest of the triangle is below it.
        std::vector<Vec3> corners{{-3, 0, 0}, {3, 0.2, 0}, {0, 0, -4}};
        const std::vector<Vec3> velocities{any(), any(), any()};
        for (std::size_t k = 0; k < corners.size(); ++k) corners[k] -= kTime * velocities[k];
        const DeformingColliders deforming = triangle_of(corners, velocities);
        ForceInput particle;
        particle.time = kTime;
        particle.radius = kRadius;
        particle.position = {0.1, 0.31 / 3.0, kRadius};
        const CollisionWorld::Nearest here = deforming.triangle_at(0, kTime).nearest(particle.position);
        ASSERT_FALSE(here.flat);
        // The particle moves along and past the edge at a momentarily constant distance.
        particle.velocity = any();
        const Vec3 slip = particle.velocity - deforming.mesh(0).motion_at(0, particle.position, kTime).velocity;
        particle.velocity -= dot(slip, here.normal) * here.normal;
        const auto distance = [&](double time) {
            return deforming.triangle_at(0, kTime + time)
                .nearest(particle.position + time * particle.velocity)
                .distance;
        };
        const double bend = (distance(kStep) - 2.0 * distance(0.0) + distance(-kStep)) / (kStep * kStep);
        EXPECT_NEAR(curvature_of(deforming, particle, {0, here.normal, false}).curvature, bend, 1e-4);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
