#include "ricochet/io/frame_writer.h"

#include <utility>

#include "ricochet/core/atomic_file.h"

namespace ricochet {
namespace {

// Up to this many frames the series file is rewritten after each; later only when the frames written since weigh as
// much as the series file, so that its upkeep never dominates.
constexpr std::size_t kAlwaysListed = 1000;

}  // namespace

FrameWriter::FrameWriter(std::filesystem::path folder, FileSeries files, std::vector<PvdEntry> earlier)
    : folder_(std::move(folder)),
      files_(files),
      series_(std::move(earlier)),
      submitted_(series_.size()),
      thread_([this] { work(); }) {}

FrameWriter::~FrameWriter() {
    {
        const std::lock_guard lock(mutex_);
        abandoned_ = true;
    }
    stop();
}

void FrameWriter::submit(std::uint64_t step, VtkPolyData frame) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return queue_.size() < kQueueLength || error_; });
    if (error_) std::rethrow_exception(error_);
    queue_.push_back({step, std::move(frame)});
    ++submitted_;
    changed_.notify_all();
}

// The list of the series is kept up to date too: what is lost after a checkpoint must not leave it behind.
std::vector<PvdEntry> FrameWriter::drain() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return queue_.empty() || error_; });
    if (error_) std::rethrow_exception(error_);
    if (listed_ != series_.size()) write_series();
    return series_;
}

void FrameWriter::finish() {
    stop();
    if (error_) std::rethrow_exception(error_);
    if (listed_ != series_.size()) write_series();
}

void FrameWriter::stop() {
    {
        const std::lock_guard lock(mutex_);
        closing_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void FrameWriter::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return !queue_.empty() || closing_; });
        if (queue_.empty() || abandoned_ || error_) return;
        const Frame& frame = queue_.front();  // stays put: only this thread takes it away
        lock.unlock();
        std::exception_ptr error;
        try {
            write_one(frame);
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        queue_.pop_front();
        if (error) error_ = error;
        changed_.notify_all();
    }
}

void FrameWriter::write_one(const Frame& frame) {
    const std::string name = files_.file_name(frame.step);
    bytes_since_series_ += write_vtp(folder_ / name, frame.data);
    series_.push_back({frame.data.time, 0, name});
    const std::size_t series_bytes = 100 * series_.size();
    if (series_.size() <= kAlwaysListed || bytes_since_series_ >= series_bytes) write_series();
}

void FrameWriter::write_series() {
    write_file(folder_ / files_.list, pvd_text(series_));
    listed_ = series_.size();
    bytes_since_series_ = 0;
}

}  // namespace ricochet
