#include "ricochet/io/scene/document.h"

#include <gtest/gtest.h>

#include <string>

#include "ricochet/io/scene/diagnostics.h"

namespace ricochet::detail {
namespace RICOCHET_FILE {

std::string only_error(std::string_view text) {
    Diagnostics diagnostics("f", {});
    (void)parse_json(text, diagnostics);
    const auto errors = diagnostics.errors();
    return errors.size() == 1 ? errors[0] : "not one error but " + std::to_string(errors.size());
}

JsonNode parsed(std::string_view text) {
    Diagnostics diagnostics("f", {});
    const auto node = parse_json(text, diagnostics);
    EXPECT_FALSE(diagnostics.failed()) << text;
    return node.value_or(JsonNode{});
}

std::string location_of(const JsonNode& node) {
    return std::to_string(node.location.line) + ":" + std::to_string(node.location.column);
}

TEST(JsonParser, KeepsEveryKindOfValue) {
    const JsonNode root = parsed(R"([true, null, 18446744073709551615, -5, 0.5, "a\"b", [], {}])");
    const JsonNode::Array& items = *root.array();
    EXPECT_TRUE(std::get<bool>(items[0].value));
    EXPECT_TRUE(items[1].is_null());
    EXPECT_EQ(items[2].whole_number(), 18446744073709551615ULL);
    EXPECT_EQ(items[3].number(), -5.0);
    EXPECT_FALSE(items[3].whole_number());
    EXPECT_EQ(items[4].number(), 0.5);
    EXPECT_EQ(*items[5].text(), "a\"b");
    EXPECT_TRUE(items[6].array()->empty());
    EXPECT_TRUE(items[7].object()->empty());
}

TEST(JsonParser, WholeNumberMayHaveAFractionOrExponent) {
    EXPECT_EQ(parsed("2.0").whole_number(), 2U);
    EXPECT_EQ(parsed("1e6").whole_number(), 1000000U);
    EXPECT_FALSE(parsed("1.5").whole_number());
    EXPECT_FALSE(parsed("1e20").whole_number());
}

TEST(JsonParser, LocationOfEveryKeyAndValueIsKnown) {
    const JsonNode root =
        parsed("// one, [two\n{\"a\": /* \"x\": 3 */ [1,\n  \"b,\\\"]\", -2.5e3],\n \"\xC3\xA4\": {\"c\" :true}}");
    EXPECT_EQ(location_of(root), "2:1");
    const JsonNode::Array& items = *root.find("a")->array();
    EXPECT_EQ(location_of(*root.find("a")), "2:20");
    EXPECT_EQ(location_of(items[0]), "2:21");
    EXPECT_EQ(location_of(items[1]), "3:3");
    EXPECT_EQ(location_of(items[2]), "3:12");
    EXPECT_EQ((*root.object())[1].key_location.line, 4U);
    EXPECT_EQ((*root.object())[1].key_location.column, 2U);
    // Columns count characters, not bytes.
    EXPECT_EQ(location_of(*root.find("\xC3\xA4")), "4:7");
    EXPECT_EQ(location_of(*root.find("\xC3\xA4")->find("c")), "4:13");
}

TEST(JsonParser, ByteOrderMarkIsAllowed) { EXPECT_EQ(location_of(parsed("\xEF\xBB\xBF[1]").array()->at(0)), "1:2"); }

TEST(JsonParser, RefusesEverythingButUtf8Text) {
    using namespace std::string_view_literals;
    const std::string utf16 = "f:1:1: is UTF-16 or binary, expected text in UTF-8: save the file as UTF-8";
    EXPECT_EQ(only_error("\xFF\xFE{\0}\0"sv), utf16);
    EXPECT_EQ(only_error("\xFE\xFF\0{\0}"sv), utf16);
    EXPECT_EQ(only_error("{\0}\0"sv), utf16);
    EXPECT_EQ(only_error("[1, 2]\n\0 and more"sv), "f:2:1: found a NUL byte, expected text only");
    EXPECT_EQ(only_error("[1, 2]\0"sv), "f:1:7: found a NUL byte, expected text only");
}

TEST(JsonParser, ErrorNamesTheMissingOrExtraComma) {
    const auto error = [](const char* text) { return only_error(text); };
    EXPECT_EQ(error("{\"a\": 1\n \"b\": 2}"), "f:2:2: not valid JSON: a comma is missing before \"b\"");
    EXPECT_EQ(error("{\"a\": {} // one, two\n \"b\": 2}"), "f:2:2: not valid JSON: a comma is missing before \"b\"");
    EXPECT_EQ(error("{\"a\": [1 2]}"), "f:1:10: not valid JSON: a comma is missing before '2'");
    EXPECT_EQ(error("[{} {}]"), "f:1:5: not valid JSON: a comma is missing before '{'");
    EXPECT_EQ(error("[{\"a\": \"x, ]\"}\n  [1]]"), "f:2:3: not valid JSON: a comma is missing before '['");
    EXPECT_EQ(error("{\"a\" 1}"), "f:1:6: not valid JSON: a colon is missing before '1'");
    EXPECT_EQ(error("{\"a\": 1,}"), "f:1:8: not valid JSON: take the last comma before '}' away");
    EXPECT_EQ(error("[1, /* , */\n]"), "f:1:3: not valid JSON: take the last comma before ']' away");
}

TEST(JsonParser, OtherErrorsKeepTheLibrarysMessage) {
    for (const char* text : {"[1] 2", "{,}", "[1, 2", "{\"a\": tru \"b\": 1}", "{\"a\"b\": 1}", "[,]", "[1:2]"}) {
        EXPECT_NE(only_error(text).find("syntax error while parsing"), std::string::npos) << only_error(text);
    }
}

TEST(JsonParser, SyntaxErrorsHaveLineAndColumn) {
    EXPECT_EQ(only_error("{\n  \"a\": 1,\n}").rfind("f:2:9: not valid JSON", 0), 0U) << only_error("{\n  \"a\": 1,\n}");
    for (const char* text : {"",           "  ",        "// only a comment",
                             "{",          "[1, 2",     "{\"a\" 1}",
                             "[1 2]",      "nul",       "[NaN]",
                             "[Infinity]", "[01]",      "[1.]",
                             "[.5]",       "['a']",     "{a: 1}",
                             "[1] 2",      "\"abc",     "[\"\t\"]",
                             "/* open",    "[1e400]",   "\xFF\xFE[\0",
                             "[\"\xC3\"]", "\x7F\x45LF"}) {
        SCOPED_TRACE(text);
        EXPECT_EQ(only_error(text).rfind("f:1:", 0), 0U) << only_error(text);
    }
}

TEST(JsonParser, MessagesAreOneLineOfPrintableText) {
    const std::string error = only_error("[\"a\nb\x01\xFF\"]");
    for (const char c : error) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << error;
    EXPECT_LT(only_error("[\"" + std::string(100000, 'x')).size(), 400U);
}

TEST(JsonParser, DuplicateKeyIsNamedWithItsLocationAndPath) {
    EXPECT_EQ(only_error("{\"a\": [0, {\"b\": 1,\n  \"c\": 2, \"b\": 3}]}"),
              "f:2:11: a[1].b: the key appears twice in one object, keep one");
}

TEST(JsonParser, DeepNestingIsRefusedWithoutRecursion) {
    EXPECT_EQ(only_error(std::string(64, '[') + std::string(64, ']')), "not one error but 0");
    EXPECT_EQ(only_error(std::string(65, '[') + std::string(65, ']')),
              "f:1:65: nested deeper than 64 levels, no scene needs that");
    EXPECT_NE(only_error(std::string(1000000, '[')).find("nested deeper"), std::string::npos);
    std::string objects;
    for (int i = 0; i < 100; ++i) objects += "{\"a\":";
    EXPECT_NE(only_error(objects).find("nested deeper"), std::string::npos);
}

TEST(JsonParser, NumberOfValuesIsBounded) {
    std::string text = "[";
    for (std::size_t i = 0; i < kMostJsonValues; ++i) text += "0,";
    EXPECT_NE(only_error(text + "0]").find("more than 4000000 values"), std::string::npos);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::detail
