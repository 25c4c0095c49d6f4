#include "ricochet/io/detail/json_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace ricochet::detail {
namespace {

// Bytes of the UTF-8 character that the text begins with; 0 where it is none.
std::size_t character_length(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xC2 ? 0
                               : first < 0xE0 ? 2
                               : first < 0xF0 ? 3
                               : first < 0xF5 ? 4
                                              : 0;
    if (length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U) return 0;
    }
    return length;
}

}  // namespace

std::optional<double> JsonNode::number() const {
    if (const auto* whole = std::get_if<std::uint64_t>(&value)) return static_cast<double>(*whole);
    if (const auto* negative = std::get_if<std::int64_t>(&value)) return static_cast<double>(*negative);
    if (const auto* real = std::get_if<double>(&value)) return *real;
    return std::nullopt;
}

std::optional<std::uint64_t> JsonNode::whole_number() const {
    if (const auto* whole = std::get_if<std::uint64_t>(&value)) return *whole;
    const auto* real = std::get_if<double>(&value);
    if (real == nullptr || !(*real >= 0.0 && *real < 0x1p64) || *real != std::floor(*real)) return std::nullopt;
    return static_cast<std::uint64_t>(*real);
}

const JsonNode* JsonNode::find(std::string_view key) const {
    const Object* members = object();
    if (members == nullptr) return nullptr;
    for (const JsonMember& member : *members) {
        if (member.key == key) return &member.value;
    }
    return nullptr;
}

JsonNode* JsonNode::find(std::string_view key) { return const_cast<JsonNode*>(std::as_const(*this).find(key)); }

std::string described(const JsonNode& node) {
    constexpr std::size_t kLongestText = 60;
    if (const auto* truth = std::get_if<bool>(&node.value)) return *truth ? "true" : "false";
    if (const auto* whole = std::get_if<std::uint64_t>(&node.value)) return fmt::format("{}", *whole);
    if (const auto* negative = std::get_if<std::int64_t>(&node.value)) return fmt::format("{}", *negative);
    if (const auto* real = std::get_if<double>(&node.value)) return fmt::format("{}", *real);
    if (const std::string* text = node.text()) return fmt::format("\"{}\"", printable(*text, kLongestText));
    if (const auto* items = node.array())
        return items->empty() ? "an empty list" : fmt::format("a list of {}", items->size());
    if (node.object() != nullptr) return "an object";
    return "null";
}

std::string printable(std::string_view text, std::size_t longest) {
    std::string result;
    std::size_t at = 0;
    while (at < text.size() && result.size() < longest) {
        const std::size_t length = character_length(text.substr(at));
        const auto code = static_cast<unsigned char>(text[at]);
        const bool shown = length > 1 || (length == 1 && code >= 0x20 && code != 0x7f);
        result += shown ? text.substr(at, length) : "?";
        at += std::max<std::size_t>(length, 1);
    }
    return at < text.size() ? result + "..." : result;
}

}  // namespace ricochet::detail
