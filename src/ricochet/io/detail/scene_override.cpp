#include "ricochet/io/detail/scene_override.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/io/detail/json_parser.h"
#include "ricochet/io/detail/suggestion.h"

namespace ricochet::detail {
namespace {

using Step = std::variant<std::string, std::size_t>;  // a key or a list index

// Takes a path apart from left to right; stands before the '=' when it is done.
class PathReader {
public:
    explicit PathReader(std::string_view text) : rest_(text) {}

    // Nothing when the text does not begin with a path followed by '='.
    std::optional<std::vector<Step>> read() {
        std::vector<Step> steps;
        while (rest_.empty() || rest_.front() != '=' || steps.empty()) {
            std::optional<Step> step = rest_.starts_with('[') ? bracket() : key(steps.empty());
            if (!step) return std::nullopt;
            steps.push_back(std::move(*step));
        }
        return steps;
    }
    [[nodiscard]] std::string_view value() const { return rest_.substr(1); }

private:
    std::optional<Step> key(bool first) {
        if (!first) {
            if (!rest_.starts_with('.')) return std::nullopt;
            rest_.remove_prefix(1);
        }
        const std::size_t length = std::min(rest_.find_first_of(".[="), rest_.size());
        if (length == 0) return std::nullopt;
        std::string name(rest_.substr(0, length));
        rest_.remove_prefix(length);
        return name;
    }

    std::optional<Step> bracket() {
        const bool quoted = rest_.starts_with("[\"");
        const std::size_t end = rest_.find(quoted ? "\"]" : "]");
        if (end == std::string_view::npos) return std::nullopt;
        const std::size_t begin = quoted ? 2 : 1;
        const std::string_view inside = end < begin ? std::string_view() : rest_.substr(begin, end - begin);
        rest_.remove_prefix(end + (quoted ? 2 : 1));
        if (quoted) return Step(std::string(inside));
        std::size_t index = 0;
        const auto [stop, error] = std::from_chars(inside.data(), inside.data() + inside.size(), index);
        if (error != std::errc() || stop != inside.data() + inside.size()) return std::nullopt;
        return Step(index);
    }

    std::string_view rest_;
};

// Walks to the value that a path names and makes objects on the way; reports where that cannot be done.
class Walker {
public:
    Walker(JsonNode& root, const Place& place, Diagnostics& diagnostics)
        : node_(&root), place_(place), diagnostics_(diagnostics) {}

    // Null pointer after reporting.
    JsonNode* walk(const std::vector<Step>& steps) {
        for (std::size_t i = 0; i < steps.size() && node_ != nullptr; ++i) {
            const bool item_follows = i + 1 < steps.size() && std::holds_alternative<std::size_t>(steps[i + 1]);
            if (const auto* index = std::get_if<std::size_t>(&steps[i])) {
                to_item(*index);
            } else {
                to_key(std::get<std::string>(steps[i]), item_follows);
            }
        }
        return node_;
    }

private:
    void fail(const std::string& path, const std::string& what) {
        diagnostics_.error(place_, path, what);
        node_ = nullptr;
    }

    void to_item(std::size_t index) {
        const std::string path = path_of_item(path_, index);
        JsonNode::Array* items = node_->array();
        if (items == nullptr) {
            fail(path, fmt::format("found {}, expected a list", described(*node_)));
        } else if (index >= items->size()) {
            fail(path, fmt::format("there is no such item, the list has {}", items->size()));
        } else {
            node_ = &(*items)[index];
            path_ = path;
        }
    }

    void to_key(const std::string& key, bool item_follows) {
        JsonNode::Object* members = node_->object();
        const std::string path = path_of_key(path_, key);
        if (members == nullptr) {
            fail(path, fmt::format("found {} in its place, expected an object", described(*node_)));
            return;
        }
        JsonNode* child = node_->find(key);
        if (child == nullptr && item_follows) {
            std::vector<std::string_view> known;
            for (const JsonMember& member : *members) known.push_back(member.key);
            const std::string help = did_you_mean(nearest_names(key, known));
            fail(path, fmt::format("there is no such list{}{}", help.empty() ? "" : "; ", help));
            return;
        }
        if (child == nullptr) {
            members->push_back({key, place_, JsonNode{JsonNode::Object{}, place_}});
            child = &members->back().value;
        }
        node_ = child;
        path_ = path;
    }

    JsonNode* node_;
    Place place_;
    Diagnostics& diagnostics_;
    std::string path_;
};

}  // namespace

void apply_override(JsonNode& root, std::size_t number, Diagnostics& diagnostics) {
    const std::string& text = diagnostics.overrides()[number];
    Place place;
    place.override_number = static_cast<std::int32_t>(number);
    PathReader reader(text);
    const std::optional<std::vector<Step>> steps = reader.read();
    if (!steps) {
        diagnostics.error(place, "",
                          "expected PATH=VALUE, for example simulation.time_step=0.01 or colliders[0].scale=2");
        return;
    }
    JsonNode* node = Walker(root, place, diagnostics).walk(*steps);
    if (node == nullptr) return;
    const std::string_view value = reader.value();
    if (std::optional<JsonNode> parsed = parse_json_value(value, place)) {
        *node = std::move(*parsed);
    } else {
        *node = JsonNode{std::string(value), place};
    }
}

}  // namespace ricochet::detail
