#include "run/frame_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <variant>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/io/frames.h"
#include "run/surface_groups.h"

namespace ricochet {

WriterThread::WriterThread(Mode mode) : mode_(mode) {
    if (mode_ != Mode::background) return;
    try {
        thread_ = std::thread([this] { work(); });
    } catch (const std::system_error& error) {
        throw RunError(fmt::format("the thread that writes files cannot be started: memory or threads are short ({})",
                                   error.code().message()));
    }
}

WriterThread::~WriterThread() {
    if (mode_ == Mode::synchronous) return;
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void WriterThread::wait_until_at_most(std::size_t in_flight) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return jobs_.size() <= in_flight || error_; });
    if (error_) std::rethrow_exception(error_);
}

void WriterThread::wait_for_room() { wait_until_at_most(kMostInFlight - 1); }

void WriterThread::drain() { wait_until_at_most(0); }

void WriterThread::check() {
    const std::lock_guard lock(mutex_);
    if (error_) std::rethrow_exception(error_);
}

void WriterThread::submit(std::function<void()> job) {
    wait_for_room();
    if (mode_ == Mode::synchronous) {
        try {
            job();
        } catch (...) {
            error_ = std::current_exception();
            throw;
        }
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(std::move(job));
    }
    changed_.notify_all();
}

void WriterThread::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return !jobs_.empty() || closing_; });
        if (closing_ || error_) return;
        std::function<void()>& job = jobs_.front();  // the reference stays valid, because only this thread removes jobs
        lock.unlock();
        std::exception_ptr error;
        try {
            job();
        } catch (...) {
            error = std::current_exception();
        }
        job = nullptr;  // releases the captured frame before the lock is taken and the queue slot is freed
        lock.lock();
        jobs_.pop_front();
        error_ = error;
        changed_.notify_all();
        if (error_) return;
    }
}

// Series of frames.

namespace {

// Number of frames up to which the series file is rewritten after each frame. A longer series file is rewritten only
// after new frames with as many bytes as the series file itself. The cost of rewriting therefore never dominates.
constexpr std::size_t kAlwaysListed = 1000;

}  // namespace

/// Frame files of a series and the series file that lists them.
/// The writer thread uses this object. Other threads use it only while the writer thread has no job. A mutex protects
/// the frames that are reused.
class FrameWriter::Series {
public:
    Series(std::filesystem::path folder, FileSeries files, std::vector<PvdEntry> earlier)
        : folder_(std::move(folder)), files_(files), entries_(std::move(earlier)) {}

    void write(std::uint64_t step, VtkPolyData& frame) {
        const std::string name = files_.file_name(step);
        list(frame.time, name, write_vtp(folder_ / name, frame));
        const std::lock_guard lock(mutex_);
        if (keeps_frames_) written_.push_back(std::move(frame));
    }

    void write_index(std::uint64_t step, double time, const std::string& text) {
        const std::string name = frame_index_name(step);
        write_file(folder_ / name, text);
        list(time, name, text.size());
    }

    // A checkpoint refers to the frames in the series file. The series file must therefore be complete before the
    // checkpoint is written.
    const std::vector<PvdEntry>& bring_up_to_date() {
        if (listed_ != entries_.size()) write_list();
        return entries_;
    }

    [[nodiscard]] const std::vector<PvdEntry>& entries() const { return entries_; }

    [[nodiscard]] VtkPolyData take_written_frame() {
        const std::lock_guard lock(mutex_);
        keeps_frames_ = true;
        if (written_.empty()) return {};
        VtkPolyData frame = std::move(written_.back());
        written_.pop_back();
        return frame;
    }

private:
    void list(double time, const std::string& name, std::uint64_t bytes) {
        bytes_since_list_ += bytes;
        entries_.push_back({time, 0, name});
        const std::size_t list_bytes = 100 * entries_.size();
        if (entries_.size() <= kAlwaysListed || bytes_since_list_ >= list_bytes) write_list();
    }

    void write_list() {
        write_file(folder_ / files_.list, pvd_text(entries_));
        listed_ = entries_.size();
        bytes_since_list_ = 0;
    }

    std::filesystem::path folder_;
    FileSeries files_;
    std::vector<PvdEntry> entries_;
    std::uint64_t bytes_since_list_ = 0;
    std::size_t listed_ = 0;  // number of entries that are in the series file
    std::mutex mutex_;
    bool keeps_frames_ = false;         // true after the first blank_frame()
    std::vector<VtkPolyData> written_;  // frames to be reused
};

FrameWriter::FrameWriter(std::filesystem::path folder, FileSeries files, std::vector<PvdEntry> earlier,
                         std::shared_ptr<WriterThread> thread)
    : series_(std::make_shared<Series>(std::move(folder), files, std::move(earlier))),
      submitted_(series_->entries().size()),
      thread_(thread ? std::move(thread) : std::make_shared<WriterThread>()) {}

VtkPolyData FrameWriter::blank_frame() {
    thread_->wait_for_room();
    return series_->take_written_frame();
}

void FrameWriter::submit(std::uint64_t step, VtkPolyData frame) {
    const auto held = std::make_shared<VtkPolyData>(std::move(frame));
    thread_->submit([series = series_, step, held] { series->write(step, *held); });
    ++submitted_;
}

void FrameWriter::submit_index(std::uint64_t step, double time, std::string text) {
    thread_->submit([series = series_, step, time, text = std::move(text)] { series->write_index(step, time, text); });
    ++submitted_;
}

std::vector<PvdEntry> FrameWriter::drain() {
    thread_->drain();
    return series_->bring_up_to_date();
}

// Contact log.

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
    if (surface_velocity) surface_velocity->resize(rows);
    if (other) other->resize(rows);
}

namespace {

ContactColumns no_rows(const Simulation& simulation) {
    ContactColumns columns;
    const auto materials = simulation.materials();
    const bool moves = std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.drives(); }) ||
                       std::any_of(simulation.colliders().begin(), simulation.colliders().end(), is_moving);
    if (moves) columns.surface_velocity.emplace();
    if (simulation.options().particle_contacts) columns.other.emplace();
    return columns;
}

}  // namespace

namespace {

/// Collider number in the rows of pair impacts, which have no collider.
constexpr std::uint32_t kNoCollider = 0xFFFFFFFFU;

/// Index of an entry in one of the two lists of a step: surface contacts or pair impacts.
struct LogRow {
    std::size_t number = 0;
    bool is_pair = false;
};

/// Merges the two lists, which are both ordered by (time, particle). Surface contacts precede pair impacts with equal
/// keys.
std::vector<LogRow> rows_in_order(const std::vector<ContactRecord>& records,
                                  const std::vector<PairImpactRecord>& pairs) {
    std::vector<LogRow> order;
    order.reserve(records.size() + pairs.size());
    std::size_t next = 0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto is_before = [&](const ContactRecord& record) {
            return record.time != pairs[k].time ? record.time < pairs[k].time : record.particle <= pairs[k].first;
        };
        for (; next < records.size() && is_before(records[next]); ++next) order.push_back({next, false});
        order.push_back({k, true});
    }
    for (; next < records.size(); ++next) order.push_back({next, false});
    return order;
}

}  // namespace

VtkPolyData contact_frame(ContactColumns columns, double time) {
    VtkPolyData frame;
    frame.time = time;
    frame.points = std::move(columns.point);
    frame.point_arrays =
        list_of(VtkArray{"time", std::move(columns.time)}, VtkArray{"particle", std::move(columns.particle)},
                VtkArray{"collider", std::move(columns.collider)}, VtkArray{"triangle", std::move(columns.triangle)},
                VtkArray{"barycentric", std::move(columns.barycentric)}, VtkArray{"normal", std::move(columns.normal)},
                VtkArray{"velocity_before", std::move(columns.velocity_before)},
                VtkArray{"velocity_after", std::move(columns.velocity_after)},
                VtkArray{"impulse", std::move(columns.impulse)}, VtkArray{"radius", std::move(columns.radius)});
    if (columns.surface_velocity) {
        frame.point_arrays.push_back({"surface_velocity", std::move(*columns.surface_velocity)});
    }
    if (columns.other) frame.point_arrays.push_back({"other", std::move(*columns.other)});
    frame.texts.push_back({kNote, {"impacts only: contact that lasts is in lasting_impulse of the collider files"}});
    return frame;
}

ContactLog::ContactLog(const std::filesystem::path& folder, const Simulation& simulation, std::size_t most_rows,
                       std::vector<PvdEntry> earlier, std::shared_ptr<WriterThread> thread)
    : files_(folder, kContactSeries, std::move(earlier), std::move(thread)),
      most_rows_(most_rows),
      step_(simulation.step_index()) {
    if (step_ > 0) written_ = step_;  // the interrupted run has written the rows of all its steps
    if (!simulation.options().record_contacts) {
        throw std::logic_error("a contact log needs a simulation that records its contacts");
    }
    for (const ColliderDescription& collider : simulation.colliders()) {
        has_triangles_.push_back(std::holds_alternative<MeshShape>(collider.shape) ||
                                 std::holds_alternative<CuboidShape>(collider.shape));
    }
    columns_ = no_rows(simulation);
}

void ContactLog::add_step(const Simulation& simulation) {
    if (simulation.step_index() == step_) return;
    if (simulation.step_index() != step_ + 1) throw std::logic_error("a step was left out of the contact log");
    step_ = simulation.step_index();
    const std::vector<ContactRecord>& records = simulation.contact_records();
    const std::vector<PairImpactRecord>& pairs = simulation.pair_records();
    const std::size_t first = columns_.size();
    columns_.resize(first + records.size() + pairs.size());
    const std::vector<LogRow> order = rows_in_order(records, pairs);
    parallel_for_blocks(order.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (order[i].is_pair) {
                set_row(first + i, pairs[order[i].number]);
            } else {
                set_row(first + i, records[order[i].number], simulation);
            }
        }
    });
    if (columns_.size() >= most_rows_) write(simulation);
}

void ContactLog::set_row(std::size_t row, const ContactRecord& record, const Simulation& simulation) {
    const SurfaceName surface = simulation.surface_name(record.surface);
    const SurfacePosition contact = simulation.contact_point(record);
    columns_.point[row] = contact.point;
    columns_.time[row] = record.time;
    columns_.particle[row] = static_cast<std::int64_t>(record.particle);
    columns_.collider[row] = surface.collider;
    columns_.triangle[row] = has_triangles_[surface.collider] ? std::int64_t{surface.triangle} : -1;
    columns_.barycentric[row] = contact.barycentric;
    columns_.normal[row] = record.normal;
    columns_.velocity_before[row] = record.velocity_before;
    columns_.velocity_after[row] = record.velocity_after;
    columns_.impulse[row] = record.mass * (record.velocity_before - record.velocity_after);
    columns_.radius[row] = record.radius;
    if (columns_.surface_velocity) (*columns_.surface_velocity)[row] = record.surface_velocity;
    if (columns_.other) (*columns_.other)[row] = -1;
}

void ContactLog::set_row(std::size_t row, const PairImpactRecord& record) {
    columns_.point[row] = record.position - record.radius * record.normal;
    columns_.time[row] = record.time;
    columns_.particle[row] = static_cast<std::int64_t>(record.first);
    columns_.collider[row] = kNoCollider;
    columns_.triangle[row] = -1;
    columns_.barycentric[row] = {};
    columns_.normal[row] = record.normal;
    columns_.velocity_before[row] = record.velocity_before;
    columns_.velocity_after[row] = record.velocity_after;
    columns_.impulse[row] = record.impulse;
    columns_.radius[row] = record.radius;
    if (columns_.surface_velocity) (*columns_.surface_velocity)[row] = {};
    (*columns_.other)[row] = static_cast<std::int64_t>(record.second);
}

void ContactLog::write(const Simulation& simulation) {
    add_step(simulation);
    if (written_ == step_) return;
    written_ = step_;
    files_.submit(step_, contact_frame(std::exchange(columns_, no_rows(simulation)), simulation.time()));
}

}  // namespace ricochet
