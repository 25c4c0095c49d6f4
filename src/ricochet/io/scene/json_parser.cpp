#include "ricochet/io/scene/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "ricochet/core/printable.h"
#include "ricochet/io/scene/diagnostics.h"

namespace ricochet::detail {

namespace {

using Json = nlohmann::json;

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

// Returns the message of the JSON library without its prefix and location.
std::string plain_message(std::string message) {
    if (const auto bracket = message.find("] "); bracket != std::string::npos) message.erase(0, bracket + 2);
    if (message.starts_with("parse error at ")) {
        if (const auto colon = message.find(": "); colon != std::string::npos) message.erase(0, colon + 2);
    }
    return printable(message, kLongestMessage);
}

// Builds the tree of nodes. An open container is the last element of its parent, so pointers to open containers stay
// valid.
class TreeBuilder final : public nlohmann::json_sax<Json> {
public:
    TreeBuilder(std::string_view text, Diagnostics& diagnostics)
        : text_(text), locations_(text), diagnostics_(diagnostics) {}

    bool null() override { return add(std::monostate{}); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(std::int64_t value) override { return add(value); }
    bool number_unsigned(std::uint64_t value) override { return add(value); }
    bool number_float(double value, const std::string& /*written*/) override { return add(value); }
    bool string(std::string& value) override { return add(std::move(value)); }
    bool binary(Json::binary_t& /*value*/) override { return false; }
    bool start_object(std::size_t /*count*/) override { return open(JsonNode::Object{}); }
    bool start_array(std::size_t /*count*/) override { return open(JsonNode::Array{}); }

    bool key(std::string& value) override {
        open_.back()->object()->push_back({std::move(value), locations_.next(), {}});
        return true;
    }
    bool end_object() override {
        refuse_duplicates(*open_.back()->object());
        return close();
    }
    bool end_array() override { return close(); }

    bool parse_error(std::size_t position, const std::string& /*token*/, const Json::exception& error) override {
        const std::optional<Hint> hint = hint_for(text_, position, error.what());
        const SourceLocation location = location_of_byte(hint ? hint->position + 1 : position);
        diagnostics_.error(location, "", "not valid JSON: " + (hint ? hint->text : plain_message(error.what())));
        return false;
    }

    JsonNode take() { return std::move(root_); }

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
    template <typename Value>
    bool add(Value value) {
        return attach({std::move(value), locations_.next()}) != nullptr;
    }

    template <typename Container>
    bool open(Container container) {
        const SourceLocation location = locations_.next();
        if (open_.size() == kDeepestNesting) {
            diagnostics_.error(location, "",
                               fmt::format("nested deeper than {} levels, no scene needs that", kDeepestNesting));
            return false;
        }
        JsonNode* node = attach({std::move(container), location});
        if (node == nullptr) return false;
        open_.push_back(node);
        return true;
    }

    bool close() {
        (void)locations_.next();
        open_.pop_back();
        return true;
    }

    JsonNode* attach(JsonNode node) {
        if (++count_ > kMostValues) {
            diagnostics_.error(
                node.location, "",
                fmt::format("more than {} values; many particles belong in a file: \"particles\": {{\"file\": ...}}",
                            kMostValues));
            return nullptr;
        }
        if (open_.empty()) {
            root_ = std::move(node);
            return &root_;
        }
        if (auto* items = open_.back()->array()) return &items->emplace_back(std::move(node));
        JsonMember& member = open_.back()->object()->back();
        member.value = std::move(node);
        return &member.value;
    }

    void refuse_duplicates(JsonNode::Object& members) {
        std::vector<const JsonMember*> sorted;
        for (const JsonMember& member : members) sorted.push_back(&member);
        const auto by_key = [](const JsonMember* a, const JsonMember* b) { return a->key < b->key; };
        std::stable_sort(sorted.begin(), sorted.end(), by_key);
        std::vector<const JsonMember*> repeated;
        for (std::size_t i = 1; i < sorted.size(); ++i) {
            if (sorted[i]->key != sorted[i - 1]->key) continue;
            repeated.push_back(sorted[i]);
            diagnostics_.error(sorted[i]->key_location, path_of_key(path_of_open(), sorted[i]->key),
                               "the key appears twice in one object, keep one");
        }
        if (repeated.empty()) return;
        JsonNode::Object kept;
        for (JsonMember& member : members) {
            if (std::find(repeated.begin(), repeated.end(), &member) == repeated.end()) {
                kept.push_back(std::move(member));
            }
        }
        members = std::move(kept);
    }

    // Returns the path of the innermost open container for messages.
    [[nodiscard]] std::string path_of_open() const {
        std::string path;
        for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
            if (const auto* items = open_[i]->array()) path = path_of_item(path, items->size() - 1);
            if (const auto* members = open_[i]->object()) path = path_of_key(path, members->back().key);
        }
        return path;
    }

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
    JsonNode root_;
    std::vector<JsonNode*> open_;
    std::size_t count_ = 0;
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
    TreeBuilder builder(text, diagnostics);
    if (!builder.is_text()) return std::nullopt;
    constexpr bool kStrict = true;
    constexpr bool kComments = true;
    if (!Json::sax_parse(text.begin(), text.end(), &builder, nlohmann::detail::input_format_t::json, kStrict,
                         kComments)) {
        return std::nullopt;
    }
    return builder.take();
}

std::optional<JsonNode> parse_json_value(std::string_view text, const SourceLocation& location) {
    Diagnostics ignored("", {});
    std::optional<JsonNode> node = parse_json(text, ignored);
    if (!node || ignored.failed()) return std::nullopt;
    set_location(*node, location);
    return node;
}

}  // namespace ricochet::detail
