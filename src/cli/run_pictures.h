// Pictures and films of a run: connects its folder to the renderer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/collider_quantity.h"
#include "cli/run_timeline.h"
#include "cli/run_turning.h"
#include "cli/wall_clearance.h"
#include "ricochet/core/transform.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/vtk.h"
#include "run/run_folder.h"
#include "view/render/camera.h"
#include "view/render/color_bar.h"
#include "view/render/color_map.h"
#include "view/render/image.h"
#include "view/render/picture.h"
#include "view/render/preview.h"
#include "view/render/sprite_image.h"
#include "view/render/sprites.h"
#include "view/render/turning.h"

namespace ricochet::cli {

inline constexpr Vec3 kPlaneColor{0.30, 0.30, 0.29};
inline constexpr double kParticleAlbedo = 0.8;  ///< factor on the colours of the colour map, so that sunlit colours do
                                                ///< not saturate

/// Largest number of positions along the path of a sphere while the shutter is open.
inline constexpr std::size_t kMostPathSteps = 65;
/// Number of these positions if no sphere hits a surface or a sphere.
inline constexpr std::size_t kFewPathSteps = 9;

/// Array of the temperatures in K that make particles glow.
inline constexpr const char* kTemperature = "temperature";

/// Drawing of particles.
enum class ParticleDrawing {
    automatic,  ///< soft if the frames have an opacity, otherwise spheres
    spheres,
    streaks,  ///< threads along the path while the shutter is open
    soft,     ///< discs that cover the background by their opacity
    glow,     ///< discs of additive light
    sprites,  ///< an image that faces the camera
    meshes,   ///< copies of a mesh
};

/// Parses auto, spheres, streaks, soft, glow, sprites or meshes.
[[nodiscard]] std::optional<ParticleDrawing> drawing_from_name(std::string_view name);

/// Returns a few of a run's frames, distributed over the whole run.
[[nodiscard]] std::vector<FrameFile> spread_sample(const std::vector<FrameFile>& frames);
/// Returns the name of a collider from its file in the run's folder.
[[nodiscard]] std::string collider_name(const RunInfo& info, const std::filesystem::path& file);

/// Opening and focus of a camera's lens.
struct Lens {
    double aperture = 0.0;        ///< diameter, in m; 0: everything is in focus
    double focus_distance = 0.0;  ///< distance of the plane of focus, in m; 0: at the target
};

/// Background of a picture. If no colour is set, the background is the sky of the lighting.
struct Background {
    std::optional<Vec3> color;  ///< linear RGB
    bool transparent = false;
};

/// A horizontal ground plane that is drawn but is not part of the run.
struct Ground {
    enum class Kind { none, automatic, at_height } kind = Kind::none;
    double height = 0.0;  ///< along the upward axis, in m
};

/// Rotation of sprites and meshes, and stretch of spheres and meshes.
struct ParticleShape {
    enum class Facing { upright, random, velocity } facing = Facing::upright;
    MeanSpread turning;  ///< rate of rotation, in rad/s
    std::optional<StretchDescription> stretch;
};

/// Drawing of particles with all its data. It applies to the particles of some emitters, or to all particles.
struct Drawing {
    ParticleDrawing kind = ParticleDrawing::automatic;
    ParticleShape shape;
    std::uint32_t mesh = 0;  ///< number of the mesh, counted from 1; 0: a ball
    std::shared_ptr<const SpriteImage> sprite;

    /// Returns true for discs and images.
    [[nodiscard]] bool is_flat() const {
        return kind == ParticleDrawing::soft || kind == ParticleDrawing::glow || kind == ParticleDrawing::sprites;
    }
    [[nodiscard]] bool is_copy() const {
        return kind == ParticleDrawing::meshes || (kind == ParticleDrawing::spheres && shape.stretch);
    }
};

/// Style of a run's pictures.
struct PictureStyle {
    /// Name of the array in the frames that colours the particles. `speed` is the length of `velocity`. An empty name
    /// means the particles' own colours, or `speed` if they have none.
    std::string color_by;
    ParticleDrawing drawing = ParticleDrawing::automatic;
    std::optional<ValueRange> range;
    ColorMap map = ColorMap::plasma;
    /// Drawn radius, in m. If not set, the scene's value is used. The value 0 means the radii in the frames, or a
    /// visible radius for points.
    std::optional<double> particle_radius;
    std::optional<ColliderQuantity> collider_quantity;  ///< quantity that colours the colliders
    std::optional<ValueRange> collider_range;
    std::vector<std::string> hidden;  ///< names of omitted colliders
    std::vector<std::string> glass;   ///< names of transparent colliders
    std::optional<Camera> camera;
    std::optional<Vec3> up;
    std::optional<Lens> lens;
    // If one of the following settings is not set, the run's own picture settings are used.
    std::optional<Lighting> light;
    std::optional<Background> background;
    std::optional<Ground> ground;
    std::optional<double> shutter;     ///< in s
    std::optional<double> black_body;  ///< temperature in K at which particles are as bright as a white surface in the
                                       ///< sun
    std::filesystem::path sprite;      ///< PNG file of sprites; empty: from the run
    std::filesystem::path mesh;        ///< mesh file for particles; empty: from the run
};

/// Reads a mesh that is drawn for each particle. The result is moved and scaled: the centre of the bounding box is the
/// origin, and the farthest vertex is at distance 1. Throws InputError if the file has no extent.
[[nodiscard]] TriangleMesh shape_from(const std::filesystem::path& file);

/// Renders chosen frames with one camera, one colour range and one set of colliders.
class RunPictures {
public:
    /// Reads the colliders and checks the chosen frames. Throws InputError for invalid files and for unknown names of
    /// colliders or arrays.
    RunPictures(const RunFolder& folder, const std::vector<FrameFile>& chosen, PictureStyle style, double aspect);

    /// Renders the run at a time between its first and its last frame.
    [[nodiscard]] Image picture(double time, const PictureOptions& options);
    /// Returns the states of the run at any time, interpolated between frames.
    [[nodiscard]] RunTimeline& timeline() { return timeline_; }
    [[nodiscard]] double shutter() const { return style_.shutter.value_or(0.0); }
    /// Sets lighting and background.
    void set_scenery(PictureOptions& options) const;
    [[nodiscard]] const ValueRange& range() const { return range_; }
    /// Returns the colour bars of the particles and of the colliders.
    [[nodiscard]] std::vector<ColorBar> color_bars() const;
    /// Returns a note about the impulses that the collider colours omit, or an empty text.
    [[nodiscard]] std::string collider_note() const {
        return style_.collider_quantity ? style_.collider_quantity->note(impulse_sizes_) : std::string();
    }
    /// Returns the time, in s, at which the collider totals end. Returns nothing unless they end before the last frame
    /// because the run was killed.
    [[nodiscard]] std::optional<double> totals_end() const { return totals_end_; }
    /// Returns the array that colours the particles.
    [[nodiscard]] const std::string& color_by() const { return style_.color_by; }
    /// Returns true if the particles have the colours that the frames contain.
    [[nodiscard]] bool shows_own_colors() const { return own_colors_; }
    [[nodiscard]] const Camera& camera() const { return camera_; }
    /// Returns true if streaks are requested, but spheres are drawn because the shutter is closed.
    [[nodiscard]] bool lacks_shutter() const {
        return !(shutter() > 0.0) && std::any_of(drawings_.begin(), drawings_.end(),
                                                 [](const Drawing& d) { return d.kind == ParticleDrawing::streaks; });
    }
    /// Returns true if at least some particles are discs or images.
    [[nodiscard]] bool draws_sprites() const {
        return std::any_of(drawings_.begin(), drawings_.end(), [](const Drawing& d) { return d.is_flat(); });
    }
    /// Returns true if the image alone determines the colours of sprites.
    [[nodiscard]] bool shows_image_colors() const { return plain_image_; }
    /// Returns true if the temperature alone determines the colours of particles.
    [[nodiscard]] bool shows_heat_alone() const { return embers_; }
    /// Returns the name of a collider that contains most particles and hides them from a camera outside it. Returns an
    /// empty text if no collider does.
    [[nodiscard]] const std::string& hiding_collider() const { return hiding_; }

private:
    /// Appearance of a collider.
    struct Looks {
        Vec3 color;
        bool glass = false;
        bool hidden = false;
        bool has_color = false;  // true if the scene sets the collider's colour
        double roughness = 1.0;
        bool pattern = true;
    };

    void survey(const std::vector<FrameFile>& chosen);
    [[nodiscard]] Looks looks_of(const RunInfo& info, const std::filesystem::path& file) const;
    void load_colliders(const RunFolder& folder);
    void color_colliders(const RunFolder& folder);
    void survey_moving(const std::vector<FrameFile>& chosen);
    void add_moving(std::map<std::uint32_t, TriangleMesh> meshes, PreviewMoving& moving) const;
    void choose_scenery(const RunInfo& info);
    void lay_ground(const RunFolder& folder);
    void choose_camera(const RunFolder& folder, double aspect);
    [[nodiscard]] std::vector<double> shown_values(const VtkPolyData& frame) const;
    void choose_looks(const VtkPolyData& frame);
    [[nodiscard]] std::vector<Vec3> colors(const VtkPolyData& frame) const;
    [[nodiscard]] std::vector<Vec3> emissions(const VtkPolyData& frame) const;
    [[nodiscard]] std::vector<Vec3> sprite_colors(const VtkPolyData& frame, ParticleDrawing kind) const;
    [[nodiscard]] double visible_radius() const;
    [[nodiscard]] std::vector<double> shown_radii(const VtkPolyData& frame) const;
    void place_camera(const VtkPolyData& frame);
    [[nodiscard]] Vec3 camera_place_in(const VtkPolyData& frame) const;
    void find_hiding(const RunFolder& folder, const std::vector<FrameFile>& chosen);
    [[nodiscard]] bool hides(const TriangleMesh& mesh, const std::vector<Vec3>& probes, const Vec3& eye) const;

    // Drawing of particles, in run_particles.cpp.
    /// Particles with the same drawing, by their indices in the frame.
    struct Group {
        const Drawing* drawing;
        std::vector<std::size_t> shown;
    };
    [[nodiscard]] std::vector<Group> groups_of(const VtkPolyData& frame, const std::vector<bool>& left_out) const;
    [[nodiscard]] std::vector<bool> add_springs(const VtkPolyData& frame, const std::vector<double>& radii,
                                                PreviewMoving& moving) const;
    [[nodiscard]] PreviewSpheres spheres_of(const Group& group, const VtkPolyData& frame,
                                            const std::vector<Vec3>& colors, const std::vector<double>& radii) const;
    void add_solid(const Moment& moment, const Group& group, PreviewSpheres&& spheres, PreviewMoving& moving);
    void set_shutter_paths(const Moment& moment, const std::vector<std::size_t>& shown, PreviewSpheres& spheres) const;
    void keep_off_walls(const Moment& moment, const Group& group, PreviewSpheres& spheres);
    [[nodiscard]] WallClearance walls_at_rest() const;
    static void add_streaks(const ShutterPaths& paths, const std::vector<std::size_t>& shown,
                            const PreviewSpheres& spheres, PreviewMoving& moving);
    void add_flat(const VtkPolyData& frame, const Group& group, std::vector<Sprites>& layers) const;

    // Shapes of particles, in run_shapes.cpp.
    void choose_shape(const RunFolder& folder);
    void add_drawing(const RunFolder& folder, const ParticleDrawingDescription& own);
    void load_drawing(Drawing& drawing, const std::filesystem::path& sprite, const std::filesystem::path& mesh);
    void widen_subject(const VtkPolyData& frame);
    void require_room_for_copies() const;
    [[nodiscard]] bool draws_copies() const;
    void add_copies(const Moment& moment, const Group& group, PreviewSpheres&& spheres, PreviewCopies& all);
    [[nodiscard]] std::vector<AffineMap> turns_of(const Group& group) const;
    [[nodiscard]] std::vector<Turn> turns_in(const VtkPolyData& frame);
    void stretch_copies(const VtkPolyData& frame, const Group& group, const std::vector<double>& radii,
                        PreviewCopies& copies);
    [[nodiscard]] std::vector<double> sprite_angles(const VtkPolyData& frame, const Group& group) const;

    PictureStyle style_;
    RunTimeline timeline_;
    ViewSubject subject_;
    std::size_t most_particles_ = 0;
    bool own_colors_ = false;       // colours come from the frames
    bool colors_are_told_ = false;  // colours come from the command line
    bool has_sizes_ = false;        // some particles have a size for drawing
    ValueRange range_;
    Camera camera_;
    std::vector<PreviewMesh> meshes_;
    std::vector<std::filesystem::path> mesh_files_;  // files of meshes_, in the same order
    ValueRange collider_range_;
    ImpulseSizes impulse_sizes_;                   // impulses on the colliders that a quantity colours
    std::optional<double> totals_end_;             // in s
    std::map<std::uint32_t, Looks> moving_looks_;  // appearance of moving colliders, by collider number
    std::map<std::uint32_t, std::filesystem::path> moving_files_;
    std::map<std::uint32_t, std::vector<Vec3>> moving_colors_;  // triangle colours of moving colliders, if a quantity
                                                                // colours them
    std::vector<PreviewPlane> planes_;
    bool is_told_ = false;              // true if the drawing comes from the command line
    std::vector<Drawing> drawings_;     // the first one is for particles whose emitter has no drawing
    std::vector<TriangleMesh> shapes_;  // meshes for particles, fitted into the ball of radius 1
    std::vector<Turn> turns_;           // rotations of the particles of the current frame, if they spin
    bool plain_image_ = false;
    bool embers_ = false;
    std::vector<Vec3> emissions_;  // light that the particles of the current frame emit; empty if none
    RunTurning turning_;
    std::string hiding_;
    std::optional<WallClearance> walls_;  // walls at rest; created for the first ball that is larger than its particle
    std::optional<Preview> preview_;
};

}  // namespace ricochet::cli
