/// \file
/// Private to the glTF reader: the part of a file's JSON that says where triangles are, with strict access to it.
///
/// What a mesh does not need (images, animations, cameras, `extras`, extensions of materials) is checked for being
/// JSON and not kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {

/// The extension that hides nodes, the only one that is kept of `extensions`.
inline constexpr std::string_view kGltfVisibility = "KHR_node_visibility";

struct GltfMember;

/// One JSON value.
struct GltfValue {
    using Array = std::vector<GltfValue>;
    using Object = std::vector<GltfMember>;
    /// Whole numbers >= 0 are std::uint64_t, all others double.
    std::variant<std::monostate, bool, std::uint64_t, double, std::string, Array, Object> value;

    /// The value of a key; null pointer when this is no object or has no such key.
    [[nodiscard]] const GltfValue* find(std::string_view key) const;
};

/// One key with its value.
struct GltfMember {
    std::string key;
    GltfValue value;
};

/// Parses the JSON of a glTF file. Throws InputError: not JSON, not an object, keys that appear twice, more than
/// 4 million values that would be kept.
[[nodiscard]] GltfValue parse_gltf_json(const MeshSource& source, std::string_view text);

class GltfPlace;

/// The items of a list; lives as long as source and document.
class GltfList {
public:
    /// items: null pointer for a list that is not there.
    GltfList(const MeshSource& source, const GltfValue::Array* items, std::string path)
        : source_(&source), items_(items), path_(std::move(path)) {}

    [[nodiscard]] std::size_t size() const { return items_ == nullptr ? 0 : items_->size(); }
    [[nodiscard]] GltfPlace operator[](std::size_t i) const;

private:
    const MeshSource* source_;
    const GltfValue::Array* items_;
    std::string path_;
};

/// A value that knows its place, such as `accessors[3].count`, for messages. What is asked of it is there and of the
/// right kind, or an InputError is thrown that says what was found. Lives as long as source and document.
class GltfPlace {
public:
    GltfPlace(const MeshSource& source, const GltfValue& value, std::string path)
        : source_(&source), value_(&value), path_(std::move(path)) {}

    /// Throws InputError "file: path: what".
    [[noreturn]] void fail(const std::string& what) const;

    [[nodiscard]] bool has(std::string_view key) const { return value_->find(key) != nullptr; }
    /// The value of a key that must be there.
    [[nodiscard]] GltfPlace at(std::string_view key) const;
    /// The items of the list that a key holds; none where there is no such key.
    [[nodiscard]] GltfList items(std::string_view key) const;

    /// This value itself.
    [[nodiscard]] std::uint64_t whole_number() const;
    [[nodiscard]] double number() const;
    [[nodiscard]] const std::string& text() const;
    /// A whole number below the count of what it points to.
    [[nodiscard]] std::uint32_t index_below(std::size_t count, std::string_view what) const;

    // Values of keys that may be missing.
    [[nodiscard]] std::uint64_t whole_number(std::string_view key, std::uint64_t otherwise) const;
    [[nodiscard]] bool flag(std::string_view key, bool otherwise) const;
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] std::optional<std::uint32_t> index_below(std::string_view key, std::size_t count,
                                                           std::string_view what) const;
    /// As many numbers as are expected; empty where there is no such key.
    [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count) const;

private:
    [[noreturn]] void fail_expected(std::string_view what) const;

    const MeshSource* source_;
    const GltfValue* value_;
    std::string path_;
};

}  // namespace ricochet
