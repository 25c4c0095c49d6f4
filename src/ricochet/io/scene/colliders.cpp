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

#include "ricochet/core/printable.h"
#include "ricochet/io/scene/context.h"
#include "ricochet/response/settings_table.h"

namespace ricochet::detail {
namespace {

Fields<MeshShape> mesh_fields() {
    return joined<MeshShape>(
        {{{"file", ValueType::file, kMeshFileMeaning, kRequired}, up_field<MeshShape>()},
         placement_fields(&MeshShape::placement),
         {{"group_materials", ValueType::text_table,
           "Materials for parts of an OBJ, glTF or ASCII STL mesh. Each key is a name that the file gives to faces, "
           "and each value is a name in `materials`. The material name (`usemtl`) of a face comes first. The next is "
           "its `g` name: the whole line, then word by word. In glTF this is the name of the mesh, in ASCII STL that "
           "of the solid. The last is its `o` name, in glTF that of the node. Faces without a listed name take the "
           "collider's material.",
           Without{"the collider's material everywhere"}},
          {"deformation", ValueType::object,
           "Motion of the vertices. `file` then gives only the faces. Requires the response \"exact\", and no `frame` "
           "or `motion`.",
           &deformation_spec(), Without{"it keeps its shape"}}}});
}

// Returns a variant with the keys for the dimensions of a shape and for its placement.
template <class Shape>
Variant placed_variant(std::string_view name, std::string_view description, const Fields<Shape>& measures) {
    return variant(name, description, joined<Shape>({measures, placement_fields(&Shape::placement)}));
}

std::vector<Variant> collider_shapes() {
    using Plane = PlaneShape;
    using Cylinder = CylinderShape;
    constexpr std::string_view kRadius = "Its radius.";
    return {variant<Plane>("plane", "An infinite plane.",
                           {{"point", &Plane::point, kCoordinate, "m", "A point on the plane."},
                            {"normal", &Plane::normal, kCoordinate, "", "Normal of the plane, of any length.",
                             kRequired, kNotZero}}),
            variant("mesh", "A triangle mesh from a file, open or closed.", mesh_fields()),
            placed_variant<BallShape>("sphere",
                                      "A ball about its own origin. It is an ellipsoid if the scale differs by axis.",
                                      {{"radius", &BallShape::radius, kLength, "m", kRadius, kRequired}}),
            placed_variant<Cylinder>("cylinder",
                                     "A cylinder with flat caps about its own z axis, centred on its own origin.",
                                     {{"radius", &Cylinder::radius, kLength, "m", kRadius, kRequired},
                                      {"height", &Cylinder::height, kLength, "m", "Its height.", kRequired}}),
            placed_variant<CuboidShape>("box", "A box centred on its own origin.",
                                        {{"size", &CuboidShape::size, kLength, "m", "Full edge lengths.", kRequired}})};
}

const ObjectSpec& surface_motion_spec() {
    static const ObjectSpec spec =
        object("surface motion",
               "Motion of the surface material while the geometry stands still: a conveyor belt, or the wall of a "
               "drum that turns about its own axis. Friction, rolling and spinning resistance, and diffuse "
               "reflection act relative to it. Only the velocity component along the surface counts.",
               fields_of<SurfaceMotion>(kSurfaceMotionTable));
    return spec;
}

const ObjectSpec& impact_table_row_spec() {
    static const ObjectSpec spec =
        object<ImpactTableRow>("row of an impact table", "Coefficients of impacts at one speed and angle.",
                               fields_of<ImpactTableRow>(kImpactTableRowTable));
    return spec;
}

class ColliderBuilder {
public:
    ColliderBuilder(SceneContext& context, SimulationSetup& setup, std::vector<FrameDescription>& frames)
        : context_(context), setup_(setup), frames_(frames), scene_frames_(frames) {}

    void build() {
        build_materials();
        std::set<std::string> taken;
        for (const ObjectView& view : context_.objects("colliders")) {
            ColliderDescription collider;
            collider.name = context_.unique_name(view, setup_.colliders.size(), "collider", taken);
            collider.material = material_of(view);
            collider.shape = shape_of(view, collider.material);
            collider.frame = frame_of(view, collider);
            setup_.colliders.push_back(std::move(collider));
        }
        warn_about_unused_materials();
    }

private:
    void build_materials() {
        for (const NamedObject& named : context_.root().named_objects("materials")) {
            setup_.materials.push_back(named.view.read<Material>());
            if (named.view.has("surface_motion")) {
                setup_.materials.back().motion = named.view.object("surface_motion").read<SurfaceMotion>();
                warn_about_idle_motion(named.view, setup_.materials.back());
            }
            check_impact_law(named.view, setup_.materials.back());
            setup_.materials.back().name = named.name;
        }
        used_.resize(setup_.materials.size(), false);
    }

    void warn_about_idle_motion(const ObjectView& view, const Material& material) {
        if (material.motion.is_none() || material.drives()) return;
        context_.warn(view, "surface_motion",
                      "nothing comes of it without friction, resistance to rolling or spinning, or diffuse reflection");
    }

    void warn_about_idle_law(const ObjectView& view, const Material& material) {
        const auto reverses = [](const ImpactTableRow& row) { return row.tangential_restitution.value_or(0.0) > 0.0; };
        const bool has_row = std::ranges::any_of(material.impact_table, reverses);
        if ((material.tangential_restitution > 0.0 || has_row) && material.friction == 0.0) {
            context_.warn(view, has_row ? "impact_table" : "tangential_restitution",
                          "nothing comes of a tangential restitution without friction");
        }
        if (!material.impact_table.empty() && view.has("restitution")) {
            context_.warn(view, "restitution", "the impact_table is used instead");
        }
    }

    void check_impact_law(const ObjectView& view, const Material& material) {
        if (!material.impact_table.empty() && !is_grid(material.impact_table)) {
            context_.error(view, "impact_table",
                           "the rows are no grid, expected the same angles at each speed, in ascending order, first by "
                           "speed, then by angle");
        }
        if (!material.impact_table.empty() && material.restitution_speed) {
            context_.error(view, "restitution_speed", "found beside an impact_table, expected one of them");
        }
        if (material.static_friction && !(*material.static_friction >= material.friction && material.friction > 0.0)) {
            context_.error(
                view, "static_friction",
                material.friction > 0.0
                    ? fmt::format("found {:g}, expected at least the friction {:g}", *material.static_friction,
                                  material.friction)
                    : "found without a friction above 0, expected both keys: a contact that slips has the friction");
        }
        warn_about_idle_law(view, material);
        if (setup_.options.response == ResponseKind::penalty && material.needs_instant_impacts()) {
            context_.error(
                view,
                "its tangential restitution, tangential factor, static friction, restitution speed or impact "
                "table does not go together with the response \"penalty\", whose contacts last: expected another "
                "response");
        }
    }

    // Returns the index of a collider's material. All colliders without a material share a perfect one, which is
    // appended to the scene's materials.
    std::uint32_t material_of(const ObjectView& view) {
        if (!view.has("material")) {
            if (setup_.materials.size() == used_.size()) setup_.materials.emplace_back();
            return static_cast<std::uint32_t>(used_.size());
        }
        return index_of_material(view.text("material"), view.location_of("material"), view.path_of("material"));
    }

    // Returns the index of the material with this name, and marks it as used. Returns 0 after reporting an unknown
    // name.
    std::uint32_t index_of_material(const std::string& name, const SourceLocation& location, const std::string& path) {
        std::vector<std::string_view> names;
        for (std::size_t i = 0; i < used_.size(); ++i) {
            names.push_back(setup_.materials[i].name);
            if (names.back() != name) continue;
            used_[i] = true;
            return static_cast<std::uint32_t>(i);
        }
        context_.diagnostics().error(location, path, unknown_name("material", name, names));
        return 0;
    }

    // Returns the material index of every triangle. The list is empty if all triangles have the collider's own
    // material. otherwise: index of the collider's own material.
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
                context_.diagnostics().error(member.key_location, path, unknown_group(member.key, known));
            }
            if (member.value.text() == nullptr) continue;  // the text has already been reported
            named.materials[member.key] = index_of_material(*member.value.text(), member.value.location, path);
        }
        TriangleMaterials result = materials_by_group(*groups, named);
        warn_about_unused_groups(view, *members, result.names_not_used, known);
        return std::move(result.materials);
    }

    static std::string without_groups(const MeshGroups& groups) {
        if (groups.format_has_groups()) {
            return "the mesh has no groups (no material, group or object with a name), leave this key out";
        }
        return fmt::format("the mesh is a file of the format {}, which has no groups; expected OBJ, glTF or ASCII STL",
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

    // Warns of group names that select no triangle's material, because other names of the same faces have priority.
    void warn_about_unused_groups(const ObjectView& view, const JsonNode::Object& members,
                                  const std::vector<std::string_view>& not_used,
                                  const std::vector<std::string_view>& known) {
        for (const JsonMember& member : members) {
            if (std::find(not_used.begin(), not_used.end(), member.key) == not_used.end()) continue;
            if (std::find(known.begin(), known.end(), member.key) == known.end()) continue;
            context_.diagnostics().warning(member.key_location,
                                           path_of_key(view.path_of("group_materials"), member.key),
                                           "no triangle takes this material: all faces of the group also have a name "
                                           "that comes before (material before group before object)");
        }
    }

    ColliderShape shape_of(const ObjectView& view, std::uint32_t material) {
        if (view.type().empty()) return PlaneShape{};  // the type has already been reported
        if (view.type() == "plane") return view.read<PlaneShape>();
        if (view.type() == "sphere") return view.read<BallShape>();
        if (view.type() == "cylinder") return view.read<CylinderShape>();
        if (view.type() == "box") return view.read<CuboidShape>();
        MeshShape mesh = view.read<MeshShape>();
        if (view.has("file")) mesh.file = context_.file_of(view).string();
        mesh.mesh = context_.load_mesh(view);
        mesh.motion = deformation_of(context_, view);
        mesh.triangle_materials = triangle_materials(view, material);
        return mesh;
    }

    // Reports a key if the response, or a flow that carries the particles, does not support moving colliders.
    // colliders, by_flow: parts of the messages.
    void require_exact(const ObjectView& view, std::string_view key, std::string_view colliders,
                       std::string_view by_flow) {
        if (setup_.options.response != ResponseKind::exact) {
            context_.error(view, key,
                           fmt::format("the response \"{}\" knows no {}, expected none, or \"exact\"",
                                       name_of(setup_.options.response), colliders));
        } else if (setup_.options.flow) {
            context_.error(view, key, fmt::format("particles that a flow carries {}, expected none", by_flow));
        }
    }

    // Returns the name of the collider's frame. If the collider has motion keys of its own, a frame is added for them.
    // A collider that is scaled over time becomes a deforming mesh.
    std::string frame_of(const ObjectView& view, ColliderDescription& collider) {
        if (view.has("deformation")) {
            for (const char* key : {"frame", "motion"}) {
                if (view.has(key)) context_.error(view, key, "a mesh that deforms stands in the world, expected none");
            }
            require_exact(view, "deformation", "meshes that deform", "cannot hit meshes that deform");
            return {};
        }
        std::string parent;
        if (view.has("frame") && is_frame_named(context_, view, scene_frames_)) parent = view.text("frame");
        if (!parent.empty() || view.has("motion")) {
            require_exact(view, parent.empty() ? "motion" : "frame", "colliders that move",
                          "know no colliders that move");
        }
        FrameDescription frame;
        if (view.has("motion")) frame = frame_through(view.objects("motion"), context_.diagnostics());
        frame.name = "motion of " + collider.name;
        while (scene_frames_.find(frame.name)) frame.name += "'";
        frame.parent = parent;
        if (stretch(context_, view, setup_.options, scene_frames_, frame, collider)) return {};
        if (!view.has("motion")) return parent;
        frames_.push_back(frame);
        return frame.name;
    }

    void warn_about_unused_materials() {
        const std::vector<NamedObject> materials = context_.root().named_objects("materials");
        for (std::size_t i = 0; i < used_.size(); ++i) {
            if (used_[i]) continue;
            context_.diagnostics().warning(materials[i].name_location, materials[i].view.path(),
                                           "no collider uses this material");
        }
    }

    SceneContext& context_;
    SimulationSetup& setup_;
    std::vector<FrameDescription>& frames_;
    FrameTree scene_frames_;
    std::vector<bool> used_;  // flag for each material of the scene: true if it is used
};

}  // namespace

const ObjectSpec& material_spec() {
    static const ObjectSpec spec = object(
        "material", "Response of a surface to impacts and contacts.",
        joined<Material>({fields_of<Material>(kMaterialTable),
                          fields_of<Material>(kImpactLawTable<Material>),
                          fields_of<Material>(kSurfaceLawTable),
                          {{"impact_table", &Material::impact_table,
                            "Coefficients by impact speed and angle, in place of `restitution` and "
                            "`restitution_speed`. The rows are a grid: the same angles at each speed, in "
                            "ascending order, first by speed. Values between rows are linear in speed and angle, "
                            "and constant outside.",
                            &impact_table_row_spec()},
                           {"surface_motion", ValueType::object, "Motion of the surface material.",
                            Without{"the material is at rest"}, &surface_motion_spec()}}}));
    return spec;
}

const ObjectSpec& rotation_spec() {
    using R = RotationTarget;
    static const ObjectSpec spec = object<R>(
        "rotation", "A rotation about an axis through the object's own origin, by the right-hand rule.",
        {{"axis", [](R& r) -> Vec3& { return r.axis; }, kCoordinate, "", "Direction of the axis, of any length.",
          kRequired, kNotZero},
         {"degrees", [](R& r) -> double& { return r.degrees; }, kAnyNumber, "degrees", "Rotation angle.", kRequired}});
    return spec;
}

const ObjectSpec& collider_spec() {
    static const ObjectSpec spec = object<Unbound>(
        "collider", "A surface that particles bounce off. Both sides are solid.",
        {{"name", ValueType::text, "Unique name for messages, reports and emitters.",
          Without{"made from type and index in the list"}},
         {"material", ValueType::text, "Name of a material in `materials`.", Without{"restitution 1, no friction"}},
         {"looks", ValueType::object, "Appearance in pictures.", Without{"the renderer's own colours"},
          &collider_looks_spec()},
         {"frame", ValueType::text,
          "Name of a frame in `frames`. The collider stands in it and moves with it. Requires the response \"exact\".",
          Without{"the world"}},
         {"motion", ValueType::list,
          "Poses that the collider moves through, in order of time: `{\"time\": ..., \"position\": ..., "
          "\"rotation\": ..., \"scale\": ...}`. At least one pose is required. The poses are relative to `frame` if "
          "that key is present. The collider's own position and rotation are relative to the poses.",
          Without{"it does not move by itself"}, kNotEmpty, &key_pose_spec()}},
        collider_shapes());
    return spec;
}

void build_colliders(SceneContext& context, SimulationSetup& setup, std::vector<FrameDescription>& frames) {
    ColliderBuilder(context, setup, frames).build();
}

}  // namespace ricochet::detail
