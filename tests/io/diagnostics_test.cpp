#include "ricochet/io/scene/diagnostics.h"

#include <gtest/gtest.h>

#include <functional>

#include "ricochet/core/random.h"

namespace ricochet::detail {
namespace RICOCHET_FILE {

using Names = std::vector<std::string_view>;

TEST(EditDistance, CountsSingleEdits) {
    EXPECT_EQ(edit_distance("", ""), 0U);
    EXPECT_EQ(edit_distance("abc", ""), 3U);
    EXPECT_EQ(edit_distance("rate", "rate"), 0U);
    EXPECT_EQ(edit_distance("rate", "rates"), 1U);
    EXPECT_EQ(edit_distance("rate", "rte"), 1U);
    EXPECT_EQ(edit_distance("rate", "rote"), 1U);
    EXPECT_EQ(edit_distance("rate", "rtae"), 1U);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
    // In an optimal string alignment no edit is made inside a swapped pair.
    EXPECT_EQ(edit_distance("ca", "abc"), 3U);
}

// Returns the distance by its recursive definition, without a table.
std::size_t distance_by_definition(std::string_view a, std::string_view b) {
    if (a.empty() || b.empty()) return a.size() + b.size();
    const std::string_view a_rest = a.substr(1);
    const std::string_view b_rest = b.substr(1);
    std::size_t best = std::min({distance_by_definition(a_rest, b) + 1, distance_by_definition(a, b_rest) + 1,
                                 distance_by_definition(a_rest, b_rest) + (a[0] == b[0] ? 0 : 1)});
    if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0]) {
        best = std::min(best, distance_by_definition(a.substr(2), b.substr(2)) + 1);
    }
    return best;
}

TEST(EditDistance, AgreesWithItsDefinition) {
    RandomSequence random(1, 0, 0);
    const auto word = [&] {
        std::string letters;
        const int length = static_cast<int>(random.uniform() * 7);
        for (int i = 0; i < length; ++i) letters += static_cast<char>('a' + static_cast<int>(random.uniform() * 3));
        return letters;
    };
    for (int i = 0; i < 500; ++i) {
        const std::string a = word();
        const std::string b = word();
        SCOPED_TRACE(::testing::Message() << a << " " << b);
        ASSERT_EQ(edit_distance(a, b), distance_by_definition(a, b));
        ASSERT_EQ(edit_distance(b, a), edit_distance(a, b));
    }
}

TEST(NearestNames, FindsTheNearestOneOnly) {
    EXPECT_EQ(nearest_names("time_stp", {"duration", "time_step", "time"}), (Names{"time_step"}));
    EXPECT_EQ(nearest_names("rame", {"name", "rate", "mass"}), (Names{"name", "rate"}));
}

TEST(NearestNames, SpellingConventionsAreIgnored) {
    EXPECT_EQ(nearest_names("TimeStep", {"time_step"}), (Names{"time_step"}));
    EXPECT_EQ(nearest_names("field-of-view", {"field_of_view"}), (Names{"field_of_view"}));
}

TEST(NearestNames, NoNameIsSuggestedIfNoneIsNear) {
    EXPECT_TRUE(nearest_names("wind", {"gravity", "drag"}).empty());
    EXPECT_TRUE(nearest_names("x", {"type", "file"}).empty());
    EXPECT_TRUE(nearest_names(std::string(1000000, 'a'), {"a"}).empty());
    EXPECT_TRUE(nearest_names("a", {}).empty());
}

TEST(DidYouMean, NamesAllCandidates) {
    EXPECT_EQ(did_you_mean({}), "");
    EXPECT_EQ(did_you_mean({"a", "b"}), "did you mean \"a\" or \"b\"?");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::detail
