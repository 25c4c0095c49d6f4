// Materials and colliders of a scene.
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/io/detail/scene_context.h"

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
            if (view.type() == "plane") collider.shape = PlaneShape{view.vector("point"), view.vector("normal")};
            if (view.type() == "mesh") collider.shape = mesh_shape(view);
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
            setup_.materials.push_back({member.key, view.number("restitution"), view.number("friction")});
        }
        used_.resize(members->size(), false);
    }

    // Index of a collider's material; colliders without one share a perfect one after those of the scene.
    std::uint32_t material_of(const ObjectView& view) {
        if (!view.has("material")) {
            if (setup_.materials.size() == used_.size()) setup_.materials.emplace_back();
            return static_cast<std::uint32_t>(used_.size());
        }
        const std::string name = view.text("material");
        std::vector<std::string_view> names;
        for (std::size_t i = 0; i < used_.size(); ++i) {
            names.push_back(setup_.materials[i].name);
            if (names.back() != name) continue;
            used_[i] = true;
            return static_cast<std::uint32_t>(i);
        }
        context_.error(view, "material", unknown_name("material", name, names));
        return 0;
    }

    MeshShape mesh_shape(const ObjectView& view) {
        const std::string file = view.has("file") ? context_.file_of(view).string() : "";
        return {context_.load_mesh(view), SceneContext::placement_of(view), file};
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
