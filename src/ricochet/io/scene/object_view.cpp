#include "ricochet/io/scene/object_view.h"

#include <utility>

#include "ricochet/io/scene/diagnostics.h"

namespace ricochet::detail {
namespace {

const JsonNode kAbsent{};

}  // namespace

ObjectView::ObjectView(const JsonNode& node, const ObjectSpec& spec, std::string path)
    : node_(&node), spec_(&spec), variant_(variant_of(node, spec)), path_(std::move(path)) {}

const JsonNode* ObjectView::value(std::string_view key) const {
    const JsonNode* found = node_->find(key);
    return found == nullptr || found->is_null() ? nullptr : found;
}

const std::vector<KeySpec>& ObjectView::keys_for(const std::type_info& target) const {
    if (*spec_->target == target) return spec_->keys;
    if (variant_ != nullptr && *variant_->target == target) return variant_->keys;
    throw std::logic_error("no keys of the table set this struct: " + std::string(spec_->title));
}

const KeySpec& ObjectView::container(std::string_view key) const {
    const KeySpec* spec = find_key(*spec_, variant_, key);
    if (spec == nullptr || spec->content == nullptr) {
        throw std::logic_error("no such object in the table: " + std::string(key));
    }
    return *spec;
}

const JsonNode& ObjectView::node(std::string_view key) const {
    const JsonNode* found = value(key);
    return found == nullptr ? kAbsent : *found;
}

std::string ObjectView::text(std::string_view key) const {
    const std::string* found = node(key).text();
    return found == nullptr ? std::string() : *found;
}

ObjectView ObjectView::object(std::string_view key) const { return {node(key), *container(key).content, path_of(key)}; }

std::vector<ObjectView> ObjectView::objects(std::string_view key) const {
    std::vector<ObjectView> views;
    const JsonNode::Array* items = node(key).array();
    if (items == nullptr) return views;
    const ObjectSpec& spec = *container(key).content;
    for (std::size_t i = 0; i < items->size(); ++i) {
        views.emplace_back((*items)[i], spec, path_of_item(path_of(key), i));
    }
    return views;
}

std::vector<NamedObject> ObjectView::named_objects(std::string_view key) const {
    std::vector<NamedObject> objects;
    const JsonNode::Object* members = node(key).object();
    if (members == nullptr) return objects;
    const ObjectSpec& spec = *container(key).content;
    for (const JsonMember& member : *members) {
        objects.push_back(
            {member.key, member.key_location, {member.value, spec, path_of_key(path_of(key), member.key)}});
    }
    return objects;
}

const SourceLocation& ObjectView::location_of(std::string_view key) const {
    const JsonNode* found = node_->find(key);
    return found == nullptr ? node_->location : found->location;
}

std::string ObjectView::path_of(std::string_view key) const { return path_of_key(path_, key); }

}  // namespace ricochet::detail
