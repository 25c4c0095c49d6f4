#include "ricochet/dynamics/neighbour_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

Box3 random_box(RandomSequence& random) {
    if (random.uniform() < 0.05) return {};
    const double radius = 0.02 + 0.1 * random.uniform();
    return ball_box({random.uniform(), 2.0 * random.uniform(), random.uniform()}, radius);
}

std::vector<std::uint32_t> near_by_brute_force(const std::vector<Box3>& boxes, const Box3& box) {
    std::vector<std::uint32_t> near;
    for (std::uint32_t k = 0; k < boxes.size(); ++k) {
        if (!boxes[k].empty() && overlap(boxes[k], box)) near.push_back(k);
    }
    return near;
}

TEST(NeighbourPairs, RepeatedChangesOfAFewBoxesGiveThePairsOfAFullSearch) {
    NeighbourPairs kept;
    NeighbourGrid anew;
    for (int seed = 1; seed <= test::scaled(40); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomSequence random(static_cast<std::uint64_t>(seed), 1, 0);
        std::vector<Box3> boxes(static_cast<std::size_t>(40 + 20 * (seed % 15)));
        for (Box3& box : boxes) box = random_box(random);
        ASSERT_TRUE(kept.find(boxes) == anew.find_pairs(boxes));
        const double part = seed % 4 == 0 ? 0.3 : 0.02;
        for (int call = 0; call < 6; ++call) {
            std::vector<std::uint32_t> changed;
            for (std::uint32_t k = 0; k < boxes.size(); ++k) {
                if (random.uniform() >= part) continue;
                changed.push_back(k);
                boxes[k] = random_box(random);
            }
            ASSERT_TRUE(kept.update(boxes, changed) == anew.find_pairs(boxes)) << call;
            ASSERT_TRUE(kept.all() == anew.find_pairs(boxes));
            const Box3 box = ball_box({random.uniform(), random.uniform(), random.uniform()}, 0.3);
            std::vector<std::uint32_t> near;
            kept.find_near(box, near);
            std::sort(near.begin(), near.end());
            ASSERT_TRUE(near == near_by_brute_force(boxes, box)) << call;
        }
    }
}

/// way: largest displacement of a box in a call along each axis, in m.
Box3 moved(const Box3& box, RandomSequence& random, double translation) {
    if (box.empty()) return box;
    const auto step = [&] { return translation * (2.0 * random.uniform() - 1.0); };
    const Vec3 by{step(), step(), step()};
    return {box.lower + by, box.upper + by};
}

// Most boxes move slightly, a few move far, appear or disappear, and finally all move far. The pairs must not depend on
// the stored state.
TEST(NeighbourPairs, DriftingBoxesGiveThePairsOfAFullSearch) {
    NeighbourPairs kept;
    NeighbourGrid anew;
    for (int seed = 1; seed <= test::scaled(12); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomSequence random(static_cast<std::uint64_t>(seed), 2, 0);
        std::vector<Box3> boxes(static_cast<std::size_t>(500 + 60 * (seed % 6)));
        for (Box3& box : boxes) box = random_box(random);
        for (int call = 0; call < 30; ++call) {
            const double translation = call % 10 == 9 ? 0.1 : 1e-3;
            for (Box3& box : boxes) {
                const bool is_made_anew = random.uniform() < (seed % 3 == 0 ? 0.06 : 0.01);
                box = is_made_anew ? random_box(random) : moved(box, random, translation);
            }
            ASSERT_TRUE(kept.find(boxes) == anew.find_pairs(boxes)) << call;
            std::vector<std::uint32_t> changed;
            for (std::uint32_t k = 0; k < boxes.size(); ++k) {
                if (random.uniform() >= 0.01) continue;
                changed.push_back(k);
                boxes[k] = random_box(random);
            }
            ASSERT_TRUE(kept.update(boxes, changed) == anew.find_pairs(boxes)) << call;
            const Box3 box = ball_box({random.uniform(), random.uniform(), random.uniform()}, 0.3);
            std::vector<std::uint32_t> near;
            kept.find_near(box, near);
            std::sort(near.begin(), near.end());
            ASSERT_TRUE(near == near_by_brute_force(boxes, box)) << call;
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
