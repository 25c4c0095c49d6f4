#include "ricochet/geometry/mesh/gltf_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "ricochet/core/printable.h"

namespace ricochet {
namespace {

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

// Selects the stored values, and throws errors.
class GltfListener final : public JsonListener {
public:
    explicit GltfListener(const MeshSource& source) : source_(source) {}

    JsonPart part_of(std::string_view key, std::size_t depth) override {
        if (depth == 1) {
            is_in_nodes_ = key == "nodes";
            // Only the existence of animations matters, so their content is not stored.
            if (key == "animations") return JsonPart::key;
            return contains(kTopKeys, key) ? JsonPart::all : JsonPart::none;
        }
        return is_kept_below(key, depth) ? JsonPart::all : JsonPart::none;
    }

    void refuse(const SourceLocation& /*location*/, const std::string& error) override { source_.fail(error); }
    void refuse_syntax(std::size_t position, const std::string& error) override {
        constexpr std::size_t kLongest = 160;
        source_.fail(fmt::format("the JSON of the glTF file cannot be read at its byte {}: {}",
                                 position == 0 ? 0 : position - 1, printable(error, kLongest)));
    }
    void refuse_repetition(const JsonMember& member, std::span<JsonNode* const> /*open*/) override {
        source_.fail(fmt::format("the key {} appears twice in one object of its JSON", in_quotes(member.key)));
    }

private:
    // The only extension of a node that is stored is KHR_node_visibility.
    [[nodiscard]] bool is_kept_below(std::string_view key, std::size_t depth) const {
        constexpr std::size_t kInNode = 3;  // nodes[0] is the third open container
        if (is_in_nodes_ && depth == kInNode && key == "extensions") return true;
        if (is_in_nodes_ && depth == kInNode + 1) return key == kGltfVisibility;
        return !contains(kLeftOut, key);
    }

    const MeshSource& source_;
    bool is_in_nodes_ = false;
};

}  // namespace

JsonNode parse_gltf_json(const MeshSource& source, std::string_view text) {
    // The parser would stop at a NUL byte and treat the text before it as the whole file.
    if (text.find('\0') != std::string_view::npos) source.fail("NUL byte in the JSON of the glTF file");
    // The deepest value that is read is meshes[0].primitives[0].targets[0].POSITION.
    const JsonLimits limits{16, "JSON nested deeper than any glTF file needs",
                            fmt::format("more than {} values in its JSON", kMostJsonValues)};
    GltfListener listener(source);
    std::optional<JsonNode> root = read_json(text, limits, listener);
    if (!root) source.fail("the JSON of the glTF file cannot be read");
    if (root->object() == nullptr) {
        source.fail(fmt::format("found {}, expected the JSON object of a glTF file", described(*root)));
    }
    return std::move(*root);
}

void GltfLocation::fail(const std::string& what) const {
    source_->fail(path_.empty() ? what : fmt::format("{}: {}", path_, what));
}

void GltfLocation::fail_expected(std::string_view what) const {
    const std::string* text = value_->text();
    fail(fmt::format("found {}, expected {}", text != nullptr ? "the text " + in_quotes(*text) : described(*value_),
                     what));
}

GltfLocation GltfLocation::at(std::string_view key) const {
    const JsonNode* found = value_->find(key);
    if (found == nullptr) fail(fmt::format("\"{}\" is missing", key));
    return {*source_, *found, path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key)};
}

GltfList GltfLocation::items(std::string_view key) const {
    if (!has(key)) return {*source_, nullptr, ""};
    const GltfLocation list = at(key);
    const auto* values = list.value_->array();
    if (values == nullptr) list.fail_expected("a list");
    return {*source_, values, list.path_};
}

GltfLocation GltfList::operator[](std::size_t i) const {
    return {*source_, (*items_)[i], fmt::format("{}[{}]", path_, i)};
}

std::uint64_t GltfLocation::whole_number() const {
    // Larger offsets and counts exceed any file. Sums of two numbers below this limit stay in the range of integers.
    // Local: a limit of input values.
    constexpr std::uint64_t kLargest = 9007199254740992;
    // Some programs write whole numbers like 3.0.
    const std::optional<std::uint64_t> whole = value_->whole_number();
    if (whole && *whole <= kLargest) return *whole;
    fail_expected("a whole number >= 0 that a file can hold");
}

double GltfLocation::number() const {
    const std::optional<double> number = value_->number();
    if (!number || !std::isfinite(*number)) fail_expected("a finite number");
    return *number;
}

const std::string& GltfLocation::text() const {
    const std::string* text = value_->text();
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
