// Warm start of sweeps over a contact network with the impulses of the last step.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "ricochet/response/contact_solver/iterative_contact_solver.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kKick = 9.81e-3;  // m/s, from gravity in one step
const Vec3 kUp{0, 0, 1};

SolverBody ball(double velocity) { return {velocity * kUp, {}, 1.0, 250.0, 0.1}; }

/// Returns the contact of a ball of 1 kg on a floor. `start` is its impulse in the last step.
SolverContact on_floor(std::uint32_t body, double start) {
    SolverContact contact;
    contact.a = body;
    contact.normal = kUp;
    contact.touched = true;
    contact.start.normal = start;
    return contact;
}

SolverSettings one_sweep() {
    SolverSettings settings;
    settings.duration = 1e-3;
    settings.sweeps = settings.most_sweeps = 1;
    return settings;
}

TEST(NetworkStart, WrongStartOfAContactDisturbsNoOther) {
    for (const double wrong : {0.0, 0.1, 3.0, 100.0}) {
        SCOPED_TRACE(wrong);
        std::vector<SolverBody> bodies = {ball(-kKick), ball(-kKick)};
        const std::vector<SolverContact> contacts = {on_floor(0, kKick), on_floor(1, wrong * kKick)};
        IterativeContactSolver().solve(bodies, contacts, one_sweep());
        EXPECT_EQ(bodies[0].velocity.z, 0.0);
    }
}

// Otherwise the impulses that wedged the ball would persist and cause friction.
TEST(NetworkStart, WedgedBallIsFreedIfGravityReverses) {
    std::vector<SolverBody> bodies = {ball(kKick)};
    std::vector<SolverContact> contacts;
    for (const double side : {-1.0, 1.0}) {
        SolverContact& wall = contacts.emplace_back(on_floor(0, kKick));
        wall.normal = {side, 0, 0};
        wall.friction = 0.5;
        wall.start.tangential = 0.5 * kKick * kUp;
    }
    SolverSettings settings = one_sweep();
    settings.sweeps = settings.most_sweeps = 100;
    IterativeContactSolver().solve(bodies, contacts, settings);
    EXPECT_EQ(bodies[0].velocity.z, kKick);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
