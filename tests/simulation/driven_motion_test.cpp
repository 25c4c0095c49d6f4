// The impacts of a preview determine the end of a substep. A plate on a slider, and grains that fall on it.
#include "ricochet/simulation/driven_motion.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "ricochet/collision/collider_list.h"
#include "ricochet/collision/collision_world.h"
#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kMass = 10.0;   // kg, of the plate
constexpr double kGrain = 0.02;  // kg

/// A plate on a vertical slider, at rest.
struct Plate {
    std::shared_ptr<FrameTree> frames;
    std::shared_ptr<ColliderList> list;
    std::unique_ptr<CollisionWorld> at_rest;
    std::unique_ptr<MovingColliders> colliders;
    ForceField forces;
    std::unique_ptr<DrivenMotion> motion;

    Plate() {
        FrameDescription frame;
        frame.name = "plate";
        frame.is_driven = true;
        frames = std::make_shared<FrameTree>(std::vector{frame});
        list = std::make_shared<ColliderList>(
            std::vector<ColliderDescription>{{"plate", CuboidShape{{1, 1, 0.1}, {}}, 0, "plate"}});
        at_rest = std::make_unique<CollisionWorld>(list, "");
        colliders = std::make_unique<MovingColliders>(*at_rest, frames);
        BodyDescription body;
        body.frame = "plate";
        body.mass = kMass;
        body.inertia = {1.0, 1.0, 1.0, 0.0, 0.0, 0.0};
        body.joint = JointKind::slider;
        ResponseSettings settings;
        settings.time_step = 0.01;
        motion = std::make_unique<DrivenMotion>(std::vector{body}, frames.get(), *colliders, forces, settings);
    }

    void plan(double begin, double end) {
        motion->plan(begin, end, begin);
        colliders->begin_step(begin, end);
    }
};

/// Returns the load of a grain that hits the plate at rest.
ColliderLoad hit(std::uint64_t particle, double time, double approach, double restitution) {
    const double dynamic = 1.0 / kGrain + 1.0 / kMass;
    const double impulse = (1.0 + restitution) * approach / dynamic;
    const double after = -approach + impulse / kGrain;
    ColliderLoad load;
    load.particle = particle;
    load.time = time;
    load.mass = kGrain;
    load.impulse = {0, 0, -impulse};
    load.particle_center = {0, 0, 0.05};
    load.lost_energy = 0.5 * kGrain * (approach * approach - after * after);
    load.approach = approach;
    return load;
}

TEST(DrivenMotion, SubstepEndsSoonerTheLessSpeedItsImpactsRemove) {
    Plate plate;
    plate.motion->begin_step();
    plate.plan(0.0, 0.01);
    EXPECT_EQ(plate.motion->cut_by({}), 0.01);
    const double time = 0.002;
    EXPECT_NEAR(plate.motion->cut_by({hit(1, time, 2.0, 0.3)}) - time, 1e-3 * 0.008, 1e-15);
    EXPECT_NEAR(plate.motion->cut_by({hit(1, time, 2.0, 1.0)}) - time, 1e-9 * 0.008, 1e-15);
    // Two elastic impacts need two substeps, however close they are.
    for (const double later : {1e-3, 1e-9, 1e-14}) {
        const double cut = plate.motion->cut_by({hit(1, time, 2.0, 1.0), hit(2, time + later, 2.0, 1.0)});
        EXPECT_GT(cut, time);
        EXPECT_LT(cut, time + later);
    }
}

// Fast impacts jolt the plate. A slow particle that rested on the plate before does not cut the step. Any other slow
// particle would hit a displaced plate and cuts it.
TEST(DrivenMotion, ReturningParticlesDoNotCutTheStepAfterAJolt) {
    const std::vector<ColliderLoad> impacts{hit(1, 0.002, 2.0, 0.3), hit(7, 0.004, 5e-3, 0.3), hit(2, 0.006, 2.0, 0.3)};
    for (const bool has_touched : {false, true}) {
        Plate plate;
        plate.motion->begin_step();
        plate.plan(0.0, 0.001);
        ColliderLoad resting = hit(7, 0.001, 1e-6, 0.0);
        resting.impact = false;
        const std::vector<ColliderLoad> before{resting};
        plate.motion->follow(has_touched ? before : std::vector<ColliderLoad>{});
        plate.motion->begin_step();  // the motion stores the last step
        plate.plan(0.001, 0.01);
        const double cut = plate.motion->cut_by(impacts);
        if (has_touched) {
            EXPECT_NEAR(cut, 0.006 + 1e-3 * 0.004, 1e-15);
        } else {
            EXPECT_NEAR(cut, 0.002 + 1e-3 * 0.002, 1e-15);
        }
        // This impact is slow, but faster than the jolt of the plate, so it counts.
        const double other = plate.motion->cut_by({hit(1, 0.002, 2.0, 0.3), hit(7, 0.004, 0.02, 0.3)});
        EXPECT_NEAR(other, 0.002 + 1e-3 * 0.002, 1e-15);
    }
}

// The centre of the body does not move. A particle beside it would otherwise be swept through its rotations without
// end.
TEST(DrivenMotion, BodyThatRotatesTooFastCountsAsDiverged) {
    for (const double drive : {1.0, 1e30}) {
        SimulationSetup setup;
        setup.options.time_step = 0.01;
        setup.options.duration = 1.0;
        FrameDescription frame;
        frame.name = "wheel";
        frame.is_driven = true;
        setup.frames = std::make_shared<const FrameTree>(std::vector{frame});
        setup.materials.emplace_back();
        setup.colliders.push_back({"wheel", BallShape{1.0, {}}, 0, "wheel"});
        BodyDescription body;
        body.frame = "wheel";
        body.inertia = {1.0, 1.0, 1.0, 0.0, 0.0, 0.0};
        body.joint = JointKind::hinge;
        body.settings.drive = drive;
        setup.bodies.push_back(body);
        setup.particles.emplace_back().position = {0, 0, 1.1};
        const auto run = [&] { Simulation(std::move(setup)).advance(3); };
        if (drive == 1.0) {
            EXPECT_NO_THROW(run());
        } else {
            EXPECT_THROW(run(), DivergedError);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
