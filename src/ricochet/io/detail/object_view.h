/// \file
/// A checked object as typed values, with the table's defaults where a key is absent.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/io/detail/json_node.h"
#include "ricochet/io/detail/scene_keys.h"

namespace ricochet::detail {

/// Values that were refused count as absent; absent ones without a default come as zero or empty, which no one sees
/// because the scene is refused as a whole.
class ObjectView {
public:
    /// node: an object, or null (then everything is absent). path: for messages.
    ObjectView(const JsonNode& node, const ObjectSpec& spec, std::string path);

    [[nodiscard]] bool has(std::string_view key) const { return value(key) != nullptr; }
    [[nodiscard]] double number(std::string_view key) const;
    [[nodiscard]] std::uint64_t whole_number(std::string_view key) const;
    [[nodiscard]] bool boolean(std::string_view key) const;
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] Vec3 vector(std::string_view key) const;
    /// One factor for all axes, or one each.
    [[nodiscard]] Vec3 scale(std::string_view key) const;
    [[nodiscard]] MeanSpread pair(std::string_view key) const;
    /// The value itself; null where it is absent.
    [[nodiscard]] const JsonNode& node(std::string_view key) const;
    [[nodiscard]] ObjectView object(std::string_view key) const;
    /// The objects of a list.
    [[nodiscard]] std::vector<ObjectView> objects(std::string_view key) const;
    [[nodiscard]] std::vector<std::uint64_t> whole_numbers(std::string_view key) const;

    /// Name of the variant; empty where it was refused.
    [[nodiscard]] std::string_view type() const { return variant_ == nullptr ? "" : variant_->name; }
    [[nodiscard]] const Place& place() const { return node_->place; }
    [[nodiscard]] const Place& place_of(std::string_view key) const;
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string path_of(std::string_view key) const;

private:
    [[nodiscard]] const JsonNode* value(std::string_view key) const;
    [[nodiscard]] JsonNode value_or_default(std::string_view key) const;

    const JsonNode* node_;
    const ObjectSpec* spec_;
    const Variant* variant_;
    std::string path_;
};

}  // namespace ricochet::detail
