// Pictures of a run: its folder on one side, the renderer on the other.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/io/run_folder.h"
#include "ricochet/io/vtk.h"
#include "ricochet/render/camera.h"
#include "ricochet/render/color_map.h"
#include "ricochet/render/picture.h"
#include "ricochet/render/preview.h"

namespace ricochet::cli {

/// How a run is shown.
struct PictureStyle {
    std::string color_by = "speed";  ///< array of the frames; speed is the length of velocity
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
    /// Reads the colliders and looks at the chosen frames. Throws InputError on files that are not a run's, and on
    /// names that the run does not have.
    RunPictures(const RunFolder& folder, const std::vector<FrameFile>& chosen, PictureStyle style, double aspect);

    [[nodiscard]] Image picture(const FrameFile& frame, const PictureOptions& options);
    [[nodiscard]] const ValueRange& range() const { return range_; }
    [[nodiscard]] const Camera& camera() const { return camera_; }

private:
    void survey(const std::vector<FrameFile>& chosen);
    void load_colliders(const RunFolder& folder);
    void choose_camera(const RunFolder& folder, double aspect);
    [[nodiscard]] std::vector<double> shown_values(const VtkPolyData& frame, const FrameFile& file) const;
    [[nodiscard]] double visible_radius() const;
    [[nodiscard]] std::vector<double> shown_radii(const VtkPolyData& frame) const;
    [[nodiscard]] PreviewMoving moving(const VtkPolyData& frame, const FrameFile& file) const;

    PictureStyle style_;
    ViewSubject subject_;
    std::size_t most_particles_ = 0;
    ValueRange range_;
    Camera camera_;
    std::vector<PreviewMesh> meshes_;
    std::vector<PreviewPlane> planes_;
    std::optional<Preview> preview_;
};

}  // namespace ricochet::cli
