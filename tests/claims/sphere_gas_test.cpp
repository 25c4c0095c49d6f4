// Elastic spheres of three sizes, and points, in closed bodies. The independent verifier must find no violation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/parity.h"
#include "support/random_draws.h"
#include "support/shared_meshes.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

const int kSpheres = test::is_long_run() ? 600 : 60;
const int kSteps = test::is_long_run() ? 500 : 60;

double distance_from(const TriangleMesh& mesh, const Vec3& p) {
    double nearest = INFINITY;
    for (const Triangle& t : mesh.triangles) {
        nearest = std::min(nearest,
                           closest_point_on_triangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])
                               .distance_squared);
    }
    return std::sqrt(nearest);
}

/// Returns particles inside the body that are more than their radius away from its surface. The radii of successive
/// particles cycle through `radii`.
std::vector<Particle> gas_in(const TriangleMesh& mesh, const std::vector<double>& radii, int count, double speed) {
    const testing::ParityOracle oracle(mesh);
    const Box3 box = bounds(mesh);
    const Vec3 size = box.size();
    RandomSequence random(17, 0, 0);
    std::vector<Particle> gas;
    while (gas.size() < static_cast<std::size_t>(count)) {
        Particle particle;
        const double x = random.uniform();
        const double y = random.uniform();
        particle.position = box.lower + Vec3{x * size.x, y * size.y, random.uniform() * size.z};
        particle.radius = radii[gas.size() % radii.size()];
        if (!oracle.inside(particle.position)) continue;
        if (particle.radius > 0.0 && distance_from(mesh, particle.position) < 1.001 * particle.radius) continue;
        particle.velocity = testing::scaled({random.unit_vector(), speed * (0.5 + random.uniform())});
        gas.push_back(particle);
    }
    return gas;
}

void expect_no_violation(SimulationSetup setup) {
    setup.options.verify = true;
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().started_inside, 0U);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
    EXPECT_GT(simulation.statistics().contacts, simulation.particles().size());
    for (const Violation& violation : simulation.violations()) {
        ADD_FAILURE() << "particle " << violation.particle << " at " << violation.time << " s, kind "
                      << static_cast<int>(violation.kind);
        break;  // the first violation is enough
    }
}

SimulationSetup gas_setup(TriangleMesh mesh, const std::vector<double>& relative_radii) {
    const double size = bounds(mesh).diagonal();
    std::vector<double> radii;
    for (const double r : relative_radii) radii.push_back(r * size);
    SimulationSetup setup;
    setup.options.time_step = 1.0;
    setup.options.duration = test::kSanitized ? 10.0 : kSteps;
    setup.options.bounce_budget = 100000;
    setup.materials.push_back({"elastic", 1.0, 0.0});
    setup.particles = gas_in(mesh, radii, test::kSanitized ? 8 : kSpheres, 0.1 * size);
    setup.colliders.push_back(testing::mesh_collider(std::move(mesh)));
    return setup;
}

class SphereGasInARealMesh : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Meshes, SphereGasInARealMesh,
                         ::testing::Values("armadillo.obj", "bunny-closed.off", "fandisk.obj"), [](const auto& name) {
                             const std::string text = name.param;
                             return text.substr(0, text.find_first_of("-."));
                         });

TEST_P(SphereGasInARealMesh, NeitherLeaksNorOverlaps) {
    RICOCHET_SHARED_MESH_OR_SKIP(path, GetParam());
    expect_no_violation(gas_setup(read_mesh(path).mesh, {0.0, 0.001, 0.01, 0.025}));
}

TEST(SphereGasInACrumpledBall, NeitherLeaksNorOverlaps) {
    TriangleMesh mesh = testing::sphere_mesh({3, -5, 7}, 1.0, 3);
    RandomSequence random(5, 0, 0);
    for (Vec3& v : mesh.vertices) v = Vec3{3, -5, 7} + (0.85 + 0.3 * random.uniform()) * (v - Vec3{3, -5, 7});
    expect_no_violation(gas_setup(std::move(mesh), {0.0, 0.01, 0.05, 0.15}));
}

// The radius of the tetrahedron's inscribed sphere is slightly larger than the radius of the largest sphere. Its
// corners are much narrower than this sphere.
TEST(SphereGasInATetrahedron, StaysOutOfCornersNarrowerThanASphere) {
    const TriangleMesh mesh{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                            {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
    const double inner = 1.0 / std::sqrt(3.0);
    const double size = bounds(mesh).diagonal();
    expect_no_violation(gas_setup(mesh, {0.1 * inner / size, 0.6 * inner / size, 0.97 * inner / size}));
}

// A sphere is in a box between two plates. The gap between the plates is one nanometre wider than the sphere. Every
// bounce hits both plates.
TEST(SphereBetweenPlates, WithANanometreOfClearanceNeitherLeaksNorOverlaps) {
    constexpr double kRadius = 0.05;
    SimulationSetup setup;
    setup.options.time_step = 0.01;
    setup.options.duration = test::kSanitized ? 0.1 : 2.0;
    setup.options.bounce_budget = 1000000;
    setup.materials.push_back({"elastic", 1.0, 0.0});
    CuboidShape room;
    room.size = {1.0, 1.0, 2.0 * kRadius + 1e-9};
    setup.colliders.push_back({"room", room, 0});
    RandomSequence random(6, 0, 0);
    for (int i = 0; i < 12; ++i) {
        Particle particle;
        const double x = 0.8 * random.uniform() - 0.4;
        particle.position = {x, 0.8 * random.uniform() - 0.4, 0.4e-9 * (2.0 * random.uniform() - 1.0)};
        particle.velocity = {random.uniform() - 0.5, 1.0, 1e-6 * random.uniform()};
        particle.radius = kRadius;
        setup.particles.push_back(particle);
    }
    expect_no_violation(std::move(setup));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
