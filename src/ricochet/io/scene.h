/// \file
/// Scene files: JSON with comments, read strictly. docs/scene-format.md is the reference and docs/scene.schema.json
/// the JSON Schema. Both are generated from the table of keys that the reader uses.
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
    std::uint64_t every = 1;             ///< steps between frames, >= 1
    std::uint64_t checkpoint_every = 0;  ///< steps between checkpoints, each written with the next frame; 0: none
    bool pieces = false;                 ///< true if each process writes its own part of frames and checkpoints
};

/// Position and optics of the camera.
struct CameraDescription {
    Vec3 position;                                  ///< m
    Vec3 target;                                    ///< centre of the picture, in m
    std::optional<Vec3> up;                         ///< any length; nothing: against gravity
    double field_of_view_degrees = 35.0;            ///< between the lower and the upper edge
    std::optional<double> focal_length{};           ///< mm, for a film of 24 mm height; determines the field of view
    double aperture = 0.0;                          ///< diameter of the lens, in m; 0: everything is sharp
    double focus_distance = 0.0;                    ///< distance of sharp objects along the view, in m; 0: the target's
    std::optional<KeyedCurve<Vec3>> path{};         ///< replaces `position`, in m
    std::optional<KeyedCurve<Vec3>> target_path{};  ///< replaces `target`, in m
    std::string frame{};                            ///< reference frame of all members; empty: the world
    std::shared_ptr<const FrameTree> frames{};      ///< frames of the scene, for a camera in a frame

    /// Returns true if the camera changes over time.
    [[nodiscard]] bool moves() const { return path || target_path || !frame.empty(); }
};

/// Appearance of a collider.
struct ColliderLooks {
    std::optional<Vec3> color;  ///< linear light; nothing: the renderer's default
    double roughness = 1.0;     ///< 0 (mirror) to 1 (matt)
    bool glass = false;         ///< transparent
    bool hidden = false;
    bool pattern = true;  ///< draws a pattern on a plane, as a visual scale

    friend bool operator==(const ColliderLooks&, const ColliderLooks&) = default;
};

/// Groups of a mesh collider's triangles, as named in the mesh file.
struct TriangleGroups {
    std::vector<std::uint32_t> triangles;  ///< index into `names`, one for each triangle
    /// Combinations of object, group and material, joined by "/".
    std::vector<std::string> names;

    [[nodiscard]] bool empty() const { return names.empty(); }
};

/// Stretching of drawn particles as they move, at constant volume; it does not affect the run.
struct StretchDescription {
    double speed = 0.0;   ///< in s/m; the length along the velocity grows by the factor 1 + `speed` times the speed
    double impact = 0.0;  ///< in s/m; an impact flattens by the factor 1 + `impact` times the normal speed
    double time = 0.1;    ///< duration of the flattening, in s, > 0; half of it is before the impact
    double most = 2.0;    ///< >= 1, largest factor of both

    friend bool operator==(const StretchDescription&, const StretchDescription&) = default;
};

/// Appearance of particles.
struct ParticleDrawingDescription {
    std::string particles;                ///< name of the style; empty: the renderer's default
    std::string sprite{};                 ///< PNG file of the sprites; run.json names a copy beside it
    std::string mesh{};                   ///< mesh file of the particles; run.json names a copy beside it
    std::string turn{};                   ///< name of the sprites' orientation; empty: upright
    std::optional<MeanSpread> turning{};  ///< rate of turn of sprites, and of meshes without a spin, in rad/s
};

/// Light and surroundings of pictures, and the default appearance of particles.
struct PictureDescription : ParticleDrawingDescription {
    std::string light;               ///< name of the light; empty: the renderer's default
    std::optional<Vec3> background;  ///< linear light; nothing: the sky of the light
    bool transparent = false;        ///< the background is transparent
    std::optional<double> ground;    ///< height of a level ground along the upward axis, in m; nothing: no ground
    double shutter = 0.0;            ///< exposure time, in s, which ends at the picture's time
    std::optional<StretchDescription> stretch{};  ///< nothing: no stretching
    /// Temperature, in K, at which a particle shines like a white surface in the sun. Particles emit light by their
    /// attribute `temperature`; nothing: no light.
    std::optional<double> black_body{};
    std::optional<double> particle_radius{};  ///< radius of drawn particles, in m; nothing: their own
    std::optional<double> time{};             ///< time of a single picture, in s; nothing: the end
};

/// Attribute of particles that selects one of the scene's drawings, counted from 1; 0 selects the default drawing.
inline constexpr std::string_view kDrawingAttribute = "drawing";

/// Scene after reading and checking.
struct SceneDescription {
    SimulationSetup setup;
    OutputOptions output;
    std::optional<CameraDescription> camera;
    std::optional<PictureDescription> picture;
    std::vector<ParticleDrawingDescription> drawings;  ///< appearance of the particles of some emitters
    std::vector<ColliderLooks> looks;                  ///< one for each collider of the setup
    std::vector<TriangleGroups> groups;                ///< one for each collider of the setup; empty without groups
    std::string file;                                  ///< as given by the user
    std::vector<std::string> warnings;                 ///< one line each, with file and source location
    std::vector<std::string> notes;                    ///< one line each: changes made to meshes while reading
    std::vector<std::filesystem::path> files;          ///< all files that the scene reads, each once
    double memory_bytes = 0.0;                         ///< estimated peak memory of a run
    /// Hash of all inputs that determine the run, including the contents of its files but not output and camera. A run
    /// can be resumed if the hashes are equal.
    std::uint64_t fingerprint = 0;
};

/// Returns the sum of the accelerations that are uniform in space, in m/s^2, which is the direction of falling.
/// Returns zero if there are none.
[[nodiscard]] Vec3 uniform_acceleration(const SimulationSetup& setup);

/// Error with everything that is wrong with a scene.
class SceneError : public InputError {
public:
    /// messages: at least one, with one line each.
    explicit SceneError(std::vector<std::string> messages);
    /// Returns one line for every error: "file:line:column: path.of[1].value: found ..., expected ...".
    [[nodiscard]] const std::vector<std::string>& messages() const { return messages_; }

private:
    std::vector<std::string> messages_;
};

/// Size limit of a scene file, in bytes; meshes and particle tables are separate files.
inline constexpr std::uint64_t kLargestSceneFile = std::uint64_t{64} << 20;

/// Reads a scene with its meshes and tables, whose paths are relative to its folder.
/// overrides: changes of the form `PATH=VALUE`, applied in order before any check. Examples:
/// "simulation.time_step=0.01", "colliders[0].scale=2".
/// Throws SceneError with all errors:
/// - syntax (with line and column), unknown keys, wrong types, values out of range;
/// - unsupported features, missing or unreadable files;
/// - more memory than this process may use.
[[nodiscard]] SceneDescription read_scene(const std::filesystem::path& file,
                                          const std::vector<std::string>& overrides = {});

/// Reads a scene from a text in memory.
/// file: name for messages; paths in the scene are relative to its folder.
[[nodiscard]] SceneDescription parse_scene(std::string_view text, const std::filesystem::path& file,
                                           const std::vector<std::string>& overrides = {});

}  // namespace ricochet
