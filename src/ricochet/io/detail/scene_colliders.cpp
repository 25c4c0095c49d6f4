// Materials and colliders of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ricochet/io/detail/mesh_groups.h"
#include "ricochet/io/detail/scene_context.h"
#include "ricochet/io/detail/suggestion.h"

namespace ricochet::detail {
namespace {

class ColliderBuilder {
public:
    ColliderBuilder(SceneContext& context, SimulationSetup& setup) : context_(context), setup_(setup) {}

    void build() {
        build_materials();
        std::set<std::string> taken;
        for (const ObjectView& view : context_.objects("colliders")) {
            ColliderDescription collider;
            collider.name = context_.unique_name(view, setup_.colliders.size(), "collider", taken);
            collider.material = material_of(view);
            collider.shape = shape_of(view, collider.material);
            setup_.colliders.push_back(std::move(collider));
        }
        warn_about_unused_materials();
    }

private:
    void build_materials() {
        const JsonNode::Object* members = context_.root().node("materials").object();
        if (members == nullptr) return;
        const ObjectSpec& spec = *find_key(scene_spec(), nullptr, "materials")->content;
        for (const JsonMember& member : *members) {
            const ObjectView view(member.value, spec, path_of_key("materials", member.key));
            setup_.materials.push_back(material(member.key, view));
        }
        used_.resize(members->size(), false);
    }

    static Material material(const std::string& name, const ObjectView& view) {
        Material material;
        material.name = name;
        material.restitution = view.number("restitution");
        material.restitution_threshold = view.number("restitution_threshold");
        material.friction = view.number("friction");
        material.rolling_friction = view.number("rolling_friction");
        material.diffuse = view.number("diffuse");
        if (view.has("wall_temperature")) material.wall_temperature = view.number("wall_temperature");
        material.absorption = view.number("absorption");
        return material;
    }

    // Index of a collider's material; colliders without one share a perfect one after those of the scene.
    std::uint32_t material_of(const ObjectView& view) {
        if (!view.has("material")) {
            if (setup_.materials.size() == used_.size()) setup_.materials.emplace_back();
            return static_cast<std::uint32_t>(used_.size());
        }
        return index_of_material(view.text("material"), view.place_of("material"), view.path_of("material"));
    }

    // The material of that name, which counts as used from now on; 0 after reporting that there is none.
    std::uint32_t index_of_material(const std::string& name, const Place& place, const std::string& path) {
        std::vector<std::string_view> names;
        for (std::size_t i = 0; i < used_.size(); ++i) {
            names.push_back(setup_.materials[i].name);
            if (names.back() != name) continue;
            used_[i] = true;
            return static_cast<std::uint32_t>(i);
        }
        context_.diagnostics().error(place, path, unknown_name("material", name, names));
        return 0;
    }

    // Material of every triangle; empty where the collider's own is that of all.
    std::vector<std::uint32_t> triangle_materials(const ObjectView& view, std::uint32_t otherwise) {
        const JsonNode::Object* members = view.node("group_materials").object();
        const MeshGroups* groups = context_.load_groups(view);
        if (members == nullptr || groups == nullptr) return {};
        if (groups->groups.empty()) {
            context_.error(view, "group_materials", without_groups(*groups));
            return {};
        }
        NamedMaterials named{{}, otherwise};
        const std::vector<std::string_view> known = groups->all_names();
        for (const JsonMember& member : *members) {
            const std::string path = path_of_key(view.path_of("group_materials"), member.key);
            if (std::find(known.begin(), known.end(), member.key) == known.end()) {
                context_.diagnostics().error(member.key_place, path, unknown_group(member.key, known));
            }
            if (member.value.text() == nullptr) continue;  // refused already
            named.materials[member.key] = index_of_material(*member.value.text(), member.value.place, path);
        }
        TriangleMaterials result = materials_by_group(*groups, named);
        warn_about_unused_groups(view, *members, result.names_not_used, known);
        return std::move(result.materials);
    }

    static std::string without_groups(const MeshGroups& groups) {
        if (groups.format_has_groups()) {
            return "the mesh has no groups (no usemtl, g or o statement with a name), leave this key out";
        }
        return fmt::format("the mesh is a file of the format {}, which has no groups; expected an OBJ file",
                           groups.format);
    }

    static std::string unknown_group(const std::string& name, const std::vector<std::string_view>& known) {
        constexpr std::size_t kMostNames = 20;
        const std::string unknown = fmt::format("the mesh has no group \"{}\"", printable(name, 60));
        const std::string help = did_you_mean(nearest_names(name, known));
        if (!help.empty()) return unknown + "; " + help;
        const std::vector<std::string_view> some(
            known.begin(), known.begin() + std::min<std::ptrdiff_t>(kMostNames, std::ssize(known)));
        return fmt::format("{}, it has: {}{}", unknown, quoted_list(some),
                           some.size() < known.size() ? fmt::format(" and {} more", known.size() - some.size()) : "");
    }

    // A name of the mesh by which no triangle takes its material: other names of its faces come first.
    void warn_about_unused_groups(const ObjectView& view, const JsonNode::Object& members,
                                  const std::vector<std::string_view>& not_used,
                                  const std::vector<std::string_view>& known) {
        for (const JsonMember& member : members) {
            if (std::find(not_used.begin(), not_used.end(), member.key) == not_used.end()) continue;
            if (std::find(known.begin(), known.end(), member.key) == known.end()) continue;
            context_.diagnostics().warning(member.key_place, path_of_key(view.path_of("group_materials"), member.key),
                                           "no triangle takes this material: all faces of the group also have a name "
                                           "that comes before (usemtl before g before o)");
        }
    }

    ColliderShape shape_of(const ObjectView& view, std::uint32_t material) {
        if (view.type().empty()) return PlaneShape{};  // refused already
        if (view.type() == "plane") return PlaneShape{view.vector("point"), view.vector("normal")};
        const Placement placement = SceneContext::placement_of(view);
        if (view.type() == "sphere") return BallShape{view.number("radius"), placement};
        if (view.type() == "cylinder") return CylinderShape{view.number("radius"), view.number("height"), placement};
        if (view.type() == "box") return CuboidShape{view.vector("size"), placement};
        const std::string file = view.has("file") ? context_.file_of(view).string() : "";
        return MeshShape{context_.load_mesh(view), placement, file, triangle_materials(view, material)};
    }

    void warn_about_unused_materials() {
        const JsonNode::Object* members = context_.root().node("materials").object();
        for (std::size_t i = 0; i < used_.size(); ++i) {
            if (used_[i]) continue;
            const JsonMember& member = (*members)[i];
            context_.diagnostics().warning(member.key_place, path_of_key("materials", member.key),
                                           "no collider uses this material");
        }
    }

    SceneContext& context_;
    SimulationSetup& setup_;
    std::vector<bool> used_;  // one for every material of the scene
};

}  // namespace

void build_colliders(SceneContext& context, SimulationSetup& setup) { ColliderBuilder(context, setup).build(); }

}  // namespace ricochet::detail
