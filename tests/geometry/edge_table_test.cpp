#include "ricochet/geometry/mesh/edge_table.h"

#include <gtest/gtest.h>

#include <set>

namespace ricochet {
namespace RICOCHET_FILE {

TEST(EdgesOf, ListsEveryEdgeOnceWithItsOppositeCorners) {
    const std::vector<MeshEdge> edges = edges_of({std::vector<Vec3>(4), {{0, 1, 2}, {2, 1, 3}}});
    ASSERT_EQ(edges.size(), 5U);
    const auto is = [&](std::size_t i, std::uint32_t first, std::uint32_t second,
                        const std::set<std::uint32_t>& across) {
        EXPECT_EQ(edges[i].first, first);
        EXPECT_EQ(edges[i].second, second);
        EXPECT_EQ((std::set<std::uint32_t>{edges[i].opposite[0], edges[i].opposite[1]}), across) << first << second;
    };
    is(0, 0, 1, {2, kNoVertex});
    is(1, 0, 2, {1, kNoVertex});
    is(2, 1, 2, {0, 3});
    is(3, 1, 3, {2, kNoVertex});
    is(4, 2, 3, {1, kNoVertex});
}

TEST(EdgesOf, ListsAnEdgeOfThreeFacesOnceAndWithoutNeighbours) {
    const std::vector<MeshEdge> edges = edges_of({std::vector<Vec3>(5), {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}});
    ASSERT_EQ(edges.size(), 7U);
    EXPECT_EQ(edges[0].first, 0U);
    EXPECT_EQ(edges[0].second, 1U);
    EXPECT_EQ(edges[0].opposite, (std::array<std::uint32_t, 2>{kNoVertex, kNoVertex}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
