#include "ricochet/core/visit_few.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace {

TEST(VisitFew, VisitsEveryOneOfTheRangeOnceAndInOrderAndNoOther) {
    RandomSequence random(5, 0, 0);
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const double share = i % 3 == 0 ? 0.02 : (i % 3 == 1 ? 0.5 : 1.0);
        std::vector<std::uint8_t> is_one(static_cast<std::size_t>(100.0 * random.uniform()));
        for (std::uint8_t& flag : is_one) flag = random.uniform() < share ? 1 : 0;
        const auto end = is_one.size();
        const auto begin = static_cast<std::size_t>(static_cast<double>(end) * random.uniform());
        std::vector<std::size_t> expected;
        for (std::size_t k = begin; k < end; ++k) {
            if (is_one[k] != 0) expected.push_back(k);
        }
        std::vector<std::size_t> visited;
        visit_few(
            begin, end, [&](std::size_t k) { return is_one[k] != 0; }, [&](std::size_t k) { visited.push_back(k); });
        EXPECT_EQ(visited, expected);
    }
}

}  // namespace
}  // namespace ricochet
