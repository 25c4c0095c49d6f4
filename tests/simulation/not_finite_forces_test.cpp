// Forces, flows and solvers that return non-finite numbers end the step with their name and the id of the particle.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/pair_forces.h"
#include "ricochet/dynamics/particle_system.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::floor_mesh;
using testing::mesh_collider;
using testing::particle_of;
using testing::setup_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns a thousand particles above a floor, under gravity.
SimulationSetup many(IntegratorKind kind) {
    SimulationSetup setup = setup_of(0.01, 1.0, {}, {0, 0, -9.81});
    setup.options.integrator.kind = kind;
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}};
    for (int k = 0; k < 1000; ++k) setup.particles.push_back(particle_of({0.1 * (k % 37), 0.01 * k, 0.5}));
    return setup;
}

std::string error_of(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    try {
        while (!simulation.finished()) simulation.step();
    } catch (const RunError& error) {
        EXPECT_THROW(simulation.step(), RunError);
        return error.what();
    }
    return {};
}

TEST(NotFiniteForces, ErrorNamesTheForceAndTheFirstParticleForAnyThreads) {
    for (const double wrong : {kNan, kInfinity, -kInfinity}) {
        for (const IntegratorKind kind :
             {IntegratorKind::ballistic, IntegratorKind::forward_euler, IntegratorKind::symplectic_euler,
              IntegratorKind::implicit_euler, IntegratorKind::midpoint, IntegratorKind::velocity_verlet,
              IntegratorKind::rk4, IntegratorKind::dormand_prince}) {
            for (const int threads : {1, 2, 5}) {
                SCOPED_TRACE(std::string(name_of(kind)) + ", threads " + std::to_string(threads));
                const ThreadLimit limit(threads);
                SimulationSetup setup = many(kind);
                setup.forces.push_back(make_force([wrong](const ForceInput& input) {
                    const bool is_wrong = input.time > 0.05 && input.id % 300 == 5;
                    return is_wrong ? Vec3{0, wrong, 0} : Vec3{-0.1 * input.velocity.x, 0, 0};
                }));
                const std::string line = error_of(std::move(setup));
                EXPECT_NE(line.find("forces[1]: "), std::string::npos) << line;
                EXPECT_NE(line.find(" particle 5 at "), std::string::npos) << line;
            }
        }
    }
}

TEST(NotFiniteForces, ErrorNamesTheForceUnderEveryResponse) {
    for (const ResponseKind kind : response_kinds()) {
        SCOPED_TRACE(name_of(kind));
        SimulationSetup setup = many(IntegratorKind::rk4);
        setup.options.response = kind;
        setup.forces.push_back(make_acceleration([](const ForceInput& input) {
            return Vec3{input.id == 700 && input.time > 0.02 ? kNan : 0.0, 0, 0};
        }));
        const std::string line = error_of(std::move(setup));
        EXPECT_NE(line.find("forces[1]: "), std::string::npos) << line;
        EXPECT_NE(line.find(" particle 700 at "), std::string::npos) << line;
    }
}

/// A force that gives a non-finite pull on one particle.
class Broken final : public ParticlesForce {
public:
    explicit Broken(std::string name) : name_(std::move(name)) {}
    void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const override {
        for (std::size_t k = 0; k < result.size(); ++k) {
            if (particles.ids[k] >= 3) result[k] += Vec3{kNan, 0, 0};
        }
    }
    [[nodiscard]] std::optional<double> potential_energy(const ParticlesView&) const override { return 0.0; }
    [[nodiscard]] std::string name() const override { return name_; }

private:
    std::string name_;
};

TEST(NotFiniteForces, ForcesBetweenParticlesAreNamed) {
    for (const auto& [name, shown] :
         {std::pair<std::string, std::string>("", "particle_forces[1]: "), {"flock", "flock: "}}) {
        SimulationSetup setup = many(IntegratorKind::velocity_verlet);
        setup.particles.resize(9);
        setup.particles_forces = {{make_cohesion({.stiffness = 1.0, .range = 1e-3})}, {std::make_shared<Broken>(name)}};
        const std::string line = error_of(std::move(setup));
        EXPECT_NE(line.find(shown), std::string::npos) << line;
        EXPECT_NE(line.find(" particle 3 at "), std::string::npos) << line;
    }
}

TEST(NotFiniteForces, PairLawIsNamed) {
    SimulationSetup setup = many(IntegratorKind::velocity_verlet);
    setup.particles = {particle_of({0, 0, 5}), particle_of({0, 0, 1}), particle_of({0.1, 0, 1})};
    PairLaw law;
    law.cutoff = 0.2;
    law.force = [](const PairState&) { return Vec3{0, kInfinity, 0}; };
    setup.particles_forces = {{make_pair_force(law)}};
    const std::string line = error_of(std::move(setup));
    EXPECT_NE(line.find("particle_forces[0]: "), std::string::npos) << line;
    EXPECT_NE(line.find(" particle 1 at "), std::string::npos) << line;
}

TEST(NotFiniteForces, SolverIsNamed) {
    SimulationSetup setup = many(IntegratorKind::rk4);
    setup.particles.resize(4);
    setup.solver = [](ParticleSystem& system, double) {
        std::vector<double> y(system.dimension());
        system.get_state(y);
        y[6 * 2 + 4] = kNan;
        system.set_state(y);
    };
    const std::string line = error_of(std::move(setup));
    EXPECT_NE(line.find("solver: found particle 2 at "), std::string::npos) << line;
}

/// A flow with a hole of non-finite values.
class Torn final : public FlowField {
public:
    [[nodiscard]] Vec3 velocity(const Vec3& position, double) const override {
        return {position.x > 1.0 ? kNan : 1.0, 0, 0};
    }
    [[nodiscard]] bool is_steady() const override { return true; }
};

TEST(NotFiniteForces, FlowThatMovesParticlesIsNamed) {
    for (const IntegratorKind kind : {IntegratorKind::forward_euler, IntegratorKind::midpoint, IntegratorKind::rk4,
                                      IntegratorKind::dormand_prince}) {
        SCOPED_TRACE(name_of(kind));
        SimulationSetup setup = setup_of(0.01, 1.0);
        setup.options.integrator.kind = kind;
        setup.options.flow = std::make_shared<Torn>();
        setup.particles = {particle_of({-9, 0, 0}), particle_of({0.5, 0, 0})};
        const std::string line = error_of(std::move(setup));
        EXPECT_NE(line.find("flow: found the velocity"), std::string::npos) << line;
        EXPECT_NE(line.find(" particle 1 at "), std::string::npos) << line;
    }
}

TEST(NotFiniteForces, FlowOfADragIsNamedByTheDrag) {
    SimulationSetup setup = setup_of(0.01, 1.0);
    setup.forces.push_back(make_linear_drag(1.0, std::make_shared<Torn>()));
    setup.particles = {particle_of({0.9, 0, 0}, {1, 0, 0})};
    const std::string line = error_of(std::move(setup));
    EXPECT_NE(line.find("forces[0]: "), std::string::npos) << line;
}

TEST(NotFiniteForces, NonFiniteCommonForceIsRefusedAtTheStart) {
    class Common final : public Force {
    public:
        [[nodiscard]] Vec3 acceleration(const ForceInput&) const override { return {kNan, 0, 0}; }
        [[nodiscard]] std::optional<double> potential_energy(const ForceInput&) const override { return 0.0; }
        [[nodiscard]] std::optional<Vec3> common_acceleration() const override { return Vec3{kNan, 0, 0}; }
    };
    SimulationSetup setup = setup_of(0.01, 1.0);
    setup.forces.push_back(std::make_unique<Common>());
    EXPECT_THROW(Simulation simulation(std::move(setup)), InputError);
}

// The path of a step may end below the floor that the particle hits. This method evaluates forces at positions of the
// particle alone.
TEST(NotFiniteForces, ForceThatIsUndefinedBehindASurfaceIsNoError) {
    const auto run = [](bool look_ahead) {
        SimulationSetup setup = setup_of(0.05, 3.0, {.name = "floor", .restitution = 0.9}, {0, 0, -9.81});
        setup.acceleration.look_ahead = look_ahead;
        setup.forces.push_back(make_acceleration([](const ForceInput& input) {
            return Vec3{0, 0, -std::sqrt(input.position.z)};
        }));
        setup.colliders = {mesh_collider(floor_mesh(50.0, 20))};
        for (int i = 0; i < 40; ++i) setup.particles.push_back(particle_of({0, 0, 0.1 + 0.07 * i}, {0.1 * i, 0, 0}));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        EXPECT_GT(simulation.statistics().contacts, 100U);
        return simulation.state_hash();
    };
    EXPECT_EQ(run(true), run(false));
}

// Trial states of a method do not count: the force of a spring that far out exceeds the range of doubles.
TEST(NotFiniteForces, TrialPositionsOutOfRangeAreNoError) {
    SimulationSetup setup = setup_of(1e30, 1e31);
    setup.options.integrator.kind = IntegratorKind::rk4;
    setup.forces.push_back(make_radial_force({.center = {}, .strength = 1.0, .exponent = 12.0}));
    setup.particles = {particle_of({1e3, 0, 0})};
    Simulation simulation(std::move(setup));
    try {
        simulation.step();
        EXPECT_EQ(simulation.statistics().frozen, 1U);
    } catch (const DivergedError&) {
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
