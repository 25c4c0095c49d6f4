// Checks the balances of mass, momentum and energy for every response, integrator and valid pair of features. Particles
// move in a box without gravity, so the walls receive everything that they lose.
#include "simulation/books.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "simulation/book_bounds.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::Account;
using test::BookBounds;
using test::BookCase;
using test::BookedRun;
using test::Feature;

void expect_refused(const BookCase& c, const std::string& reason) {
    try {
        const Simulation simulation(test::setup_of(c));
        ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
}

/// Checks that the scene has exercised the effect of each feature.
void expect_exercised(const BookCase& c, const BookedRun& run) {
    const SimulationStatistics& statistics = run.simulation().statistics();
    EXPECT_GT(statistics.contacts, 5U);
    EXPECT_EQ(c.has(Feature::children), run.born().count > 5U);
    EXPECT_EQ(c.has(Feature::absorbing) && !c.has(Feature::flow), statistics.absorbed > 0U);
    EXPECT_EQ(c.has(Feature::shattering) && !c.has(Feature::flow), statistics.shattered > 0U);
    EXPECT_EQ(c.has(Feature::springs) && c.has(Feature::absorbing), statistics.springs_lost > 0U);
}

void expect_counted(const BookedRun& run) {
    const SimulationStatistics& statistics = run.simulation().statistics();
    EXPECT_EQ(statistics.unsimulated_time, 0.0);
    EXPECT_EQ(statistics.frozen, 0U);
    EXPECT_EQ(statistics.absorbed, run.swallowed().count);
    EXPECT_EQ(statistics.emitted, run.living().count + statistics.absorbed + statistics.shattered);
    EXPECT_NEAR(run.living().mass + run.swallowed().mass, run.start().mass + run.born().mass, 1e-12);
}

void expect_closed(const BookCase& c, const BookedRun& run) {
    const Account end = run.living();
    const BookBounds bounds = test::bounds_of(c, run);
    EXPECT_LT(length(end.momentum + run.walls() - run.start().momentum), bounds.momentum);
    const double energy = end.energy + run.swallowed().energy - run.start().energy;
    EXPECT_GT(energy, -bounds.energy - bounds.lost);
    EXPECT_LT(energy, bounds.energy + bounds.launched);
}

// Particles in a flow have no momentum: the walls receive none, and no particle is lost. Materials and masses have no
// effect here.
void expect_carried(const BookedRun& run) {
    EXPECT_EQ(run.walls(), Vec3{});
    EXPECT_EQ(run.living().count, run.start().count + run.born().count);
}

void check_cell(const BookCase& c) {
    SCOPED_TRACE(test::name(c));
    if (const auto reason = test::refusal(c)) {
        expect_refused(c, *reason);
        return;
    }
    BookedRun run(c);
    run.run();
    if (c.seed == BookCase{}.seed) expect_exercised(c, run);
    expect_counted(run);
    if (c.has(Feature::flow)) {
        expect_carried(run);
    } else {
        expect_closed(c, run);
    }
}

/// Returns all pairs of features, and each feature alone.
std::vector<std::uint32_t> feature_sets() {
    std::vector<std::uint32_t> sets;
    for (std::size_t a = 0; a < test::kFeatures.size(); ++a) {
        for (std::size_t b = a; b < test::kFeatures.size(); ++b) {
            sets.push_back(test::both(test::kFeatures[a], test::kFeatures[b]));
        }
    }
    return sets;
}

/// The full matrix has every response, integrator and pair. Every 7th cell is enough to include all of each.
constexpr std::size_t kStride = 7;

TEST(Books, BalancesAreClosedForEveryPairOfFeatures) {
    const std::size_t stride = test::is_long_run() ? 1 : kStride;
    std::size_t cells = 0;
    for (const std::uint32_t features : feature_sets()) {
        for (BookCase c : test::all_methods()) {
            c.features = features;
            if (cells++ % stride == 0) check_cell(c);
        }
    }
    EXPECT_EQ(cells, 15U * 5U * 8U);
}

// The bounds for springs are second order in the step, or of the order of the method.
TEST(Books, BalancesOfSpringsImproveWithShorterSteps) {
    for (BookCase c : test::all_methods()) {
        if (c.response != ResponseKind::exact && !test::is_long_run()) continue;
        c.features = static_cast<std::uint32_t>(Feature::springs);
        c.time_step = 0.0005;
        check_cell(c);
    }
}

// Uses other directions, and therefore other impacts.
TEST(BooksLong, BalancesOfManyScenesAreClosed) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        for (const std::uint32_t features : feature_sets()) {
            for (BookCase c : test::all_methods()) {
                c.features = features;
                c.seed = seed;
                check_cell(c);
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
