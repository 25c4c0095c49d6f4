#include "ricochet/io/detail/object_view.h"

#include <stdexcept>
#include <utility>

#include "ricochet/io/detail/diagnostics.h"
#include "ricochet/io/detail/json_parser.h"
#include "ricochet/io/detail/scene_check.h"

namespace ricochet::detail {
namespace {

const JsonNode kAbsent{};

Vec3 vector_of(const JsonNode& node) {
    const JsonNode::Array* items = node.array();
    if (items == nullptr || items->size() != 3) return {};
    return {(*items)[0].number().value_or(0.0), (*items)[1].number().value_or(0.0), (*items)[2].number().value_or(0.0)};
}

}  // namespace

ObjectView::ObjectView(const JsonNode& node, const ObjectSpec& spec, std::string path)
    : node_(&node), spec_(&spec), variant_(variant_of(node, spec)), path_(std::move(path)) {}

const JsonNode* ObjectView::value(std::string_view key) const {
    const JsonNode* found = node_->find(key);
    return found == nullptr || found->is_null() ? nullptr : found;
}

JsonNode ObjectView::value_or_default(std::string_view key) const {
    if (const JsonNode* found = value(key)) return *found;
    const KeySpec* spec = find_key(*spec_, variant_, key);
    if (spec == nullptr) throw std::logic_error("no such key in the table: " + std::string(key));
    if (spec->fallback.empty()) return {};
    return parse_json_value(spec->fallback, {}).value();
}

double ObjectView::number(std::string_view key) const { return value_or_default(key).number().value_or(0.0); }

std::uint64_t ObjectView::whole_number(std::string_view key) const {
    return value_or_default(key).whole_number().value_or(0);
}

bool ObjectView::boolean(std::string_view key) const {
    const JsonNode found = value_or_default(key);
    const bool* truth = std::get_if<bool>(&found.value);
    return truth != nullptr && *truth;
}

std::string ObjectView::text(std::string_view key) const {
    const JsonNode found = value_or_default(key);
    return found.text() == nullptr ? std::string() : *found.text();
}

Vec3 ObjectView::vector(std::string_view key) const { return vector_of(value_or_default(key)); }

Vec3 ObjectView::scale(std::string_view key) const {
    const JsonNode found = value_or_default(key);
    if (const auto factor = found.number()) return {*factor, *factor, *factor};
    return vector_of(found);
}

MeanSpread ObjectView::pair(std::string_view key) const {
    const JsonNode found = value_or_default(key);
    if (const auto mean = found.number()) return {*mean, 0.0};
    const JsonNode::Array* items = found.array();
    if (items == nullptr || items->size() != 2) return {};
    return {(*items)[0].number().value_or(0.0), (*items)[1].number().value_or(0.0)};
}

const JsonNode& ObjectView::node(std::string_view key) const {
    const JsonNode* found = value(key);
    return found == nullptr ? kAbsent : *found;
}

ObjectView ObjectView::object(std::string_view key) const {
    const KeySpec* spec = find_key(*spec_, variant_, key);
    if (spec == nullptr || spec->content == nullptr) {
        throw std::logic_error("no such object in the table: " + std::string(key));
    }
    return {node(key), *spec->content, path_of(key)};
}

std::vector<ObjectView> ObjectView::objects(std::string_view key) const {
    std::vector<ObjectView> views;
    const JsonNode::Array* items = node(key).array();
    if (items == nullptr) return views;
    const ObjectSpec& spec = *find_key(*spec_, variant_, key)->content;
    for (std::size_t i = 0; i < items->size(); ++i) {
        views.emplace_back((*items)[i], spec, path_of_item(path_of(key), i));
    }
    return views;
}

std::vector<std::uint64_t> ObjectView::whole_numbers(std::string_view key) const {
    std::vector<std::uint64_t> numbers;
    const JsonNode::Array* items = node(key).array();
    if (items == nullptr) return numbers;
    for (const JsonNode& item : *items) numbers.push_back(item.whole_number().value_or(0));
    return numbers;
}

const Place& ObjectView::place_of(std::string_view key) const {
    const JsonNode* found = node_->find(key);
    return found == nullptr ? node_->place : found->place;
}

std::string ObjectView::path_of(std::string_view key) const { return path_of_key(path_, key); }

}  // namespace ricochet::detail
