#include "view/export/run_export.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "ricochet/core/error.h"
#include "run/mesh_writer.h"
#include "view/export/export_colliders.h"
#include "view/export/export_folder.h"
#include "view/export/frame_reader.h"
#include "view/export/glb_writer.h"
#include "view/export/ply_points.h"

namespace ricochet {
namespace {

constexpr const char* kPly = ".ply";

std::string numbered(std::uint64_t number) { return fmt::format("_{:06}{}", number, kPly); }

std::string left_out_note(const ExportColliders& colliders, const RunFolder& folder) {
    const std::size_t count = folder.frames.size() - colliders.frames().size();
    return fmt::format("{} {} the moving colliders and {} left out", count, count == 1 ? "frame lacks" : "frames lack",
                       count == 1 ? "is" : "are");
}

const std::vector<double>* radii_of(const VtkPolyData& frame) {
    const VtkArray* const array = find_array(frame.point_arrays, "radius");
    return array == nullptr ? nullptr : std::get_if<std::vector<double>>(&array->values);
}

void add_colliders(const RunFolder& folder, const FrameFile& frame, GlbScene& scene, ExportReport& report) {
    const ExportColliders colliders(folder);
    if (colliders.any_moves() && frame.moving.empty()) {
        throw InputError(fmt::format("--frame {}: lacks the moving colliders; another frame has them", frame.step));
    }
    const std::map<std::uint32_t, TriangleMesh> moving = colliders.moving(frame);
    std::size_t hidden = 0;
    for (const ExportCollider& collider : colliders.all()) {
        if (collider.looks.hidden) {
            ++hidden;
            continue;
        }
        scene.meshes.push_back({collider.name, collider.moves ? moving.at(collider.number) : collider.mesh,
                                collider.looks.color, collider.looks.roughness, collider.looks.glass});
    }
    if (hidden > 0) report.notes.push_back(fmt::format("colliders that the scene hides are left out: {}", hidden));
}

// Adds particles with a radius as spheres and all other particles as points. If there are too many spheres, all
// particles become points.
void add_particles(VtkPolyData frame, GlbScene& scene, ExportReport& report) {
    const std::vector<double>* const radii = radii_of(frame);
    std::size_t lost = 0;
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
        const double radius = radii == nullptr ? 0.0 : (*radii)[i];
        if (!is_finite(frame.points[i])) {
            ++lost;
        } else if (radius > 0.0) {
            scene.spheres.push_back({frame.points[i], radius});
        } else {
            scene.points.push_back(frame.points[i]);
        }
    }
    if (scene.spheres.size() > kMostSphereNodes) {
        report.notes.push_back(
            fmt::format("{} particles have a radius, more than the {} that become spheres: all are points",
                        scene.spheres.size(), kMostSphereNodes));
        for (const GlbSphere& sphere : scene.spheres) scene.points.push_back(sphere.center);
        scene.spheres.clear();
    }
    if (lost > 0) report.notes.push_back(fmt::format("particles without a finite position are left out: {}", lost));
    if (!frame.lines.empty()) report.notes.emplace_back("springs that are lines are left out");
    if (!frame.triangles.empty()) {
        scene.meshes.push_back({"cloth", {std::move(frame.points), std::move(frame.triangles)}, {}});
    }
}

// Writer of an export to PLY. Chooses the file names before it writes the files.
class PlyExport {
public:
    PlyExport(const RunFolder& folder, ExportNumbers numbers) : colliders_(folder) {
        std::vector<std::string> endings;
        for (const FrameFile& frame : colliders_.frames()) {
            endings.push_back(numbered(numbers == ExportNumbers::steps ? frame.step : endings.size()));
        }
        frame_endings_ = std::move(endings);
        (void)names_.take("particles", frame_endings_);
        for (const ExportCollider& collider : colliders_.all()) {
            stems_.push_back(
                names_.take(collider.name, collider.moves ? frame_endings_ : std::vector<std::string>{kPly}));
        }
    }

    ExportReport write(ExportFolder& target, const ExportProgress& progress) {
        target.begin(names_.files());
        for (std::size_t c = 0; c < stems_.size(); ++c) {
            const ExportCollider& collider = colliders_.all()[c];
            if (!collider.moves) write_mesh(collider.mesh, target.file(stems_[c] + kPly));
        }
        const std::vector<FrameFile>& frames = colliders_.frames();
        std::map<std::string, std::string> renamed;
        for (std::size_t k = 0; k < frames.size(); ++k) {
            const std::filesystem::path file = target.file("particles" + frame_endings_[k]);
            for (const auto& [name, property] : write_ply_points(file, read_frame(frames[k].path)).renamed) {
                renamed.emplace(name, property);
            }
            const std::map<std::uint32_t, TriangleMesh> moving = colliders_.moving(frames[k]);
            for (std::size_t c = 0; c < stems_.size(); ++c) {
                const ExportCollider& collider = colliders_.all()[c];
                if (collider.moves) write_mesh(moving.at(collider.number), target.file(stems_[c] + frame_endings_[k]));
            }
            progress(static_cast<double>(k + 1) / static_cast<double>(frames.size()));
        }
        ExportReport report{names_.files().size(), frames.size(), {}};
        for (const auto& [name, property] : renamed) {
            report.notes.push_back(fmt::format("the attribute \"{}\" is written as {}", name, property));
        }
        return report;
    }

    [[nodiscard]] const ExportColliders& colliders() const { return colliders_; }

private:
    ExportColliders colliders_;
    ExportNames names_;
    std::vector<std::string> frame_endings_;
    std::vector<std::string> stems_;  // stems of the file names, by collider
};

}  // namespace

ExportReport export_ply(const RunFolder& folder, const std::filesystem::path& target, ExportNumbers numbers,
                        const ExportProgress& progress) {
    ExportFolder output(target);  // constructed first, so that an unsuitable folder is reported before the work
    PlyExport work(folder, numbers);
    ExportReport report = work.write(output, progress);
    if (report.frames < folder.frames.size()) report.notes.push_back(left_out_note(work.colliders(), folder));
    return report;
}

ExportReport export_gltf(const RunFolder& folder, const FrameFile& frame, const std::filesystem::path& target) {
    ExportReport report{1, 1, {}};
    GlbScene scene;
    add_colliders(folder, frame, scene, report);
    add_particles(read_frame(frame.path), scene, report);
    (void)write_glb(target, scene);
    return report;
}

}  // namespace ricochet
