/// \file
/// The parts of a scene: the table of keys of each, what builds each, and what all of these need.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/error.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/keyed_curve.h"
#include "ricochet/core/transform.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/scene/diagnostics.h"
#include "ricochet/io/scene/fields.h"
#include "ricochet/io/scene/files.h"

namespace ricochet::detail {

/// Where the document and its files are, and where to report.
class SceneContext {
public:
    SceneContext(const JsonNode& root, std::filesystem::path folder, Diagnostics& diagnostics);

    [[nodiscard]] const ObjectView& root() const { return root_; }
    [[nodiscard]] Diagnostics& diagnostics() const { return diagnostics_; }
    /// True when something was refused already; defaults may stand instead of it.
    [[nodiscard]] bool failed() const { return diagnostics_.failed(); }

    /// The objects of one of the scene's lists, with the paths that messages give them.
    [[nodiscard]] std::vector<ObjectView> objects(std::string_view list) const { return root_.objects(list); }

    void error(const ObjectView& view, std::string_view key, const std::string& what) const;
    void error(const ObjectView& view, const std::string& what) const;
    void warn(const ObjectView& view, std::string_view key, const std::string& what) const;
    void warn(const ObjectView& view, const std::string& what) const;

    /// The path that the key "file" means; noted among files().
    [[nodiscard]] std::filesystem::path file_of(const ObjectView& view) const;
    /// That which a name means.
    [[nodiscard]] std::filesystem::path path_of_file(const std::string& name) const {
        return (folder_ / name).lexically_normal();
    }
    /// Among files().
    void note(const std::filesystem::path& path) const { files_.insert(path); }
    /// Notes memory that the scene itself holds, bytes.
    void add_memory(double bytes) const { memory_bytes_ += bytes; }
    /// All that was noted.
    [[nodiscard]] double memory_bytes() const { return memory_bytes_; }
    /// Every path that file_of() has given, each once.
    [[nodiscard]] std::vector<std::filesystem::path> files() const { return {files_.begin(), files_.end()}; }
    /// The mesh that the key "file" names, with the axis up that "up" says; null pointer after reporting why there is
    /// none.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> load_mesh(const ObjectView& view);
    /// A mesh in world coordinates; null pointer after reporting, for this key, that a vertex is out of range.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> placed_mesh(const ObjectView& view, std::string_view key,
                                                                  const TriangleMesh& mesh,
                                                                  const Placement& placement) const;
    /// The groups of the mesh that the key "file" names; null pointer where load_mesh() gives one.
    [[nodiscard]] const MeshGroups* load_groups(const ObjectView& view);

    /// The name given, or one made from the type and the index in the list; reports a name that is taken.
    [[nodiscard]] std::string unique_name(const ObjectView& view, std::size_t index, std::string_view kind,
                                          std::set<std::string>& taken) const;

private:
    /// Warns of an implausible size of a mesh, unless a scale is stated.
    void warn_of_size(const ObjectView& view, const TriangleMesh& mesh, const std::filesystem::path& path) const;

    ObjectView root_;
    std::filesystem::path folder_;
    Diagnostics& diagnostics_;
    MeshLibrary meshes_;
    mutable std::set<std::filesystem::path> files_;
    mutable double memory_bytes_ = 0.0;
};

/// `there is no material "ruber"; did you mean "rubber"?`
[[nodiscard]] std::string unknown_name(std::string_view kind, const std::string& name,
                                       const std::vector<std::string_view>& known);

// The tables of keys.

/// The whole scene.
[[nodiscard]] const ObjectSpec& scene_spec();
[[nodiscard]] const ObjectSpec& flow_spec();
[[nodiscard]] const ObjectSpec& force_spec();
[[nodiscard]] const ObjectSpec& particle_force_spec();
[[nodiscard]] const ObjectSpec& heat_spec();
[[nodiscard]] const ObjectSpec& particle_contacts_spec();
[[nodiscard]] const ObjectSpec& material_spec();
[[nodiscard]] const ObjectSpec& collider_spec();
[[nodiscard]] const ObjectSpec& frame_spec();
[[nodiscard]] const ObjectSpec& body_spec();
[[nodiscard]] const ObjectSpec& emitter_spec();
[[nodiscard]] const ObjectSpec& particle_spec();
/// {"file": ...} instead of a particle list.
[[nodiscard]] const ObjectSpec& particle_file_spec();
[[nodiscard]] const ObjectSpec& springs_spec();
[[nodiscard]] const ObjectSpec& camera_spec();
[[nodiscard]] const ObjectSpec& picture_spec();
[[nodiscard]] const ObjectSpec& collider_looks_spec();
/// A declared attribute: `{"components": ..., "default": ...}`.
[[nodiscard]] const ObjectSpec& attribute_spec();
/// {"lower": ..., "upper": ...}, which sets a Box3.
[[nodiscard]] Fields<Box3> box_fields(std::string_view upper_meaning);

inline constexpr Range kFieldOfView = between(1.0, 170.0);
inline constexpr std::string_view kFieldOfViewMeaning = "Angle from the lower to the upper edge.";
/// Reports a camera, whose keys the view has, that stands on its own target.
void refuse_camera_on_target(const SceneContext& context, const ObjectView& view);

/// The members of a placement or a frame that a turn about an axis sets.
struct RotationTarget {
    Vec3& axis;
    double& degrees;
};
[[nodiscard]] const ObjectSpec& rotation_spec();

/// position, rotation and scale, which set a Placement that is a member. needs: the key that must stand beside them.
template <class Struct>
[[nodiscard]] Fields<Struct> placement_fields(Placement Struct::*placement, Needs needs = {}) {
    return {{"position", [placement](Struct& s) -> Vec3& { return (s.*placement).position; }, kCoordinate, "m",
             "Where its origin is put; scale and rotation come first.", needs},
            {"rotation",
             [placement](Struct& s) {
                 return RotationTarget{(s.*placement).rotation_axis, (s.*placement).rotation_degrees};
             },
             "Turns it.", Without{"not turned"}, needs, &rotation_spec()},
            {"scale", [placement](Struct& s) -> Vec3& { return (s.*placement).scale; }, kCoordinate, "",
             "Factor, or one for each of its own axes; a negative one mirrors.", ValueType::scale, needs}};
}

inline constexpr std::string_view kMeshFileMeaning = "The mesh: OBJ, PLY, STL, OFF or glTF (.gltf, .glb).";

/// The axis of a mesh file that points up, for load_mesh().
template <class Struct>
[[nodiscard]] Field<Struct> up_field(Needs needs = {}) {
    return {"up",
            ValueType::choice,
            "Axis of the file that points up; z does in scenes. Where y does, (x, y, z) is read as (x, -z, y), before "
            "the scale.",
            Choices{choice(MeshUp::z, "z", "coordinates are taken as they are in the file"),
                    choice(MeshUp::y, "y", "a quarter turn about x")},
            Without{"`y` for glTF files, as their standard says, `z` for all others"},
            needs};
}
/// What the key "up" of an object says.
[[nodiscard]] MeshUp up_of(const ObjectView& view);

/// {"interpolation": ..., "keys": [{"time": ..., "value": NUMBER}], "ends": ...}; the unit is that of the key that
/// holds the curve.
[[nodiscard]] const ObjectSpec& number_curve_spec();
/// The same with "value": [x, y, z].
[[nodiscard]] const ObjectSpec& vector_curve_spec();
/// The same with "value": a factor above 0, or [x, y, z] of these.
[[nodiscard]] const ObjectSpec& scale_curve_spec();
/// The curve of an object of number_curve_spec(). What is wrong is reported with its path ("frames.arm.motions[0]"),
/// and a constant zero returned.
[[nodiscard]] KeyedCurve<double> number_curve_of(const ObjectView& view, Diagnostics& diagnostics);
[[nodiscard]] KeyedCurve<Vec3> vector_curve_of(const ObjectView& view, Diagnostics& diagnostics);

/// color, opacity, particle_size, attributes, over_life and over_age of an emitter; read by read_looks().
[[nodiscard]] std::vector<KeySpec> emitter_look_keys();
/// color, opacity, size and attributes of an explicit particle; read by particle_values().
[[nodiscard]] std::vector<KeySpec> particle_look_keys();

// What builds the parts, in the order in which they are built.

/// Builds the scene from a document that check_scene() has seen, and reports what only shows here: names that refer to
/// nothing, files, values that contradict each other. folder: where relative paths begin.
[[nodiscard]] SceneDescription build_scene(const JsonNode& root, const std::filesystem::path& folder,
                                           Diagnostics& diagnostics);

/// Makes the forces and flows.
class ForceBuilder {
public:
    explicit ForceBuilder(const SceneContext& context);

    /// The forces that could be made; reports what is wrong with the others.
    [[nodiscard]] std::vector<std::unique_ptr<Force>> forces() const;
    /// What the key "flow" says: an object, or the name of one. Null pointer where there is none, or after reporting.
    [[nodiscard]] FlowPointer flow_at(const ObjectView& view) const;

private:
    [[nodiscard]] FlowPointer flow(const ObjectView& view) const;
    [[nodiscard]] FlowPointer sum_of(const ObjectView& view) const;

    const SceneContext& context_;
    std::map<std::string, FlowPointer, std::less<>> flows_;
};

/// Where the vertices of a mesh that deforms are in time: a key of colliders of the type mesh.
[[nodiscard]] const ObjectSpec& deformation_spec();
/// What a collider's key "deformation" says; null pointer where there is none, or after reporting.
[[nodiscard]] std::shared_ptr<const MeshMotion> deformation_of(SceneContext& context, const ObjectView& collider);

/// Where its own frame, which is not one of `frames`, or one that this stands on, scales a collider, makes it the mesh
/// that deforms so; false where none does. Reports shapes that keep their size.
[[nodiscard]] bool stretch(SceneContext& context, const ObjectView& view, const SimulationOptions& options,
                           const FrameTree& frames, const FrameDescription& own, ColliderDescription& collider);

/// frames: those of the scene; the ones that colliders move in by their own keys are added.
void build_colliders(SceneContext& context, SimulationSetup& setup, std::vector<FrameDescription>& frames);
/// The bodies among the frames, with the mass of the colliders that stand in them.
void build_bodies(const SceneContext& context, SimulationSetup& setup, const std::vector<FrameDescription>& frames);
/// The declared attributes, and those of appearance that emitters and explicit particles use. Reports names and
/// defaults that cannot be.
void build_attributes(const SceneContext& context, SimulationSetup& setup);
/// The scene's frames; without errors so far only, their parents too.
[[nodiscard]] std::vector<FrameDescription> frames_of(const SceneContext& context);
/// The keys of a frame that a collider has for itself, and what they say.
[[nodiscard]] const ObjectSpec& key_pose_spec();
[[nodiscard]] FrameDescription frame_through(const std::vector<ObjectView>& keys, Diagnostics& diagnostics);
/// True when a key "frame" names one of them; reports otherwise.
[[nodiscard]] bool is_frame_named(const SceneContext& context, const ObjectView& view, const FrameTree& frames);
/// In setup.frames.
void build_emitters(SceneContext& context, SimulationSetup& setup);
/// The shapes of emitters that need no file: keys and values. One that was refused is a point.
[[nodiscard]] std::vector<Variant> simple_shapes();
[[nodiscard]] EmitterShape simple_shape_of(const ObjectView& view);
/// The key "cloud" of an emitter of type child.
[[nodiscard]] const ObjectSpec& cloud_spec();
/// Emitters whose particles are born of particles: their keys, their rule (the parent's number is found when all are
/// known), and what shows when they are.
[[nodiscard]] Variant child_variant();
[[nodiscard]] ParentRule rule_of(const SceneContext& context, const ObjectView& view,
                                 const EmitterDescription& emitter);
void check_parents(const SceneContext& context, SimulationSetup& setup);
/// After all else of the setup: refuses what does not go together with clouds.
void check_clouds(const SceneContext& context, const SimulationSetup& setup);
/// Sets an emitter's attributes and curves; reports those that are not declared or have other components.
void read_looks(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                EmitterDescription& emitter);
void build_particles(SceneContext& context, SimulationSetup& setup);
/// What spheres do when they meet; before the attributes, which hold their materials.
void read_particle_contacts(const SceneContext& context, SimulationOptions& options);
/// After the springs: refuses what does not go together with spheres that meet.
void check_particle_contacts(const SceneContext& context, const SimulationSetup& setup);
/// The value of kMaterialAttribute that an emitter's or a particle's key "material" says; nothing where it has none, or
/// after reporting.
[[nodiscard]] std::optional<AttributeValue> material_of(const SceneContext& context, const SimulationSetup& setup,
                                                        const ObjectView& view);
/// After the attributes, bodies and emitters.
void build_particle_forces(const SceneContext& context, SimulationSetup& setup);
/// After all else of the setup.
void build_heat(const SceneContext& context, const ForceBuilder& forces, SimulationSetup& setup);
/// The values of an explicit particle, one a column; empty when the scene has no columns.
[[nodiscard]] std::vector<AttributeValue> particle_values(const SceneContext& context, const SimulationSetup& setup,
                                                          const ObjectView& view);
/// After the particles: adds those of ropes, chains and cloth behind them.
void build_springs(SceneContext& context, SimulationSetup& setup);
/// Sets what a run needs, and reports the part that asks for most where it is more than this process may have, and
/// bursts that are larger than the population may be.
void check_memory(const SceneContext& context, SceneDescription& scene);
/// The key "drawing" of an emitter.
[[nodiscard]] const ObjectSpec& drawing_spec();
/// Which of the scene's drawings an emitter that has this key brings, from 1 on.
[[nodiscard]] std::size_t drawing_number(const SceneContext& context, const ObjectView& emitter);
/// The camera, the picture's settings and the emitters' drawings; after the frames.
void build_pictures(const SceneContext& context, SceneDescription& scene);
/// Ids of a list that no particle of the setup has or will have.
void warn_of_unknown_ids(const SceneContext& context, const ObjectView& view, const SimulationSetup& setup,
                         std::span<const std::uint64_t> ids);
/// The same of the scene's forces on single particles.
void warn_of_forces_on_nobody(const SceneContext& context, const SimulationSetup& setup);
/// Forces that grow with a particle's radius, in a scene of points only.
void warn_of_forces_without_radius(const SceneContext& context, const SimulationSetup& setup);

// Tables of particles.

/// What a table holds, and what is wrong with it.
struct ParticleTable {
    std::vector<Particle> particles;
    std::vector<std::string> errors;  ///< "start.csv:12: found ..., expected ..."; the first few
    std::vector<AttributeDescription>
        attributes;                           ///< those that were declared, and those of appearance that the table has
    std::vector<std::string> unused_columns;  ///< of a run's own final state, which mean nothing at a start
};

/// Comma-separated values: a header line with the columns x, y, z and, where wanted, vx, vy, vz, mass, radius in any
/// order, and attributes (name, or name_x, name_y, name_z): those declared, and those of appearance; then a line a
/// particle. The final state that a run writes can be read back. Never throws for bad contents.
[[nodiscard]] ParticleTable parse_particle_table(std::string_view text, const std::string& name,
                                                 std::vector<AttributeDescription> declared = {});
/// Reads a .csv file. Throws InputError when it cannot be read or is another kind of file.
[[nodiscard]] ParticleTable read_particle_table(const std::filesystem::path& path,
                                                std::vector<AttributeDescription> declared = {});

// Flows and forces by their "type": the keys of each beside its maker, and the lines that several of these tables
// share.

/// The keys of a type, and its maker from an object of these keys.
template <class Made, class... Others>
struct Law {
    Variant variant;
    std::function<Made(const ObjectView&, const Others&...)> make;
};

template <class AnyLaw>
std::vector<Variant> variants_of(const std::vector<AnyLaw>& laws) {
    std::vector<Variant> variants;
    for (const AnyLaw& law : laws) variants.push_back(law.variant);
    return variants;
}

/// Null pointer for a type that was refused.
template <class AnyLaw>
const AnyLaw* law_of(const std::vector<AnyLaw>& laws, const ObjectView& view) {
    const auto found =
        std::find_if(laws.begin(), laws.end(), [&](const AnyLaw& law) { return law.variant.name == view.type(); });
    return found == laws.end() ? nullptr : &*found;
}

/// What a maker refuses is reported with its source location. Where values were refused before, defaults stand instead
/// of them, and what is said about those means nothing.
template <class Make>
auto made(const SceneContext& context, const ObjectView& view, const Make& make) -> decltype(make()) {
    try {
        return make();
    } catch (const InputError& problem) {
        if (!context.failed()) context.error(view, problem.what());
        return nullptr;
    }
}

template <class Struct>
Field<Struct> center(Vec3 Struct::*member) {
    return {"center", member, kCoordinate, "m", "Its centre."};
}
template <class Struct>
Field<Struct> axis_point(Vec3 Struct::*member) {
    return {"point", member, kCoordinate, "m", "A point of the axis."};
}
template <class Struct>
Field<Struct> axis(Vec3 Struct::*member) {
    constexpr std::string_view kMeaning = "Direction of the axis, of any length; right-hand rule.";
    return {"axis", member, kCoordinate, "", kMeaning, kRequired, kNotZero};
}

}  // namespace ricochet::detail
