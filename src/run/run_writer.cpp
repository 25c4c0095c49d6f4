#include "run/run_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>
#include <variant>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/io/frames.h"
#include "ricochet/io/vtk.h"
#include "run/camera_frames.h"
#include "run/picture_files.h"
#include "run/run_folder.h"

namespace ricochet {
namespace {

/// Timer that adds its own lifetime, in s, to a sum.
class SecondsTo {
public:
    explicit SecondsTo(double& sum) : sum_(sum) {}
    // Negative durations count as 0, although a steady clock should never run backwards.
    ~SecondsTo() { sum_ += std::max(0.0, std::chrono::duration<double>(Clock::now() - start_).count()); }
    SecondsTo(const SecondsTo&) = delete;
    SecondsTo& operator=(const SecondsTo&) = delete;

private:
    using Clock = std::chrono::steady_clock;

    double& sum_;
    Clock::time_point start_ = Clock::now();
};

std::vector<ColliderInfo> describe_colliders(const Simulation& simulation) {
    std::vector<ColliderInfo> infos;
    for (const ColliderDescription& collider : simulation.colliders()) {
        infos.push_back({collider.name,
                         type_name(collider.shape),
                         collider_file_name(infos.size(), collider.name),
                         collider.material,
                         is_moving(collider),
                         {}});
    }
    return infos;
}

}  // namespace

Box3 particle_region(const SimulationSetup& setup) {
    Box3 region;
    for (const Particle& particle : setup.particles) region.include(particle.position);
    for (const EmitterDescription& emitter : setup.emitters) {
        if (!emitter.parent) region.include(bounds(emitter.shape));
    }
    if (setup.bounds) region.include(*setup.bounds);
    return region;
}

Box3 collider_region(const Simulation& simulation) {
    Box3 region;
    for (std::size_t i = 0; i < simulation.colliders().size(); ++i) {
        const MovingPose pose = simulation.collider_pose(i, simulation.time());
        const bool moves = is_moving(simulation.colliders()[i]);
        auto mesh = simulation.collider_mesh(i);
        if (!mesh) continue;
        for (Vec3& vertex : mesh->vertices) {
            if (moves) vertex = pose.point(vertex);
        }
        region.include(bounds(*mesh));
    }
    return region;
}

void list_kept_files(const std::filesystem::path& folder, const Checkpoint& checkpoint) {
    const auto list = [&](const FileSeries& series, const std::vector<PvdEntry>& entries) {
        std::error_code ignored;
        if (std::filesystem::exists(folder / series.list, ignored)) write_file(folder / series.list, pvd_text(entries));
    };
    list(kParticleSeries, checkpoint.frames);
    list(kContactSeries, checkpoint.contacts);
    list(kMovingSeries, checkpoint.moving);
}

void fill_run_frame(VtkPolyData& frame, const RunInfo& info, const Simulation& simulation) {
    fill_particle_frame(frame, simulation.particles(), simulation.shown_attributes(), simulation.time(),
                        simulation.has_spheres());
    if (const auto parents = simulation.cloud_parents()) add_cloud_parents(frame, simulation.particles(), *parents);
    if (!simulation.springs().empty()) {
        add_springs(frame, simulation.particles(), simulation.springs(), simulation.spring_faces());
    }
    if (info.camera && info.camera->moves()) {
        add_camera(frame, current_camera_position(*info.camera, info.up, info.camera->frames.get(), simulation));
    }
}

RunWriter::RunWriter(std::filesystem::path folder, RunInfo info, const Simulation& simulation, const Box3& region,
                     const std::optional<Checkpoint>& resumed, WriterThread::Mode mode)
    : folder_(std::move(folder)),
      info_(std::move(info)),
      region_(region),
      output_seconds_(resumed ? resumed->output_seconds : 0.0),
      thread_(std::make_shared<WriterThread>(mode)),
      frames_(folder_, kParticleSeries, resumed ? resumed->frames : std::vector<PvdEntry>{}, thread_),
      loads_(folder_, resumed ? resumed->loads : LoadRows{}),
      counters_(folder_, resumed ? resumed->counters : CounterRows{}) {
    const SecondsTo clock(output_seconds_);
    if (resumed) last_frame_ = simulation.step_index();
    if (simulation.options().record_contacts) {
        contacts_.emplace(folder_, simulation, ContactLog::kMostRows,
                          resumed ? resumed->contacts : std::vector<PvdEntry>{}, thread_);
    }
    const std::vector<ColliderDescription>& colliders = simulation.colliders();
    if (std::any_of(colliders.begin(), colliders.end(), is_moving)) {
        moving_.emplace(folder_, kMovingSeries, resumed ? resumed->moving : std::vector<PvdEntry>{}, thread_);
    }
    if (!resumed) region_.include(collider_region(simulation));
    info_.colliders = describe_colliders(simulation);
    for (std::size_t i = 0; i < std::min(info_.looks.size(), info_.colliders.size()); ++i) {
        info_.colliders[i].looks = info_.looks[i];
    }
    if (info_.picture) keep_picture_files(folder_, *info_.picture);
    for (std::size_t k = 0; k < info_.drawings.size(); ++k) keep_picture_files(folder_, info_.drawings[k], k + 1);
    write_file(folder_ / kRunInfoFile, run_info_text(info_));
    write_colliders(simulation);
    std::vector<PvdEntry> series;
    for (std::size_t i = 0; i < info_.colliders.size(); ++i) {
        if (!is_moving(colliders[i])) series.push_back({0.0, series.size(), info_.colliders[i].file});
    }
    if (!series.empty()) write_file(folder_ / kColliderSeriesFile, pvd_text(series));
}

void RunWriter::add_step(const Simulation& simulation) {
    const SecondsTo clock(output_seconds_);
    frames_.check();
    if (contacts_) contacts_->add_step(simulation);
}

void RunWriter::write_frame(const Simulation& simulation) {
    if (last_frame_ == simulation.step_index()) return;
    const SecondsTo clock(output_seconds_);
    if (contacts_) contacts_->write(simulation);
    if (writes_particles_) {
        VtkPolyData frame = frames_.blank_frame();
        fill_run_frame(frame, info_, simulation);
        frames_.submit(simulation.step_index(), std::move(frame));
    }
    if (moving_) moving_->submit(simulation.step_index(), moving_collider_frame(simulation, region_));
    loads_.add(simulation);
    counters_.add(simulation);
    last_frame_ = simulation.step_index();
}

void RunWriter::list(const PieceIndex& index) {
    frames_.submit_index(index.step, index.shape.time, pvtp_text(index.shape, index.files));
}

void RunWriter::write_checkpoint(const Simulation& simulation, std::uint64_t scene, double wall_seconds,
                                 std::vector<CheckpointPart> parts) {
    const SecondsTo clock(output_seconds_);
    Checkpoint checkpoint{scene, wall_seconds,  output_seconds_,  frames_.drain(), {},
                          {},    loads_.rows(), std::move(parts), counters_.rows()};
    if (contacts_) checkpoint.contacts = contacts_->drain();
    if (moving_) checkpoint.moving = moving_->drain();
    loads_.write(simulation);
    counters_.write(simulation);
    ricochet::write_checkpoint(folder_ / kCheckpointFile, checkpoint, simulation);
}

void RunWriter::keep_checkpoint_for_extension() const {
    std::error_code error;
    if (!std::filesystem::exists(folder_ / kCheckpointFile, error)) return;
    std::filesystem::rename(folder_ / kCheckpointFile, folder_ / kExtensionFile, error);
    if (!error) return;
    throw RunError(fmt::format("{}: cannot be renamed to {} ({})", (folder_ / kCheckpointFile).string(), kExtensionFile,
                               error.message()));
}

RunSummary RunWriter::finish(const Simulation& simulation) {
    write_frame(simulation);
    return close(simulation);
}

RunSummary RunWriter::finish_diverged(const Simulation& simulation, const std::string& message) {
    RunSummary summary = close(simulation);
    summary.diverged = message;
    return summary;
}

RunSummary RunWriter::close(const Simulation& simulation) {
    {
        const SecondsTo clock(output_seconds_);
        frames_.finish();
        if (contacts_) contacts_->finish();
        if (moving_) moving_->finish();
        write_colliders(simulation);
        loads_.write(simulation);
        counters_.write(simulation);
    }
    RunSummary summary = summarize(simulation, info_.groups);
    summary.frames = frames_.submitted();
    summary.output_seconds = output_seconds_;
    for (std::size_t i = 0; i < summary.colliders.size(); ++i) summary.colliders[i].file = info_.colliders[i].file;
    return summary;
}

void RunWriter::write_summary(const RunSummary& summary) const {
    write_file(folder_ / kSummaryFile, summary_text(summary));
}

void RunWriter::write_colliders(const Simulation& simulation) const {
    for (std::size_t i = 0; i < info_.colliders.size(); ++i) {
        const ColliderDescription& collider = simulation.colliders()[i];
        const TriangleTotals totals = simulation.triangle_totals(i);
        const auto mesh = simulation.collider_mesh(i);
        const double time = simulation.time();
        VtkPolyData frame = mesh ? mesh_collider_frame(*mesh, totals, time)
                                 : plane_collider_frame(std::get<PlaneShape>(collider.shape), region_, totals, time);
        const TriangleGroups groups = i < info_.groups.size() ? info_.groups[i] : TriangleGroups{};
        add_surfaces(frame, collider, simulation.materials(), groups, totals);
        write_vtp(folder_ / info_.colliders[i].file, frame);
    }
}

}  // namespace ricochet
