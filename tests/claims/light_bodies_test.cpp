// Persistent contact on bodies lighter than their load. Conserved quantities stay constant for any masses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "ricochet/simulation.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

// A tray of 1 kg on a spring carries balls. It starts at the rest length of the spring. Tray and balls swing about
// their common equilibrium like a single mass.
TEST(ATrayOnASpring, SwingsWithItsLoadAsOneMass) {
    for (const auto& [count, load] : {std::pair{10, 0.3}, {10, 1.0}, {10, 3.0}, {10, 10.0}, {1, 10.0}}) {
        for (const double step : {0.01, 0.002}) {
            SCOPED_TRACE(std::to_string(load) + " kg, step " + std::to_string(step));
            FrameDescription frame = frame_of("tray", {});
            frame.is_driven = true;
            const double whole = 1.0 + load;
            const double stiffness = 100.0 * whole;
            const double damping = 4.0 * whole;
            SimulationSetup setup = setup_of({frame}, {{"tray", PlaneShape{}, 0, "tray"}}, step, 1.5);
            BodyDescription tray;
            tray.frame = "tray";
            tray.mass = 1.0;
            tray.inertia = {.xx = 1.0, .yy = 1.0, .zz = 1.0};
            tray.joint = JointKind::slider;
            tray.axis = {0, 0, 1};
            tray.settings.spring = stiffness;
            tray.settings.damping = damping;
            setup.bodies = {tray};
            setup.forces.push_back(make_gravity({0, 0, -9.81}));
            for (int k = 0; k < count; ++k) {
                Particle ball = particle_of({0.1 * k, 0, 0.05 + 1e-9}, {}, 0.05);
                ball.mass = load / count;
                setup.particles.push_back(ball);
            }
            setup.materials = {{"steel", 0.0, 0.5}};
            Simulation simulation(std::move(setup));
            // The coordinate obeys x'' = -g - 100 x - 4 x'. It swings about -g/100 at sqrt(96) rad/s and decays at the
            // rate 2/s.
            const double turning = std::sqrt(96.0);
            double worst = 0.0;
            while (!simulation.finished()) {
                simulation.step();
                const double t = simulation.time();
                const double x =
                    0.0981 *
                    (std::exp(-2.0 * t) * (std::cos(turning * t) + 2.0 / turning * std::sin(turning * t)) - 1.0);
                worst = std::max(worst, std::fabs(simulation.bodies()[0].coordinate - x));
            }
            EXPECT_LT(worst, (step > 0.005 ? 0.01 : 5e-4) * 0.0981);
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
