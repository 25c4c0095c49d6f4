// A run at any time between its first and its last frame: what lies between frames, from the states at both and the
// impacts in between.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/run_folder.h"
#include "ricochet/io/vtk.h"
#include "view/render/motion_path.h"

namespace ricochet::cli {

/// The ways of particles while the shutter is open.
struct ShutterPaths {
    double open = 0.0;                         ///< s
    double close = 0.0;                        ///< s
    std::vector<std::vector<PathNode>> nodes;  ///< of each point of the frame; empty without a shutter
    std::vector<double> born;                  ///< s, of each, where later than `open`; `open` otherwise

    [[nodiscard]] bool empty() const { return nodes.empty(); }
};

/// A run at a moment.
struct Moment {
    VtkPolyData frame;                             ///< the particles then
    std::map<std::uint32_t, TriangleMesh> moving;  ///< colliders that move, by their numbers
    ShutterPaths paths;
};

/// The impact of a particle that is nearest to a moment.
struct NearImpact {
    double away = 0.0;   ///< s from the moment, either way
    double speed = 0.0;  ///< m/s along the normal, before it; 0: there is none
    Vec3 normal;         ///< of unit length, away from what was hit
};

/// Reads frames and contact files as they are needed, and keeps those near the last time that was asked for.
class RunTimeline {
public:
    explicit RunTimeline(const RunFolder& folder);

    [[nodiscard]] double time_of(std::size_t frame);
    [[nodiscard]] double first_time() { return time_of(0); }
    [[nodiscard]] double last_time() { return time_of(files_.size() - 1); }
    /// The time of a step that is one of the frames; what is asked for next is best near it.
    [[nodiscard]] double go_to(std::uint64_t step);
    /// s from the first frame to the second; 0 where there is one frame only.
    [[nodiscard]] double spacing() { return files_.size() < 2 ? 0.0 : time_of(1) - time_of(0); }
    /// The run at a time within it; exactly a frame's own state at its time. shutter: s before it that the paths are
    /// wanted for; 0: no paths. Throws InputError for files that are not a run's.
    [[nodiscard]] Moment at(double time, double shutter);
    /// Of each particle of a moment at that time, the impact at most `reach` s away from it.
    [[nodiscard]] std::vector<NearImpact> impacts_near(const VtkPolyData& frame, double time, double reach);
    /// True when impacts between frames are known.
    [[nodiscard]] bool knows_impacts() const { return !contacts_.empty(); }

private:
    struct Rows;  // of the particles of a moment

    [[nodiscard]] const VtkPolyData& frame(std::size_t k);
    [[nodiscard]] const VtkPolyData& contact_log(std::uint64_t step, const std::filesystem::path& path);
    // The last frame at or before a time; frames within a billionth of their distance count as at it.
    [[nodiscard]] std::size_t index_at(double time);
    [[nodiscard]] bool is_at(std::size_t k, double time);
    [[nodiscard]] Rows rows_at(std::size_t k, bool exact, double time);
    void add_frame_nodes(std::size_t first, std::size_t last, const Rows& rows, ShutterPaths& paths);
    void add_impact_nodes(std::size_t first, std::size_t last, const Rows& rows, ShutterPaths& paths);
    void set_births(std::size_t last, const Rows& rows, ShutterPaths& paths);
    // Particles of which nothing is known at the time or later: they ended before it.
    static void drop_ended(double time, Rows& rows, ShutterPaths& paths);
    [[nodiscard]] VtkPolyData mixed_frame(std::size_t k, double time, const Rows& rows, const ShutterPaths& paths);
    void add_moving(std::size_t k, bool exact, double time, Moment& moment);

    std::vector<FrameFile> files_;
    std::map<std::uint64_t, std::filesystem::path> contacts_;  // by their step
    std::map<std::size_t, std::shared_ptr<const VtkPolyData>> loaded_;
    std::map<std::uint64_t, std::shared_ptr<const VtkPolyData>> loaded_contacts_;
    std::size_t current_ = 0;
};

}  // namespace ricochet::cli
