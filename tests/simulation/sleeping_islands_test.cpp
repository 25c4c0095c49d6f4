// Neighbours of sleeping spheres: a row of spheres, the first of which leans on a wall.
#include "ricochet/simulation/sleeping_islands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace ricochet {
namespace RICOCHET_FILE {

using Ids = std::vector<std::uint64_t>;

WarmStartMemory::Entry pair_of(std::uint64_t first, std::uint64_t second, double normal) {
    return {ContactKey::of_pair(first, second), {normal, {}, {}}, false};
}

/// Returns spheres 10 to 14 and 20. Each of 10 to 14 is pressed by the next with its number minus 10. Sphere 20 is
/// awake and presses 14 with 5.
SleepingIslands row() {
    SleepingIslands piles;
    std::vector<WarmStartMemory::Entry> contacts = {{ContactKey::of_wall(10, 3), {9.0, {}, {}}, false}};
    for (std::uint64_t k = 10; k < 14; ++k) contacts.push_back(pair_of(k, k + 1, static_cast<double>(k + 1 - 10)));
    contacts.push_back(pair_of(14, 20, 5.0));
    piles.add({12, 10, 14, 11, 13}, contacts, {{10, 3, {0, 0, -9}}});
    return piles;
}

bool has(const std::vector<WarmStartMemory::Entry>& entries, std::uint64_t first, std::uint64_t second) {
    const ContactKey key = ContactKey::of_pair(first, second);
    return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) { return entry.key == key; });
}

TEST(SleepingIslands, NeighboursAreFound) {
    const SleepingIslands piles = row();
    EXPECT_EQ(piles.around({12}, 1), (Ids{11, 12, 13}));
    EXPECT_EQ(piles.around({10, 14}, 1), (Ids{10, 11, 13, 14}));
    EXPECT_EQ(piles.around({10}, 2), (Ids{10, 11, 12}));
    EXPECT_EQ(piles.around({12}, 1 << 30), (Ids{10, 11, 12, 13, 14}));  // all at once
    EXPECT_EQ(piles.around({20}, 1), Ids{});
    EXPECT_EQ(piles.number_of(14), 10U);
}

TEST(SleepingIslands, LargestLoadOnASleeperIsKnown) {
    const SleepingIslands piles = row();
    EXPECT_EQ(piles.load_of(10), 9.0);
    EXPECT_EQ(piles.load_of(12), 3.0);
    EXPECT_EQ(piles.load_of(14), 5.0);
}

TEST(SleepingIslands, SpheresBeyondAWokenOneLoseTheirSupport) {
    SleepingIslands piles = row();
    EXPECT_EQ(piles.not_joined_to({10}), Ids{});
    const std::vector<WarmStartMemory::Entry> contacts = piles.wake({12});
    EXPECT_EQ(contacts.size(), 2U);
    EXPECT_TRUE(has(contacts, 11, 12) && has(contacts, 12, 13));
    EXPECT_EQ(piles.not_joined_to({10}), (Ids{13, 14}));
    EXPECT_EQ(piles.not_joined_to({10, 14}), Ids{});
    // The sphere that is awake still presses its neighbours.
    EXPECT_TRUE(has(piles.edge_contacts(), 11, 12) && has(piles.edge_contacts(), 12, 13) &&
                has(piles.edge_contacts(), 14, 20));
}

TEST(SleepingIslands, SphereThatFallsAsleepAgainForgetsItsFormerLoads) {
    SleepingIslands piles = row();
    static_cast<void>(piles.wake({12}));
    piles.add({12}, {pair_of(11, 12, 7.0)}, {});
    EXPECT_EQ(piles.load_of(12), 7.0);
    EXPECT_EQ(piles.load_of(13), 4.0);
    EXPECT_EQ(piles.not_joined_to({10}), (Ids{13, 14}));
}

// The neighbour did not press the sphere when that fell asleep again, so it does not support the sphere. The sphere
// must still wake when the neighbour moves.
TEST(SleepingIslands, FormerNeighbourOfASleeperStaysANeighbour) {
    SleepingIslands piles = row();
    static_cast<void>(piles.wake({12}));
    piles.add({12}, {pair_of(11, 12, 7.0)}, {});
    EXPECT_EQ(piles.around({12}, 1), (Ids{11, 12, 13}));
    static_cast<void>(piles.wake({12}));
    EXPECT_TRUE(has(piles.edge_contacts(), 12, 13));
    static_cast<void>(piles.wake({13}));
    EXPECT_FALSE(has(piles.edge_contacts(), 12, 13));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
