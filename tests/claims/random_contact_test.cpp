// Particles in contact gain no energy, lose no simulated time, and stay on their side. The random scenes have meshes
// and shapes, with particles inside and outside, any restitution, friction and rolling friction, and every integrator.
// Independent code checks the runs. Results have the same bits with and without sleeping.
//
// A long run has a thousand scenes. RICOCHET_SEED=... in the environment selects a single scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "claims/random_contact_scene.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Seeds first, first + 1, ...: a few dozen scenes by default, a thousand in a long run.
struct Seeds {
    std::uint64_t first = 0;
    std::uint64_t count = 0;
};
Seeds seeds() {
    if (const char* one = std::getenv("RICOCHET_SEED")) return {std::stoull(one), 1};  // NOLINT(concurrency-mt-unsafe)
    return {0, static_cast<std::uint64_t>(test::scaled(40 * test::case_factor(25)))};
}

/// Returns true for integrators that follow uniform gravity exactly. Euler methods gain and lose energy in flight.
bool is_exact_for_gravity(const Integrator& integrator) {
    return integrator.kind != IntegratorKind::forward_euler && !kicks_first(integrator.kind);
}

double energy_of(const Particle& p, const Vec3& gravity) {
    return 0.5 * length_squared(p.velocity) + 0.2 * p.radius * p.radius * length_squared(p.spin) -
           dot(gravity, p.position);
}

/// Compares each particle's energy per mass with its energy in the previous step.
class EnergyWatch {
public:
    EnergyWatch(const Simulation& simulation, const Vec3& gravity) : gravity_(gravity) {
        last_ = by_id(simulation);
        for (const Particle& p : last_) largest_ = std::max(largest_, largest_term(p));
    }
    /// Fails for every particle whose energy gain in the step exceeds the rounding error.
    void expect_no_gain(const Simulation& simulation) {
        const std::vector<Particle> now = by_id(simulation);
        for (std::size_t i = 0; i < now.size(); ++i) {
            largest_ = std::max(largest_, largest_term(now[i]));
            const double gain = energy_of(now[i], gravity_) - energy_of(last_[i], gravity_);
            worst_ = std::max(worst_, gain / largest_);
            const double rounding = kRounding + kRoundingOfImpact * impacts_of(simulation, now[i].id);
            EXPECT_LE(gain, rounding * largest_) << description(simulation, i, now[i]);
        }
        last_ = now;
    }
    [[nodiscard]] double worst() const { return worst_; }

private:
    /// Relative rounding error of a step. A step has a few hundred intervals and impacts. Each has an error of 4e-16 of
    /// its largest term, and positions 1e-15 off the surface.
    static constexpr double kRounding = 1e-13;

    /// Relative energy error of an impact. The particle is placed at a contact offset of 16 units in the last place, or
    /// 64 if that position is not free.
    static constexpr double kRoundingOfImpact = 64 * 0x1p-52;

    static double impacts_of(const Simulation& simulation, std::uint64_t particle) {
        const auto& records = simulation.contact_records();
        return static_cast<double>(std::count_if(records.begin(), records.end(),
                                                 [&](const ContactRecord& r) { return r.particle == particle; }));
    }
    static std::vector<Particle> by_id(const Simulation& simulation) {
        std::vector<Particle> list;
        for (const std::uint32_t i : simulation.particles().order_by_id()) list.push_back(simulation.particles().at(i));
        return list;
    }
    [[nodiscard]] double largest_term(const Particle& p) const {
        return std::max({0.5 * length_squared(p.velocity), 0.2 * p.radius * p.radius * length_squared(p.spin),
                         length(gravity_) * length(p.position), 1e-3});
    }
    [[nodiscard]] std::string description(const Simulation& simulation, std::size_t i, const Particle& now) const {
        std::ostringstream out;
        out.precision(17);
        const auto say = [&](const char* when, const Particle& p) {
            out << when << ": position " << p.position.x << ' ' << p.position.y << ' ' << p.position.z << ", velocity "
                << p.velocity.x << ' ' << p.velocity.y << ' ' << p.velocity.z << ", spin " << p.spin.x << ' '
                << p.spin.y << ' ' << p.spin.z << '\n';
        };
        out << "particle " << now.id << ", radius " << now.radius << ", step " << simulation.step_index() << '\n';
        say("before", last_[i]);
        say("after", now);
        for (const ContactRecord& r : simulation.contact_records()) {
            if (r.particle != now.id) continue;
            out << "  t " << r.time << " surface " << r.surface << " normal " << r.normal.x << ' ' << r.normal.y << ' '
                << r.normal.z << " approach " << dot(r.velocity_before, r.normal) << " leaving "
                << dot(r.velocity_after, r.normal) << " speeds " << length(r.velocity_before) << ' '
                << length(r.velocity_after) << '\n';
        }
        return out.str();
    }

    Vec3 gravity_;
    std::vector<Particle> last_;
    double largest_ = 0.0;
    double worst_ = 0.0;
};

void expect_nothing_wrong(const Simulation& simulation) {
    const SimulationStatistics& statistics = simulation.statistics();
    EXPECT_EQ(statistics.unsimulated_time, 0.0);
    EXPECT_EQ(statistics.budget_exhausted, 0U);
    EXPECT_EQ(statistics.frozen, 0U);
    EXPECT_EQ(statistics.violations, 0U);
    for (const Violation& violation : simulation.violations()) {
        ADD_FAILURE() << "violation " << static_cast<int>(violation.kind) << " of particle " << violation.particle
                      << " at " << violation.time << " s, collider " << violation.collider.value_or(99) << ", triangle "
                      << violation.triangle.value_or(99'999);
    }
}

TEST(RandomContact, GainsNoEnergyLosesNoTimeAndHasNoLeaks) {
    const Seeds range = seeds();
    std::uint64_t contacts = 0;
    for (std::uint64_t seed = range.first; seed < range.first + range.count; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        SimulationSetup setup = random_contact_scene(seed);
        setup.options.record_contacts = true;
        const bool keeps_energy = is_exact_for_gravity(setup.options.integrator);
        Simulation simulation(std::move(setup));
        EnergyWatch energy(simulation, random_contact_gravity(seed));
        while (!simulation.finished() && !::testing::Test::HasFatalFailure()) {
            simulation.step();
            if (keeps_energy) energy.expect_no_gain(simulation);
        }
        expect_nothing_wrong(simulation);
        contacts += simulation.statistics().contacts;
    }
    EXPECT_GT(contacts, range.count);
}

// The work of drag and wind depends on the path. The energy gain of every interval is compared with the work of the
// forces at its ends.
TEST(RandomContact, GainsNoMoreEnergyThanTheWorkOfAWind) {
    Seeds range = seeds();
    if (range.count > 1) range.count = range.count * 3 / 5;
    for (std::uint64_t seed = range.first; seed < range.first + range.count; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        SimulationSetup setup = random_contact_scene(seed);
        setup.forces.push_back(make_linear_drag(seed % 2 == 0 ? 2.0 : 0.05, make_wind({1, 0.5, -0.2})));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        expect_nothing_wrong(simulation);
        EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    }
}

TEST(RandomContact, EndsInTheSameBitsWithSleepingOnAndOff) {
    const Seeds range = seeds();
    for (std::uint64_t seed = range.first; seed < range.first + range.count; ++seed) {
        const auto hash = [&](bool sleeping) {
            SimulationSetup setup = random_contact_scene(seed);
            setup.options.verify = false;
            setup.acceleration.sleeping = sleeping;
            Simulation simulation(std::move(setup));
            while (!simulation.finished()) simulation.step();
            return simulation.state_hash();
        };
        EXPECT_EQ(hash(true), hash(false)) << "seed " << seed;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
