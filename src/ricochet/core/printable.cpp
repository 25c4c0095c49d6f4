#include "ricochet/core/printable.h"

#include <fmt/format.h>

#include <algorithm>

namespace ricochet {
namespace {

/// The first character of a text.
struct Character {
    std::size_t length = 0;  ///< in bytes; 0 if it is not valid UTF-8
    char32_t code = 0;
};

Character character_of(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return {1, first};
    const std::size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
    if (length == 0 || length > text.size()) return {};
    char32_t code = first & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xC0U) != 0x80U) return {};
        code = code << 6U | (byte & 0x3FU);
    }
    return {length, code};
}

/// Returns true for control characters (C0 and C1) and for characters that change the direction of text.
bool is_control_character(char32_t code) {
    const auto between = [&](char32_t first, char32_t last) { return code >= first && code <= last; };
    return code < 0x20 || between(0x7F, 0x9F) || code == 0x061C || between(0x200E, 0x200F) || between(0x2028, 0x202E) ||
           between(0x2066, 0x2069);
}

std::string escape_of(char32_t code) {
    if (code == U'\n') return "\\n";
    if (code == U'\r') return "\\r";
    if (code == U'\t') return "\\t";
    return code < 0x100 ? fmt::format("\\x{:02x}", static_cast<unsigned>(code))
                        : fmt::format("\\u{:04x}", static_cast<unsigned>(code));
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
    std::string result;
    std::size_t at = 0;
    while (at < text.size() && result.size() < longest) {
        const Character character = character_of(text.substr(at));
        if (character.length == 0) {
            result += escape_of(static_cast<unsigned char>(text[at]));
        } else if (is_control_character(character.code)) {
            result += escape_of(character.code);
        } else {
            result += text.substr(at, character.length);
        }
        at += std::max<std::size_t>(character.length, 1);
    }
    return at < text.size() ? result + "..." : result;
}

bool is_column_name(std::string_view text) {
    return text.find_first_of(",\"") == std::string_view::npos && printable(text) == text;
}

}  // namespace ricochet
