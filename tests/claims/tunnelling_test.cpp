// A bullet of any speed never passes through a thin plate, for any time step.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

struct Shot {
    IntegratorKind integrator;
    double time_step;
    bool is_sheet;  ///< true: a single layer of triangles; false: a plate 0.1 mm thick
};

class Tunnelling : public ::testing::TestWithParam<Shot> {};

std::string shot_name(const ::testing::TestParamInfo<Shot>& shot) {
    return std::string(name_of(shot.param.integrator)) + (shot.param.is_sheet ? "_sheet_1e" : "_plate_1e") +
           std::to_string(static_cast<int>(-std::log10(shot.param.time_step) + 0.5));
}

std::vector<Shot> all_shots() {
    std::vector<Shot> shots;
    for (const auto kind : {IntegratorKind::ballistic, IntegratorKind::symplectic_euler}) {
        for (const double step : {1.0, 1e-1, 1e-2, 1e-3, 1e-4}) {
            for (const bool is_sheet : {true, false}) shots.push_back({kind, step, is_sheet});
        }
    }
    return shots;
}

INSTANTIATE_TEST_SUITE_P(Shots, Tunnelling, ::testing::ValuesIn(all_shots()), shot_name);

TriangleMesh target(bool is_sheet) {
    if (!is_sheet) return box_mesh({0, -1e5, -1e5}, {1e-4, 1e5, 1e5});
    return {{{0, -1e5, -1e5}, {0, 1e5, -1e5}, {0, 1e5, 1e5}, {0, -1e5, 1e5}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST_P(Tunnelling, ABulletStaysOnItsSideOfAThinPlate) {
    SimulationSetup setup;
    setup.options.time_step = GetParam().time_step;
    setup.options.duration = std::min(2.0, 200.0 * GetParam().time_step);
    setup.options.integrator = GetParam().integrator;
    setup.forces.push_back(make_gravity({1000.0, 0, -9.81}));  // a force along x blows the bullet back towards the
                                                               // plate
    setup.materials = {{"steel", 0.9, 0.1}};
    setup.colliders.push_back(
        {"target", MeshShape{std::make_shared<const TriangleMesh>(target(GetParam().is_sheet)), {}, ""}, 0});
    RandomSequence random(1, 0, 0);
    for (int i = 0; i < test::scaled(100); ++i) {
        Particle bullet;
        const double distance = std::pow(10.0, -15.0 * random.uniform());
        bullet.position = {-distance, random.uniform(), random.uniform()};
        bullet.velocity = {1e4, 1e3 * random.uniform(), 1e3 * random.uniform()};
        setup.particles.push_back(bullet);
    }
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) {
        simulation.step();
        for (const Vec3& p : simulation.particles().position) ASSERT_LT(p.x, 0.0);
    }
    EXPECT_GE(simulation.statistics().contacts, simulation.particles().size());
    EXPECT_EQ(simulation.statistics().frozen, 0U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
