#include "ricochet/dynamics/particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

namespace ricochet {
namespace RICOCHET_FILE {

Particle numbered(std::uint64_t id) {
    const double x = static_cast<double>(id);
    return {id, {x, 1, 2}, {3, x, 4}, 1.0 + x, 0.5 * x, 0.25 * x, 10.0 + x};
}

Particles with_ids(const std::vector<std::uint64_t>& ids) {
    Particles particles;
    for (const std::uint64_t id : ids) particles.append(numbered(id));
    return particles;
}

TEST(Particles, ReturnAppendedParticles) {
    const Particles particles = with_ids({7, 3});
    ASSERT_EQ(particles.size(), 2U);
    const Particle second = particles.at(1);
    EXPECT_EQ(second.id, 3U);
    EXPECT_EQ(second.position, (Vec3{3, 1, 2}));
    EXPECT_EQ(second.velocity, (Vec3{3, 3, 4}));
    EXPECT_EQ(second.mass, 4.0);
    EXPECT_EQ(second.radius, 1.5);
    EXPECT_EQ(second.birth_time, 0.75);
    EXPECT_EQ(second.lifetime, 13.0);
    EXPECT_FALSE(second.pinned);
}

TEST(Particles, AreTheSameWithCapacityReserved) {
    Particles particles;
    particles.keeps_origin = true;
    particles.attributes = AttributeTable({{"heat", 1, {1.5, 0, 0}}, {"wind", 3, {1, 2, 3}}});
    particles.reserve(1000);
    const Vec3* const first = particles.position.data();
    for (std::uint64_t id = 0; id < 1000; ++id) particles.append(numbered(id));
    EXPECT_EQ(particles.position.data(), first) << "nothing was moved";
    EXPECT_EQ(particles.position.capacity(), 1000U);
    EXPECT_EQ(particles.origin.capacity(), 1000U);
    EXPECT_EQ(particles.at(7).position, numbered(7).position);
    EXPECT_EQ(particles.attributes.value(1, 999), (AttributeValue{1, 2, 3}));
}

TEST(Particles, StartWithoutAHistory) {
    const Particles particles = with_ids({1});
    EXPECT_EQ(particles.contacts[0], 0U);
    EXPECT_EQ(particles.resting[0], 0U);
    EXPECT_EQ(particles.unsimulated_time[0], 0.0);
}

TEST(Particles, CompactKeepsFlaggedEntriesInOrderInEveryArray) {
    Particles particles = with_ids({0, 1, 2, 3, 4});
    for (std::size_t i = 0; i < 5; ++i) {
        particles.contacts[i] = static_cast<std::uint32_t>(10 + i);
        particles.resting[i] = static_cast<std::uint8_t>(i);
        particles.unsimulated_time[i] = static_cast<double>(i);
        particles.pinned[i] = static_cast<std::uint8_t>(i % 2);
    }
    particles.compact({0, 1, 0, 1, 1});
    ASSERT_EQ(particles.id, (std::vector<std::uint64_t>{1, 3, 4}));
    EXPECT_EQ(particles.contacts, (std::vector<std::uint32_t>{11, 13, 14}));
    EXPECT_EQ(particles.pinned, (std::vector<std::uint8_t>{1, 1, 0}));
    EXPECT_EQ(particles.resting, (std::vector<std::uint8_t>{1, 3, 4}));
    EXPECT_EQ(particles.unsimulated_time, (std::vector<double>{1, 3, 4}));
    EXPECT_EQ(particles.position[1].x, 3.0);
    EXPECT_EQ(particles.velocity[1].y, 3.0);
    EXPECT_EQ(particles.mass[2], 5.0);
    EXPECT_EQ(particles.radius.size(), 3U);
    EXPECT_EQ(particles.birth_time.size(), 3U);
    EXPECT_EQ(particles.lifetime.size(), 3U);
}

TEST(Particles, OrderByIdListsEveryEntryOnce) {
    EXPECT_EQ(with_ids({5, 2, 9, 0}).order_by_id(), (std::vector<std::uint32_t>{3, 1, 0, 2}));
    EXPECT_EQ(with_ids({1, 4, 6}).order_by_id(), (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(Particles{}.order_by_id().empty());
}

TEST(Particles, AreOrderedByDenseSparseAndRepeatedIds) {
    const std::vector<std::vector<std::uint64_t>> lists = {
        {},
        {5},
        {0, 1, 2},
        {3, 1, 2, 0},
        {9, 4, 6, 30, 5},
        {std::uint64_t{1} << 63U, 3, std::uint64_t{1} << 40U, 0},
        {std::numeric_limits<std::uint64_t>::max(), 0},
        {std::numeric_limits<std::uint64_t>::max(), std::numeric_limits<std::uint64_t>::max() - 2},
        {2, 1, 2, 1},
    };
    for (const std::vector<std::uint64_t>& ids : lists) {
        std::vector<std::uint64_t> ordered;
        std::set<std::uint32_t> places;
        const Particles particles = with_ids(ids);
        for (const std::uint32_t i : particles.order_by_id()) {
            ordered.push_back(ids[i]);
            places.insert(i);
        }
        std::vector<std::uint64_t> expected = ids;
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(ordered, expected);
        EXPECT_EQ(places.size(), ids.size());
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
