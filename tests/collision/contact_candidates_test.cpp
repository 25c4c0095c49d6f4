#include "ricochet/collision/contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace ricochet {
namespace RICOCHET_FILE {

TEST(ContactCandidates, IsUnknownAtFirstAndStoresUpToFourTriangles) {
    EXPECT_FALSE(ContactCandidates().is_known());
    ContactCandidates candidates = ContactCandidates::none();
    ASSERT_TRUE(candidates.is_known());
    EXPECT_TRUE(candidates.triangles().empty());
    const std::vector<std::uint32_t> expected{7, 0, 123456789, 3};
    for (const std::uint32_t triangle : expected) candidates.add(triangle);
    ASSERT_TRUE(candidates.is_known());
    EXPECT_TRUE(std::ranges::equal(candidates.triangles(), expected));
    candidates.add(8);
    EXPECT_FALSE(candidates.is_known());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
