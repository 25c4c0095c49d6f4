#include "ricochet/io/frame_writer.h"

#include <mutex>
#include <utility>

#include "ricochet/core/atomic_file.h"

namespace ricochet {

WriterThread::WriterThread(Mode mode) : mode_(mode) {
    if (mode_ == Mode::background) thread_ = std::thread([this] { work(); });
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
        std::function<void()>& job = jobs_.front();  // stays put: only this thread takes it away
        lock.unlock();
        std::exception_ptr error;
        try {
            job();
        } catch (...) {
            error = std::current_exception();
        }
        job = nullptr;  // what it holds is freed without the lock, and before anyone is told that there is room
        lock.lock();
        jobs_.pop_front();
        error_ = error;
        changed_.notify_all();
        if (error_) return;
    }
}

namespace {

// Up to this many frames the series file is rewritten after each; later only when the frames written since weigh as
// much as the series file, so that its upkeep never dominates.
constexpr std::size_t kAlwaysListed = 1000;

}  // namespace

/// The files of a series and their list. Touched by the writer's thread, and by others only while that has no job; the
/// frames to be used again are the exception.
class FrameWriter::Series {
public:
    Series(std::filesystem::path folder, FileSeries files, std::vector<PvdEntry> earlier)
        : folder_(std::move(folder)), files_(files), entries_(std::move(earlier)) {}

    void write(std::uint64_t step, VtkPolyData& frame) {
        const std::string name = files_.file_name(step);
        bytes_since_list_ += write_vtp(folder_ / name, frame);
        entries_.push_back({frame.time, 0, name});
        const std::size_t list_bytes = 100 * entries_.size();
        if (entries_.size() <= kAlwaysListed || bytes_since_list_ >= list_bytes) write_list();
        const std::lock_guard lock(mutex_);
        if (keeps_frames_) written_.push_back(std::move(frame));
    }

    // What is lost after a checkpoint must not leave the list behind.
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
    void write_list() {
        write_file(folder_ / files_.list, pvd_text(entries_));
        listed_ = entries_.size();
        bytes_since_list_ = 0;
    }

    std::filesystem::path folder_;
    FileSeries files_;
    std::vector<PvdEntry> entries_;
    std::uint64_t bytes_since_list_ = 0;
    std::size_t listed_ = 0;  // entries that are in the series file
    std::mutex mutex_;
    bool keeps_frames_ = false;         // from the first blank_frame() on
    std::vector<VtkPolyData> written_;  // to be filled again
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

std::vector<PvdEntry> FrameWriter::drain() {
    thread_->drain();
    return series_->bring_up_to_date();
}

}  // namespace ricochet
