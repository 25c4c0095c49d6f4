#include "cli/terminal.h"

#include <gtest/gtest.h>

namespace ricochet::cli {
namespace RICOCHET_FILE {

const std::vector<ColliderDescription> kColliders = {{"floor", PlaneShape{}, 0}, {"tube", MeshShape{}, 0}};

TEST(ViolationReport, NamesParticlePositionTimeColliderAndTriangle) {
    const std::vector<Violation> violations = {{ViolationKind::crossing, 7, {1, 0.1, -2}, 0.25, 1, 99},
                                               {ViolationKind::wrong_side, 8, {0, 0, 0}, 1, 0, {}},
                                               {ViolationKind::overlap, 9, {0, 0, 0}, 1, 1, 3},
                                               {ViolationKind::gap, 10, {0, 0, 0}, 1, {}, {}},
                                               {ViolationKind::energy, 11, {0, 0, 0}, 1, {}, {}},
                                               {ViolationKind::pair_overlap, 12, {0, 0, 0}, 1, {}, {}},
                                               {ViolationKind::pair_impact, 13, {0, 0, 0}, 1, {}, {}},
                                               {ViolationKind::rebound, 14, {0, 0, 0}, 1, {}, {}}};
    EXPECT_EQ(
        violation_lines(violations, 8, kColliders),
        (std::vector<std::string>{
            "leak: particle 7 at (1, 0.10000000000000001, -2) m, time 0.25 s: a segment crosses collider \"tube\", "
            "triangle 99",
            "leak: particle 8 at (0, 0, 0) m, time 1 s: is on a different side than at birth of collider \"floor\"",
            "leak: particle 9 at (0, 0, 0) m, time 1 s: overlaps collider \"tube\", triangle 3",
            "leak: particle 10 at (0, 0, 0) m, time 1 s: its segments do not join",
            "energy: particle 11 at (0, 0, 0) m, time 1 s: has gained energy from surfaces",
            "spheres: particle 12 at (0, 0, 0) m, time 1 s: overlaps another sphere",
            "spheres: particle 13 at (0, 0, 0) m, time 1 s: its impact on another sphere is inconsistent",
            "energy: particle 14 at (0, 0, 0) m, time 1 s: an impact has another rebound than the surfaces that it "
            "has hit"}));
}

TEST(ViolationReport, ListsTwentyAndCountsTheRest) {
    const std::vector<Violation> violations(25);
    const auto lines = violation_lines(violations, 5000, kColliders);
    ASSERT_EQ(lines.size(), 21U);
    EXPECT_EQ(lines.back(), "violations: and 4980 more");
    EXPECT_EQ(violation_lines({violations.data(), 20}, 20, kColliders).size(), 20U);
    EXPECT_TRUE(violation_lines({}, 0, kColliders).empty());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::cli
