#include "ricochet/io/scene/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "ricochet/core/printable.h"
#include "ricochet/io/scene/diagnostics.h"

namespace ricochet::detail {

// Changes from the command line.

namespace {

using Step = std::variant<std::string, std::size_t>;  // part of a path: a key or a list index

// Splits a path into steps from left to right. Stops before the '=' that follows the path.
class PathReader {
public:
    explicit PathReader(std::string_view text) : rest_(text) {}

    // Returns the steps of the path; nothing if the text does not begin with a path and '='.
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

// Follows a path to its value, and adds missing objects. Reports paths that cannot be followed.
class Walker {
public:
    Walker(JsonNode& root, const SourceLocation& location, Diagnostics& diagnostics)
        : node_(&root), location_(location), diagnostics_(diagnostics) {}

    // Returns the value at the end of the path, or a null pointer after reporting an error.
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
        diagnostics_.error(location_, path, what);
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
            fail(path, fmt::format("found {} there, expected an object", described(*node_)));
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
            members->push_back({key, location_, JsonNode{JsonNode::Object{}, location_}});
            child = &members->back().value;
        }
        node_ = child;
        path_ = path;
    }

    JsonNode* node_;
    SourceLocation location_;
    Diagnostics& diagnostics_;
    std::string path_;
};

}  // namespace

void apply_override(JsonNode& root, std::size_t number, Diagnostics& diagnostics) {
    const std::string& text = diagnostics.overrides()[number];
    SourceLocation location;
    location.override_index = static_cast<std::int32_t>(number);
    PathReader reader(text);
    const std::optional<std::vector<Step>> steps = reader.read();
    if (!steps) {
        diagnostics.error(location, "",
                          "expected PATH=VALUE, for example simulation.time_step=0.01 or colliders[0].scale=2");
        return;
    }
    JsonNode* node = Walker(root, location, diagnostics).walk(*steps);
    if (node == nullptr) return;
    const std::string_view value = reader.value();
    if (std::optional<JsonNode> parsed = parse_json_value(value, location)) {
        *node = std::move(*parsed);
    } else {
        *node = JsonNode{std::string(value), location};
    }
}

// Fingerprints.

namespace {

constexpr std::array<std::string_view, 5> kLeftOut{"output", "camera", "picture", "title", "description"};

/// Key that the fingerprint excludes, so that a run can be extended. The state at a time does not depend on the end of
/// the run.
constexpr std::string_view kDuration = "duration";

/// Adds a value to a hash, preceded by a number for its type. Different scenes therefore add different sequences.
class ValueHasher {
public:
    explicit ValueHasher(StateHash& hash) : hash_(hash) {}

    void operator()(std::monostate) const { hash_.add(std::uint64_t{0}); }
    void operator()(bool value) const { add(1, value ? 1 : 0); }
    void operator()(std::uint64_t value) const { add(2, value); }
    void operator()(std::int64_t value) const { add(3, static_cast<std::uint64_t>(value)); }
    void operator()(double value) const {
        hash_.add(std::uint64_t{4});
        hash_.add(value);
    }
    void operator()(const std::string& text) const {
        add(5, text.size());
        for (const char c : text) hash_.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
    }
    void operator()(const JsonNode::Array& list) const {
        add(6, list.size());
        for (const JsonNode& node : list) std::visit(*this, node.value);
    }
    void operator()(const JsonNode::Object& object) const {
        add(7, object.size());
        for (const JsonMember& member : object) this->member(member);
    }
    void member(const JsonMember& member) const {
        (*this)(member.key);
        std::visit(*this, member.value.value);
    }

private:
    void add(std::uint64_t type, std::uint64_t value) const {
        hash_.add(type);
        hash_.add(value);
    }
    StateHash& hash_;
};

}  // namespace

void add_to_hash(StateHash& hash, const JsonNode& node) { std::visit(ValueHasher(hash), node.value); }

std::uint64_t scene_fingerprint(const JsonNode& root) {
    StateHash hash;
    const ValueHasher hasher(hash);
    if (root.object() == nullptr) return hash.value();
    for (const JsonMember& member : *root.object()) {
        if (std::find(kLeftOut.begin(), kLeftOut.end(), member.key) != kLeftOut.end()) continue;
        const JsonNode::Object* const members = member.value.object();
        if (member.key != "simulation" || members == nullptr) {
            hasher.member(member);
            continue;
        }
        hasher(member.key);
        for (const JsonMember& setting : *members) {
            if (setting.key != kDuration) hasher.member(setting);
        }
    }
    return hash.value();
}

}  // namespace ricochet::detail
