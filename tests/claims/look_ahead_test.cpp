// The look-ahead makes no query for particles that certainly hit nothing, and queried particles are processed in
// spatial order. Neither may change a bit of any result.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/integrators.h"
#include "support/random_draws.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// A scene with long flights between small objects, in which most particles hit nothing in most steps. It depends only
/// on the seed.
class SparseCase {
public:
    enum class Forces { uniform, varying };

    /// shift: offset of the whole scene from the origin, in m.
    explicit SparseCase(std::uint64_t seed, const Vec3& shift = {}, Forces forces = Forces::uniform)
        : random_(seed, 31, 0), shift_(shift), forces_(forces) {}

    SimulationSetup setup() {
        SimulationSetup setup;
        const auto kinds = std::array{IntegratorKind::ballistic, IntegratorKind::symplectic_euler,
                                      IntegratorKind::forward_euler, IntegratorKind::rk4};
        setup.options.integrator = kinds[pick(4)];
        setup.options.time_step = std::array{1e-3, 4e-3, 0.015}[pick(3)];
        setup.options.duration = (150.0 + (pick(2) == 0 ? 0.37 : 0.0)) * setup.options.time_step;
        setup.options.record_contacts = true;
        setup.options.verify = pick(3) == 0;
        if (pick(2) == 0) setup.forces.push_back(make_gravity(testing::random_vector(random_, 9.0)));
        if (forces_ == Forces::varying) add_varying_forces(setup);
        setup.materials.push_back({"wall", pick(2) == 0 ? 1.0 : random_.uniform(), pick(2) == 0 ? 0.0 : 0.3});
        setup.colliders.push_back({"mesh", MeshShape{mesh(), {}, "", {}}, 0});
        if (pick(2) == 0)
            setup.colliders.push_back({"floor", PlaneShape{shift_ + Vec3{0, 0, -0.9}, random_.unit_vector()}, 0});
        if (pick(2) == 0) {
            BallShape ball{0.2, {}};
            ball.placement.position = shift_;
            setup.colliders.push_back({"ball", ball, 0});
        }
        if (pick(3) == 0) setup.bounds = Box3{shift_ - Vec3{2, 2, 2}, shift_ + Vec3{2, 2, 2}};
        const double largest = std::array{0.0, 1e-4, 0.03}[pick(3)];
        for (int i = 0; i < 40; ++i) setup.particles.push_back(particle(largest));
        return setup;
    }

private:
    // Some change slowly along a path, and some within a few steps.
    void add_varying_forces(SimulationSetup& setup) {
        setup.options.integrator = test::kAllIntegrators[pick(static_cast<int>(test::kAllIntegrators.size()))];
        setup.forces.push_back(pick(2) == 0 ? make_linear_drag(random_.uniform()) : make_quadratic_drag(0.2));
        if (pick(3) == 0)
            setup.forces.push_back(make_swirl(shift_, random_.unit_vector(), 20.0 * random_.uniform(), 0.1));
        if (pick(3) == 0)
            setup.forces.push_back(make_point_gravity({{shift_ + place(), 5.0 * random_.uniform(), 0.05}}));
    }

    std::size_t pick(int count) { return static_cast<std::size_t>(random_.uniform() * count); }

    Vec3 place() {
        const double x = random_.uniform();
        const double y = random_.uniform();
        return {2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * random_.uniform() - 1.0};
    }

    Particle particle(double largest_radius) {
        Particle particle;
        particle.position = shift_ + place();
        particle.velocity = testing::scaled({random_.unit_vector(), std::array{0.5, 2.0, 8.0}[pick(3)]});
        particle.radius = largest_radius * random_.uniform();
        particle.birth_time = pick(4) == 0 ? 0.2 * random_.uniform() : 0.0;
        if (pick(3) == 0) particle.lifetime = random_.uniform();
        return particle;
    }

    /// Returns a rough ball around all particles, or scattered triangles that include slivers.
    std::shared_ptr<const TriangleMesh> mesh() {
        auto result = std::make_shared<TriangleMesh>();
        const std::size_t kind = pick(3);
        if (kind != 2) {
            // With fine triangles, one query along a parabola covers less than a step.
            *result = testing::sphere_mesh({}, 1.9, kind == 0 ? 3 : 5);
            for (Vec3& v : result->vertices) v = shift_ + (1.0 + 0.05 * random_.uniform()) * v;
            return result;
        }
        for (std::uint32_t k = 0; k < 80; ++k) {
            const Vec3 corner = shift_ + place();
            const double size = 0.02 + 0.2 * random_.uniform();
            const double width = pick(4) == 0 ? 1e-5 : size;
            result->vertices.insert(result->vertices.end(), {corner, corner + size * random_.unit_vector(),
                                                             corner + width * random_.unit_vector()});
            result->triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
        }
        return result;
    }

    RandomSequence random_;
    Vec3 shift_;
    Forces forces_;
};

void expect_same_records(const Simulation& a, const Simulation& b) {
    ASSERT_EQ(a.contact_records().size(), b.contact_records().size());
    for (std::size_t k = 0; k < a.contact_records().size(); ++k) {
        const ContactRecord& x = a.contact_records()[k];
        const ContactRecord& y = b.contact_records()[k];
        ASSERT_EQ(x.surface, y.surface) << k;
        ASSERT_EQ(x.particle, y.particle) << k;
        ASSERT_EQ(std::bit_cast<std::uint64_t>(x.time), std::bit_cast<std::uint64_t>(y.time)) << k;
    }
}

void expect_same_statistics(const Simulation& a, const Simulation& b) {
    EXPECT_EQ(a.statistics().particle_steps, b.statistics().particle_steps);
    EXPECT_EQ(a.statistics().contacts, b.statistics().contacts);
    EXPECT_EQ(a.statistics().expired, b.statistics().expired);
    EXPECT_EQ(a.statistics().out_of_bounds, b.statistics().out_of_bounds);
    EXPECT_EQ(a.statistics().resting, b.statistics().resting);
    EXPECT_EQ(a.statistics().asleep, b.statistics().asleep);
    EXPECT_EQ(a.statistics().unsimulated_time, b.statistics().unsimulated_time);
    EXPECT_EQ(a.statistics().violations, b.statistics().violations);
    EXPECT_EQ(a.kinetic_energy(), b.kinetic_energy());
}

/// Runs random scenes with and without look-ahead and spatial order, and expects equal results. Returns the number of
/// impacts.
std::uint64_t expect_the_same_with_look_ahead(int cases, const Vec3& shift,
                                              SparseCase::Forces forces = SparseCase::Forces::uniform) {
    std::uint64_t impacts = 0;
    for (int i = 0; i < cases; ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const auto seed = static_cast<std::uint64_t>(i);
        SimulationSetup plain = SparseCase(seed, shift, forces).setup();
        plain.acceleration.culling = i % 16 != 5;
        plain.acceleration.look_ahead = false;
        plain.acceleration.spatial_order = false;
        Simulation reference(std::move(plain));
        Simulation simulation(SparseCase(seed, shift, forces).setup());
        while (!simulation.finished()) {
            simulation.step();
            reference.step();
            expect_same_records(simulation, reference);
            EXPECT_EQ(simulation.state_hash(), reference.state_hash()) << "step " << simulation.step_index();
            if (::testing::Test::HasFailure()) return impacts;
        }
        expect_same_statistics(simulation, reference);
        EXPECT_EQ(simulation.statistics().violations, 0U);
        impacts += simulation.statistics().contacts;
    }
    return impacts;
}

TEST(LookAheadRuns, ChangesNoImpactAndNoBitOfTheStateInRandomScenes) {
    const int cases = test::scaled(150);
    EXPECT_GT(expect_the_same_with_look_ahead(cases, {}), static_cast<std::uint64_t>(cases) * 20);
}

TEST(LookAheadRuns, ChangesNothingFarFromTheOrigin) {
    const int cases = test::scaled(150);
    EXPECT_GT(expect_the_same_with_look_ahead(cases, {3e6, -5e6, 1e6}), static_cast<std::uint64_t>(cases) * 20);
}

// The reference knows no free space along a path, and in some cases none at all.
TEST(LookAheadRuns, ChangesNothingUnderForcesThatVary) {
    const int cases = test::scaled(60);
    EXPECT_GT(expect_the_same_with_look_ahead(cases, {}, SparseCase::Forces::varying),
              static_cast<std::uint64_t>(cases) * 20);
}

TEST(LookAheadRuns, ChangesNothingUnderForcesThatVaryFarFromTheOrigin) {
    const int cases = test::scaled(60);
    EXPECT_GT(expect_the_same_with_look_ahead(cases, {3e6, -5e6, 1e6}, SparseCase::Forces::varying),
              static_cast<std::uint64_t>(cases) * 20);
}

/// A sphere is born with its centre on a face that occurs twice, with both windings. The sphere cannot leave to either
/// side and stays there.
TEST(LookAheadRuns, DoesNotFreeASphereThatCannotLeaveItsSurface) {
    const auto run = [](bool look_ahead) {
        SimulationSetup setup;
        setup.options.time_step = 1.0 / 60.0;
        setup.options.duration = 0.5;
        setup.acceleration.look_ahead = look_ahead;
        setup.materials.push_back({"wall", 1.0, 0.0});
        auto mesh = std::make_shared<TriangleMesh>();
        mesh->vertices = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
        mesh->triangles = {{0, 1, 2}, {0, 2, 1}};
        setup.colliders.push_back({"mesh", MeshShape{std::move(mesh), {}, "", {}}, 0});
        Particle particle;
        particle.velocity = {0.1, 0, 1.0};
        particle.radius = 1e-3;
        setup.particles.push_back(particle);
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        return std::pair(simulation.state_hash(), simulation.statistics().unsimulated_time);
    };
    EXPECT_EQ(run(true), run(false));
}

/// Returns the state, violations and contacts of a whole run.
std::tuple<std::uint64_t, std::uint64_t, std::uint64_t> outcome_of(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    simulation.advance(simulation.step_count());
    return {simulation.state_hash(), simulation.statistics().violations, simulation.statistics().contacts};
}

/// The sphere is far from the origin and slow. The rounding of every step exceeds its distance from the wall. The exact
/// path leads away from the wall, but the rounded positions would lead through the wall.
TEST(LookAheadRuns, KeepsAWallToWhichRoundedStepsLeadBack) {
    constexpr double kFar = 5e6;
    constexpr double kUlp = 0x1p-30;
    const auto run = [](bool look_ahead) {
        SimulationSetup setup;
        setup.options.time_step = 1e-3;
        setup.options.duration = 3.6;
        setup.options.integrator = IntegratorKind::symplectic_euler;
        setup.acceleration.look_ahead = look_ahead;
        setup.options.verify = true;
        setup.materials.push_back({"wall", 1.0, 0.0});
        auto mesh = std::make_shared<TriangleMesh>();
        mesh->vertices = {{kFar - 4, -4, -4}, {kFar + 4, -4, 4}, {kFar, 8, 0}};
        mesh->triangles = {{0, 1, 2}};
        setup.colliders.push_back({"mesh", MeshShape{std::move(mesh), {}, "", {}}, 0});
        Particle particle;
        particle.radius = 1e-6;
        particle.position = {kFar, 0.0, -std::sqrt(2.0) * (particle.radius + 16.0 * kUlp)};
        particle.velocity = {0.0009317789226770401, 0.0, 0.0009317416697740555};
        setup.particles.push_back(particle);
        return outcome_of(std::move(setup));
    };
    EXPECT_EQ(run(true), run(false));
    EXPECT_EQ(std::get<1>(run(true)), 0U);
}

// The rounding error of heights above the plane is larger than the particle's distance from the plane.
TEST(LookAheadRuns, DoesNotTakeParticlesThroughAPlaneWhosePointIsFarAlongIt) {
    const auto run = [](bool look_ahead) {
        SimulationSetup setup;
        setup.options.time_step = 0.1;
        setup.options.duration = 10.0;
        setup.acceleration.look_ahead = look_ahead;
        setup.options.verify = true;
        setup.materials.push_back({"wall", 1.0, 0.0});
        setup.colliders.push_back({"plane", PlaneShape{{8e8, -6e8, 0}, {0.6, 0.8, 0}}, 0});
        Particle particle;
        particle.position = {-7e-8, 0, 0};
        particle.velocity = {0, -1e-9, 0};
        setup.particles.push_back(particle);
        return outcome_of(std::move(setup));
    };
    EXPECT_EQ(run(true), run(false));
    EXPECT_EQ(std::get<1>(run(true)), 0U);
    EXPECT_EQ(std::get<2>(run(true)), 1U);
}

void add_fountain(SimulationSetup& setup) {
    EmitterDescription fountain;
    fountain.name = "fountain";
    fountain.shape = SphereShape{{}, 0.3};
    fountain.rate = {100.0 / setup.options.duration, 0.0};
    fountain.speed = {2.0, 0.5};
    fountain.lifetime = {0.4 * setup.options.duration, 0.1 * setup.options.duration};
    setup.emitters.push_back(std::move(fountain));
}

// Calls advance() with one step, several steps, and more steps than can be deferred. Some calls are stopped early.
TEST(Advance, GivesTheBitsOfSingleSteps) {
    int stretches = 0;
    for (int i = 0; i < test::scaled(150); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const auto seed = static_cast<std::uint64_t>(i);
        RandomSequence random(seed, 32, 0);
        SimulationSetup setup = SparseCase(seed).setup();
        SimulationSetup same = SparseCase(seed).setup();
        if (i % 2 == 0) {
            add_fountain(setup);
            add_fountain(same);
        }
        Simulation reference(std::move(same));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) {
            const double u = random.uniform();
            const auto count = static_cast<std::uint64_t>(1.0 + 120.0 * u * u);
            const std::uint64_t last = simulation.step_index() + (random.uniform() < 0.3 ? 1 + count / 2 : count);
            simulation.advance(count, [&] {
                reference.step();
                EXPECT_EQ(simulation.step_index(), reference.step_index());
                EXPECT_EQ(simulation.particles().size(), reference.particles().size());
                expect_same_records(simulation, reference);
                return simulation.step_index() < last && !::testing::Test::HasFatalFailure();
            });
            ASSERT_TRUE(simulation.finished() || simulation.step_index() <= last);
            ASSERT_EQ(simulation.state_hash(), reference.state_hash()) << "step " << simulation.step_index();
            ++stretches;
        }
        expect_same_statistics(simulation, reference);
    }
    EXPECT_GT(stretches, 2 * test::scaled(150));
}

TEST(Advance, KeepsTheLastStepIfItsCallerThrows) {
    Simulation simulation(SparseCase(4).setup());
    Simulation reference(SparseCase(4).setup());
    EXPECT_THROW(simulation.advance(100,
                                    [&] {
                                        if (simulation.step_index() == 30) throw std::runtime_error("enough");
                                        return true;
                                    }),
                 std::runtime_error);
    EXPECT_EQ(simulation.step_index(), 30U);
    while (reference.step_index() < 30) reference.step();
    EXPECT_EQ(simulation.state_hash(), reference.state_hash());
    simulation.advance(1000);
    while (!reference.finished()) reference.step();
    EXPECT_TRUE(simulation.finished());
    EXPECT_EQ(simulation.state_hash(), reference.state_hash());
}

TEST(Advance, MayBeCalledRecursively) {
    Simulation simulation(SparseCase(4).setup());
    Simulation reference(SparseCase(4).setup());
    simulation.advance(20, [&] {
        if (simulation.step_index() == 10) simulation.advance(5);
        return true;
    });
    while (reference.step_index() < 25) reference.step();
    EXPECT_EQ(simulation.step_index(), 25U);
    EXPECT_EQ(simulation.state_hash(), reference.state_hash());
}

/// Returns a scene with enough triangles and particles for the spatial order. In a step, a tenth of the particles have
/// impacts. This tenth is also large enough for the spatial order.
SimulationSetup crowd() {
    SimulationSetup setup;
    setup.options.time_step = 0.05;
    setup.options.duration = 1.0;
    setup.options.record_contacts = true;
    setup.options.bounce_budget = 1;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.materials.push_back({"wall", 0.6, 0.4});
    setup.colliders.push_back(
        {"body", MeshShape{std::make_shared<const TriangleMesh>(testing::sphere_mesh({}, 1.0, 7)), {}, "", {}}, 0});
    RandomSequence random(5, 0, 0);
    for (int i = 0; i < 8 * test::scaled(1000); ++i) {
        Particle particle;
        particle.position = 0.5 * random.in_unit_ball();
        particle.velocity = 3.0 * random.unit_vector();
        particle.lifetime = i % 3 == 0 ? random.uniform() : 10.0;
        setup.particles.push_back(particle);
    }
    return setup;
}

TEST(SpatialOrder, ChangesNoRecordNoTotalAndNoStatistic) {
    SimulationSetup plain = crowd();
    plain.acceleration.spatial_order = false;
    Simulation reference(std::move(plain));
    Simulation simulation(crowd());
    while (!simulation.finished()) {
        simulation.step();
        reference.step();
        ASSERT_NO_FATAL_FAILURE(expect_same_records(simulation, reference));
    }
    EXPECT_EQ(simulation.state_hash(), reference.state_hash());
    EXPECT_GT(simulation.statistics().unsimulated_time, 0.0);
    expect_same_statistics(simulation, reference);
    EXPECT_EQ(simulation.triangle_totals(0).hits, reference.triangle_totals(0).hits);
    EXPECT_EQ(simulation.triangle_totals(0).impulse, reference.triangle_totals(0).impulse);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
