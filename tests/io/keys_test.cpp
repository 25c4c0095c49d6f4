#include "ricochet/io/scene/keys.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "ricochet/io/scene/context.h"
#include "ricochet/io/scene/fields.h"

namespace ricochet::detail {
namespace RICOCHET_FILE {

enum class Color { red, green };

struct Part {
    double weight = 2.5;
};

struct Sample {
    double number = 1e-9;
    double endless = std::numeric_limits<double>::infinity();
    std::uint32_t count = 7;
    bool flag = true;
    std::string word = "a";
    Vec3 vector{1, 2, 3};
    Vec3 scale{1, 1, 1};
    MeanSpread pair{4.0, 0.0};
    std::optional<double> maybe;
    Color color = Color::green;
    Part part;
    std::vector<Part> parts;
    std::vector<std::uint64_t> ids;
};

const ObjectSpec& part_spec() {
    static const ObjectSpec spec = object<Part>("part", "", {{"weight", &Part::weight, kPositive, "kg", "How heavy."}});
    return spec;
}

const ObjectSpec& sample_spec() {
    using S = Sample;
    static const ObjectSpec spec =
        object<S>("sample", "",
                  {{"number", &S::number, kPositive, "m", "A number."},
                   {"endless", &S::endless, kPositive, "s", "A time."},
                   {"count", &S::count, kCount, "", "A count."},
                   {"flag", &S::flag, "A flag."},
                   {"word", &S::word, "A word."},
                   {"vector", &S::vector, kCoordinate, "m", "A vector."},
                   {"scale", &S::scale, kCoordinate, "", "A scale.", ValueType::scale},
                   {"pair", &S::pair, kPositive, "", "A pair."},
                   {"maybe", &S::maybe, kPositive, "", "Perhaps a number."},
                   {"color", &S::color, "A colour.",
                    Choices{choice(Color::red, "red", "warm"), choice(Color::green, "green", "cool")}},
                   {"part", &S::part, "A part.", &part_spec()},
                   {"parts", &S::parts, "Parts.", &part_spec()},
                   {"ids", &S::ids, "Ids.", Without{"none"}},
                   {"weight", [](S& s) -> double& { return s.part.weight; }, kPositive, "kg", "Of the part."}});
    return spec;
}

const KeySpec& key(std::string_view name) { return *find_key(sample_spec(), nullptr, name); }

Sample read(const std::string& text) {
    const JsonNode node = parse_json_value(text, {}).value();
    return ObjectView(node, sample_spec(), "").read<Sample>();
}

/// Calls visit(path, key) for every key of an object and of its nested objects. Each type of object is visited once.
template <class Visit>
void visit_keys(const ObjectSpec& spec, const std::string& path, std::set<const ObjectSpec*>& seen,
                const Visit& visit) {
    if (!seen.insert(&spec).second) return;
    const auto visit_all = [&](const std::vector<KeySpec>& keys, const std::string& where) {
        for (const KeySpec& key : keys) {
            const std::string here = where + "." + std::string(key.name);
            visit(here, key);
            if (key.content != nullptr) visit_keys(*key.content, here, seen, visit);
        }
    };
    visit_all(spec.keys, path);
    for (const Variant& variant : spec.variants) visit_all(variant.keys, path + "." + std::string(variant.name));
}

TEST(Keys, EveryLengthOfASceneIsAtMostTheLargestCoordinate) {
    std::set<const ObjectSpec*> seen;
    int lengths = 0;
    visit_keys(scene_spec(), "scene", seen, [&](const std::string& path, const KeySpec& key) {
        // Keys of object type have no range of their own.
        if (key.unit != "m" || key.type == ValueType::object) return;
        ++lengths;
        EXPECT_LE(key.range.upper, kLargestCoordinate) << path;
        EXPECT_GE(key.range.lower, -kLargestCoordinate) << path;
    });
    EXPECT_GT(lengths, 40);
}

TEST(Keys, TypeAndDefaultComeFromTheMember) {
    EXPECT_EQ(key("number").type, ValueType::number);
    EXPECT_EQ(key("number").default_value, "1e-9");
    EXPECT_EQ(key("endless").default_value, "");
    EXPECT_EQ(key("count").type, ValueType::integer);
    EXPECT_EQ(key("count").default_value, "7");
    EXPECT_EQ(key("flag").default_value, "true");
    EXPECT_EQ(key("word").default_value, "\"a\"");
    EXPECT_EQ(key("vector").type, ValueType::vector);
    EXPECT_EQ(key("vector").default_value, "[1, 2, 3]");
    EXPECT_EQ(key("scale").type, ValueType::scale);
    EXPECT_EQ(key("scale").default_value, "1");
    EXPECT_EQ(key("pair").type, ValueType::pair);
    EXPECT_EQ(key("pair").default_value, "4");
    EXPECT_EQ(key("maybe").type, ValueType::number);
    EXPECT_EQ(key("maybe").default_value, "");
    EXPECT_EQ(key("color").default_value, "\"green\"");
    EXPECT_EQ(key("part").type, ValueType::object);
    EXPECT_EQ(key("parts").default_value, "[]");
    EXPECT_EQ(key("ids").type, ValueType::integers);
    EXPECT_EQ(key("ids").default_value, "");
    EXPECT_EQ(key("weight").default_value, "2.5");
}

TEST(Keys, KeysSetTheirMembersAndNoOthers) {
    const Sample all = read(R"({"number": 2, "count": 3, "flag": false, "word": "b", "vector": [4, 5, 6], "scale": 2,
        "pair": [1, 0.5], "maybe": 8, "color": "red", "part": {"weight": 9}, "parts": [{"weight": 1}, {}],
        "ids": [4, 2]})");
    EXPECT_EQ(all.number, 2.0);
    EXPECT_EQ(all.count, 3U);
    EXPECT_FALSE(all.flag);
    EXPECT_EQ(all.word, "b");
    EXPECT_EQ(all.vector, Vec3(4, 5, 6));
    EXPECT_EQ(all.scale, Vec3(2, 2, 2));
    EXPECT_EQ(all.pair.spread, 0.5);
    EXPECT_EQ(all.maybe, 8.0);
    EXPECT_EQ(all.color, Color::red);
    EXPECT_EQ(all.part.weight, 9.0);
    ASSERT_EQ(all.parts.size(), 2U);
    EXPECT_EQ(all.parts[1].weight, 2.5);
    EXPECT_EQ(all.ids, (std::vector<std::uint64_t>{4, 2}));
    const Sample none = read("{}");
    EXPECT_EQ(none.number, 1e-9);
    EXPECT_EQ(none.color, Color::green);
    EXPECT_EQ(none.maybe, std::nullopt);
}

TEST(Keys, FunctionReachesNestedMembers) { EXPECT_EQ(read(R"({"weight": 3})").part.weight, 3.0); }

TEST(Keys, RefusedValueCountsAsAbsent) { EXPECT_EQ(read(R"({"number": null, "count": 3})").number, 1e-9); }

TEST(Keys, StructOfAnotherTableCannotBeRead) {
    const JsonNode node = parse_json_value("{}", {}).value();
    EXPECT_THROW((void)ObjectView(node, sample_spec(), "").read<Part>(), std::logic_error);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::detail
