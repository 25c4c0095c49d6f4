/// \file
/// Parts of a scene: their tables of keys, the functions that build them, and shared helper functions.
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

/// The document, the folder of its files, and the diagnostics that collect its errors.
class SceneContext {
public:
    SceneContext(const JsonNode& root, std::filesystem::path folder, Diagnostics& diagnostics);

    [[nodiscard]] const ObjectView& root() const { return root_; }
    [[nodiscard]] Diagnostics& diagnostics() const { return diagnostics_; }
    /// Returns true if an error has been reported. Refused values may then have been replaced by defaults.
    [[nodiscard]] bool failed() const { return diagnostics_.failed(); }

    /// Returns the objects of a list of the scene, with their paths for messages.
    [[nodiscard]] std::vector<ObjectView> objects(std::string_view list) const { return root_.objects(list); }

    void error(const ObjectView& view, std::string_view key, const std::string& what) const;
    void error(const ObjectView& view, const std::string& what) const;
    void warn(const ObjectView& view, std::string_view key, const std::string& what) const;
    void warn(const ObjectView& view, const std::string& what) const;

    /// Returns the path given by the key "file", and adds it to files().
    [[nodiscard]] std::filesystem::path file_of(const ObjectView& view) const;
    /// Returns the path of a file. name: path relative to the scene's folder.
    [[nodiscard]] std::filesystem::path path_of_file(const std::string& name) const {
        return (folder_ / name).lexically_normal();
    }
    /// Adds a path to files().
    void note(const std::filesystem::path& path) const { files_.insert(path); }
    /// Adds memory that the scene description occupies, in bytes.
    void add_memory(double bytes) const { memory_bytes_ += bytes; }
    [[nodiscard]] double memory_bytes() const { return memory_bytes_; }
    /// Returns all added paths, without duplicates.
    [[nodiscard]] std::vector<std::filesystem::path> files() const { return {files_.begin(), files_.end()}; }
    /// Loads the mesh of the keys "file" and "up". Returns a null pointer after reporting an error.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> load_mesh(const ObjectView& view);
    /// Returns a mesh with its placement applied. Returns a null pointer after reporting a vertex out of range.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> placed_mesh(const ObjectView& view, std::string_view key,
                                                                  const TriangleMesh& mesh,
                                                                  const Placement& placement) const;
    /// Returns the groups of the mesh of the key "file". Returns a null pointer if load_mesh() does.
    [[nodiscard]] const MeshGroups* load_groups(const ObjectView& view);

    /// Returns the object's name, or a name made from its kind and its index. Reports a name that is in `taken`.
    [[nodiscard]] std::string unique_name(const ObjectView& view, std::size_t index, std::string_view kind,
                                          std::set<std::string>& taken) const;

private:
    /// Warns if the size of a mesh is implausible, unless the object has a scale.
    void warn_of_size(const ObjectView& view, const TriangleMesh& mesh, const std::filesystem::path& path) const;

    ObjectView root_;
    std::filesystem::path folder_;
    Diagnostics& diagnostics_;
    MeshLibrary meshes_;
    mutable std::set<std::filesystem::path> files_;
    mutable double memory_bytes_ = 0.0;
};

/// Returns a message such as `there is no material "ruber"; did you mean "rubber"?`.
[[nodiscard]] std::string unknown_name(std::string_view kind, const std::string& name,
                                       const std::vector<std::string_view>& known);

// Tables of keys.

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
/// Table of the object that a drawn value can be.
[[nodiscard]] const ObjectSpec& distribution_spec();
[[nodiscard]] const ObjectSpec& particle_spec();
/// Table of the object {"file": ...}, which can replace a list of particles.
[[nodiscard]] const ObjectSpec& particle_file_spec();
[[nodiscard]] const ObjectSpec& springs_spec();
[[nodiscard]] const ObjectSpec& counter_spec();
[[nodiscard]] const ObjectSpec& histogram_spec();
[[nodiscard]] const ObjectSpec& camera_spec();
[[nodiscard]] const ObjectSpec& picture_spec();
[[nodiscard]] const ObjectSpec& collider_looks_spec();
[[nodiscard]] const ObjectSpec& attribute_spec();
/// Returns the keys `lower` and `upper` of a box.
[[nodiscard]] Fields<Box3> box_fields(std::string_view upper_meaning);

inline constexpr Range kFieldOfView = between(1.0, 170.0);
inline constexpr std::string_view kFieldOfViewMeaning = "Angle from the lower to the upper edge.";
/// Reports a camera whose position equals its target. view: object with the keys of the camera.
void refuse_camera_on_target(const SceneContext& context, const ObjectView& view);

/// Members of a placement or a frame that the key of a rotation sets.
struct RotationTarget {
    Vec3& axis;
    double& degrees;
};
[[nodiscard]] const ObjectSpec& rotation_spec();

/// Returns the keys position, rotation and scale of a placement. needs: key that must also be present.
template <class Struct>
[[nodiscard]] Fields<Struct> placement_fields(Placement Struct::*placement, Needs needs = {}) {
    return {
        {"position", [placement](Struct& s) -> Vec3& { return (s.*placement).position; }, kCoordinate, "m",
         "Position of its origin. Scale and rotation are applied first.", needs},
        {"rotation",
         [placement](Struct& s) {
             return RotationTarget{(s.*placement).rotation_axis, (s.*placement).rotation_degrees};
         },
         "Rotation about its origin.", Without{"no rotation"}, needs, &rotation_spec()},
        {"scale", [placement](Struct& s) -> Vec3& { return (s.*placement).scale; }, kCoordinate, "",
         "Scale factor, or one factor for each of its own axes. A negative factor mirrors.", ValueType::scale, needs}};
}

inline constexpr std::string_view kMeshFileMeaning = "Mesh file: OBJ, PLY, STL, OFF or glTF (.gltf, .glb).";

/// Returns the key for the upward axis of a mesh file.
template <class Struct>
[[nodiscard]] Field<Struct> up_field(Needs needs = {}) {
    return {"up",
            ValueType::choice,
            "Axis of the file that points up. In scenes it is z. With y, (x, y, z) is read as (x, -z, y), before the "
            "scale.",
            Choices{choice(MeshUp::z, "z", "coordinates are used as they are in the file"),
                    choice(MeshUp::y, "y", "coordinates are rotated by 90 degrees about x")},
            Without{"`y` for glTF files, as their standard says; `z` for all others"},
            needs};
}
/// Returns the value of the key "up" of an object.
[[nodiscard]] MeshUp up_of(const ObjectView& view);

[[nodiscard]] const ObjectSpec& number_curve_spec();
[[nodiscard]] const ObjectSpec& vector_curve_spec();
[[nodiscard]] const ObjectSpec& scale_curve_spec();
/// Return the curve of an object of number_curve_spec() or vector_curve_spec(), or the constant 0 after reporting an
/// error.
[[nodiscard]] KeyedCurve<double> number_curve_of(const ObjectView& view, Diagnostics& diagnostics);
[[nodiscard]] KeyedCurve<Vec3> vector_curve_of(const ObjectView& view, Diagnostics& diagnostics);

/// Returns the keys of an emitter for appearance and attributes. read_looks() reads their values.
[[nodiscard]] Fields<EmitterDescription> emitter_look_fields();
/// Returns the keys of an explicit particle for appearance and attributes. particle_values() reads their values.
[[nodiscard]] Fields<Particle> particle_look_fields();

// Functions that build the parts of a scene.

/// Builds the scene from a checked document. Reports unknown names, faults of files, and contradictory values. folder:
/// folder to which paths are relative.
[[nodiscard]] SceneDescription build_scene(const JsonNode& root, const std::filesystem::path& folder,
                                           Diagnostics& diagnostics);

/// Builder of forces and flows.
class ForceBuilder {
public:
    explicit ForceBuilder(const SceneContext& context);

    /// Returns all valid forces, and reports the others.
    [[nodiscard]] std::vector<std::unique_ptr<Force>> forces() const;
    /// Returns the flow that the key "flow" describes or names. Returns a null pointer if the key is absent or invalid.
    [[nodiscard]] FlowPointer flow_at(const ObjectView& view) const;

private:
    [[nodiscard]] FlowPointer flow(const ObjectView& view) const;
    [[nodiscard]] FlowPointer sum_of(const ObjectView& view) const;

    const SceneContext& context_;
    std::map<std::string, FlowPointer, std::less<>> flows_;
};

[[nodiscard]] const ObjectSpec& deformation_spec();
/// Returns the motion of a collider's key "deformation". Returns a null pointer if the key is absent or invalid.
[[nodiscard]] std::shared_ptr<const MeshMotion> deformation_of(SceneContext& context, const ObjectView& collider);

/// Converts a collider to a deforming mesh if its frame or a parent of this frame is scaled. Returns false if no frame
/// is scaled. Reports shapes that cannot be scaled. own: frame of the collider's own keys, which is not in `frames`.
[[nodiscard]] bool stretch(SceneContext& context, const ObjectView& view, const SimulationOptions& options,
                           const FrameTree& frames, const FrameDescription& own, ColliderDescription& collider);

/// Builds the colliders. frames: frames of the scene, to which frames from the colliders' own keys are added.
void build_colliders(SceneContext& context, SimulationSetup& setup, std::vector<FrameDescription>& frames);
/// Builds the bodies of all driven frames, from the colliders in these frames.
void build_bodies(const SceneContext& context, SimulationSetup& setup, const std::vector<FrameDescription>& frames);
/// Builds the declared attributes, and the appearance attributes that emitters and explicit particles use.
void build_attributes(const SceneContext& context, SimulationSetup& setup);
/// Returns the scene's frames. After an error, the returned frames have no parents.
[[nodiscard]] std::vector<FrameDescription> frames_of(const SceneContext& context);
[[nodiscard]] const ObjectSpec& key_pose_spec();
/// Returns a frame that moves through poses.
[[nodiscard]] FrameDescription frame_through(const std::vector<ObjectView>& keys, Diagnostics& diagnostics);
/// Returns true if the key "frame" contains the name of one of these frames. Reports an unknown name.
[[nodiscard]] bool is_frame_named(const SceneContext& context, const ObjectView& view, const FrameTree& frames);
/// Reports a distribution that is unsound, or whose values leave the range. Returns true if the value can be drawn.
[[nodiscard]] bool check_drawn(const SceneContext& context, const ObjectView& view, std::string_view key,
                               const DrawnValue& value, const Range& range);
[[nodiscard]] const ObjectSpec& thermal_spec();
/// Returns the keys of an emitter that set mass, lifetime and radius.
[[nodiscard]] Fields<EmitterDescription> body_fields();
/// Reports contradictory settings of direction, velocity and mass. Sets the cone of the cosine law if it is not given,
/// and values that can be drawn in place of refused ones. Shape and parent must be set.
void check_launch(const SceneContext& context, const ObjectView& view, EmitterDescription& emitter);
/// Builds the emitters. Must run after the frames and colliders of the setup are built.
void build_emitters(SceneContext& context, SimulationSetup& setup);
/// Returns the emitter shapes that need no file, with their keys.
[[nodiscard]] std::vector<Variant> simple_shapes();
/// Returns a shape of simple_shapes(), or a point if the shape was refused.
[[nodiscard]] EmitterShape simple_shape_of(const ObjectView& view);
[[nodiscard]] const ObjectSpec& cloud_spec();
[[nodiscard]] Variant child_variant();
/// Returns the rule of an emitter of type child. check_parents() sets the number of the parent.
[[nodiscard]] ParentRule rule_of(const SceneContext& context, const ObjectView& view,
                                 const EmitterDescription& emitter);
/// Sets the parents of emitters of type child. Reports unknown names and parents whose mass is distributed twice. Warns
/// of cycles. Must run when all emitters are known.
void check_parents(const SceneContext& context, SimulationSetup& setup);
/// Reports settings that cannot be combined with clouds. Must run after all parts that clouds depend on.
void check_clouds(const SceneContext& context, const SimulationSetup& setup);
/// Sets the attributes and curves of an emitter.
void read_looks(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                EmitterDescription& emitter);
void build_particles(SceneContext& context, SimulationSetup& setup);
/// Reads the settings for contacts between spheres. Must run before build_attributes(), which needs their materials.
void read_particle_contacts(const SceneContext& context, SimulationOptions& options);
/// Reports settings that cannot be combined with contacts between spheres. Must run after build_springs().
void check_particle_contacts(const SceneContext& context, const SimulationSetup& setup);
/// Returns the value of kMaterialAttribute for the key "material". Returns nothing if the key is absent or refused.
[[nodiscard]] std::optional<AttributeValue> material_of(const SceneContext& context, const SimulationSetup& setup,
                                                        const ObjectView& view);
/// Builds the forces between particles. Must run after the attributes, bodies and emitters are built.
void build_particle_forces(const SceneContext& context, SimulationSetup& setup);
/// Builds the heat settings. Must run after all other parts of the setup are built.
void build_heat(const SceneContext& context, const ForceBuilder& forces, SimulationSetup& setup);
/// Returns the attribute values of an explicit particle, one per column.
[[nodiscard]] std::vector<AttributeValue> particle_values(const SceneContext& context, const SimulationSetup& setup,
                                                          const ObjectView& view);
/// Builds the springs. Appends the particles of ropes, chains and cloth to the particles of the scene.
void build_springs(SceneContext& context, SimulationSetup& setup);
void build_counters(SceneContext& context, SimulationSetup& setup);
/// Sets the estimated memory of a run. If it exceeds the limit of this process, reports the part of the scene that
/// needs most memory. Warns of bursts that exceed the largest number of particles.
void check_memory(const SceneContext& context, SceneDescription& scene);
[[nodiscard]] const ObjectSpec& drawing_spec();
/// Returns the number of the drawing that an emitter with the key "drawing" adds to the scene, counted from 1.
[[nodiscard]] std::size_t drawing_number(const SceneContext& context, const ObjectView& emitter);
/// Builds the camera, the picture settings and the drawings of emitters. Must run after the frames are built.
void build_pictures(const SceneContext& context, SceneDescription& scene);
/// Warns of ids of the key "particles" if no particle has or will have them.
void warn_of_unknown_ids(const SceneContext& context, const ObjectView& view, const SimulationSetup& setup,
                         std::span<const std::uint64_t> ids);
void warn_of_forces_on_nobody(const SceneContext& context, const SimulationSetup& setup);
/// Returns true if no particle has a radius, from the start or by an emitter.
[[nodiscard]] bool has_only_points(const SimulationSetup& setup);
/// Warns of forces that depend on the particle radius if all particles are points, because such forces are zero.
void warn_of_forces_without_radius(const SceneContext& context, const SimulationSetup& setup);

// Particle tables.

/// Contents of a particle table, and the errors found in it.
struct ParticleTable {
    std::vector<Particle> particles;
    std::vector<std::string> errors;  ///< first errors, for example "start.csv:12: found ..., expected ..."
    std::vector<AttributeDescription> attributes;  ///< declared attributes, and the table's attributes for appearance
    std::vector<std::string> unused_columns;  ///< columns of a final state that have no meaning at the start of a run
};

/// Parses comma-separated values: a header line with the names of the columns, in any order, then one line per
/// particle. The columns x, y and z are required. Columns of attributes are `name`, or `name_x`, `name_y` and `name_z`.
/// The final state that a run writes is a valid table. Faults of the contents are returned as errors, never thrown.
[[nodiscard]] ParticleTable parse_particle_table(std::string_view text, const std::string& name,
                                                 std::vector<AttributeDescription> declared = {});
/// Reads a .csv file. Throws InputError if the file cannot be read or has another extension.
[[nodiscard]] ParticleTable read_particle_table(const std::filesystem::path& path,
                                                std::vector<AttributeDescription> declared = {});

// Flows and forces by "type": the keys of each type, the function that makes the object, and table lines that several
// types share.

/// Keys of a type, and the function that makes an object of this type from a view.
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

/// Returns the law for the type of a view, or a null pointer if the type was refused.
template <class AnyLaw>
const AnyLaw* law_of(const std::vector<AnyLaw>& laws, const ObjectView& view) {
    const auto found =
        std::find_if(laws.begin(), laws.end(), [&](const AnyLaw& law) { return law.variant.name == view.type(); });
    return found == laws.end() ? nullptr : &*found;
}

/// Calls a function that makes an object. Reports an InputError that it throws, unless values have been refused before:
/// the error may then concern defaults that replaced them.
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
    return {"point", member, kCoordinate, "m", "A point on the axis."};
}
template <class Struct>
Field<Struct> axis(Vec3 Struct::*member) {
    constexpr std::string_view kMeaning = "Direction of the axis, of any length. Rotation follows the right-hand rule.";
    return {"axis", member, kCoordinate, "", kMeaning, kRequired, kNotZero};
}

}  // namespace ricochet::detail
