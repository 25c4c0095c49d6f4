#include "ricochet/io/scene/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "ricochet/core/printable.h"
#include "ricochet/io/scene/diagnostics.h"
#include "ricochet/io/scene/json_hint.h"

namespace ricochet::detail {

namespace {

using Json = nlohmann::json;

bool is_delimiter(char c) { return std::string_view(" \t\r\n,:[]{}\"/").find(c) != std::string_view::npos; }

// Finds the locations of the parser's events, which have no locations themselves. Every event corresponds to one token
// of the text.
class TokenLocations {
public:
    explicit TokenLocations(std::string_view text) : text_(text) {
        if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    }

    SourceLocation next() {
        skip_between_tokens();
        const SourceLocation location{line_, column_};
        skip_token();
        return location;
    }

private:
    [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }

    void advance() {
        const char c = text_[at_++];
        if (c == '\n') {
            ++line_;
            column_ = 1;
        } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {  // first byte of a UTF-8 character
            ++column_;
        }
    }

    void skip_comment() {
        const bool to_line_end = text_.substr(at_).starts_with("//");
        const std::size_t found = to_line_end ? text_.find('\n', at_) : text_.find("*/", at_ + 2);
        const std::size_t end = found == std::string_view::npos ? text_.size() : found + (to_line_end ? 1 : 2);
        while (at_ < end) advance();
    }

    void skip_between_tokens() {
        while (!at_end()) {
            if (text_[at_] == '/') {
                skip_comment();
            } else if (std::string_view(" \t\r\n,:").find(text_[at_]) != std::string_view::npos) {
                advance();
            } else {
                return;
            }
        }
    }

    void skip_token() {
        if (at_end()) return;
        const char first = text_[at_];
        advance();
        if (first == '"') {
            while (!at_end() && text_[at_] != '"') {
                if (text_[at_] == '\\') advance();
                if (!at_end()) advance();
            }
            if (!at_end()) advance();
        } else if (!is_delimiter(first)) {
            while (!at_end() && !is_delimiter(text_[at_])) advance();
        }
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::uint32_t line_ = 1;
    std::uint32_t column_ = 1;
};

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
        const std::optional<JsonHint> hint = json_hint(text_, position, error.what());
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
        const std::size_t end = std::min(position == 0 ? 0 : position - 1, text_.size());
        for (std::size_t i = text_.starts_with("\xEF\xBB\xBF") ? 3 : 0; i < end; ++i) {
            if (text_[i] == '\n') {
                ++location.line;
                location.column = 1;
            } else if ((static_cast<unsigned char>(text_[i]) & 0xC0U) != 0x80U) {
                ++location.column;
            }
        }
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
