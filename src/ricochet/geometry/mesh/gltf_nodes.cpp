#include "ricochet/geometry/mesh/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "ricochet/geometry/mesh/placed_mesh_builder.h"

namespace ricochet {
namespace {

constexpr std::string_view kQuantization = "KHR_mesh_quantization";
constexpr std::string_view kInstancing = "EXT_mesh_gpu_instancing";

// Prefixes of extensions that a file may require, but that do not affect triangles.
constexpr std::array<std::string_view, 8> kHarmless = {
    "KHR_materials_",      "KHR_texture_",    "EXT_texture_",          "MSFT_texture_",
    "KHR_lights_punctual", "KHR_xmp_json_ld", "KHR_animation_pointer", kGltfVisibility};

// Applies the rotation of a quaternion. The terms are divided by the square of the quaternion's length, so quarter
// turns are exact for any rounding of the square root of 1/2.
void turn(AffineMap& map, const GltfLocation& node, const std::vector<double>& q) {
    const double x = q[0];
    const double y = q[1];
    const double z = q[2];
    const double w = q[3];
    const double n = x * x + y * y + z * z + w * w;
    if (!(n > 0.0) || !std::isfinite(n)) node.fail("its rotation has no direction, expected a unit quaternion");
    map.row_x = {1.0 - 2.0 * (y * y + z * z) / n, 2.0 * (x * y - w * z) / n, 2.0 * (x * z + w * y) / n};
    map.row_y = {2.0 * (x * y + w * z) / n, 1.0 - 2.0 * (x * x + z * z) / n, 2.0 * (y * z - w * x) / n};
    map.row_z = {2.0 * (x * z - w * y) / n, 2.0 * (y * z + w * x) / n, 1.0 - 2.0 * (x * x + y * y) / n};
}

AffineMap map_of_matrix(const GltfLocation& node, const std::vector<double>& m) {
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
        node.fail("the last row of its matrix is not 0 0 0 1");
    }
    return {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[12], m[13], m[14]}};
}

AffineMap parent_from(const GltfLocation& node) {
    const std::vector<double> matrix = node.numbers("matrix", 16);
    const std::vector<double> translation = node.numbers("translation", 3);
    const std::vector<double> rotation = node.numbers("rotation", 4);
    const std::vector<double> scale = node.numbers("scale", 3);
    if (!matrix.empty()) {
        if (!translation.empty() || !rotation.empty() || !scale.empty()) {
            node.fail("has a matrix and also a translation, rotation or scale, expected one or the other");
        }
        return map_of_matrix(node, matrix);
    }
    AffineMap map;
    if (!rotation.empty()) turn(map, node, rotation);
    if (!scale.empty()) {
        for (auto row : {&AffineMap::row_x, &AffineMap::row_y, &AffineMap::row_z}) {
            map.*row = {(map.*row).x * scale[0], (map.*row).y * scale[1], (map.*row).z * scale[2]};
        }
    }
    if (!translation.empty()) map.translation = {translation[0], translation[1], translation[2]};
    return map;
}

class NodeWalk {
public:
    explicit NodeWalk(const GltfLocation& document)
        : document_(document),
          nodes_(document.items("nodes")),
          meshes_(document.items("meshes")),
          has_parent_(nodes_.size(), false),
          is_reached_(nodes_.size(), false) {}

    GltfScenery walk() {
        find_parents();
        const GltfList scenes = document_.items("scenes");
        if (scenes.size() == 0) {
            for (std::size_t n = 0; n < nodes_.size(); ++n) {
                if (!has_parent_[n]) walk_from(static_cast<std::uint32_t>(n));
            }
        } else {
            walk_scene(scenes[document_.index_below("scene", scenes.size(), "scenes").value_or(0)]);
        }
        return {std::move(placed_), hidden_nodes_};
    }

private:
    // A node on the path from its root, with the index of its next child.
    struct Open {
        std::uint32_t node = 0;
        std::size_t next_child = 0;
        AffineMap world;
        std::optional<std::uint32_t> named;  // the node itself, or the nearest ancestor that has a name
    };

    // The nodes reachable from the roots form trees if every node has at most one parent and the roots have none.
    void find_parents() {
        for (std::size_t n = 0; n < nodes_.size(); ++n) {
            const GltfList children = nodes_[n].items("children");
            for (std::size_t c = 0; c < children.size(); ++c) {
                const std::uint32_t child = children[c].index_below(nodes_.size(), "nodes");
                if (has_parent_[child]) {
                    children[c].fail(fmt::format("node {} has another parent already, expected a tree", child));
                }
                has_parent_[child] = true;
            }
        }
    }

    void walk_scene(const GltfLocation& scene) {
        const GltfList roots = scene.items("nodes");
        for (std::size_t r = 0; r < roots.size(); ++r) {
            const std::uint32_t root = roots[r].index_below(nodes_.size(), "nodes");
            if (has_parent_[root]) roots[r].fail(fmt::format("node {} has a parent, expected a root", root));
            if (is_reached_[root]) roots[r].fail(fmt::format("node {} is listed twice", root));
            is_reached_[root] = true;
            walk_from(root);
        }
    }

    // Visits parents before children without recursion, because a file may nest its nodes to any depth.
    void walk_from(std::uint32_t root) {
        enter(root, {}, std::nullopt);
        while (!open_.empty()) {
            Open& at = open_.back();
            const GltfList children = nodes_[at.node].items("children");
            if (at.next_child == children.size()) {
                open_.pop_back();
                continue;
            }
            const std::uint32_t child = children[at.next_child++].index_below(nodes_.size(), "nodes");
            const AffineMap world = at.world;
            enter(child, world, at.named);
        }
    }

    void enter(std::uint32_t number, const AffineMap& world_from_parent, std::optional<std::uint32_t> named) {
        const GltfLocation node = nodes_[number];
        if (is_hidden(node)) {
            ++hidden_nodes_;
            return;
        }
        const AffineMap world = joined(world_from_parent, parent_from(node));
        if (!node.text("name").empty()) named = number;
        if (const auto mesh = node.index_below("mesh", meshes_.size(), "meshes")) {
            require_rigid(node, meshes_[*mesh]);
            placed_.push_back({*mesh, world, named ? nodes_[*named].text("name") : std::string()});
        }
        open_.push_back({number, 0, world, named});
    }

    static bool is_hidden(const GltfLocation& node) {
        if (!node.has("extensions") || !node.at("extensions").has(kGltfVisibility)) return false;
        return !node.at("extensions").at(kGltfVisibility).flag("visible", true);
    }

    // Refuses meshes that a skin or morph targets deform.
    static void require_rigid(const GltfLocation& node, const GltfLocation& mesh) {
        if (node.has("skin")) {
            node.fail(
                "its mesh is posed by the joints of a skin, which are not followed: apply the armature before "
                "exporting (in Blender: Object > Convert > Mesh)");
        }
        const GltfList weights = node.has("weights") ? node.items("weights") : mesh.items("weights");
        for (std::size_t w = 0; w < weights.size(); ++w) {
            if (weights[w].number() == 0.0) continue;
            weights[w].fail(
                "its mesh is shaped by morph targets, which are not followed: apply the shape keys before "
                "exporting");
        }
    }

    const GltfLocation& document_;
    GltfList nodes_;
    GltfList meshes_;
    std::vector<bool> has_parent_;
    std::vector<bool> is_reached_;
    std::vector<Open> open_;
    std::vector<PlacedGltfMesh> placed_;
    std::size_t hidden_nodes_ = 0;
};

bool lists(const GltfLocation& document, std::string_view key, std::string_view name) {
    const GltfList extensions = document.items(key);
    for (std::size_t i = 0; i < extensions.size(); ++i) {
        if (extensions[i].text() == name) return true;
    }
    return false;
}

}  // namespace

GltfScenery placed_gltf_meshes(const GltfLocation& document) { return NodeWalk(document).walk(); }

void require_known_extensions(const GltfLocation& document) {
    if (lists(document, "extensionsUsed", kInstancing)) {
        document.fail(fmt::format("uses {} (copies of meshes), which is not followed: export without it", kInstancing));
    }
    const GltfList required = document.items("extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
        const std::string name = required[i].text();
        if (name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression" ||
            name == "KHR_meshopt_compression") {
            required[i].fail(
                fmt::format("its meshes are compressed ({}), which is not read: export without "
                            "compression (in Blender: Data > Compression off)",
                            name));
        }
        const bool is_harmless = std::any_of(kHarmless.begin(), kHarmless.end(),
                                             [&name](std::string_view begin) { return name.starts_with(begin); });
        if (!is_harmless && name != kQuantization) {
            required[i].fail(
                fmt::format("the file requires {}, which is not known here: export without it", in_quotes(name)));
        }
    }
}

bool uses_quantization(const GltfLocation& document) { return lists(document, "extensionsUsed", kQuantization); }

}  // namespace ricochet
