// States of a run at any time between its first and its last frame. A state between two frames is interpolated from
// both frames and from the impacts between them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/vtk.h"
#include "run/run_folder.h"
#include "view/render/motion_path.h"

namespace ricochet::cli {

/// Paths of particles while the shutter is open.
struct ShutterPaths {
    double open = 0.0;                         ///< in s
    double close = 0.0;                        ///< in s
    std::vector<std::vector<PathNode>> nodes;  ///< for each point of the frame; empty without a shutter
    std::vector<double> born;                  ///< start of each path in s: the particle's birth time or `open`,
                                               ///< whichever is later

    [[nodiscard]] bool empty() const { return nodes.empty(); }
};

/// State of a run at one time.
struct Moment {
    VtkPolyData frame;                             ///< particles at that time
    std::map<std::uint32_t, TriangleMesh> moving;  ///< moving colliders, by their numbers
    ShutterPaths paths;
};

/// The impact of one particle that is nearest to a given time.
struct NearImpact {
    double away = 0.0;   ///< time between the impact and the given time, in s, not negative
    double speed = 0.0;  ///< normal speed before the impact, in m/s; 0: no impact
    Vec3 normal;         ///< unit normal, away from the surface
};

/// Reader of a run. Loads frames and contact files on demand. Caches the files near the last requested time.
class RunTimeline {
public:
    explicit RunTimeline(const RunFolder& folder);

    [[nodiscard]] double time_of(std::size_t frame);
    [[nodiscard]] double first_time() { return time_of(0); }
    [[nodiscard]] double last_time() { return time_of(files_.size() - 1); }
    /// Returns the time of a frame by its step. Subsequent requests near this time are fast.
    [[nodiscard]] double go_to(std::uint64_t step);
    /// Returns the time from the first frame to the second, in s. It is 0 if there is only one frame.
    [[nodiscard]] double spacing() { return files_.size() < 2 ? 0.0 : time_of(1) - time_of(0); }
    /// Returns the run at a time. At the time of a frame, the result is exactly the frame's state. `shutter` is the
    /// duration, in s, of the returned paths, which end at the time; 0 gives no paths. Throws InputError for invalid
    /// files.
    [[nodiscard]] Moment at(double time, double shutter);
    /// Returns the impact of each particle that is nearest to the time. Ignores impacts that are more than `reach`, in
    /// s, before or after the time.
    [[nodiscard]] std::vector<NearImpact> impacts_near(const VtkPolyData& frame, double time, double reach);
    /// Returns true if the impacts between frames are recorded.
    [[nodiscard]] bool knows_impacts() const { return !contacts_.empty(); }

private:
    struct Rows;  // particles at one time

    [[nodiscard]] const VtkPolyData& frame(std::size_t k);
    [[nodiscard]] const VtkPolyData& contact_log(std::uint64_t step, const std::filesystem::path& path);
    // Returns the last frame at or before a time. A time within a billionth of the frame spacing counts as the frame's
    // time.
    [[nodiscard]] std::size_t index_at(double time);
    [[nodiscard]] bool is_at(std::size_t k, double time);
    [[nodiscard]] Rows rows_at(std::size_t k, bool exact, double time);
    void add_frame_nodes(std::size_t first, std::size_t last, const Rows& rows, ShutterPaths& paths);
    void add_impact_nodes(std::size_t first, std::size_t last, const Rows& rows, ShutterPaths& paths);
    void set_births(std::size_t last, const Rows& rows, ShutterPaths& paths);
    // Removes particles without any record at or after the time, because these particles ended before.
    static void drop_ended(double time, Rows& rows, ShutterPaths& paths);
    [[nodiscard]] VtkPolyData mixed_frame(std::size_t k, double time, const Rows& rows, const ShutterPaths& paths);
    void add_moving(std::size_t k, bool exact, double time, Moment& moment);

    std::vector<FrameFile> files_;
    std::map<std::uint64_t, std::filesystem::path> contacts_;  // by the step in the file name
    std::map<std::size_t, std::shared_ptr<const VtkPolyData>> loaded_;
    std::map<std::uint64_t, std::shared_ptr<const VtkPolyData>> loaded_contacts_;
    std::size_t current_ = 0;
};

}  // namespace ricochet::cli
