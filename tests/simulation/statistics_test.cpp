// The table of statistics has every counter, and sums over ranks treat each by its rule.
#include "ricochet/simulation/statistics.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <variant>

namespace ricochet {
namespace RICOCHET_FILE {

/// Calls visit with every line whose value is a member, and the pointer to it.
void for_each_member(const auto& visit) {
    for (const Statistic& line : kStatistics) {
        const auto visit_member = [&](auto member) {
            if constexpr (std::is_member_object_pointer_v<decltype(member)>) visit(line, member);
        };
        std::visit(visit_member, line.member);
    }
}

/// Returns statistics with another value in each member: start, start + 1, ...
SimulationStatistics numbered(unsigned start) {
    SimulationStatistics statistics;
    for_each_member([&](const Statistic& /*line*/, auto member) {
        auto& value = statistics.*member;
        value = static_cast<std::remove_reference_t<decltype(value)>>(start++);
    });
    return statistics;
}

TEST(Statistics, EveryMemberIsInTheTableOnce) {
    const SimulationStatistics statistics;
    std::map<const void*, std::size_t> sizes;
    for_each_member([&](const Statistic& line, auto member) {
        const auto& value = statistics.*member;
        EXPECT_TRUE(sizes.emplace(&value, sizeof(value)).second) << line.name;
    });
    std::size_t bytes = 0;
    for (const auto& [member, size] : sizes) bytes += size;
    // One counter has four bytes, and four bytes of padding follow it.
    EXPECT_EQ(bytes + sizeof(std::uint32_t), sizeof(SimulationStatistics));
}

TEST(Statistics, NamesAreDistinctAndHaveMeanings) {
    std::set<std::string> names;
    for (const Statistic& line : kStatistics) {
        EXPECT_TRUE(names.emplace(line.name).second) << line.name;
        EXPECT_FALSE(line.meaning.empty()) << line.name;
    }
}

TEST(Statistics, SumsOverPartsCoverEveryMember) {
    SimulationStatistics run = numbered(100);
    add_part(run, numbered(1000));
    unsigned number = 0;
    for_each_member([&](const Statistic& line, auto member) {
        const unsigned first = 100 + number;
        const unsigned second = 1000 + number++;
        const unsigned expected = line.over_parts == OverParts::sum       ? first + second
                                  : line.over_parts == OverParts::largest ? second
                                                                          : first;
        EXPECT_EQ(static_cast<double>(run.*member), expected) << line.name;
    });
}

TEST(Statistics, OnlyStepsAndTheirPartsAreTheSameOnAllRanks) {
    std::set<std::string> same;
    for (const Statistic& line : kStatistics) {
        if (line.over_parts == OverParts::same) same.emplace(line.name);
    }
    EXPECT_EQ(same, (std::set<std::string>{"body_parts", "steps"}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
