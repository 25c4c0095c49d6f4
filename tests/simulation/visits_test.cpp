// Visits of a counter: first passages, stays, and their saved form.
#include "ricochet/simulation/counters/visits.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(Visits, OnlyTheFirstPassageOfAParticleIsNew) {
    Visits visits;
    for (const std::uint64_t particle : {5ULL, 0ULL, 63ULL, 64ULL, 100000ULL}) {
        EXPECT_TRUE(visits.pass(particle));
        EXPECT_FALSE(visits.pass(particle));
    }
    EXPECT_TRUE(visits.pass(1));
}

TEST(Visits, StayEndsWhenTheParticleLeaves) {
    Visits visits;
    EXPECT_FALSE(visits.leave(3)) << "born inside";
    visits.enter(3, 0.5);
    visits.enter(4, 0.75);
    EXPECT_EQ(visits.leave(3), 0.5);
    EXPECT_FALSE(visits.leave(3));
    EXPECT_EQ(visits.leave(4), 0.75);
}

TEST(Visits, SavedVisitsGoOn) {
    Visits visits;
    EXPECT_TRUE(visits.pass(70));
    visits.enter(9, 0.25);
    std::vector<std::byte> bytes;
    BinaryWriter writer([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    visits.archive(writer);
    Visits restored;
    std::size_t at = 0;
    BinaryReader reader([&](std::span<std::byte> part) {
        if (bytes.size() - at < part.size()) throw InputError("the bytes end too early");
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
    restored.archive(reader);
    EXPECT_EQ(at, bytes.size());
    EXPECT_FALSE(restored.pass(70));
    EXPECT_TRUE(restored.pass(71));
    EXPECT_EQ(restored.leave(9), 0.25);
    EXPECT_TRUE(restored.is_sound());
    restored.enter(9, std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(restored.is_sound());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
