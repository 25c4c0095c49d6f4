#include "ricochet/geometry/mesh/gltf_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "ricochet/core/printable.h"

namespace ricochet {
namespace {

using Json = nlohmann::json;

/// Maximum number of stored values. A file with this many values outside its buffers has about a million nodes.
constexpr std::size_t kMostGltfValues = 4'000'000;

/// Top-level keys of a glTF file that describe a mesh.
constexpr std::array<std::string_view, 11> kTopKeys = {
    "asset", "accessors", "buffers", "bufferViews",    "materials",         "meshes",
    "nodes", "scene",     "scenes",  "extensionsUsed", "extensionsRequired"};

/// Keys below the top level that a mesh does not need. Textures of materials are the largest part.
constexpr std::array<std::string_view, 13> kLeftOut = {"extras",
                                                       "extensions",
                                                       "copyright",
                                                       "generator",
                                                       "min",
                                                       "max",
                                                       "normalTexture",
                                                       "occlusionTexture",
                                                       "emissiveTexture",
                                                       "emissiveFactor",
                                                       "pbrMetallicRoughness",
                                                       "target",
                                                       "targets"};

// Builds the tree of stored values. Each open container is the last element of its parent, so pointers to open
// containers stay valid.
class GltfTreeBuilder final : public nlohmann::json_sax<Json> {
public:
    explicit GltfTreeBuilder(const MeshSource& source) : source_(source) {}

    bool null() override { return add(std::monostate{}); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(std::int64_t value) override { return add(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) override { return add(value); }
    bool number_float(double value, const std::string& /*written*/) override { return add(value); }
    bool string(std::string& value) override { return add(std::move(value)); }
    bool binary(Json::binary_t& /*value*/) override { return false; }
    bool start_object(std::size_t /*count*/) override { return open(GltfValue::Object{}); }
    bool start_array(std::size_t /*count*/) override { return open(GltfValue::Array{}); }
    bool end_object() override {
        if (skipped_depth_ == 0) refuse_duplicates(std::get<GltfValue::Object>(open_.back()->value));
        return close();
    }
    bool end_array() override { return close(); }

    bool key(std::string& name) override {
        if (skipped_depth_ > 0) return true;
        const bool is_top = open_.size() == 1;
        if (is_top) is_in_nodes_ = name == "nodes";
        const bool is_kept = is_top ? contains(kTopKeys, name) : is_kept_below(name);
        skips_next_ = !is_kept;
        // Only the existence of animations matters, so their content is not stored.
        if (is_kept || (is_top && name == "animations"))
            std::get<GltfValue::Object>(open_.back()->value).push_back({std::move(name), {}});
        return true;
    }

    bool parse_error(std::size_t position, const std::string& /*token*/, const Json::exception& error) override {
        std::string what = error.what();
        if (const auto bracket = what.find("] "); bracket != std::string::npos) what.erase(0, bracket + 2);
        constexpr std::size_t kLongest = 160;
        source_.fail(fmt::format("the JSON of the glTF file cannot be read at its byte {}: {}",
                                 position == 0 ? 0 : position - 1, printable(what, kLongest)));
    }

    GltfValue take() { return std::move(root_); }

private:
    // The only extension of a node that is stored is KHR_node_visibility.
    [[nodiscard]] bool is_kept_below(std::string_view name) const {
        constexpr std::size_t kInNode = 3;  // nodes[0] is the third open container
        if (is_in_nodes_ && open_.size() == kInNode && name == "extensions") return true;
        if (is_in_nodes_ && open_.size() == kInNode + 1) return name == kGltfVisibility;
        return !contains(kLeftOut, name);
    }

    template <typename Value>
    bool add(Value value) {
        if (skipped_depth_ > 0) return true;
        if (std::exchange(skips_next_, false)) return true;
        attach({std::move(value)});
        return true;
    }

    template <typename Container>
    bool open(Container container) {
        if (skipped_depth_ > 0 || std::exchange(skips_next_, false)) {
            ++skipped_depth_;
            return true;
        }
        // The deepest value that is read is meshes[0].primitives[0].targets[0].POSITION.
        constexpr std::size_t kDeepest = 16;
        if (open_.size() == kDeepest) source_.fail("JSON nested deeper than any glTF file needs");
        open_.push_back(attach({std::move(container)}));
        return true;
    }

    bool close() {
        if (skipped_depth_ > 0) {
            --skipped_depth_;
        } else {
            open_.pop_back();
        }
        return true;
    }

    GltfValue* attach(GltfValue value) {
        if (++count_ > kMostGltfValues) source_.fail(fmt::format("more than {} values in its JSON", kMostGltfValues));
        if (open_.empty()) {
            root_ = std::move(value);
            return &root_;
        }
        GltfValue& parent = *open_.back();
        if (auto* items = std::get_if<GltfValue::Array>(&parent.value)) return &items->emplace_back(std::move(value));
        GltfMember& member = std::get<GltfValue::Object>(parent.value).back();
        member.value = std::move(value);
        return &member.value;
    }

    void refuse_duplicates(const GltfValue::Object& members) const {
        std::set<std::string_view> keys;
        for (const GltfMember& member : members) {
            if (keys.insert(member.key).second) continue;
            source_.fail(fmt::format("the key {} appears twice in one object of its JSON", in_quotes(member.key)));
        }
    }

    const MeshSource& source_;
    GltfValue root_;
    std::vector<GltfValue*> open_;
    std::size_t skipped_depth_ = 0;
    bool skips_next_ = false;
    bool is_in_nodes_ = false;
    std::size_t count_ = 0;
};

std::string described(const GltfValue& value) {
    if (const auto* text = std::get_if<std::string>(&value.value)) return fmt::format("the text {}", in_quotes(*text));
    if (const auto* whole = std::get_if<std::uint64_t>(&value.value)) return fmt::format("{}", *whole);
    if (const auto* number = std::get_if<double>(&value.value)) return fmt::format("{}", *number);
    if (const auto* flag = std::get_if<bool>(&value.value)) return *flag ? "true" : "false";
    if (std::holds_alternative<GltfValue::Array>(value.value)) return "a list";
    return std::holds_alternative<GltfValue::Object>(value.value) ? "an object" : "null";
}

}  // namespace

const GltfValue* GltfValue::find(std::string_view key) const {
    const auto* members = std::get_if<Object>(&value);
    if (members == nullptr) return nullptr;
    const auto found =
        std::find_if(members->begin(), members->end(), [key](const GltfMember& member) { return member.key == key; });
    return found == members->end() ? nullptr : &found->value;
}

GltfValue parse_gltf_json(const MeshSource& source, std::string_view text) {
    // The parser would stop at a NUL byte and treat the text before it as the whole file.
    if (text.find('\0') != std::string_view::npos) source.fail("NUL byte in the JSON of the glTF file");
    GltfTreeBuilder builder(source);
    if (!Json::sax_parse(text.begin(), text.end(), &builder)) source.fail("the JSON of the glTF file cannot be read");
    GltfValue root = builder.take();
    if (!std::holds_alternative<GltfValue::Object>(root.value)) {
        source.fail(fmt::format("found {}, expected the JSON object of a glTF file", described(root)));
    }
    return root;
}

void GltfLocation::fail(const std::string& what) const {
    source_->fail(path_.empty() ? what : fmt::format("{}: {}", path_, what));
}

void GltfLocation::fail_expected(std::string_view what) const {
    fail(fmt::format("found {}, expected {}", described(*value_), what));
}

GltfLocation GltfLocation::at(std::string_view key) const {
    const GltfValue* found = value_->find(key);
    if (found == nullptr) fail(fmt::format("\"{}\" is missing", key));
    return {*source_, *found, path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key)};
}

GltfList GltfLocation::items(std::string_view key) const {
    if (!has(key)) return {*source_, nullptr, ""};
    const GltfLocation list = at(key);
    const auto* values = std::get_if<GltfValue::Array>(&list.value_->value);
    if (values == nullptr) list.fail_expected("a list");
    return {*source_, values, list.path_};
}

GltfLocation GltfList::operator[](std::size_t i) const {
    return {*source_, (*items_)[i], fmt::format("{}[{}]", path_, i)};
}

std::uint64_t GltfLocation::whole_number() const {
    // Larger offsets and counts exceed any file. Sums of two numbers below this limit stay in the range of integers.
    // Local: a limit of input values.
    constexpr double kLargest = 9007199254740992.0;
    if (const auto* whole = std::get_if<std::uint64_t>(&value_->value)) {
        if (*whole <= static_cast<std::uint64_t>(kLargest)) return *whole;
    } else if (const auto* number = std::get_if<double>(&value_->value)) {
        // Some programs write whole numbers like 3.0.
        if (*number >= 0.0 && *number <= kLargest && *number == std::floor(*number)) {
            return static_cast<std::uint64_t>(*number);
        }
    }
    fail_expected("a whole number >= 0 that a file can hold");
}

double GltfLocation::number() const {
    if (const auto* whole = std::get_if<std::uint64_t>(&value_->value)) return static_cast<double>(*whole);
    const auto* number = std::get_if<double>(&value_->value);
    if (number == nullptr || !std::isfinite(*number)) fail_expected("a finite number");
    return *number;
}

const std::string& GltfLocation::text() const {
    const auto* text = std::get_if<std::string>(&value_->value);
    if (text == nullptr) fail_expected("a text");
    return *text;
}

std::uint32_t GltfLocation::index_below(std::size_t count, std::string_view what) const {
    const std::uint64_t index = whole_number();
    if (index >= count) fail(fmt::format("found {}, but the file has {} {}", index, count, what));
    return static_cast<std::uint32_t>(index);
}

std::uint64_t GltfLocation::whole_number(std::string_view key, std::uint64_t otherwise) const {
    return has(key) ? at(key).whole_number() : otherwise;
}

bool GltfLocation::flag(std::string_view key, bool otherwise) const {
    if (!has(key)) return otherwise;
    const GltfLocation location = at(key);
    const auto* flag = std::get_if<bool>(&location.value_->value);
    if (flag == nullptr) location.fail_expected("true or false");
    return *flag;
}

std::string GltfLocation::text(std::string_view key) const { return has(key) ? at(key).text() : std::string(); }

std::optional<std::uint32_t> GltfLocation::index_below(std::string_view key, std::size_t count,
                                                       std::string_view what) const {
    if (!has(key)) return std::nullopt;
    return at(key).index_below(count, what);
}

std::vector<double> GltfLocation::numbers(std::string_view key, std::size_t count) const {
    const GltfList locations = items(key);
    if (has(key) && locations.size() != count) {
        at(key).fail(fmt::format("found {} numbers, expected {}", locations.size(), count));
    }
    std::vector<double> numbers;
    for (std::size_t i = 0; i < locations.size(); ++i) numbers.push_back(locations[i].number());
    return numbers;
}

}  // namespace ricochet
