#include "ricochet/response/contact_solver/contact_coloring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

SolverContact pair_of(std::uint32_t a, std::uint32_t b) {
    SolverContact contact;
    contact.a = a;
    contact.b = b;
    return contact;
}

std::vector<SolverContact> random_pairs(std::uint32_t bodies, std::size_t count) {
    RandomSequence random(3, 0, 0);
    std::vector<SolverContact> contacts;
    while (contacts.size() < count) {
        const auto a = static_cast<std::uint32_t>(bodies * random.uniform());
        const auto b = static_cast<std::uint32_t>(bodies * random.uniform());
        if (a != b) contacts.push_back(pair_of(a, random.uniform() < 0.2 ? SolverContact::kWall : b));
    }
    return contacts;
}

TEST(ContactColoring, NoTwoContactsOfAColourShareABody) {
    const std::vector<SolverContact> contacts = random_pairs(300, 1500);
    ContactColoring coloring;
    coloring.assign(300, contacts);
    std::vector<std::uint32_t> seen(coloring.order().begin(), coloring.order().end());
    for (std::size_t color = 0; color < coloring.colors(); ++color) {
        EXPECT_FALSE(coloring.is_serial(color));
        std::set<std::uint32_t> bodies;
        for (std::size_t k = coloring.begin_of(color); k < coloring.end_of(color); ++k) {
            const SolverContact& contact = contacts[coloring.order()[k]];
            EXPECT_TRUE(bodies.insert(contact.a).second);
            if (contact.b != SolverContact::kWall) {
                EXPECT_TRUE(bodies.insert(contact.b).second);
            }
        }
    }
    std::sort(seen.begin(), seen.end());
    for (std::uint32_t i = 0; i < contacts.size(); ++i) EXPECT_EQ(seen[i], i);
}

TEST(ContactColoring, ContactsOfABoulderAmongSandAreSerial) {
    std::vector<SolverContact> contacts;
    for (std::uint32_t i = 1; i <= 100; ++i) contacts.push_back(pair_of(i, 0));
    ContactColoring coloring;
    coloring.assign(101, contacts);
    ASSERT_EQ(coloring.colors(), ContactColoring::kMostColors + 1);
    EXPECT_TRUE(coloring.is_serial(ContactColoring::kMostColors));
    EXPECT_EQ(coloring.end_of(ContactColoring::kMostColors) - coloring.begin_of(ContactColoring::kMostColors), 36U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
