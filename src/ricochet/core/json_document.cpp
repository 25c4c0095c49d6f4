#include "ricochet/core/json_document.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "ricochet/core/printable.h"

namespace ricochet {
namespace {

using Json = nlohmann::json;

// Builds the tree of stored values. An open container is the last element of its parent, so pointers to open containers
// stay valid.
class JsonTreeBuilder final : public nlohmann::json_sax<Json> {
public:
    JsonTreeBuilder(const JsonLimits& limits, JsonListener& listener) : limits_(limits), listener_(listener) {}

    bool null() override { return add(std::monostate{}); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(std::int64_t value) override { return add(value); }
    bool number_unsigned(std::uint64_t value) override { return add(value); }
    bool number_float(double value, const std::string& /*written*/) override { return add(value); }
    bool string(std::string& value) override { return add(std::move(value)); }
    bool binary(Json::binary_t& /*value*/) override { return false; }
    bool start_object(std::size_t /*count*/) override { return open(JsonNode::Object{}); }
    bool start_array(std::size_t /*count*/) override { return open(JsonNode::Array{}); }
    bool end_object() override {
        if (skipped_depth_ == 0) refuse_repetitions(*open_.back()->object());
        return close();
    }
    bool end_array() override { return close(); }

    bool key(std::string& name) override {
        const SourceLocation location = listener_.next_location();
        if (skipped_depth_ > 0) return true;
        const JsonPart part = listener_.part_of(name, open_.size());
        skips_next_ = part != JsonPart::all;
        if (part != JsonPart::none) open_.back()->object()->push_back({std::move(name), location, {}});
        return true;
    }

    bool parse_error(std::size_t position, const std::string& /*token*/, const Json::exception& error) override {
        std::string message = error.what();
        if (const auto bracket = message.find("] "); bracket != std::string::npos) message.erase(0, bracket + 2);
        listener_.refuse_syntax(position, message);
        return false;
    }

    JsonNode take() { return std::move(root_); }

private:
    template <typename Value>
    bool add(Value value) {
        const SourceLocation location = listener_.next_location();
        if (skipped_depth_ > 0 || std::exchange(skips_next_, false)) return true;
        return attach({std::move(value), location}) != nullptr;
    }

    template <typename Container>
    bool open(Container container) {
        const SourceLocation location = listener_.next_location();
        if (skipped_depth_ > 0 || std::exchange(skips_next_, false)) {
            ++skipped_depth_;
            return true;
        }
        if (open_.size() == limits_.deepest_nesting) {
            listener_.refuse(location, limits_.too_deep);
            return false;
        }
        JsonNode* node = attach({std::move(container), location});
        if (node != nullptr) open_.push_back(node);
        return node != nullptr;
    }

    bool close() {
        (void)listener_.next_location();
        if (skipped_depth_ > 0) {
            --skipped_depth_;
        } else {
            open_.pop_back();
        }
        return true;
    }

    JsonNode* attach(JsonNode node) {
        if (++count_ > kMostJsonValues) {
            listener_.refuse(node.location, limits_.too_many);
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

    // Keeps the first member of every key.
    void refuse_repetitions(JsonNode::Object& members) {
        std::set<std::string> keys;
        std::erase_if(members, [&](const JsonMember& member) {
            const bool is_new = keys.insert(member.key).second;
            if (!is_new) listener_.refuse_repetition(member, open_);
            return !is_new;
        });
    }

    const JsonLimits& limits_;
    JsonListener& listener_;
    JsonNode root_;
    std::vector<JsonNode*> open_;
    std::size_t skipped_depth_ = 0;
    bool skips_next_ = false;
    std::size_t count_ = 0;
};

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

std::optional<JsonNode> read_json(std::string_view text, const JsonLimits& limits, JsonListener& listener) {
    JsonTreeBuilder builder(limits, listener);
    constexpr bool kStrict = true;
    if (!Json::sax_parse(text.begin(), text.end(), &builder, nlohmann::detail::input_format_t::json, kStrict,
                         limits.has_comments)) {
        return std::nullopt;
    }
    return builder.take();
}

}  // namespace ricochet
