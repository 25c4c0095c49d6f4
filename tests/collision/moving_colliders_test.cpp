// Compares the broad phase for moving bodies, and their positions, with a test of every body.
#include "ricochet/collision/moving_colliders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/collision/overlap.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Balls that spin and oscillate, each on its own frame, with a moving plane and a ball at rest.
struct ManyBodies {
    std::shared_ptr<const FrameTree> frames;
    std::shared_ptr<ColliderList> list;
    std::unique_ptr<CollisionWorld> at_rest;
    std::unique_ptr<MovingColliders> bodies;

    ManyBodies(std::size_t count, std::uint64_t seed) {
        RandomSequence random(seed, 0, 0);
        std::vector<FrameDescription> descriptions;
        std::vector<ColliderDescription> colliders{{"still", BallShape{0.5, {{1, 2, 3}}}, 0}};
        for (std::size_t k = 0; k < count; ++k) {
            const std::string name = "frame " + std::to_string(k);
            const Vec3 place = 6.0 * random.unit_vector();
            const Vec3 axis = random.unit_vector();
            const Vec3 shake = random.uniform() * random.unit_vector();
            descriptions.push_back({name,
                                    "",
                                    place,
                                    {0, 0, 1},
                                    0.0,
                                    {Spin{axis, 300.0 * random.uniform()}, Oscillation{shake, random.uniform(), 0.0}}});
            const Vec3 center = random.unit_vector();
            colliders.push_back({name, BallShape{0.1 + 0.4 * random.uniform(), {center}}, 0, name});
        }
        colliders.push_back({"lift", PlaneShape{{0, 0, -50}, {0, 0, 1}}, 0, "frame 0"});
        frames = std::make_shared<const FrameTree>(descriptions);
        list = std::make_shared<ColliderList>(std::move(colliders));
        at_rest = std::make_unique<CollisionWorld>(list, "");
        bodies = std::make_unique<MovingColliders>(*at_rest, frames);
    }
};

TEST(MovingColliders, NearABoxAreAllThatEnterItInTheirOrder) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        SCOPED_TRACE(seed);
        ManyBodies many(1 + 12 * seed, seed);
        RandomSequence random(seed, 1, 0);
        for (int step = 0; step < 3; ++step) {
            many.bodies->begin_step(0.1 * step, 0.1 * (step + 1));
            for (int query = 0; query < 50; ++query) {
                const Vec3 center = 7.0 * random.uniform() * random.unit_vector();
                const double half = 2.0 * random.uniform() * random.uniform();
                const Box3 box{center - Vec3{half, half, half}, center + Vec3{half, half, half}};
                const BodyId except = query % 3 == 0
                                          ? kWorldBody
                                          : static_cast<BodyId>(static_cast<std::size_t>(query) % many.bodies->size());
                std::vector<BodyId> expected{kWorldBody};  // existing entries are kept
                if (except != kWorldBody && !many.bodies->stays_out(kWorldBody, box)) expected.push_back(kWorldBody);
                for (BodyId body = 0; body < many.bodies->size(); ++body) {
                    if (body != except && !many.bodies->stays_out(body, box)) expected.push_back(body);
                }
                std::vector<BodyId> near{kWorldBody};
                many.bodies->near(box, except, near);
                EXPECT_EQ(near, expected);
            }
        }
    }
}

// A spawned particle is tested only against bodies near its position. If no boxes are known for the time, it is tested
// against all bodies.
TEST(Births, FindTheBodiesThatATestOfEachBodyFinds) {
    ManyBodies near(60, 5);
    ManyBodies all(60, 5);
    RandomSequence random(5, 2, 0);
    std::size_t found = 0;
    for (int step = 0; step < 3; ++step) {
        near.bodies->begin_step(0.1 * step, 0.1 * (step + 1));
        for (int birth = 0; birth < 300; ++birth) {
            const double time = 0.1 * (step + random.uniform());
            const Vec3 center = (4.5 + 3.0 * random.uniform()) * random.unit_vector();
            const double radius = random.uniform();
            std::vector<BodyId> asked;
            all.bodies->near_at({center, center}, time, asked);
            EXPECT_EQ(asked.size(), all.bodies->size());
            const auto expected = deepest_overlap(*all.bodies, center, radius, time);
            const auto overlap = deepest_overlap(*near.bodies, center, radius, time);
            ASSERT_EQ(overlap.has_value(), expected.has_value());
            if (overlap) {
                EXPECT_EQ(overlap->surface, expected->surface);
            }
            found += overlap ? 1 : 0;
            EXPECT_EQ(off_bodies(*near.bodies, center, time), off_bodies(*all.bodies, center, time));
            // The point is exactly on a body and is moved off it.
            const MovingPose pose = near.bodies->pose(0, time);
            const Vec3 on = pose.point({0.3, 0.2, -50.0});
            EXPECT_EQ(off_bodies(*near.bodies, on, time), off_bodies(*all.bodies, on, time));
        }
    }
    EXPECT_GT(found, 50U);
}

// Poses are cached. Poses of other times, bodies, steps and scenes must never be confused.
TEST(MovingColliders, FollowTheirFramesWhateverWasQueriedBefore) {
    ManyBodies a(7, 1);
    ManyBodies b(7, 2);
    RandomSequence random(3, 0, 0);
    for (int step = 0; step < 4; ++step) {
        a.bodies->begin_step(0.1 * step, 0.1 * (step + 1));
        b.bodies->begin_step(0.1 * step, 0.1 * (step + 1));
        for (int query = 0; query < 300; ++query) {
            ManyBodies& many = random.uniform() < 0.5 ? a : b;
            const auto body = static_cast<BodyId>(7.0 * random.uniform());
            const double time = 0.1 * (step + static_cast<double>(static_cast<int>(5.0 * random.uniform())) / 4.0);
            const MovingPose pose = many.bodies->pose(body, time);
            const MovingPose other = many.frames->at(body, time);
            EXPECT_EQ(pose.local_position({1, 2, 3}), other.local_position({1, 2, 3}));
            EXPECT_EQ(pose.velocity_of({1, 2, 3}), other.velocity_of({1, 2, 3}));
            EXPECT_EQ(pose.acceleration, other.acceleration);
        }
    }
}

// A body stays in its swept box at every time of a step.
TEST(SweptBoxes, ContainTheirBodyAtAllTimes) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        const ManyBodies many(5, seed);
        RandomSequence random(seed, 2, 0);
        for (std::size_t frame = 0; frame < 5; ++frame) {
            const Box3 box{{-0.5, -0.2, -1.0}, {0.7, 0.3, 0.4}};
            const double begin = 3.0 * random.uniform();
            const double end = begin + random.uniform();
            const Box3 swept = swept_box(*many.frames, frame, box, begin, end);
            for (int k = 0; k <= 50; ++k) {
                const MovingPose pose = many.frames->at(frame, begin + (end - begin) * k / 50.0);
                for (int corner = 0; corner < 8; ++corner) {
                    const Vec3 p{corner & 1 ? box.lower.x : box.upper.x, corner & 2 ? box.lower.y : box.upper.y,
                                 corner & 4 ? box.lower.z : box.upper.z};
                    EXPECT_TRUE(swept.contains(pose.point(p)));
                }
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
