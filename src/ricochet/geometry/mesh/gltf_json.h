/// \file
/// The part of a glTF file's JSON that describes triangles, with checked access to its values. Private to the glTF
/// reader.
///
/// Data that a mesh does not need (images, animations, cameras, `extras`, extensions of materials) must be valid JSON,
/// but is not stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/json_document.h"
#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {

/// Extension that hides nodes. It is the only extension that is stored.
inline constexpr std::string_view kGltfVisibility = "KHR_node_visibility";

/// Parses the JSON of a glTF file. Throws InputError if the text is not JSON or not an object, or if a key appears
/// twice. It also throws if more than 4 million values would be stored.
[[nodiscard]] JsonNode parse_gltf_json(const MeshSource& source, std::string_view text);

class GltfLocation;

/// The items of a list. Valid as long as the source and the document exist.
class GltfList {
public:
    /// Makes a list. `items` is a null pointer if the list is missing.
    GltfList(const MeshSource& source, const JsonNode::Array* items, std::string path)
        : source_(&source), items_(items), path_(std::move(path)) {}

    [[nodiscard]] std::size_t size() const { return items_ == nullptr ? 0 : items_->size(); }
    [[nodiscard]] GltfLocation operator[](std::size_t i) const;

private:
    const MeshSource* source_;
    const JsonNode::Array* items_;
    std::string path_;
};

/// A value that knows its location in the JSON, such as `accessors[3].count`, for messages. Each access checks that the
/// requested value exists and has the right kind. If not, it throws an InputError that states the found value. Valid as
/// long as the source and the document exist.
class GltfLocation {
public:
    GltfLocation(const MeshSource& source, const JsonNode& value, std::string path)
        : source_(&source), value_(&value), path_(std::move(path)) {}

    /// Throws InputError "file: path: what".
    [[noreturn]] void fail(const std::string& what) const;

    [[nodiscard]] bool has(std::string_view key) const { return value_->find(key) != nullptr; }
    /// Returns the value of a required key.
    [[nodiscard]] GltfLocation at(std::string_view key) const;
    /// Returns the items of the list under a key, or an empty list if the key is missing.
    [[nodiscard]] GltfList items(std::string_view key) const;

    /// The next three functions read this value itself.
    [[nodiscard]] std::uint64_t whole_number() const;
    [[nodiscard]] double number() const;
    [[nodiscard]] const std::string& text() const;
    /// Returns a whole number that must be below `count`. `what` names the indexed elements in messages.
    [[nodiscard]] std::uint32_t index_below(std::size_t count, std::string_view what) const;

    // The next functions read the values of optional keys.
    [[nodiscard]] std::uint64_t whole_number(std::string_view key, std::uint64_t otherwise) const;
    [[nodiscard]] bool flag(std::string_view key, bool otherwise) const;
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] std::optional<std::uint32_t> index_below(std::string_view key, std::size_t count,
                                                           std::string_view what) const;
    /// Returns exactly `count` numbers, or none if the key is missing.
    [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count) const;

private:
    [[noreturn]] void fail_expected(std::string_view what) const;

    const MeshSource* source_;
    const JsonNode* value_;
    std::string path_;
};

}  // namespace ricochet
