#include "ricochet/io/scene/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "ricochet/core/printable.h"
#include "ricochet/io/scene/diagnostics.h"

namespace ricochet::detail {

namespace {

constexpr std::string_view kSpace = " \t\r\n";
constexpr std::string_view kMarks = "{}[],:";
constexpr std::size_t kLongestToken = 40;

// Number of bytes of the byte order mark that some editors write.
std::size_t start_of(std::string_view text) { return text.starts_with("\xEF\xBB\xBF") ? 3 : 0; }

struct Token {
    std::size_t begin = 0;
    std::string_view text;

    [[nodiscard]] std::size_t end() const { return begin + text.size(); }
    [[nodiscard]] bool is_one_of(std::string_view marks) const {
        return text.size() == 1 && marks.find(text.front()) != std::string_view::npos;
    }
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

// Returns the token at an offset, or the next token after it. Punctuation marks are also tokens. The result is empty at
// the end of the text.
Token token_from(std::string_view text, std::size_t at) {
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

// Moves a location to the end of the text that follows it.
void move_past(std::string_view text, SourceLocation& location) {
    for (const char c : text) {
        if (c == '\n') {
            ++location.line;
            location.column = 1;
        } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {  // first byte of a UTF-8 character
            ++location.column;
        }
    }
}

// Finds the locations of the parser's events, which have no locations themselves. Every event corresponds to one token
// of the text, except commas and colons.
class TokenLocations {
public:
    explicit TokenLocations(std::string_view text) : text_(text.substr(start_of(text))) {}

    SourceLocation next() {
        Token token = token_from(text_, end_);
        while (token.is_one_of(",:")) token = token_from(text_, token.end());
        move_past(text_.substr(begin_, token.begin - begin_), location_);
        begin_ = token.begin;
        end_ = token.end();
        return location_;
    }

private:
    std::string_view text_;
    SourceLocation location_{1, 1};
    std::size_t begin_ = 0;  // offset of location_
    std::size_t end_ = 0;    // offset of the end of the last token
};

// Hint for a common typing error.
struct Hint {
    std::size_t position = 0;  // offset in the text, in bytes
    std::string text;
};

std::string shown(const Token& token) {
    const std::string text = printable(std::string(token.text), kLongestToken);
    return token.text.front() == '"' ? text : "'" + text + "'";
}

// Returns a hint for a missing comma or colon, or for a superfluous comma. Returns nothing for other errors. position:
// number of bytes that the parser had read when it stopped. message: error message of the parser.
std::optional<Hint> hint_for(std::string_view text, std::size_t position, std::string_view message) {
    Token before;
    Token token = token_from(text, start_of(text));
    while (!token.text.empty() && token.end() < position) {
        before = token;
        token = token_from(text, token.end());
    }
    const auto says = [&](std::string_view words) { return message.find(words) != std::string_view::npos; };
    if (token.text.empty() || before.text.empty() || !says(" - unexpected ")) return std::nullopt;
    if (token.is_one_of("}]") && before.is_one_of(",")) {
        return Hint{before.begin, fmt::format("take the last comma before {} away", shown(token))};
    }
    if (token.is_one_of(",:}]") || before.is_one_of(",:{[") || says("expected end of input")) return std::nullopt;
    const char* const mark = says("object separator") ? "colon" : "comma";
    return Hint{token.begin, fmt::format("a {} is missing before {}", mark, shown(token))};
}

// Returns the message of the JSON library without its location.
std::string plain_message(std::string message) {
    constexpr std::size_t kLongest = 200;
    if (message.starts_with("parse error at ")) {
        if (const auto colon = message.find(": "); colon != std::string::npos) message.erase(0, colon + 2);
    }
    return printable(message, kLongest);
}

// Finds locations, and reports errors with them.
class SceneListener final : public JsonListener {
public:
    SceneListener(std::string_view text, Diagnostics& diagnostics)
        : text_(text), locations_(text), diagnostics_(diagnostics) {}

    SourceLocation next_location() override { return locations_.next(); }
    void refuse(const SourceLocation& location, const std::string& error) override {
        diagnostics_.error(location, "", error);
    }
    void refuse_syntax(std::size_t position, const std::string& error) override {
        const std::optional<Hint> hint = hint_for(text_, position, error);
        const SourceLocation location = location_of_byte(hint ? hint->position + 1 : position);
        diagnostics_.error(location, "", "not valid JSON: " + (hint ? hint->text : plain_message(error)));
    }
    void refuse_repetition(const JsonMember& member, std::span<JsonNode* const> open) override {
        std::string path;
        for (const JsonNode* outer : open.first(open.size() - 1)) {
            if (const auto* items = outer->array()) path = path_of_item(path, items->size() - 1);
            if (const auto* members = outer->object()) path = path_of_key(path, members->back().key);
        }
        diagnostics_.error(member.key_location, path_of_key(path, member.key),
                           "the key appears twice in one object, keep one");
    }

    /// Returns true if the text has no NUL byte. Otherwise reports an error, because the parser would read only the
    /// part before this byte.
    [[nodiscard]] bool is_text() {
        const std::size_t nul = text_.find('\0');
        if (nul == std::string_view::npos) return true;
        constexpr std::size_t kWidestCharacter = 4;
        if (nul < kWidestCharacter) {
            diagnostics_.error({1, 1}, "", "is UTF-16 or binary, expected text in UTF-8: save the file as UTF-8");
        } else {
            diagnostics_.error(location_of_byte(nul + 1), "", "found a NUL byte, expected text only");
        }
        return false;
    }

private:
    [[nodiscard]] SourceLocation location_of_byte(std::size_t position) const {
        SourceLocation location{1, 1};
        const std::size_t start = start_of(text_);
        const std::size_t end = std::min(position == 0 ? 0 : position - 1, text_.size());
        if (end > start) move_past(text_.substr(start, end - start), location);
        return location;
    }

    std::string_view text_;
    TokenLocations locations_;
    Diagnostics& diagnostics_;
};

void set_location(JsonNode& node, const SourceLocation& location) {
    node.location = location;
    if (auto* items = node.array()) {
        for (JsonNode& item : *items) set_location(item, location);
    }
    if (auto* members = node.object()) {
        for (JsonMember& member : *members) {
            member.key_location = location;
            set_location(member.value, location);
        }
    }
}

}  // namespace

std::optional<JsonNode> parse_json(std::string_view text, Diagnostics& diagnostics) {
    const JsonLimits limits{
        64, "nested deeper than 64 levels, no scene needs that",
        fmt::format("more than {} values; many particles belong in a file: \"particles\": {{\"file\": ...}}",
                    kMostJsonValues),
        true};
    SceneListener listener(text, diagnostics);
    return listener.is_text() ? read_json(text, limits, listener) : std::nullopt;
}

std::optional<JsonNode> parse_json_value(std::string_view text, const SourceLocation& location) {
    Diagnostics ignored("", {});
    std::optional<JsonNode> node = parse_json(text, ignored);
    if (!node || ignored.failed()) return std::nullopt;
    set_location(*node, location);
    return node;
}

}  // namespace ricochet::detail
