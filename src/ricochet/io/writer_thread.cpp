#include "ricochet/io/writer_thread.h"

#include <utility>

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

}  // namespace ricochet
