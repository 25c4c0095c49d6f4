// Particles that slide in the edges and corners of a sheared mesh lose no simulated time.
//
// The angle between the faces at an edge changes. If a path is lifted off one face, it must not lead into the other
// face.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_motion.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kDuration = 0.44;  // in s

/// Transforms the vertices by a random linear map close to the identity. All faces stay planar.
std::vector<Vec3> sheared(const std::vector<Vec3>& vertices, RandomSequence& random) {
    const Vec3 x = Vec3{1, 0, 0} + 0.3 * random.in_unit_ball();
    const Vec3 y = Vec3{0, 1, 0} + 0.3 * random.in_unit_ball();
    const Vec3 z = Vec3{0, 0, 1} + 0.3 * random.in_unit_ball();
    std::vector<Vec3> moved;
    for (const Vec3& v : vertices) moved.push_back(v.x * x + v.y * y + v.z * z);
    return moved;
}

SimulationSetup sheared_box(std::uint64_t seed, const Material& material) {
    RandomSequence random(seed, 17, 0);
    SimulationSetup setup;
    setup.options.time_step = kDuration / 25;
    setup.options.duration = kDuration;
    setup.options.verify = true;
    setup.materials = {material};
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    const TriangleMesh box = box_mesh({-0.95, -0.72, -0.66}, {0.95, 0.72, 0.66});
    MeshShape shape{std::make_shared<const TriangleMesh>(box), {}, "", {}};
    shape.motion =
        std::make_shared<const MeshMotion>(std::vector<double>{0.0, kDuration},
                                           std::vector<std::vector<Vec3>>{box.vertices, sheared(box.vertices, random)});
    setup.colliders = {{"box", std::move(shape), 0}};
    for (int k = 0; k < 8; ++k) {
        const double radius = k % 2 == 0 ? 0.0 : 0.02 + 0.1 * random.uniform();
        setup.particles.push_back(particle_of(0.5 * random.in_unit_ball(), 7.0 * random.in_unit_ball(), radius));
    }
    return setup;
}

TEST(ABoxThatIsSheared, LosesNoTimeOfParticlesSlidingInItsEdges) {
    for (const Material& material : {Material{"", 0.0, 0.0}, Material{"", 0.3, 0.2}}) {
        const auto seeds = static_cast<std::uint64_t>(test::scaled(12) * test::case_factor(12));
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            SCOPED_TRACE(std::to_string(material.friction) + ", seed " + std::to_string(seed));
            Simulation simulation(sheared_box(seed, material));
            while (!simulation.finished()) simulation.step();
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
            EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
            EXPECT_TRUE(simulation.violations().empty());
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
