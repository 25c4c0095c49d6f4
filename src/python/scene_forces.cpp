#include "python/scene_forces.h"

#include <algorithm>
#include <optional>

#include "ricochet/io/scene.h"
#include "ricochet/io/scene/diagnostics.h"

namespace ricochet {
namespace {

/// Converts all numbers to doubles and sorts all keys, so that equal values have equal hashes. For example, 2 and 2.0
/// become equal.
void make_plain(JsonNode& node) {
    if (const auto number = node.number()) node.value = *number;
    if (JsonNode::Array* list = node.array()) {
        for (JsonNode& entry : *list) make_plain(entry);
    }
    if (JsonNode::Object* object = node.object()) {
        for (JsonMember& member : *object) make_plain(member.value);
        std::sort(object->begin(), object->end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    }
}

}  // namespace

std::uint64_t forces_fingerprint(std::string_view text, const std::vector<std::string>& overrides) {
    detail::Diagnostics diagnostics("scene", overrides);
    std::optional<JsonNode> root = detail::parse_json(text, diagnostics);
    if (!root) throw SceneError(diagnostics.errors());
    for (std::size_t i = 0; i < overrides.size(); ++i) detail::apply_override(*root, i, diagnostics);
    StateHash hash;
    for (const std::string_view key : {"forces", "particle_forces", "flows"}) {
        JsonNode* const node = root->find(key);
        const bool has_any = node != nullptr && ((node->array() != nullptr && !node->array()->empty()) ||
                                                 (node->object() != nullptr && !node->object()->empty()));
        if (has_any) make_plain(*node);
        detail::add_to_hash(hash, has_any ? *node : JsonNode{});
    }
    return hash.value();
}

}  // namespace ricochet
