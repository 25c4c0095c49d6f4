/// \file
/// A checked object of a scene, its source locations for messages, and the struct that its keys set.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/io/scene/document.h"
#include "ricochet/io/scene/keys.h"

namespace ricochet::detail {

struct NamedObject;

/// Values that were refused count as absent; what then stands instead (the struct's default) is seen by no one, because
/// the scene is refused as a whole.
class ObjectView {
public:
    /// node: an object, or null (then everything is absent). path: for messages.
    ObjectView(const JsonNode& node, const ObjectSpec& spec, std::string path);

    /// The struct that the object's own keys set, or those of its variant; the other members keep their defaults.
    template <class Struct>
    [[nodiscard]] Struct read() const {
        Struct result = Struct();
        read_members(*node_, keys_for(typeid(Struct)), &result);
        return result;
    }

    /// True for an object that is not there, or was refused.
    [[nodiscard]] bool is_absent() const { return node_->object() == nullptr; }
    [[nodiscard]] bool has(std::string_view key) const { return value(key) != nullptr; }
    /// The value itself; null where it is absent.
    [[nodiscard]] const JsonNode& node(std::string_view key) const;
    /// A name or a path; empty where it is absent.
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] ObjectView object(std::string_view key) const;
    /// The objects of a list.
    [[nodiscard]] std::vector<ObjectView> objects(std::string_view key) const;
    /// The objects of a table.
    [[nodiscard]] std::vector<NamedObject> named_objects(std::string_view key) const;

    /// Name of the variant; empty where it was refused.
    [[nodiscard]] std::string_view type() const { return variant_ == nullptr ? "" : variant_->name; }
    [[nodiscard]] const SourceLocation& location() const { return node_->location; }
    [[nodiscard]] const SourceLocation& location_of(std::string_view key) const;
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string path_of(std::string_view key) const;

private:
    [[nodiscard]] const JsonNode* value(std::string_view key) const;
    [[nodiscard]] const KeySpec& container(std::string_view key) const;
    [[nodiscard]] const std::vector<KeySpec>& keys_for(const std::type_info& target) const;

    const JsonNode* node_;
    const ObjectSpec* spec_;
    const Variant* variant_;
    std::string path_;
};

/// One object of a table.
struct NamedObject {
    std::string name;
    SourceLocation name_location;
    ObjectView view;
};

}  // namespace ricochet::detail
