// Pictures and films of a run: its folder on one side, the renderer on the other.
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
#include "ricochet/io/run_folder.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/vtk.h"
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
inline constexpr double kParticleAlbedo = 0.8;  ///< of the colour map's colours, so that sunlit ones do not burn out

/// Most places that a sphere has while the shutter is open.
inline constexpr std::size_t kMostWaySteps = 65;
/// The same where none of them hits anything.
inline constexpr std::size_t kFewWaySteps = 9;

/// Array by which particles shine, K.
inline constexpr const char* kTemperature = "temperature";

/// What particles are drawn as.
enum class ParticleDrawing {
    automatic,  ///< soft where the frames have an opacity, spheres otherwise
    spheres,
    streaks,  ///< threads along the way that they went while the shutter was open
    soft,     ///< discs that cover what is behind by their opacity
    glow,     ///< discs of light that adds up
    sprites,  ///< an image that faces the camera
    meshes,   ///< copies of a mesh
};

/// auto, spheres, streaks, soft, glow, sprites or meshes.
[[nodiscard]] std::optional<ParticleDrawing> drawing_from_name(std::string_view name);

/// A few of a run's frames, spread over all of it.
[[nodiscard]] std::vector<FrameFile> spread_sample(const std::vector<FrameFile>& frames);
/// Of a collider by its file in the run's folder.
[[nodiscard]] std::string collider_name(const RunInfo& info, const std::filesystem::path& file);

/// The opening of a camera's lens.
struct Lens {
    double aperture = 0.0;        ///< m; 0: everything is sharp
    double focus_distance = 0.0;  ///< m; 0: at the target
};

/// What is behind everything: the sky of the light unless there is a colour.
struct Background {
    std::optional<Vec3> color;  ///< linear light
    bool transparent = false;
};

/// A level ground that the run did not have.
struct Ground {
    enum class Kind { none, automatic, at_height } kind = Kind::none;
    double height = 0.0;  ///< m along the upward axis
};

/// How sprites and meshes are turned, and how spheres and meshes change their shape.
struct ParticleShape {
    enum class Facing { upright, random, velocity } facing = Facing::upright;
    MeanSpread turning;  ///< rad/s
    std::optional<StretchDescription> stretch;
};

/// What particles are drawn as, with all that this needs: those of an emitter, or all.
struct Drawing {
    ParticleDrawing kind = ParticleDrawing::automatic;
    ParticleShape shape;
    std::uint32_t mesh = 0;  ///< number of the mesh that they are copies of, from 1 on; 0: a ball
    std::shared_ptr<const SpriteImage> sprite;

    /// True for discs or images.
    [[nodiscard]] bool is_flat() const {
        return kind == ParticleDrawing::soft || kind == ParticleDrawing::glow || kind == ParticleDrawing::sprites;
    }
    [[nodiscard]] bool is_copy() const {
        return kind == ParticleDrawing::meshes || (kind == ParticleDrawing::spheres && shape.stretch);
    }
};

/// How a run is shown.
struct PictureStyle {
    /// Array of the frames; speed is the length of velocity. Empty: the particles' own colours, or speed without.
    std::string color_by;
    ParticleDrawing drawing = ParticleDrawing::automatic;
    std::optional<ValueRange> range;
    ColorMap map = ColorMap::plasma;
    /// m; nothing: the scene's. 0: the frames' own, or one that can be seen for points.
    std::optional<double> particle_radius;
    std::optional<ColliderQuantity> collider_quantity;  ///< that colours the colliders
    std::optional<ValueRange> collider_range;
    std::vector<std::string> hidden;  ///< colliders that are left out, by name
    std::vector<std::string> glass;   ///< colliders that are seen through, by name
    std::optional<Camera> camera;
    std::optional<Vec3> up;
    std::optional<Lens> lens;
    // What is not set here is as the run's own picture settings say.
    std::optional<Lighting> light;
    std::optional<Background> background;
    std::optional<Ground> ground;
    std::optional<double> shutter;     ///< s
    std::optional<double> black_body;  ///< K, at which particles shine as a white surface in the sun
    std::filesystem::path sprite;      ///< PNG file of sprites; empty: the run's own
    std::filesystem::path mesh;        ///< file of the mesh that particles are copies of; empty: the run's own
};

/// A mesh that particles are copies of: the middle of its box in the origin, its farthest vertex 1 away. Throws
/// InputError where the file has none.
[[nodiscard]] TriangleMesh shape_from(const std::filesystem::path& file);

/// Makes pictures of chosen frames with one camera, one range of colours and one set of colliders.
class RunPictures {
public:
    /// Reads the colliders and checks the chosen frames. Throws InputError on files that are not a run's, and on
    /// names that the run does not have.
    RunPictures(const RunFolder& folder, const std::vector<FrameFile>& chosen, PictureStyle style, double aspect);

    /// The run at a time between its first and its last frame.
    [[nodiscard]] Image picture(double time, const PictureOptions& options);
    /// The frames and what lies between them.
    [[nodiscard]] RunTimeline& timeline() { return timeline_; }
    [[nodiscard]] double shutter() const { return style_.shutter.value_or(0.0); }
    /// Light and background.
    void set_scenery(PictureOptions& options) const;
    [[nodiscard]] const ValueRange& range() const { return range_; }
    /// What the colours mean: of the particles, and of the colliders where a quantity colours them.
    [[nodiscard]] std::vector<ColorBar> color_bars() const;
    /// What the colours of the colliders leave out; empty where that is nothing.
    [[nodiscard]] std::string collider_note() const {
        return style_.collider_quantity ? style_.collider_quantity->note(impulse_sizes_) : std::string();
    }
    /// s, at which the totals that colour the colliders end, if that is before the last frame: the run was killed.
    [[nodiscard]] std::optional<double> totals_end() const { return totals_end_; }
    /// Array that colours the particles.
    [[nodiscard]] const std::string& color_by() const { return style_.color_by; }
    /// True when the frames themselves say the colours.
    [[nodiscard]] bool shows_own_colors() const { return own_colors_; }
    [[nodiscard]] const Camera& camera() const { return camera_; }
    /// True when streaks are asked for and spheres drawn.
    [[nodiscard]] bool lacks_shutter() const {
        return !(shutter() > 0.0) && std::any_of(drawings_.begin(), drawings_.end(),
                                                 [](const Drawing& d) { return d.kind == ParticleDrawing::streaks; });
    }
    /// True when particles are discs or images, some of them at least.
    [[nodiscard]] bool draws_sprites() const {
        return std::any_of(drawings_.begin(), drawings_.end(), [](const Drawing& d) { return d.is_flat(); });
    }
    /// True when sprites have the colours of their image alone.
    [[nodiscard]] bool shows_image_colors() const { return plain_image_; }
    /// True when particles have no colour but that of their heat.
    [[nodiscard]] bool shows_heat_alone() const { return embers_; }
    /// The collider in which most particles are and that hides them from the camera outside; empty where there is none.
    [[nodiscard]] const std::string& hiding_collider() const { return hiding_; }

private:
    /// How a collider is shown.
    struct Looks {
        Vec3 color;
        bool glass = false;
        bool hidden = false;
        bool has_color = false;  // of its own, from the scene
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

    // How particles are drawn, run_particles.cpp.
    /// Particles that are drawn alike, by their numbers in the frame.
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
    void set_ways(const Moment& moment, const std::vector<std::size_t>& shown, PreviewSpheres& spheres) const;
    void keep_off_walls(const Moment& moment, const Group& group, PreviewSpheres& spheres);
    [[nodiscard]] WallClearance walls_at_rest() const;
    static void add_streaks(const ShutterPaths& paths, const std::vector<std::size_t>& shown,
                            const PreviewSpheres& spheres, PreviewMoving& moving);
    void add_flat(const VtkPolyData& frame, const Group& group, std::vector<Sprites>& layers) const;

    // What particles are drawn as, run_shapes.cpp.
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
    bool own_colors_ = false;       // colours are those of the frames
    bool colors_are_told_ = false;  // by the command line
    bool has_sizes_ = false;        // some particle has a size to be drawn with
    ValueRange range_;
    Camera camera_;
    std::vector<PreviewMesh> meshes_;
    std::vector<std::filesystem::path> mesh_files_;  // of each of the meshes
    ValueRange collider_range_;
    ImpulseSizes impulse_sizes_;                   // on the colliders that a quantity colours
    std::optional<double> totals_end_;             // s
    std::map<std::uint32_t, Looks> moving_looks_;  // of colliders that move, by their number
    std::map<std::uint32_t, std::filesystem::path> moving_files_;
    std::map<std::uint32_t, std::vector<Vec3>> moving_colors_;  // of their triangles, where a quantity colours them
    std::vector<PreviewPlane> planes_;
    bool is_told_ = false;              // what particles are drawn as, by the command line
    std::vector<Drawing> drawings_;     // the first: of those whose emitter says nothing
    std::vector<TriangleMesh> shapes_;  // meshes that particles are copies of, fitted into the ball of radius 1
    std::vector<Turn> turns_;           // of the particles of the frame that is drawn, where they spin
    bool plain_image_ = false;
    bool embers_ = false;
    std::vector<Vec3> emissions_;  // of the particles of the frame that is drawn; empty: none
    RunTurning turning_;
    std::string hiding_;
    std::optional<WallClearance> walls_;  // at rest, once some ball is larger than its particle
    std::optional<Preview> preview_;
};

}  // namespace ricochet::cli
