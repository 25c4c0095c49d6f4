// Exports a run as meshes with point caches.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "ricochet/core/error.h"
#include "run/mesh_writer.h"
#include "view/export/export_colliders.h"
#include "view/export/export_folder.h"
#include "view/export/frame_reader.h"
#include "view/export/point_cache_writer.h"
#include "view/export/run_export.h"

namespace ricochet {
namespace {

constexpr const char* kObj = ".obj";
constexpr const char* kPc2 = ".pc2";

/// Largest deviation of a frame's time from even spacing, relative to the spacing.
/// Reason: times are rounded sums of time steps, which deviate far less. The last frame deviates far more if the run's
/// duration is not a multiple of the spacing.
constexpr double kSameTime = 1e-6;

const std::vector<std::int64_t>& ids_of(const VtkPolyData& frame, const FrameFile& file) {
    const VtkArray* const array = find_array(frame.point_arrays, "id");
    const auto* const ids = array == nullptr ? nullptr : std::get_if<std::vector<std::int64_t>>(&array->values);
    if (ids == nullptr) throw InputError(fmt::format("{}: has no array id", file.path.string()));
    return *ids;
}

/// Properties of the frames that must be known before the first sample is written.
struct Survey {
    std::vector<FrameFile> frames;  ///< evenly spaced in time
    double start = 0.0;             ///< time of the first frame, in s
    double spacing = 0.0;           ///< time between frames, in s
    std::size_t left_out = 0;       ///< number of frames that are not evenly spaced
    bool same_particles = true;
    std::string why_not;  ///< description of the first frame that has other particles than the run's first frame
};

// Returns the median time between consecutive frames.
double usual_spacing(const std::vector<double>& times) {
    std::vector<double> gaps;
    for (std::size_t k = 1; k < times.size(); ++k) gaps.push_back(times[k] - times[k - 1]);
    const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
    std::nth_element(gaps.begin(), middle, gaps.end());
    return *middle;
}

// Selects frames that are evenly spaced in time, because a cache requires evenly spaced samples. An interruption or the
// end of a run can write frames at other times; these frames are left out.
void choose_frames(const std::vector<FrameFile>& files, const std::vector<double>& times, Survey& survey) {
    if (times.size() < 2) {
        throw InputError(
            fmt::format("{}: a point cache needs at least 2 frames; expected a run with more, or --format "
                        "ply or gltf",
                        files.front().path.parent_path().string()));
    }
    survey.start = times.front();
    survey.spacing = usual_spacing(times);
    double last = survey.start;
    for (std::size_t k = 0; k < times.size(); ++k) {
        const double wanted = survey.start + static_cast<double>(survey.frames.size()) * survey.spacing;
        if (std::fabs(times[k] - wanted) <= kSameTime * survey.spacing) {
            survey.frames.push_back(files[k]);
            last = times[k];
        } else if (times[k] > wanted) {
            if (k + 1 == times.size()) break;
            throw InputError(
                fmt::format("{}: at {} s, but a frame at {} s is missing: samples of a point cache are "
                            "evenly spaced, expected all frames, or --format ply",
                            files[k].path.string(), times[k], wanted));
        }
    }
    survey.left_out = times.size() - survey.frames.size();
    // The spacing is computed over the whole range, so that the rounding of each time has little effect.
    if (survey.frames.size() > 1)
        survey.spacing = (last - survey.start) / static_cast<double>(survey.frames.size() - 1);
}

Survey survey_of(const std::vector<FrameFile>& files) {
    Survey survey;
    std::vector<double> times;
    std::vector<std::int64_t> first;
    for (const FrameFile& file : files) {
        const VtkPolyData frame = read_frame(file.path);
        const std::vector<std::int64_t>& ids = ids_of(frame, file);
        if (times.empty()) first = ids;
        if (survey.same_particles && (ids != first || ids.empty())) {
            survey.same_particles = false;
            survey.why_not = ids.empty() && first.empty()
                                 ? fmt::format("step {} has none", file.step)
                                 : fmt::format("step {} has others than step {}", file.step, files.front().step);
        }
        times.push_back(frame.time);
    }
    choose_frames(files, times, survey);
    return survey;
}

/// A moving collider or the particles, with their cache.
struct Cached {
    std::string stem;
    std::optional<std::uint32_t> collider;  ///< collider index; std::nullopt: the particles
    std::size_t points = 0;
    std::unique_ptr<PointCacheWriter> cache = nullptr;
};

class Pc2Export {
public:
    explicit Pc2Export(const RunFolder& folder) : colliders_(folder), survey_(survey_of(colliders_.frames())) {
        const std::vector<std::string> both = {kObj, kPc2};
        particles_stem_ = survey_.same_particles ? names_.take("particles", both) : "";
        for (const ExportCollider& collider : colliders_.all()) {
            stems_.push_back(names_.take(collider.name, collider.moves ? both : std::vector<std::string>{kObj}));
        }
        if (!colliders_.any_moves() && !survey_.same_particles) {
            throw InputError(
                fmt::format("{}: nothing of this run fits a point cache: no collider moves, and the particles change "
                            "({}); expected --format ply",
                            folder.frames.front().path.parent_path().string(), survey_.why_not));
        }
    }

    ExportReport write(ExportFolder& target, const ExportProgress& progress) {
        target.begin(names_.files());
        write_meshes(target);
        for (Cached& one : cached_) {
            one.cache =
                std::make_unique<PointCacheWriter>(target.file(one.stem + kPc2), one.points, survey_.frames.size());
        }
        for (std::size_t k = 0; k < survey_.frames.size(); ++k) {
            add_sample(survey_.frames[k]);
            progress(static_cast<double>(k + 1) / static_cast<double>(survey_.frames.size()));
        }
        for (Cached& one : cached_) one.cache->commit();
        return {names_.files().size(), survey_.frames.size(), notes()};
    }

private:
    // Writes all meshes. Moving meshes are at their positions in the first sample.
    void write_meshes(const ExportFolder& target) {
        if (survey_.same_particles) {
            const TriangleMesh points{read_frame(survey_.frames.front().path).points, {}};
            write_mesh(points, target.file(particles_stem_ + kObj));
            cached_.push_back({particles_stem_, std::nullopt, points.vertices.size()});
        }
        for (std::size_t c = 0; c < stems_.size(); ++c) {
            const ExportCollider& collider = colliders_.all()[c];
            write_mesh(collider.mesh, target.file(stems_[c] + kObj));
            if (collider.moves) cached_.push_back({stems_[c], collider.number, collider.mesh.vertices.size()});
        }
    }

    void add_sample(const FrameFile& frame) {
        const std::map<std::uint32_t, TriangleMesh> moving = colliders_.moving(frame);
        for (const Cached& one : cached_) {
            one.cache->add(one.collider ? moving.at(*one.collider).vertices : read_frame(frame.path).points);
        }
    }

    [[nodiscard]] std::vector<std::string> notes() const {
        std::vector<std::string> notes;
        notes.push_back(fmt::format("samples are {:.12g} s apart: \"frame_rate\": {:.12g}, \"start\": {:.12g}",
                                    survey_.spacing, 1.0 / survey_.spacing, survey_.start));
        if (survey_.left_out > 0) {
            notes.push_back(
                fmt::format("frames that are not evenly spaced in time are left out: {}", survey_.left_out));
        }
        if (!survey_.same_particles) {
            notes.push_back(
                fmt::format("the particles do not fit a point cache, whose points are always the same ({}): "
                            "--format ply has them",
                            survey_.why_not));
        }
        return notes;
    }

    ExportColliders colliders_;
    Survey survey_;
    ExportNames names_;
    std::string particles_stem_;
    std::vector<std::string> stems_;  // stems of the file names, by collider
    std::vector<Cached> cached_;
};

}  // namespace

ExportReport export_pc2(const RunFolder& folder, const std::filesystem::path& target, const ExportProgress& progress) {
    ExportFolder output(target);  // constructed first, so that an unsuitable folder is reported before the work
    return Pc2Export(folder).write(output, progress);
}

}  // namespace ricochet
