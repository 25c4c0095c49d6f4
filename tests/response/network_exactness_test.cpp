// Contacts that require a smaller error than others of their network.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ricochet/response/contact_solver/iterative_contact_solver.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kKick = 9.81e-3;  // m/s, from gravity in one step
constexpr std::uint32_t kHeight = 20;
const Vec3 kUp{0, 0, 1};

struct Columns {
    std::vector<SolverBody> bodies;
    std::vector<SolverContact> contacts;
};

/// Returns columns of balls of 1 kg on a floor, without initial contact impulses. exactness: one factor for the
/// contacts of each column.
Columns columns(const std::vector<double>& exactness) {
    Columns all;
    for (const double own : exactness) {
        for (std::uint32_t k = 0; k < kHeight; ++k) {
            const auto body = static_cast<std::uint32_t>(all.bodies.size());
            all.bodies.push_back({{0.1 * kKick, 0, -kKick}, {}, 1.0, 250.0, 0.1});
            SolverContact& contact = all.contacts.emplace_back();
            contact.a = body;
            if (k > 0) contact.b = body - 1;
            contact.normal = kUp;
            contact.friction = 0.3;
            contact.exactness = own;
        }
    }
    return all;
}

SolverReport solve(Columns& network, double tolerance) {
    SolverSettings settings;
    settings.duration = 1e-3;
    settings.tolerance = tolerance;
    return IterativeContactSolver().solve(network.bodies, network.contacts, settings);
}

double fall_of(const Columns& network, std::uint32_t column) {
    double fall = 0.0;
    for (std::uint32_t k = 0; k < kHeight; ++k) {
        fall = std::max(fall, std::fabs(network.bodies[kHeight * column + k].velocity.z));
    }
    return fall;
}

// The factor is a power of two, so that nothing is rounded.
TEST(NetworkExactness, ExactnessOfAllContactsActsAsASmallerTolerance) {
    Columns exact = columns({1024.0, 1024.0});
    Columns plain = columns({1.0, 1.0});
    const SolverReport first = solve(exact, 1024.0 * 1e-9);
    const SolverReport second = solve(plain, 1e-9);
    EXPECT_EQ(first.sweeps, second.sweeps);
    EXPECT_EQ(first.residual, 1024.0 * second.residual);
    for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
        EXPECT_EQ(exact.bodies[i].velocity, plain.bodies[i].velocity) << i;
        EXPECT_EQ(exact.bodies[i].spin, plain.bodies[i].spin) << i;
    }
}

TEST(NetworkExactness, ExactnessOfOneColumnNeedsOnlyItsOwnSweeps) {
    Columns both = columns({1.0, 1000.0});
    Columns coarse = columns({1.0});
    const SolverReport report = solve(both, 0.1 * kKick);
    EXPECT_GT(report.sweeps, solve(coarse, 0.1 * kKick).sweeps);
    EXPECT_LT(fall_of(both, 1), 0.01 * kKick);
    EXPECT_GT(fall_of(coarse, 0), 0.1 * kKick);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
