#include "ricochet/io/scene/json_hint.h"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/core/printable.h"

namespace ricochet::detail {

namespace {

constexpr std::size_t kLongestToken = 40;

struct Token {
    std::size_t begin = 0;
    std::string_view text;
};

std::size_t end_of_comment(std::string_view text, std::size_t at) {
    const bool to_line_end = text.substr(at).starts_with("//");
    const std::size_t end = to_line_end ? text.find('\n', at) : text.find("*/", at + 2);
    return end == std::string_view::npos ? text.size() : end + (to_line_end ? 1 : 2);
}

std::size_t end_of_string(std::string_view text, std::size_t at) {
    for (++at; at < text.size() && text[at] != '"'; ++at) {
        if (text[at] == '\\') ++at;
    }
    return std::min(at + 1, text.size());
}

/// Returns the token at an offset, or the next token after it. Punctuation marks are also tokens. The result is empty
/// at the end of the text.
Token token_from(std::string_view text, std::size_t at) {
    constexpr std::string_view kSpace = " \t\r\n";
    constexpr std::string_view kMarks = "{}[],:";
    while (at < text.size()) {
        if (text[at] == '/') {
            at = end_of_comment(text, at);
        } else if (kSpace.find(text[at]) != std::string_view::npos) {
            ++at;
        } else {
            break;
        }
    }
    if (at >= text.size()) return {text.size(), {}};
    std::size_t end = at + 1;
    if (text[at] == '"') {
        end = end_of_string(text, at);
    } else if (kMarks.find(text[at]) == std::string_view::npos) {
        end = std::min(text.find_first_of(" \t\r\n{}[],:\"/", at + 1), text.size());
    }
    return {at, text.substr(at, end - at)};
}

bool is_one_of(const Token& token, std::string_view marks) {
    return token.text.size() == 1 && marks.find(token.text.front()) != std::string_view::npos;
}

std::string shown(const Token& token) {
    const std::string text = printable(std::string(token.text), kLongestToken);
    return token.text.front() == '"' ? text : "'" + text + "'";
}

}  // namespace

std::optional<JsonHint> json_hint(std::string_view text, std::size_t position, std::string_view message) {
    Token before;
    Token token = token_from(text, text.starts_with("\xEF\xBB\xBF") ? 3 : 0);
    while (!token.text.empty() && token.begin + token.text.size() < position) {
        before = token;
        token = token_from(text, token.begin + token.text.size());
    }
    const auto says = [&](std::string_view words) { return message.find(words) != std::string_view::npos; };
    if (token.text.empty() || before.text.empty() || !says(" - unexpected ")) return std::nullopt;
    if (is_one_of(token, "}]") && is_one_of(before, ",")) {
        return JsonHint{before.begin, fmt::format("take the last comma before {} away", shown(token))};
    }
    if (is_one_of(token, ",:}]") || is_one_of(before, ",:{[") || says("expected end of input")) return std::nullopt;
    const char* const mark = says("object separator") ? "colon" : "comma";
    return JsonHint{token.begin, fmt::format("a {} is missing before {}", mark, shown(token))};
}

}  // namespace ricochet::detail
