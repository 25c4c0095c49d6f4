#include "ricochet/response/clear_flight.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/random.h"
#include "ricochet/response/exact.h"
#include "support/counts.h"
#include "support/integrators.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::mesh_collider;

constexpr double kTimeStep = 0.02;  // s

/// A ball of triangles under gravity and drag.
class Air {
public:
    explicit Air(IntegratorKind integrator) : world_(of_ball()) {
        settings_.integrator = integrator;
        std::vector<std::unique_ptr<Force>> forces;
        forces.push_back(make_gravity({0, 0, -9.81}));
        forces.push_back(make_linear_drag(0.3));
        forces_ = ForceField(std::move(forces));
    }

    [[nodiscard]] ResponseRules rules(bool look_ahead = false) const {
        ResponseRules rules{world_, bodies_, forces_, materials_, settings_};
        rules.settings.time_step = kTimeStep;
        rules.look_ahead = look_ahead;
        return rules;
    }
    CollisionWorld& world() { return world_; }

private:
    static std::vector<ColliderDescription> of_ball() { return {mesh_collider(testing::sphere_mesh({}, 1.0, 3))}; }

    CollisionWorld world_;
    MovingColliders bodies_{world_};
    ForceField forces_;
    std::vector<Material> materials_{Material{}};
    ResponseSettings settings_;
};

MovingParticle random_particle(RandomSequence& random, double radius) {
    MovingParticle particle;
    particle.state = {3.0 * random.in_unit_ball(), 5.0 * random.in_unit_ball(), 1.0, radius, random.uniform()};
    return particle;
}

void expect_equal(const FlownPiece& a, const FlownPiece& b) {
    EXPECT_EQ(a.path.c, b.path.c);
    EXPECT_EQ(a.path.end, b.path.end);
    EXPECT_EQ(a.begin, b.begin);
    EXPECT_EQ(a.duration, b.duration);
}

class ClearFlight : public ::testing::TestWithParam<IntegratorKind> {};

// Without culling every triangle is tested, and no flight counts as clear.
TEST_P(ClearFlight, EndsInTheBitsOfAStepThatTestsEveryTriangle) {
    Air air(GetParam());
    air.world().prepare_radius(0.1);
    RandomSequence random(9, 0, 0);
    int clear = 0;
    for (int k = 0; k < test::scaled(400); ++k) {
        SCOPED_TRACE("case " + std::to_string(k));
        const MovingParticle start = random_particle(random, k % 2 == 0 ? 0.0 : 0.1);
        const double duration = 0.01 + 0.01 * random.uniform();
        MoveScratch scratch;
        scratch.record_segments = scratch.record_flown = scratch.record_motions = k % 3 == 0;
        MovingParticle fast = start;
        air.world().set_culling(true);
        std::optional<Flight> flight;
        if (!fly_clear(air.rules(), fast, duration, scratch, flight)) continue;
        ++clear;
        MovingParticle slow = start;
        MoveScratch reference;
        reference.record_segments = reference.record_flown = reference.record_motions = k % 3 == 0;
        air.world().set_culling(false);
        (void)ExactResponse(air.rules()).move(slow, duration, reference);
        EXPECT_EQ(fast.state.position, slow.state.position);
        EXPECT_EQ(fast.state.velocity, slow.state.velocity);
        EXPECT_EQ(fast.state.time, slow.state.time);
        EXPECT_EQ(fast.contact, slow.contact);
        EXPECT_EQ(scratch.motions.size(), reference.motions.size());
        ASSERT_EQ(scratch.flown.size(), reference.flown.size());
        for (std::size_t p = 0; p < scratch.flown.size(); ++p) {
            expect_equal(scratch.flown[p], reference.flown[p]);
        }
        ASSERT_EQ(scratch.segments.empty(), reference.segments.empty());
        if (scratch.segments.empty()) continue;
        EXPECT_EQ(scratch.segments.back().to, reference.segments.back().to);
        EXPECT_EQ(scratch.segments.front().from, reference.segments.front().from);
    }
    EXPECT_GT(clear, test::scaled(400) / 4);
}

INSTANTIATE_TEST_SUITE_P(By, ClearFlight, ::testing::ValuesIn(test::kAllIntegrators),
                         [](const auto& tested) { return std::string(name_of(tested.param)); });

// The particle first makes a step with a contact query, which looks ahead along a forecast.
TEST_P(ClearFlight, StaysInTheSpaceOfAForecastForManySteps) {
    Air air(GetParam());
    air.world().prepare_radius(0.1);
    const ExactResponse response(air.rules(/*look_ahead=*/true));
    RandomSequence random(10, 0, 0);
    int steps = 0;
    int forecasts = 0;
    for (int k = 0; k < test::scaled(200); ++k) {
        SCOPED_TRACE("case " + std::to_string(k));
        MovingParticle particle = random_particle(random, k % 2 == 0 ? 0.0 : 0.1);
        MoveScratch scratch;
        air.world().set_culling(true);
        (void)response.move(particle, kTimeStep, scratch);
        if (particle.clear.is_at_rest()) continue;
        ++forecasts;
        std::optional<Flight> flight;
        MovingParticle slow = particle;
        const ClearSpace forecast = particle.clear;
        while (fly_clear(air.rules(true), particle, kTimeStep, scratch, flight)) {
            if (particle.clear.begin != forecast.begin) break;
            ++steps;
            air.world().set_culling(false);
            (void)response.move(slow, kTimeStep, scratch);
            air.world().set_culling(true);
            ASSERT_EQ(particle.state.position, slow.state.position);
            ASSERT_EQ(particle.state.velocity, slow.state.velocity);
        }
        EXPECT_LE(slow.state.time, forecast.end);
    }
    EXPECT_GT(forecasts, test::scaled(200) / 4);
    EXPECT_GT(steps, 4 * forecasts);
}

TEST(ClearFlight, ParticleInContactOrNearASurfaceIsNotMoved) {
    const Air air(IntegratorKind::midpoint);
    MoveScratch scratch;
    std::optional<Flight> flight;
    MovingParticle near;
    near.state = {{0, 0, 1.001}, {1, 0, 0}, 1.0, 0.0, 0.0};
    EXPECT_FALSE(fly_clear(air.rules(), near, 0.02, scratch, flight));
    EXPECT_EQ(near.state.time, 0.0);
    MovingParticle touching;
    touching.state = {{0, 0, 3}, {1, 0, 0}, 1.0, 0.0, 0.0};
    touching.contact.count = 1;
    EXPECT_FALSE(fly_clear(air.rules(), touching, 0.02, scratch, flight));
    EXPECT_EQ(touching.state.position, (Vec3{0, 0, 3}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
