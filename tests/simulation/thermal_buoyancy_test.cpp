// Thermal buoyancy in running simulations, compared with closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kGravity = 9.81;   // m/s^2
constexpr double kAmbient = 300.0;  // K

/// Returns a parcel of the given temperature at the origin, with gravity and buoyancy.
SimulationSetup parcel(double temperature, double time_step, double duration) {
    SimulationSetup setup = setup_of(time_step, duration, {"floor", 0.6, 0.2}, {0, 0, -kGravity});
    setup.colliders.clear();
    setup.attributes.push_back({"temperature", 1, {temperature, 0, 0}});
    setup.forces.push_back(make_thermal_buoyancy(kAmbient, {0, 0, -kGravity}));
    Particle particle = particle_of({0, 0, 0}, {0, 0, 0});
    particle.radius = 0.1;
    setup.particles.push_back(particle);
    return setup;
}

double height_of(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation.particles().position[0].z;
}

TEST(ThermalBuoyancy, LiftIsProportionalToTheTemperatureDifference) {
    for (const double temperature : {600.0, 330.0, 150.0}) {
        const double acceleration = kGravity * (temperature - kAmbient) / kAmbient;
        EXPECT_NEAR(height_of(parcel(temperature, 0.1, 2.0)), 0.5 * acceleration * 4.0, 1e-12) << temperature;
    }
    EXPECT_EQ(height_of(parcel(kAmbient, 0.1, 2.0)), 0.0) << "with the temperature of the gas it floats";
    EXPECT_NEAR(height_of(parcel(0.0, 0.1, 2.0)), -0.5 * kGravity * 4.0, 1e-12) << "at 0 K it falls freely";
}

TEST(ThermalBuoyancy, TerminalSpeedBalancesDragAndLift) {
    SimulationSetup setup = parcel(390.0, 0.01, 10.0);
    constexpr double kDrag = 4.0;
    setup.particles[0].mass = 2.0;
    setup.forces.push_back(make_linear_drag(kDrag));
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_NEAR(simulation.particles().velocity[0].z, kGravity * 90.0 / kAmbient * 2.0 / kDrag, 1e-4);
}

// Convection alone cools exactly. Within a step the lift is that of its start, so the error is first order in the time
// step.
TEST(ThermalBuoyancy, LiftFadesAsTheParcelCools) {
    constexpr double kRate = 0.8;  // 1/s
    constexpr double kTime = 2.0;  // s
    const auto error = [&](double time_step) {
        SimulationSetup setup = parcel(500.0, time_step, kTime);
        setup.particles[0].mass = 4.0 * std::acos(-1.0) * 0.01;  // equal to its surface, in kg for m^2
        setup.heat = HeatSettings{};
        setup.heat->specific_heat = 1.0;
        setup.heat->ambient_temperature = kAmbient;
        setup.heat->convection = Convection{};
        setup.heat->convection->coefficient = kRate;
        const double lift = kGravity * 200.0 / kAmbient / kRate;
        return std::fabs(height_of(std::move(setup)) - lift * (kTime - (1.0 - std::exp(-kRate * kTime)) / kRate));
    };
    const double coarse = error(0.02);
    const double fine = error(0.01);
    EXPECT_LT(fine, 0.06);
    EXPECT_NEAR(coarse / fine, 2.0, 0.05);
}

TEST(ThermalBuoyancy, MissingAttributeAndInteractingParticlesAreRefused) {
    const auto message = [](SimulationSetup setup) -> std::string {
        try {
            const Simulation simulation(std::move(setup));
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    SimulationSetup without = parcel(400.0, 0.1, 1.0);
    without.attributes.clear();
    EXPECT_NE(message(std::move(without)).find("temperature"), std::string::npos);
    SimulationSetup meeting = parcel(400.0, 0.1, 1.0);
    meeting.options.particle_contacts.emplace();
    EXPECT_NE(message(std::move(meeting)).find("particle_contacts"), std::string::npos);
    EXPECT_THROW((void)make_thermal_buoyancy(0.0, {0, 0, -1}), InputError);
    EXPECT_THROW((void)make_thermal_buoyancy(300.0, {0, 0, std::nan("")}), InputError);

    SimulationSetup plain = parcel(400.0, 0.1, 1.0);
    plain.attributes.clear();
    plain.forces.pop_back();
    Simulation simulation(std::move(plain));
    std::vector<std::unique_ptr<Force>> forces;
    forces.push_back(make_thermal_buoyancy(300.0, {0, 0, -1}));
    EXPECT_THROW(simulation.set_forces(std::move(forces)), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
