// Pictures and films of a run: its folder on one side, the renderer on the other.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/unfinished_file.h"
#include "ricochet/io/run_folder.h"
#include "ricochet/io/vtk.h"
#include "ricochet/render/camera.h"
#include "ricochet/render/color_map.h"
#include "ricochet/render/image.h"
#include "ricochet/render/picture.h"
#include "ricochet/render/preview.h"

namespace ricochet::cli {

// A film from pictures, through the ffmpeg program.

/// Feeds pictures to ffmpeg, which writes an H.264 film. The film appears under its name when finish() has been called;
/// without it nothing is left behind.
class Film {
public:
    /// What ffmpeg holds of pictures that it compares, bytes a pixel; measured.
    static constexpr double kBytesPerPixel = 200.0;

    /// Throws RunError when ffmpeg is not installed. width and height must be even.
    Film(std::filesystem::path target, int width, int height, int frames_per_second);
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Throws RunError with ffmpeg's own words when it has given up.
    void add(const Image& image);
    void finish();

private:
    void start(int width, int height, int frames_per_second);
    int wait();
    [[noreturn]] void fail();

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    UnfinishedFile unfinished_;
    std::FILE* messages_ = nullptr;  // what ffmpeg says on stderr
    int pipe_ = -1;
    int process_ = -1;
};

/// What particles are drawn as.
enum class ParticleDrawing {
    automatic,  ///< soft where the frames have an opacity, spheres otherwise
    spheres,
    soft,  ///< discs that cover what is behind by their opacity
    glow,  ///< discs of light that adds up
};

/// How a run is shown.
struct PictureStyle {
    /// Array of the frames; speed is the length of velocity. Empty: the particles' own colours, or speed without.
    std::string color_by;
    ParticleDrawing drawing = ParticleDrawing::automatic;
    std::optional<ValueRange> range;
    ColorMap map = ColorMap::plasma;
    std::optional<double> particle_radius;  ///< m; nothing: the frames' own, or one that can be seen for points
    bool collider_hits = false;             ///< colour colliders by hits
    std::vector<std::string> hidden;        ///< colliders that are left out, by name
    std::vector<std::string> glass;         ///< colliders that are seen through, by name
    std::optional<Camera> camera;
    std::optional<Vec3> up;
};

/// Makes pictures of chosen frames with one camera, one range of colours and one set of colliders.
class RunPictures {
public:
    /// Reads the colliders and checks the chosen frames. Throws InputError on files that are not a run's, and on
    /// names that the run does not have.
    RunPictures(const RunFolder& folder, const std::vector<FrameFile>& chosen, PictureStyle style, double aspect);

    [[nodiscard]] Image picture(const FrameFile& frame, const PictureOptions& options);
    [[nodiscard]] const ValueRange& range() const { return range_; }
    /// Array that colours the particles.
    [[nodiscard]] const std::string& color_by() const { return style_.color_by; }
    /// True when the frames themselves say the colours.
    [[nodiscard]] bool shows_own_colors() const { return own_colors_; }
    [[nodiscard]] const Camera& camera() const { return camera_; }
    /// True when particles are soft discs.
    [[nodiscard]] bool draws_sprites() const {
        return style_.drawing == ParticleDrawing::soft || style_.drawing == ParticleDrawing::glow;
    }

private:
    void survey(const std::vector<FrameFile>& chosen);
    void load_colliders(const RunFolder& folder);
    void survey_moving(const std::vector<FrameFile>& chosen);
    void add_moving(const FrameFile& file, PreviewMoving& moving) const;
    void choose_camera(const RunFolder& folder, double aspect);
    [[nodiscard]] std::vector<double> shown_values(const VtkPolyData& frame, const FrameFile& file) const;
    void choose_looks(const VtkPolyData& frame);
    [[nodiscard]] std::vector<Vec3> colors(const VtkPolyData& frame, const FrameFile& file) const;
    [[nodiscard]] double visible_radius() const;
    [[nodiscard]] std::vector<double> shown_radii(const VtkPolyData& frame) const;
    [[nodiscard]] PreviewMoving moving(const VtkPolyData& frame, const FrameFile& file) const;

    PictureStyle style_;
    ViewSubject subject_;
    std::size_t most_particles_ = 0;
    bool own_colors_ = false;  // colours are those of the frames
    bool has_sizes_ = false;   // some particle has a size to be drawn with
    ValueRange range_;
    Camera camera_;
    std::vector<PreviewMesh> meshes_;
    /// How a collider that moves is shown, by its number.
    struct MovingLooks {
        Vec3 color;
        bool glass = false;
        bool hidden = false;
    };
    std::map<std::uint32_t, MovingLooks> moving_looks_;
    std::vector<PreviewPlane> planes_;
    std::optional<Preview> preview_;
};

}  // namespace ricochet::cli
