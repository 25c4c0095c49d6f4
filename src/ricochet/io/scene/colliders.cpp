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

namespace ricochet::detail {
namespace {

Fields<MeshShape> mesh_fields() {
    return joined<MeshShape>(
        {{{"file", ValueType::file, kMeshFileMeaning, kRequired}, up_field<MeshShape>()},
         placement_fields(&MeshShape::placement),
         {{"group_materials", ValueType::text_table,
           "Materials of parts of an OBJ, glTF or ASCII STL mesh: names that the file gives to its faces, each with "
           "one "
           "of the names in `materials`. A face goes by its `usemtl` name (the material's); where that is not listed "
           "by its `g` name (the whole line, then word by word; of glTF the mesh's, of ASCII STL the solid's), then by "
           "its `o` name (the node's). Faces without a listed name take the collider's material.",
           Without{"the collider's material everywhere"}},
          {"deformation", ValueType::object,
           "Its vertices move: `file` says the faces only. Only with the response \"exact\", and without `frame` and "
           "`motion`.",
           &deformation_spec(), Without{"it keeps its shape"}}}});
}

// A shape's own measures, then where it stands.
template <class Shape>
Variant placed_variant(std::string_view name, std::string_view description, const Fields<Shape>& measures) {
    return variant(name, description, joined<Shape>({measures, placement_fields(&Shape::placement)}));
}

std::vector<Variant> shapes() {
    using Plane = PlaneShape;
    using Cylinder = CylinderShape;
    constexpr std::string_view kRadius = "Its radius.";
    return {
        variant<Plane>(
            "plane", "An infinite plane.",
            {{"point", &Plane::point, kCoordinate, "m", "A point of the plane."},
             {"normal", &Plane::normal, kCoordinate, "", "Its normal, of any length.", kRequired, kNotZero}}),
        variant("mesh", "A triangle mesh from a file, open or closed.", mesh_fields()),
        placed_variant<BallShape>("sphere", "A ball about its own origin; an ellipsoid when the scale differs by axis.",
                                  {{"radius", &BallShape::radius, kLength, "m", kRadius, kRequired}}),
        placed_variant<Cylinder>("cylinder",
                                 "A cylinder with flat caps about its own z axis, its middle at the origin.",
                                 {{"radius", &Cylinder::radius, kLength, "m", kRadius, kRequired},
                                  {"height", &Cylinder::height, kLength, "m", "Its height.", kRequired}}),
        placed_variant<CuboidShape>("box", "A box about its own origin.",
                                    {{"size", &CuboidShape::size, kLength, "m", "Full edge lengths.", kRequired}})};
}

constexpr Range kSurfaceSpeed = between(-kMaxSpeed, kMaxSpeed);

const ObjectSpec& surface_motion_spec() {
    using S = SurfaceMotion;
    static const ObjectSpec spec =
        object<S>("surface motion",
                  "How the material of the surface moves while its geometry stands still: a belt, or the wall of a "
                  "drum that turns about its own axis. Friction, resistance to rolling and spinning, and diffuse "
                  "reflection are relative to it; only the part of the velocity along the surface counts.",
                  {{"velocity", &S::velocity, kSurfaceSpeed, "m/s", "The same everywhere."},
                   {"angular_velocity", &S::angular_velocity, kSurfaceSpeed, "rad/s",
                    "Turning by the right-hand rule about an axis through `center`, added to `velocity`."},
                   {"center", &S::center, kCoordinate, "m", "A point of the axis, in world coordinates."}});
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
            setup_.materials.back().name = named.name;
        }
        used_.resize(setup_.materials.size(), false);
    }

    void warn_about_idle_motion(const ObjectView& view, const Material& material) {
        if (material.motion.is_none() || material.drives()) return;
        context_.diagnostics().warning(view.location_of("surface_motion"), view.path_of("surface_motion"),
                                       "nothing comes of it without friction, resistance to rolling or spinning, or "
                                       "diffuse reflection");
    }

    // Index of a collider's material; colliders without one share a perfect one after those of the scene.
    std::uint32_t material_of(const ObjectView& view) {
        if (!view.has("material")) {
            if (setup_.materials.size() == used_.size()) setup_.materials.emplace_back();
            return static_cast<std::uint32_t>(used_.size());
        }
        return index_of_material(view.text("material"), view.location_of("material"), view.path_of("material"));
    }

    // The material of that name, which counts as used from now on; 0 after reporting that there is none.
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
                context_.diagnostics().error(member.key_location, path, unknown_group(member.key, known));
            }
            if (member.value.text() == nullptr) continue;  // refused already
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

    // A name of the mesh by which no triangle takes its material: other names of its faces come first.
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
        if (view.type().empty()) return PlaneShape{};  // refused already
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

    // What a mesh that deforms does not go together with.
    void require_exact(const ObjectView& view) {
        for (const char* key : {"frame", "motion"}) {
            if (view.has(key)) context_.error(view, key, "a mesh that deforms stands in the world, expected none");
        }
        if (setup_.options.response != ResponseKind::exact) {
            context_.error(view, "deformation",
                           fmt::format("the response \"{}\" knows no meshes that deform, expected none, or \"exact\"",
                                       name_of(setup_.options.response)));
        } else if (setup_.options.flow) {
            context_.error(view, "deformation",
                           "particles that a flow carries know no meshes that deform, expected none");
        }
    }

    // The name of the frame that it stands in; its own keys make one more. What is scaled is a mesh that deforms.
    std::string frame_of(const ObjectView& view, ColliderDescription& collider) {
        if (view.has("deformation")) {
            require_exact(view);
            return {};
        }
        std::string parent;
        if (view.has("frame") && is_frame_named(context_, view, scene_frames_)) parent = view.text("frame");
        const bool moves = !parent.empty() || view.has("motion");
        if (moves && setup_.options.response != ResponseKind::exact) {
            context_.error(view, parent.empty() ? "motion" : "frame",
                           fmt::format("the response \"{}\" knows no colliders that move, expected none, or \"exact\"",
                                       name_of(setup_.options.response)));
        } else if (moves && setup_.options.flow) {
            context_.error(view, parent.empty() ? "motion" : "frame",
                           "particles that a flow carries know no colliders that move, expected none");
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
    std::vector<bool> used_;  // one for every material of the scene
};

}  // namespace

const ObjectSpec& material_spec() {
    using M = Material;
    static const ObjectSpec spec =
        object<M>("material", "What a surface does to what hits it.",
                  {{"restitution", &M::restitution, kFraction, "",
                    "Speed of the rebound over speed of the approach, along the normal."},
                   {"restitution_threshold", &M::restitution_threshold, kNotNegative, "m/s",
                    "Below this speed of approach the restitution falls linearly to 0."},
                   {"friction", &M::friction, kNotNegative, "", "Coulomb's coefficient, for impacts and for sliding."},
                   {"rolling_friction", &M::rolling_friction, kNotNegative, "",
                    "Moment that resists rolling, over radius times normal force; for particles with a radius."},
                   {"spinning_friction", &M::spinning_friction, kLengthOrZero, "m",
                    "Moment that resists spinning about the normal, over normal force; for particles with a radius."},
                   {"diffuse", &M::diffuse, kFraction, "",
                    "Accommodation: fraction of the impacts that are reflected by the cosine law."},
                   {"wall_temperature", &M::wall_temperature, kPositive, "K",
                    "Diffuse reflections leave with the thermal speeds of a wall of this temperature.",
                    Without{"diffuse reflections keep the speed of arrival"}},
                   {"absorption", &M::absorption, kFraction, "", "Fraction of the impacts that remove the particle."},
                   {"surface_motion", ValueType::object, "How the surface's own material moves.",
                    Without{"the material is at rest"}, &surface_motion_spec()}});
    return spec;
}

const ObjectSpec& rotation_spec() {
    using R = RotationTarget;
    static const ObjectSpec spec =
        object<R>("rotation", "A turn about an axis through the own origin, by the right-hand rule.",
                  {{"axis", [](R& r) -> Vec3& { return r.axis; }, kCoordinate, "",
                    "Direction of the axis, of any length.", kRequired, kNotZero},
                   {"degrees", [](R& r) -> double& { return r.degrees; }, kAnyNumber, "degrees", "Angle.", kRequired}});
    return spec;
}

const ObjectSpec& collider_spec() {
    static const ObjectSpec spec = object<Unbound>(
        "collider", "What particles bounce off. Both sides are solid.",
        {{"name", ValueType::text, "For messages, reports and emitters; no two colliders share one.",
          Without{"made from type and index in the list"}},
         {"material", ValueType::text, "One of the names in `materials`.", Without{"restitution 1, no friction"}},
         {"looks", ValueType::object, "How pictures show it.", Without{"in the renderer's own colours"},
          &collider_looks_spec()},
         {"frame", ValueType::text,
          "One of the names in `frames`: the collider stands in it and moves with it. Only with the response "
          "\"exact\".",
          Without{"it stands in the world"}},
         {"motion", ValueType::list,
          "A frame of its own: poses in the order of time, at least one, each `{\"time\": ..., \"position\": ..., "
          "\"rotation\": ..., \"scale\": ...}`, within `frame` where that is given too. The collider's own position "
          "and rotation are within that.",
          Without{"it does not move by itself"}, kNotEmpty, &key_pose_spec()}},
        shapes());
    return spec;
}

void build_colliders(SceneContext& context, SimulationSetup& setup, std::vector<FrameDescription>& frames) {
    ColliderBuilder(context, setup, frames).build();
}

}  // namespace ricochet::detail
