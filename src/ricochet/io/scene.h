/// \file
/// Scene files: JSON with comments, checked strictly. docs/scene-format.md is the reference, and docs/scene.schema.json
/// is the JSON Schema. Both are generated from the tables of keys that the reader uses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/keyed_curve.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Settings of a run's output.
struct OutputOptions {
    std::string format = "vtp";
    std::uint64_t every = 1;  ///< steps between frames, >= 1
    /// Steps between checkpoints; a checkpoint is written with the next frame; 0: no checkpoints.
    std::uint64_t checkpoint_every = 0;
    bool pieces = false;  ///< true if each process writes its own part of the frames and checkpoints
};

/// Position and optics of the camera.
struct CameraDescription {
    Vec3 position;                         ///< m
    Vec3 target;                           ///< centre of the picture, in m
    std::optional<Vec3> up;                ///< upward direction, of any length; nothing: opposite to gravity
    double field_of_view_degrees = 35.0;   ///< angle between the lower and the upper edge of the picture
    std::optional<double> focal_length{};  ///< in mm, for a film of 24 mm height; determines the field of view
    double aperture = 0.0;                 ///< diameter of the lens, in m; 0: all objects are in focus
    /// Distance of objects in focus along the view direction, in m; 0: the distance of the target.
    double focus_distance = 0.0;
    std::optional<KeyedCurve<Vec3>> path{};         ///< replaces `position`, in m
    std::optional<KeyedCurve<Vec3>> target_path{};  ///< replaces `target`, in m
    std::string frame{};                            ///< name of the reference frame of all members; empty: the world
    std::shared_ptr<const FrameTree> frames{};      ///< frames of the scene, if the camera is in a frame

    /// Returns true if the camera changes over time.
    [[nodiscard]] bool moves() const { return path || target_path || !frame.empty(); }
};

/// Appearance of a collider.
struct ColliderLooks {
    std::optional<Vec3> color;  ///< colour in linear light; nothing: the renderer's default
    double roughness = 1.0;     ///< 0 (mirror) to 1 (matt)
    bool glass = false;         ///< transparent
    bool hidden = false;
    bool pattern = true;  ///< true if a plane has a pattern that shows its scale

    friend bool operator==(const ColliderLooks&, const ColliderLooks&) = default;
};

/// Named groups of a mesh collider's triangles, from the mesh file.
struct TriangleGroups {
    std::vector<std::uint32_t> triangles;  ///< index into `names` for each triangle
    /// Names of the groups: combinations of object, group and material, joined by "/".
    std::vector<std::string> names;

    [[nodiscard]] bool empty() const { return names.empty(); }
};

/// Deformation of drawn particles in the direction of motion, at constant volume. It does not affect the run.
struct StretchDescription {
    /// In s/m; the length along the velocity is multiplied by 1 + `speed` times the particle's speed.
    double speed = 0.0;
    /// In s/m; at an impact the length along the normal is divided by 1 + `impact` times the normal speed.
    double impact = 0.0;
    double time = 0.1;  ///< duration of the flattening, in s, > 0; the impact is in the middle of it
    double most = 2.0;  ///< largest allowed factor of both deformations, >= 1

    friend bool operator==(const StretchDescription&, const StretchDescription&) = default;
};

/// Appearance of particles.
struct ParticleDrawingDescription {
    std::string particles;  ///< name of the drawing style; empty: the renderer's default
    std::string sprite{};   ///< PNG file of the sprites; run.json contains the name of a copy in its folder
    std::string mesh{};     ///< mesh file of the particles; run.json contains the name of a copy in its folder
    std::string turn{};     ///< name of the sprites' orientation; empty: upright
    std::optional<MeanSpread> turning{};  ///< rotation rate of sprites, and of meshes without a spin, in rad/s
};

/// Light and background of pictures, and the default appearance of particles.
struct PictureDescription : ParticleDrawingDescription {
    std::string light;               ///< name of the light; empty: the renderer's default
    std::optional<Vec3> background;  ///< colour in linear light; nothing: the sky that belongs to the light
    bool transparent = false;        ///< the background is transparent
    /// Height of a horizontal ground plane along the upward axis, in m; nothing: no ground.
    std::optional<double> ground;
    double shutter = 0.0;                         ///< exposure time, in s; the exposure ends at the time of the picture
    std::optional<StretchDescription> stretch{};  ///< nothing: no stretching
    /// Temperature, in K, at which a particle is as bright as a white surface in sunlight. Particles emit light
    /// according to their attribute `temperature`. Nothing: particles emit no light.
    std::optional<double> black_body{};
    std::optional<double> particle_radius{};  ///< radius of drawn particles, in m; nothing: each particle's own radius
    std::optional<double> time{};             ///< time of a single picture, in s; nothing: the end of the run
};

/// Particle attribute that selects one of the scene's drawings, counted from 1. 0 selects the default drawing.
inline constexpr std::string_view kDrawingAttribute = "drawing";

/// Scene that has been read and checked.
struct SceneDescription {
    SimulationSetup setup;
    OutputOptions output;
    std::optional<CameraDescription> camera;
    std::optional<PictureDescription> picture;
    std::vector<ParticleDrawingDescription> drawings;  ///< appearance of the particles of some emitters
    std::vector<ColliderLooks> looks;                  ///< one for each collider of the setup
    /// One for each collider of the setup, with empty lists if a collider has no groups.
    std::vector<TriangleGroups> groups;
    std::string file;                          ///< path of the scene file as given by the user
    std::vector<std::string> warnings;         ///< warnings of one line each, with file and source location
    std::vector<std::string> notes;            ///< notes of one line each, on changes made to meshes while reading
    std::vector<std::filesystem::path> files;  ///< all files that the scene reads, without duplicates
    double memory_bytes = 0.0;                 ///< estimated peak memory of a run
    /// Hash of all inputs that determine the run. It includes the contents of the scene's files, but not the output and
    /// camera settings. A run can be resumed only if the hashes are equal.
    std::uint64_t fingerprint = 0;
};

/// Returns the sum of the forces' accelerations that are uniform in space, in m/s^2. Particles fall in its direction.
/// Returns zero if there are no such accelerations.
[[nodiscard]] Vec3 uniform_acceleration(const SimulationSetup& setup);

/// Error with messages about all faults of a scene.
class SceneError : public InputError {
public:
    /// messages: at least one message; each message is one line.
    explicit SceneError(std::vector<std::string> messages);
    /// Returns one line for every error, for example "file:line:column: path.of[1].value: found ..., expected ...".
    [[nodiscard]] const std::vector<std::string>& messages() const { return messages_; }

private:
    std::vector<std::string> messages_;
};

/// Size limit of a scene file, in bytes; meshes and particle tables are separate files.
inline constexpr std::uint64_t kLargestSceneFile = std::uint64_t{64} << 20;

/// Reads a scene with its meshes and tables. Their paths are relative to the folder of the scene. overrides: changes of
/// the form `PATH=VALUE`, for example "simulation.time_step=0.01" or "colliders[0].scale=2". They are applied in order
/// before any check. Throws SceneError with messages about all errors of these kinds:
/// - syntax (with line and column), unknown keys, wrong types, values out of range;
/// - unsupported features, missing or unreadable files;
/// - memory that exceeds the limit of this process.
[[nodiscard]] SceneDescription read_scene(const std::filesystem::path& file,
                                          const std::vector<std::string>& overrides = {});

/// Reads a scene from a text in memory. file: file name for messages. Paths in the scene are relative to the folder of
/// this file.
[[nodiscard]] SceneDescription parse_scene(std::string_view text, const std::filesystem::path& file,
                                           const std::vector<std::string>& overrides = {});

}  // namespace ricochet
