#include "ricochet/dynamics/flows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

Vec3 linear(const Vec3& p) { return {1.0 + 2.0 * p.x - p.y, 3.0 * p.z + 0.5 * p.x, p.y - 2.0}; }

VectorGrid sampled_grid() {
    VectorGrid grid{{-1, 2, 3}, {0.5, 0.25, 2}, {4, 3, 5}, {}};
    for (std::uint32_t k = 0; k < 5; ++k) {
        for (std::uint32_t j = 0; j < 3; ++j) {
            for (std::uint32_t i = 0; i < 4; ++i) {
                grid.values.push_back(linear({-1 + 0.5 * i, 2 + 0.25 * j, 3 + 2.0 * k}));
            }
        }
    }
    return grid;
}

TEST(GridFlow, ReproducesLinearFields) {
    const FlowPointer flow = make_grid_flow(sampled_grid());
    RandomSequence random(2, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p{-1 + 1.5 * random.uniform(), 2 + 0.5 * random.uniform(), 3 + 8 * random.uniform()};
        EXPECT_NEAR(length(flow->velocity(p, 0.0) - linear(p)), 0.0, 1e-13);
    }
    EXPECT_TRUE(flow->is_steady());
    EXPECT_FALSE(flow->is_uniform());
}

TEST(GridFlow, IsExactAtItsPoints) {
    const VectorGrid grid = sampled_grid();
    const FlowPointer flow = make_grid_flow(grid);
    EXPECT_EQ(flow->velocity({-1, 2, 3}, 0.0), grid.values.front());
    EXPECT_EQ(flow->velocity({0.5, 2.5, 11}, 0.0), grid.values.back());
    EXPECT_EQ(flow->velocity({-0.5, 2.25, 5}, 0.0), grid.values[1 + 4 * (1 + 3 * 1)]);
}

TEST(GridFlow, HasTheNearestValueOrZeroOutside) {
    const FlowPointer clamped = make_grid_flow(sampled_grid(), OutsideGrid::clamp);
    const FlowPointer zero = make_grid_flow(sampled_grid(), OutsideGrid::zero);
    EXPECT_NEAR(length(clamped->velocity({-5, 2.1, 4}, 0.0) - linear({-1, 2.1, 4})), 0.0, 1e-14);
    EXPECT_NEAR(length(clamped->velocity({9, 9, 99}, 0.0) - linear({0.5, 2.5, 11})), 0.0, 1e-14);
    EXPECT_NEAR(length(clamped->velocity({0, -1e75, 4}, 0.0) - linear({0, 2, 4})), 0.0, 1e-14);
    EXPECT_EQ(zero->velocity({-5, 2.1, 4}, 0.0), Vec3{});
    EXPECT_EQ(zero->velocity({0, 2.1, 11.0001}, 0.0), Vec3{});
    EXPECT_EQ(zero->velocity({0.5, 2.5, 11}, 0.0), clamped->velocity({0.5, 2.5, 11}, 0.0));
    (void)clamped->velocity({std::nan(""), 0, 0}, 0.0);  // no index may leave the grid
}

TEST(GridFlow, IsConstantAlongAnAxisWithOnePoint) {
    const FlowPointer flow =
        make_grid_flow({{0, 0, 0}, {1, 1, 1}, {2, 1, 1}, {{0, 0, 0}, {2, 0, 0}}}, OutsideGrid::zero);
    EXPECT_EQ(flow->velocity({0.5, 77, -3}, 0.0), (Vec3{1, 0, 0}));
}

TEST(GridFlow, RefusesInvalidGrids) {
    const auto refuses = [](auto change) {
        VectorGrid grid = sampled_grid();
        change(grid);
        EXPECT_THROW((void)make_grid_flow(grid), InputError);
    };
    refuses([](VectorGrid& g) { g.values.pop_back(); });
    refuses([](VectorGrid& g) { g.counts[1] = 0; });
    refuses([](VectorGrid& g) { g.counts = {60, 1U << 31, 1U << 31}; });
    refuses([](VectorGrid& g) { g.spacing.y = 0.0; });
    refuses([](VectorGrid& g) { g.spacing.z = -1.0; });
    refuses([](VectorGrid& g) { g.values[7].y = std::nan(""); });
    refuses([](VectorGrid& g) { g.origin.x = std::nan(""); });
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
