#include "ricochet/io/contact_log.h"

#include <stdexcept>
#include <utility>
#include <variant>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

/// Rows per unit of parallel work.
constexpr std::size_t kBlock = 1024;

}  // namespace

void ContactColumns::resize(std::size_t rows) {
    point.resize(rows);
    time.resize(rows);
    particle.resize(rows);
    collider.resize(rows);
    triangle.resize(rows);
    barycentric.resize(rows);
    normal.resize(rows);
    velocity_before.resize(rows);
    velocity_after.resize(rows);
    impulse.resize(rows);
    radius.resize(rows);
}

VtkPolyData contact_frame(ContactColumns columns, double time) {
    VtkPolyData frame;
    frame.time = time;
    frame.points = std::move(columns.point);
    frame.point_arrays = {{"time", std::move(columns.time)},
                          {"particle", std::move(columns.particle)},
                          {"collider", std::move(columns.collider)},
                          {"triangle", std::move(columns.triangle)},
                          {"barycentric", std::move(columns.barycentric)},
                          {"normal", std::move(columns.normal)},
                          {"velocity_before", std::move(columns.velocity_before)},
                          {"velocity_after", std::move(columns.velocity_after)},
                          {"impulse", std::move(columns.impulse)},
                          {"radius", std::move(columns.radius)}};
    return frame;
}

ContactLog::ContactLog(const std::filesystem::path& folder, const Simulation& simulation, std::size_t most_rows,
                       std::vector<PvdEntry> earlier, std::shared_ptr<WriterThread> thread)
    : files_(folder, kContactSeries, std::move(earlier), std::move(thread)),
      most_rows_(most_rows),
      step_(simulation.step_index()) {
    if (step_ > 0) written_ = step_;  // an interrupted run has written all of its steps
    if (!simulation.options().record_contacts) {
        throw std::logic_error("a contact log needs a simulation that records its contacts");
    }
    for (const ColliderDescription& collider : simulation.colliders()) {
        has_triangles_.push_back(std::holds_alternative<MeshShape>(collider.shape) ||
                                 std::holds_alternative<CuboidShape>(collider.shape));
    }
}

void ContactLog::add_step(const Simulation& simulation) {
    if (simulation.step_index() == step_) return;
    if (simulation.step_index() != step_ + 1) throw std::logic_error("a step was left out of the contact log");
    step_ = simulation.step_index();
    const std::vector<ContactRecord>& records = simulation.contact_records();
    const std::size_t first = columns_.size();
    columns_.resize(first + records.size());
    parallel_for_blocks(records.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) set_row(first + i, records[i], simulation);
    });
    if (columns_.size() >= most_rows_) write(simulation);
}

void ContactLog::set_row(std::size_t row, const ContactRecord& record, const Simulation& simulation) {
    const SurfaceName surface = simulation.surface_name(record.surface);
    const SurfacePosition place = simulation.contact_point(record);
    columns_.point[row] = place.point;
    columns_.time[row] = record.time;
    columns_.particle[row] = static_cast<std::int64_t>(record.particle);
    columns_.collider[row] = surface.collider;
    columns_.triangle[row] = has_triangles_[surface.collider] ? std::int64_t{surface.triangle} : -1;
    columns_.barycentric[row] = place.barycentric;
    columns_.normal[row] = record.normal;
    columns_.velocity_before[row] = record.velocity_before;
    columns_.velocity_after[row] = record.velocity_after;
    columns_.impulse[row] = record.mass * (record.velocity_before - record.velocity_after);
    columns_.radius[row] = record.radius;
}

void ContactLog::write(const Simulation& simulation) {
    add_step(simulation);
    if (written_ == step_) return;
    written_ = step_;
    files_.submit(step_, contact_frame(std::exchange(columns_, {}), simulation.time()));
}

}  // namespace ricochet
