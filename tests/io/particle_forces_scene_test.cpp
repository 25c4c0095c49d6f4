// Forces between particles in scenes: the effect of each key, and one-line errors.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/particle_forces_scene.h"
#include "io/scene_errors.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::errors_of;
using test::kParticleForcesScene;
using test::Lines;

/// Returns a scene of two particles 2 m apart with these forces. Their masses are 3 kg and 1 kg, their charges 2 C and
/// -1 C.
std::string scene_with(const std::string& forces, const std::string& more = "") {
    return R"({"ricochet": 1, "attributes": {"charge": {"default": 0}, "wind": {"components": 3}},
  "particles": [{"position": [0, 0, 0], "mass": 3, "radius": 0.95, "attributes": {"charge": 2}},
                {"position": [0, 0, 2], "radius": 0.95, "attributes": {"charge": -1}}],
  "emitters": [{"name": "tap", "type": "point", "rate": 1}],)" +
           more + R"("particle_forces": [)" + forces + "]}";
}

/// Returns the acceleration of the second particle along z, in m/s^2.
double pull(const std::string& force) {
    SimulationSetup setup = parse_scene(scene_with(force), "s.json").setup;
    const std::vector<std::uint64_t> ids{0, 1};
    const std::vector<Vec3> positions{setup.particles[0].position, setup.particles[1].position};
    const std::vector<Vec3> velocities(2);
    const std::vector<double> masses{3.0, 1.0};
    const std::vector<double> radii{0.95, 0.95};
    const std::vector<double> charges{2.0, -1.0};
    ParticlesView view{0.0, ids, positions, velocities, masses, radii};
    const ParticlesForce& made = *setup.particles_forces.at(0).force;
    if (!made.attributes().empty()) view.attributes = {charges};
    std::vector<Vec3> result(2);
    made.add_accelerations(view, result);
    return result[1].z;
}

TEST(ParticleForcesScene, NamedForcesAreMade) {
    EXPECT_NEAR(pull(R"({"type": "gravity"})"), -6.6743e-11 * 3.0 / 4.0, 1e-24);
    EXPECT_NEAR(pull(R"({"type": "gravity", "constant": 2, "softening": 1.5})"), -2.0 * 3.0 * 2.0 / 15.625, 1e-14);
    EXPECT_NEAR(pull(R"({"type": "charge"})"), -8.9875517862e9 * 2.0 / 4.0, 1e-5);
    EXPECT_NEAR(pull(R"({"type": "charge", "constant": 1, "softening": 1.5})"), -2.0 * 2.0 / 15.625, 1e-14);
    EXPECT_NEAR(pull(R"({"type": "lennard_jones", "diameter": 2, "depth": 3, "cutoff": 1000})"), 36.0, 1e-9);
    EXPECT_NEAR(pull(R"({"type": "cohesion", "stiffness": 90, "range": 0.3})"), -90.0 * 0.1 * 4.0 / 9.0, 1e-12);
}

TEST(ParticleForcesScene, ParticlesAndEmittersSelectTheParticipants) {
    const auto setup =
        parse_scene(scene_with(R"({"type": "gravity", "particles": [1], "emitter": "tap"}, {"type": "gravity"})"),
                    "s.json")
            .setup;
    ASSERT_EQ(setup.particles_forces.size(), 2U);
    EXPECT_EQ(setup.particles_forces[0].particles, (std::vector<std::uint64_t>{1}));
    EXPECT_EQ(setup.particles_forces[0].emitters, (std::vector<std::uint32_t>{0}));
    EXPECT_TRUE(setup.particles_forces[1].particles.empty());
    EXPECT_TRUE(setup.particles_forces[1].emitters.empty());
}

TEST(ParticleForcesScene, SampleRuns) {
    SimulationSetup setup = parse_scene(kParticleForcesScene, "s.json").setup;
    ASSERT_EQ(setup.particles_forces.size(), 4U);
    Simulation simulation(std::move(setup));
    simulation.advance(10);
    EXPECT_TRUE(std::isfinite(simulation.potential_energy().value()));
    EXPECT_NE(simulation.particles().velocity[0], (Vec3{}));
}

TEST(ParticleForcesScene, InvalidForcesAreRefusedInOneLine) {
    struct Case {
        const char* force;
        const char* message;
    };
    for (const Case& c : {
             Case{R"({"type": "gravitation"})", "particle_forces[0].type"},
             Case{R"({"type": "gravity", "softening": -1})", "particle_forces[0].softening"},
             Case{R"({"type": "gravity", "constant": "big"})", "particle_forces[0].constant"},
             Case{R"({"type": "gravity", "opening": 0})", "particle_forces[0].opening"},
             Case{R"({"type": "gravity", "opening": 1.5})", "particle_forces[0].opening"},
             Case{R"({"type": "gravity", "method": "fast"})", "particle_forces[0].method"},
             Case{R"({"type": "gravity", "emitter": "tab"})", "did you mean \"tap\"?"},
             Case{R"({"type": "charge", "attribute": "chrge"})", "did you mean \"charge\"?"},
             Case{R"({"type": "charge", "attribute": "wind"})", "is a vector, expected one component"},
             Case{R"({"type": "lennard_jones", "cutoff": 1})", "particle_forces[0].cutoff"},
             Case{R"({"type": "lennard_jones", "depth": 0})", "particle_forces[0].depth"},
             Case{R"({"type": "cohesion", "stiffness": 1})", "particle_forces[0]"},
             Case{R"({"type": "cohesion", "stiffness": -1, "range": 1})", "particle_forces[0].stiffness"},
             Case{R"({"type": "cohesion", "stiffness": 1e300, "range": 1})",
                  "particle_forces[0].stiffness: found 1e+300, expected at most 1e+75 in magnitude"},
             Case{R"({"type": "cohesion", "stiffness": 1, "range": 1, "damping": 1e76})",
                  "particle_forces[0].damping: found 1e+76, expected at most 1e+75 in magnitude"},
         }) {
        const Lines errors = errors_of(scene_with(c.force));
        ASSERT_EQ(errors.size(), 1U) << c.force;
        EXPECT_NE(errors[0].find(c.message), std::string::npos) << errors[0];
        EXPECT_EQ(errors[0].find('\n'), std::string::npos) << errors[0];
    }
}

TEST(ParticleForcesScene, IncompatibleFeaturesAreRefused) {
    const auto error_of = [](const std::string& more) {
        const Lines errors = errors_of(scene_with(R"({"type": "gravity"})", more));
        return errors.size() == 1 ? errors[0] : "not one error";
    };
    EXPECT_NE(error_of(R"("simulation": {"integrator": "implicit_euler"},)").find("implicit_euler"), std::string::npos);
    EXPECT_NE(error_of(R"("particle_contacts": {"method": "events"},)").find("particle_contacts.method"),
              std::string::npos);
    EXPECT_NE(error_of(R"("simulation": {"motion": "flow", "flow": {"type": "uniform", "velocity": [1, 0, 0]}},)")
                  .find("a flow carries the particles"),
              std::string::npos);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
