/// \file
/// Scene files: JSON with comments, read strictly. docs/scene-format.md is the reference, docs/scene.schema.json the
/// JSON Schema; both are made from the table that the reader uses.
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

/// What a run writes.
struct OutputOptions {
    std::string format = "vtp";
    std::uint64_t every = 1;             ///< steps from one frame to the next, >= 1
    std::uint64_t checkpoint_every = 0;  ///< steps from one checkpoint to the next, at the frame that follows; 0: none
    bool pieces = false;                 ///< each process of a run writes its own part of frames and checkpoints
};

/// Where a picture is taken from.
struct CameraDescription {
    Vec3 position;                                  ///< m
    Vec3 target;                                    ///< m, the middle of the picture
    std::optional<Vec3> up;                         ///< of any length; nothing: against gravity
    double field_of_view_degrees = 35.0;            ///< from the lower to the upper edge
    std::optional<double> focal_length{};           ///< mm, of a film 24 mm high; sets the field of view
    double aperture = 0.0;                          ///< m, diameter of the lens; 0: everything is sharp
    double focus_distance = 0.0;                    ///< m along the view to what is sharp; 0: at the target
    std::optional<KeyedCurve<Vec3>> path{};         ///< m, instead of position
    std::optional<KeyedCurve<Vec3>> target_path{};  ///< m, instead of target
    std::string frame{};                            ///< in which all of this stands; empty: the world
    std::shared_ptr<const FrameTree> frames{};      ///< of the scene, for a camera in a frame

    /// True where it is not the same at all times.
    [[nodiscard]] bool moves() const { return path || target_path || !frame.empty(); }
};

/// How a collider is shown.
struct ColliderLooks {
    std::optional<Vec3> color;  ///< linear light; nothing: one of the renderer's own
    double roughness = 1.0;     ///< 0 (a mirror's gloss) .. 1 (matt)
    bool glass = false;         ///< seen through
    bool hidden = false;
    bool pattern = true;  ///< of a plane: what gives the eye a scale

    friend bool operator==(const ColliderLooks&, const ColliderLooks&) = default;
};

/// Groups of a mesh collider's triangles, as its file names them.
struct TriangleGroups {
    std::vector<std::uint32_t> triangles;  ///< index into `names`, one a triangle
    /// One a combination of object, group and material: those that the file gives, joined by "/".
    std::vector<std::string> names;

    [[nodiscard]] bool empty() const { return names.empty(); }
};

/// How drawn particles change their shape as they move, at the same volume; it does nothing to the run.
struct StretchDescription {
    double speed = 0.0;   ///< s/m: along the velocity they are longer by 1 + this times the speed
    double impact = 0.0;  ///< s/m: at an impact flatter along the normal by 1 + this times its normal speed
    double time = 0.1;    ///< s, > 0, over which they are flatter, half of it before the impact
    double most = 2.0;    ///< >= 1: neither longer nor flatter than by this factor

    friend bool operator==(const StretchDescription&, const StretchDescription&) = default;
};

/// What particles are drawn as.
struct ParticleDrawingDescription {
    std::string particles;                ///< by name; empty: the renderer's own
    std::string sprite{};                 ///< PNG file that they are drawn with; in run.json: beside it
    std::string mesh{};                   ///< mesh file that they are copies of; in run.json: beside it
    std::string turn{};                   ///< how sprites are turned, by name; empty: upright
    std::optional<MeanSpread> turning{};  ///< rad/s, by which sprites and meshes without a spin turn on
};

/// Light and surroundings of pictures, and what particles are drawn as.
struct PictureDescription : ParticleDrawingDescription {
    std::string light;                            ///< by name; empty: the renderer's own
    std::optional<Vec3> background;               ///< linear light; nothing: the light's sky
    bool transparent = false;                     ///< nothing behind everything
    std::optional<double> ground;                 ///< m along the upward axis: a level ground; nothing: none
    double shutter = 0.0;                         ///< s of the run that a picture shows, up to its own time
    std::optional<StretchDescription> stretch{};  ///< nothing: they keep their shape
    /// K: particles shine by their attribute `temperature`, at this one as a white surface in the sun; nothing: no
    /// light.
    std::optional<double> black_body{};
    std::optional<double> particle_radius{};  ///< m, by which particles are drawn; nothing: their own
    std::optional<double> time{};             ///< s, that a single picture shows; nothing: the end
};

/// A scene, read and checked.
struct SceneDescription {
    SimulationSetup setup;
    OutputOptions output;
    std::optional<CameraDescription> camera;
    std::optional<PictureDescription> picture;
    /// What the particles of some emitters are drawn as: those whose attribute kDrawingAttribute is 1 as the first
    /// says.
    std::vector<ParticleDrawingDescription> drawings;
    std::vector<ColliderLooks> looks;          ///< of the setup's colliders, one each
    std::vector<TriangleGroups> groups;        ///< the same; empty for those without
    std::string file;                          ///< as it was named
    std::vector<std::string> warnings;         ///< one line each, with file and source location
    std::vector<std::string> notes;            ///< of the same kind: what was done to meshes as they were read
    std::vector<std::filesystem::path> files;  ///< every file that it names and reads, each once
    double memory_bytes = 0.0;                 ///< that a run of it needs at its peak, about
    /// Hash of all that decides the run (not of output and camera), what is in its files too: a run may be resumed
    /// where it is the same.
    std::uint64_t fingerprint = 0;
};

/// Sum of the accelerations that are the same everywhere, m/s^2: the direction in which things fall. Zero where there
/// are none.
[[nodiscard]] Vec3 uniform_acceleration(const SimulationSetup& setup);

/// All that is wrong with a scene.
class SceneError : public InputError {
public:
    /// messages: one line each, at least one.
    explicit SceneError(std::vector<std::string> messages);
    /// One line for every error: "file:line:column: path.of[1].value: found ..., expected ...".
    [[nodiscard]] const std::vector<std::string>& messages() const { return messages_; }

private:
    std::vector<std::string> messages_;
};

/// Largest scene file that is read, bytes; meshes and particle tables have files of their own.
inline constexpr std::uint64_t kLargestSceneFile = std::uint64_t{64} << 20;

/// Reads a scene with the meshes and tables that it names, relative to its folder. overrides: `PATH=VALUE` changes,
/// applied in order before anything is checked, for example "simulation.time_step=0.01" or "colliders[0].scale=2".
/// Throws SceneError with everything that is wrong: syntax (line and column), unknown keys, wrong types, values out of
/// range, what is not built yet, missing or unreadable files, and what asks for more memory than this process may have.
[[nodiscard]] SceneDescription read_scene(const std::filesystem::path& file,
                                          const std::vector<std::string>& overrides = {});

/// The same for a text in memory. file: the name for messages; paths in the scene are relative to its folder.
[[nodiscard]] SceneDescription parse_scene(std::string_view text, const std::filesystem::path& file,
                                           const std::vector<std::string>& overrides = {});

/// The JSON Schema (draft 2020-12) of scene files, as docs/scene.schema.json holds it. It says all that a schema can;
/// the reader also checks what ties values together (names, files, orders).
[[nodiscard]] std::string scene_schema();

/// The reference of the scene format in Markdown, as docs/scene-format.md holds it.
[[nodiscard]] std::string scene_reference();

}  // namespace ricochet
