#include "ricochet/geometry/mesh/mesh_motion.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Positions = std::vector<std::vector<Vec3>>;

std::string refusal(std::vector<double> times, Positions positions, MeshEnds ends = MeshEnds::hold) {
    try {
        const MeshMotion motion(std::move(times), std::move(positions), ends);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(MeshMotion, IsLinearBetweenItsKeysAndAtRestOutsideThem) {
    const MeshMotion motion({1.0, 2.0, 4.0}, {{{0, 0, 0}}, {{1, 2, 0}}, {{1, 2, 8}}});
    EXPECT_EQ(motion.at(0.5).position(0), Vec3(0, 0, 0));
    EXPECT_EQ(motion.at(0.5).velocity(0), Vec3());
    EXPECT_EQ(motion.at(1.0).position(0), Vec3(0, 0, 0));
    EXPECT_EQ(motion.at(1.5).position(0), Vec3(0.5, 1, 0));
    EXPECT_EQ(motion.at(1.5).velocity(0), Vec3(1, 2, 0));
    EXPECT_EQ(motion.at(2.0).position(0), Vec3(1, 2, 0));
    EXPECT_EQ(motion.at(2.0).velocity(0), Vec3(0, 0, 4));
    EXPECT_EQ(motion.at(4.0).position(0), Vec3(1, 2, 8));
    EXPECT_EQ(motion.at(9.0).velocity(0), Vec3());
    EXPECT_EQ(motion.next_key(0.0), 1.0);
    EXPECT_EQ(motion.next_key(1.0), 2.0);
    EXPECT_EQ(motion.next_key(3.0), 4.0);
    EXPECT_EQ(motion.next_key(4.0), std::numeric_limits<double>::infinity());
}

TEST(MeshMotion, RepeatsItsCycleBeforeAndAfter) {
    const MeshMotion motion({0.0, 1.0, 3.0}, {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 0, 0}}}, MeshEnds::repeat);
    for (const double round : {-6.0, -3.0, 0.0, 3.0, 300.0}) {
        EXPECT_EQ(motion.at(round).position(0), Vec3(0, 0, 0)) << round;
        EXPECT_EQ(motion.at(round + 0.5).position(0), Vec3(0.5, 0, 0)) << round;
        EXPECT_EQ(motion.at(round + 2.0).position(0), Vec3(0.5, 0, 0)) << round;
        EXPECT_EQ(motion.at(round + 2.0).velocity(0), Vec3(-0.5, 0, 0)) << round;
        EXPECT_EQ(motion.next_key(round), round + 1.0);
        EXPECT_EQ(motion.next_key(round + 1.0), round + 3.0);
    }
}

// The keys repeat, at times that are not sums of powers of two. Each time must lie between its two keys.
TEST(MeshMotion, FindsTheKeysAroundAnyTime) {
    const MeshMotion motion({0.1, 0.3, 0.7}, {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 0, 0}}}, MeshEnds::repeat);
    RandomSequence random(5, 0, 0);
    for (int k = 0; k < 2000; ++k) {
        const double time = 100.0 * random.uniform() - 50.0;
        const double key = motion.next_key(time);
        EXPECT_GT(key, time);
        EXPECT_LE(key, time + 0.4 + 1e-12);
        EXPECT_EQ(motion.at(key).part, 0.0);  // exactly at a key
        EXPECT_GE(motion.at(time).part, 0.0);
        EXPECT_LE(motion.at(time).part, 1.0);
    }
}

TEST(MeshMotion, ReportsInvalidInput) {
    EXPECT_EQ(refusal({0.0}, {{{0, 0, 0}}}), "mesh that deforms: found 1 keys, expected at least 2");
    EXPECT_EQ(refusal({0.0, 1.0, 2.0}, {{{0, 0, 0}}, {{0, 0, 0}}}),
              "mesh that deforms: found 3 times for 2 sets of positions, expected one for each");
    EXPECT_EQ(refusal({1.0, 0.5}, {{{0, 0, 0}}, {{0, 0, 0}}}),
              "mesh that deforms: the time of key 1 is not after the one before, expected ascending times");
    EXPECT_EQ(refusal({0.0, 1.0}, {{{0, 0, 0}}, {{0, 0, 0}, {0, 0, 1}}}),
              "mesh that deforms: found 2 vertices at key 1, expected the 1 of the first");
    EXPECT_EQ(refusal({0.0, 1.0}, {{{0, 0, 0}}, {{0, 0, 1e76}}}),
              "mesh that deforms: a vertex at key 1 is not finite or beyond 1e75 m");
    EXPECT_EQ(refusal({0.0, std::numeric_limits<double>::quiet_NaN()}, {{{0, 0, 0}}, {{0, 0, 0}}}),
              "mesh that deforms: the time of key 1 is not finite or beyond 1e75 s");
    EXPECT_EQ(refusal({0.0, 1.0}, {{{0, 0, 0}}, {{0, 0, 1}}}, MeshEnds::repeat),
              "mesh that deforms: it repeats, and its last positions are not the first, expected the same");
}

TEST(MeshMotion, CanBeSampledFromAFunctionAndTransformed) {
    const MeshMotion motion = sampled_motion(
        [](double time) {
            return std::vector<Vec3>{{time, time * time, 0}};
        },
        {0.0, 1.0, 2.0});
    EXPECT_EQ(motion.at(1.5).position(0), Vec3(1.5, 2.5, 0));
    Placement placement;
    placement.position = {1, 0, 0};
    placement.scale = {2, 2, 2};
    EXPECT_EQ(motion.mapped(world_from_local(placement)).at(1.5).position(0), Vec3(4, 5, 0));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
