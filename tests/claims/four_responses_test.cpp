// Compares the responses exact, rollback, project and penalty: their guarantees, their limits, and their common results
// for small steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "response/fitted_slope.h"
#include "response/solids.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/response/penalty.h"
#include "ricochet/simulation.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::fitted_slope;
using testing::mesh_collider;
using testing::plane_collider;

constexpr double kG = 9.81;

Simulation finished(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

std::string test_name(const ::testing::TestParamInfo<ResponseKind>& kind) { return std::string(name_of(kind.param)); }

class EveryResponse : public ::testing::TestWithParam<ResponseKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryResponse, ::testing::ValuesIn(response_kinds().begin(), response_kinds().end()),
                         test_name);

TEST_P(EveryResponse, IsKnownByItsName) { EXPECT_EQ(response_from_name(name_of(GetParam())), GetParam()); }

TEST(ResponseNames, IncludeNoOthers) {
    for (const char* name : {"", "Exact", "exact ", "rollbak", "bounce"})
        EXPECT_FALSE(response_from_name(name)) << name;
}

TEST(ResponseSettingsCheck, RefusesValuesOutOfRangeInOneLineThatNamesThem) {
    struct Wrong {
        const char* word;
        std::function<void(SimulationOptions&, double)> set;
    };
    const std::vector<Wrong> settings{
        {"stiffness", [](auto& options, double x) { options.penalty.stiffness = x; }},
        {"contact_steps", [](auto& options, double x) { options.penalty.contact_steps = x; }},
        {"friction_speed", [](auto& options, double x) { options.penalty.friction_speed = x; }},
        {"offset", [](auto& options, double x) { options.project.offset = x; }},
        {"time_tolerance", [](auto& options, double x) { options.rollback.time_tolerance = x; }},
        {"substeps", [](auto& options, double) { options.penalty.substeps = 0; }},
    };
    for (const ResponseKind kind : response_kinds()) {
        for (const Wrong& wrong : settings) {
            for (const double value : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
                SCOPED_TRACE(fmt::format("{}: {} = {}", name_of(kind), wrong.word, value));
                SimulationSetup setup;
                setup.options.response = kind;
                wrong.set(setup.options, value);
                try {
                    const Simulation simulation(std::move(setup));
                    ADD_FAILURE() << "accepted";
                } catch (const InputError& error) {
                    const std::string line = error.what();
                    EXPECT_NE(line.find(wrong.word), std::string::npos) << line;
                    EXPECT_NE(line.find("expected"), std::string::npos) << line;
                    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
                }
            }
        }
    }
}

TEST(PenaltyWarning, IsGivenExactlyWhenTheSubstepExceedsTheStabilityBoundOfTheLightestParticle) {
    for (const double restitution : {1.0, 0.7, 0.3}) {
        for (const double part : {0.5, 0.999, 1.001, 3.0}) {
            SCOPED_TRACE(fmt::format("restitution {}, part {}", restitution, part));
            SimulationSetup setup;
            setup.materials = {{"hard", 1.0, 0.0}, {"soft", restitution, 0.0}};
            setup.colliders.push_back(plane_collider({0, 0, 0}, {0, 0, 1}));
            setup.colliders.push_back(plane_collider({0, 0, 9}, {0, 0, 1}));
            setup.colliders[1].material = 1;
            for (const double mass : {3.0, 0.5, 2.0}) {
                setup.particles.emplace_back();
                setup.particles.back().mass = mass;
            }
            setup.options.response = ResponseKind::penalty;
            setup.options.penalty.stiffness = 5e4;
            const double zeta = damping_ratio(restitution);
            const double bound = 2.0 / std::sqrt(5e4 / 0.5) * (std::sqrt(1.0 + zeta * zeta) - zeta);
            setup.options.time_step = part * bound * setup.options.penalty.substeps;
            SimulationSetup exact;
            exact.options = setup.options;
            exact.options.response = ResponseKind::exact;
            const Simulation simulation(std::move(setup));
            ASSERT_EQ(simulation.warnings().size(), part > 1.0 ? 1U : 0U);
            if (part > 1.0) {
                EXPECT_EQ(simulation.warnings()[0].find('\n'), std::string::npos);
            }
            EXPECT_TRUE(Simulation(std::move(exact)).warnings().empty());
        }
    }
}

TEST(PenaltyWarning, AsksForEnoughSubsteps) {
    SimulationSetup setup;
    setup.materials = {{"", 0.4, 0.0}};
    setup.colliders.push_back(plane_collider({0, 0, 0}, {0, 0, 1}));
    setup.particles.emplace_back();
    setup.options.response = ResponseKind::penalty;
    setup.options.penalty.stiffness = 1e8;
    const auto warnings = [&](std::uint32_t substeps) {
        SimulationSetup copy;
        copy.options = setup.options;
        copy.options.penalty.substeps = substeps;
        copy.materials = setup.materials;
        copy.colliders = setup.colliders;
        copy.particles = setup.particles;
        return Simulation(std::move(copy)).warnings();
    };
    const auto given = warnings(10);
    ASSERT_EQ(given.size(), 1U);
    const std::size_t at = given[0].find("use at least ");
    ASSERT_NE(at, std::string::npos) << given[0];
    const auto enough = static_cast<std::uint32_t>(std::stoul(given[0].substr(at + 13)));
    EXPECT_TRUE(warnings(enough).empty());
    EXPECT_FALSE(warnings(enough - 1).empty());
}

/// Scene with a bullet that is shot at a plate 1 cm thick, in steps of 1 ms.
constexpr double kThickness = 0.01;
constexpr double kStep = 1e-3;
constexpr double kOffset = 1e-4;
constexpr std::uint32_t kSubsteps = 4;
constexpr double kStiffness = 4e3;  // in N/m; for one gram omega = 2000 / s, which is half a radian per sub-step

struct Shot {
    double travel;  ///< in m per step
    double phase;   ///< phase of the steps: fraction of a step's travel at which a step ends behind the plate's front
};

std::vector<Shot> shots() {
    std::vector<Shot> list;
    for (const double thicknesses : {0.3, 0.45, 0.7, 0.99, 1.0, 1.03, 1.5, 3.0, 4.1, 7.0, 40.0}) {
        for (int phase = 0; phase < 24; ++phase) list.push_back({thicknesses * kThickness, (phase + 0.31) / 24.0});
    }
    return list;
}

/// Numbers of contacts and penetrations of the bullet, and whether the bullet ends in front of the plate.
struct Flown {
    std::uint64_t contacts = 0;
    std::uint64_t penetrations = 0;
    bool is_stopped = false;
};

Flown shoot(ResponseKind kind, const Shot& shot) {
    SimulationSetup setup;
    setup.options.response = kind;
    setup.options.time_step = kStep;
    setup.options.duration = 6.0 * kStep;
    setup.options.project.offset = kOffset;
    setup.options.penalty.substeps = kSubsteps;
    setup.options.penalty.stiffness = kStiffness;
    setup.materials = {{"steel", 1.0, 0.0}};
    setup.colliders.push_back(mesh_collider(testing::box_mesh({0, -1, -1}, {kThickness, 1, 1})));
    Particle bullet;
    bullet.mass = 1e-3;
    bullet.position = {(shot.phase - 2.0) * shot.travel, 0.1, 0.2};
    bullet.velocity = {shot.travel / kStep, 0, 0};
    setup.particles.push_back(bullet);
    const Simulation simulation = finished(std::move(setup));
    return {simulation.statistics().contacts, simulation.statistics().penetrations,
            simulation.particles().position[0].x < 0.0 && simulation.particles().velocity[0].x < 0.0};
}

/// Returns true if a step of this length ends between `from` and `to` behind the plate's front.
bool some_step_ends_in(double from, double to, double translation, double start) {
    const double first = start + std::ceil((from - start) / translation) * translation;
    return first <= to;
}

TEST(BulletAndPlate, ExactAndRollbackStopEveryBullet) {
    for (const Shot& shot : shots()) {
        for (const ResponseKind kind : {ResponseKind::exact, ResponseKind::rollback}) {
            const Flown flown = shoot(kind, shot);
            EXPECT_TRUE(flown.is_stopped) << name_of(kind) << ' ' << shot.travel << ' ' << shot.phase;
            EXPECT_EQ(flown.contacts, 1U);
        }
    }
}

// The response project stops the bullet if a step ends in the near half of the plate or in the contact layer before it.
TEST(BulletAndPlate, ProjectStopsABulletIfAndOnlyIfAStepEndsInTheNearHalf) {
    for (const Shot& shot : shots()) {
        SCOPED_TRACE(fmt::format("travel {}, phase {}", shot.travel, shot.phase));
        const double start = (shot.phase - 2.0) * shot.travel;
        EXPECT_EQ(shoot(ResponseKind::project, shot).is_stopped,
                  some_step_ends_in(-kOffset, 0.5 * kThickness, shot.travel, start));
    }
}

TEST(BulletAndPlate, ProjectMissesSomePhasesBeyondHalfAPlatePerStepAndAllBeyondAPlateAndTwoOffsets) {
    const auto count = [](double travel, const std::function<bool(const Flown&)>& is) {
        int number = 0;
        for (int phase = 0; phase < 48; ++phase) {
            number += is(shoot(ResponseKind::project, {travel, (phase + 0.37) / 48.0})) ? 1 : 0;
        }
        return number;
    };
    const auto missed = [](const Flown& flown) { return !flown.is_stopped; };
    const auto unseen = [](const Flown& flown) { return flown.contacts == 0 && flown.penetrations == 0; };
    EXPECT_EQ(count(0.99 * (0.5 * kThickness + kOffset), missed), 0);
    EXPECT_GT(count(1.1 * (0.5 * kThickness + kOffset), missed), 0);
    EXPECT_EQ(count(0.99 * (kThickness + 2.0 * kOffset), unseen), 0);
    EXPECT_GT(count(1.1 * (kThickness + 2.0 * kOffset), unseen), 0);
}

// Every sub-step that ends in the plate pushes the bullet. The bullet returns if the first such sub-step ends in the
// near half and the spring is stiff enough.
TEST(BulletAndPlate, PenaltyStopsSlowBulletsAndMissesThePlateIfNoSubstepEndsInIt) {
    const double omega = std::sqrt(kStiffness / 1e-3);
    int slow = 0;
    int over = 0;
    for (const Shot& shot : shots()) {
        SCOPED_TRACE(fmt::format("travel {}, phase {}", shot.travel, shot.phase));
        const double start = (shot.phase - 2.0) * shot.travel;
        const double translation = shot.travel / kSubsteps;
        const Flown flown = shoot(ResponseKind::penalty, shot);
        if (!some_step_ends_in(0.0, kThickness, translation, start)) {
            EXPECT_GT(translation, kThickness);
            EXPECT_FALSE(flown.is_stopped);
            EXPECT_EQ(flown.contacts, 0U);
            ++over;
        } else if (shot.travel / kStep / omega + translation < 0.5 * kThickness) {
            EXPECT_TRUE(flown.is_stopped);
            ++slow;
        }
    }
    EXPECT_GT(over, 10);
    EXPECT_GT(slow, 10);
}

/// Scene with a ball that is thrown down a slope with friction. It bounces three times and loses energy.
constexpr double kDuration = 1.45;
constexpr double kRestitution = 0.8;
constexpr double kFriction = 0.1;
constexpr double kAngle = 0.3;
const Vec3 kNormal{std::sin(kAngle), 0, std::cos(kAngle)};
const Vec3 kDownhill{std::cos(kAngle), 0, -std::sin(kAngle)};
const Vec3 kAcross{0, 1, 0};
constexpr double kHeight = 0.5;     // start height along the normal, in m
const Vec3 kThrown{1.3, 0.4, 0.2};  // components downhill, across and along the normal, in m/s

struct EndState {
    Vec3 position;  ///< components downhill, across and along the normal
    Vec3 velocity;
    [[nodiscard]] double distance(const EndState& other) const {
        return length(position - other.position) + length(velocity - other.velocity);
    }
};

/// Returns the state at the end, computed by closed forms from impact to impact. The ball slips at every impact, so
/// friction reduces the tangential speed by mu (1 + e) v.
EndState closed_form() {
    const Vec3 pull{kG * std::sin(kAngle), 0, -kG * std::cos(kAngle)};
    EndState now{{0, 0, kHeight}, kThrown};
    double left = kDuration;
    const auto fly = [&](double time) {
        now.position += time * now.velocity + (0.5 * time * time) * pull;
        now.velocity += time * pull;
        left -= time;
    };
    for (int bounce = 0; bounce < 3; ++bounce) {
        const double v = now.velocity.z;
        fly((v + std::sqrt(v * v - 2.0 * pull.z * now.position.z)) / -pull.z);
        const double approach = -now.velocity.z;
        const Vec3 slip{now.velocity.x, now.velocity.y, 0};
        now.position.z = 0.0;
        now.velocity = (1.0 - kFriction * (1.0 + kRestitution) * approach / length(slip)) * slip;
        now.velocity.z = kRestitution * approach;
    }
    fly(left);
    return now;
}

/// Returns the distance of a run's end from the closed form.
double error_of(ResponseKind kind, int steps, const std::function<void(SimulationOptions&)>& set = {}) {
    SimulationSetup setup;
    setup.options.response = kind;
    setup.options.duration = kDuration;
    setup.options.time_step = kDuration / steps;
    if (set) set(setup.options);
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.materials = {{"", kRestitution, kFriction}};
    setup.colliders.push_back(plane_collider({0, 0, 0}, kNormal));
    Particle ball;
    ball.position = kHeight * kNormal;
    ball.velocity = kThrown.x * kDownhill + kThrown.y * kAcross + kThrown.z * kNormal;
    setup.particles.push_back(ball);
    const Simulation simulation = finished(std::move(setup));
    EXPECT_EQ(simulation.statistics().contacts, 3U) << name_of(kind) << ", " << steps << " steps";
    const auto on_axes = [](const Vec3& v) { return Vec3{dot(v, kDownhill), dot(v, kAcross), dot(v, kNormal)}; };
    return EndState{on_axes(simulation.particles().position[0]), on_axes(simulation.particles().velocity[0])}.distance(
        closed_form());
}

struct Errors {
    std::vector<double> steps;  ///< in s
    std::vector<double> errors;
    [[nodiscard]] double slope() const { return fitted_slope(steps, errors); }
};

/// Returns the errors for steps that differ by more than six halvings. The numbers of steps are irregular, so that
/// impacts occur at any fraction of a step.
Errors errors_of(ResponseKind kind, double factor, const std::function<void(SimulationOptions&)>& set = {}) {
    Errors result;
    for (double steps = 100.0; steps < 100.0 * 80.0; steps *= factor) {
        result.steps.push_back(kDuration / steps);
        result.errors.push_back(error_of(kind, static_cast<int>(std::lround(steps)), set));
    }
    return result;
}

TEST(FourResponses, ExactMatchesTheClosedFormToRoundingWithAnyStep) {
    for (const int steps : {1, 7, 97, 1000, 10000}) EXPECT_LT(error_of(ResponseKind::exact, steps), 2e-11) << steps;
}

TEST(FourResponses, RollbackMatchesTheClosedFormToFirstOrderInItsToleranceWithAnyStep) {
    Errors all;
    for (const int steps : {1, 7, 97, 1000}) {
        for (double tolerance = 1e-3; tolerance > 1e-11; tolerance /= 3.0) {
            const double error = error_of(ResponseKind::rollback, steps, [&](SimulationOptions& options) {
                options.rollback.time_tolerance = tolerance;
            });
            // the factor covers accelerations, and the growth of errors over three bounces
            EXPECT_LT(error, 100.0 * tolerance) << steps << " steps";
            all.steps.push_back(tolerance);
            all.errors.push_back(error);
        }
    }
    EXPECT_NEAR(all.slope(), 1.0, 0.1);
}

TEST(FourResponses, ProjectMatchesTheClosedFormToFirstOrderInTheStep) {
    EXPECT_NEAR(errors_of(ResponseKind::project, 1.11).slope(), 1.0, 0.2);
}

// Contacts last two steps, and the length of sub-steps decreases faster than the length of steps.
TEST(FourResponses, PenaltyMatchesTheClosedFormToFirstOrderIfContactsAreResolvedBetter) {
    const auto resolved = [](SimulationOptions& options) {
        options.penalty.substeps = static_cast<std::uint32_t>(std::lround(0.0725 / options.time_step));
        options.penalty.contact_steps = 2.0 * options.penalty.substeps;
    };
    EXPECT_NEAR(errors_of(ResponseKind::penalty, 1.2, resolved).slope(), 1.0, 0.2);
}

// With a fixed number of sub-steps per contact, the restitution has a constant error. The error at the end of the run
// therefore does not vanish.
TEST(FourResponses, PenaltyKeepsAnErrorWithFixedSubstepsPerContact) {
    const Errors plain = errors_of(ResponseKind::penalty, 1.11);
    const auto tail = plain.errors.end() - 12;
    EXPECT_GT(*std::max_element(tail, plain.errors.end()), 0.02);
    EXPECT_LT(*std::max_element(tail, plain.errors.end()), 0.3);
    const Errors fine = errors_of(ResponseKind::penalty, 1.11, [](SimulationOptions& options) {
        options.penalty.substeps = 50;
        options.penalty.contact_steps = 100.0;
    });
    EXPECT_LT(*std::max_element(fine.errors.end() - 12, fine.errors.end()),
              0.3 * *std::max_element(tail, plain.errors.end()));
}

/// A response, with a flag for the rollback of the whole system.
struct Answer {
    ResponseKind kind;
    bool global = false;
};

class EveryAnswer : public ::testing::TestWithParam<Answer> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryAnswer,
                         ::testing::Values(Answer{ResponseKind::exact}, Answer{ResponseKind::rollback},
                                           Answer{ResponseKind::rollback, true}, Answer{ResponseKind::project},
                                           Answer{ResponseKind::penalty}),
                         [](const auto& of) {
                             return std::string(name_of(of.param.kind)) + (of.param.global ? "_global" : "");
                         });

/// Returns marbles that fall onto a ring, a ball and a floor, with losses and friction.
SimulationSetup marbles(const Answer& of) {
    SimulationSetup setup;
    setup.options.response = of.kind;
    setup.options.rollback.global = of.global;
    setup.options.time_step = 1.0 / 100.0;
    setup.options.duration = of.global ? 0.3 : 0.45;
    setup.options.seed = 5;
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.forces.push_back(make_linear_drag(0.02));
    setup.materials = {{"glass", 0.7, 0.3}, {"felt", 0.3, 0.5}};
    setup.colliders.push_back(mesh_collider(testing::solid("torus")));
    setup.colliders.push_back(plane_collider({0, 0, -0.5}, {0.05, 0, 1}));
    setup.colliders.push_back({"ball", BallShape{0.3, {}}, 0});
    setup.colliders[1].material = 1;
    EmitterDescription emitter;
    emitter.shape = SphereShape{{0.1, 0.2, 1.0}, 0.4, false};
    emitter.burst = 300;  // more particles than a block
    emitter.speed = {2.0, 1.0};
    emitter.lifetime = {0.5, 0.2};
    emitter.radius = {0.02, 0.015};
    setup.emitters.push_back(emitter);
    return setup;
}

TEST_P(EveryAnswer, IsTheSameInAllBitsForAnyNumberOfThreadsAndWithoutCulling) {
    const auto run = [&](int threads, bool culling) {
        const ThreadLimit limit(threads);
        SimulationSetup setup = marbles(GetParam());
        setup.acceleration.culling = culling;
        return finished(std::move(setup));
    };
    const Simulation reference = run(1, true);
    EXPECT_GT(reference.statistics().contacts, 30U);
    EXPECT_EQ(reference.statistics().frozen, 0U);
    for (const auto& [threads, culling] : {std::pair{2, true}, std::pair{2, false}}) {
        const Simulation other = run(threads, culling);
        EXPECT_EQ(other.state_hash(), reference.state_hash());
        EXPECT_EQ(other.kinetic_energy(), reference.kinetic_energy());
        EXPECT_EQ(other.statistics().contacts, reference.statistics().contacts);
        EXPECT_EQ(other.statistics().trials, reference.statistics().trials);
        EXPECT_EQ(other.statistics().penetrations, reference.statistics().penetrations);
        EXPECT_EQ(other.statistics().penetration_sum, reference.statistics().penetration_sum);
        for (std::size_t collider = 0; collider < 3; ++collider) {
            EXPECT_EQ(other.triangle_totals(collider).hits, reference.triangle_totals(collider).hits);
            EXPECT_EQ(other.triangle_totals(collider).impulse, reference.triangle_totals(collider).impulse);
        }
    }
}

/// One particle stays alive. It is born before, between and after particles that are removed.
TEST_P(EveryResponse, LeavesAParticleUnchangedWhenOthersAreRemoved) {
    const auto end = [&](int others) {
        SimulationSetup setup = marbles({GetParam()});
        setup.emitters.clear();
        setup.options.duration = 0.8;
        for (int i = 0; i < others; ++i) {
            setup.particles.emplace_back();
            setup.particles.back().position = {0.9, 0, 0.05 * (i % 7)};  // inside the ring, on the opposite side of the
                                                                         // first particle
            setup.particles.back().lifetime = 0.2 + 0.02 * i;            // ends while the first particle bounces on the
                                                                         // ring
        }
        setup.particles.emplace_back();
        setup.particles.back().position = {0.8, 0.1, 1.0};
        const Simulation simulation = finished(std::move(setup));
        EXPECT_EQ(simulation.particles().size(), 1U);
        return simulation.particles().position[0];
    };
    const Vec3 alone = end(0);
    EXPECT_EQ(end(20), alone);
    EXPECT_GT(length(alone - Vec3{0.8, 0.1, 1.0}), 0.3);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
