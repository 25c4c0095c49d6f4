#include "python/gil.h"

#include <atomic>
#include <chrono>
#include <thread>

namespace ricochet::python {
namespace {

constexpr std::chrono::seconds kLongestWait{2};
constexpr std::chrono::milliseconds kLook{1};

std::atomic<int> beside_count = 0;
thread_local int own_count = 0;
std::atomic<bool> is_ending = false;
std::thread::id ending_thread;  // thread that ends the interpreter; set before is_ending

[[noreturn]] void stay() {
    beside_count -= own_count;
    while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// Releases the GIL, so that threads that already wait for it can acquire it and finish. Threads that ask for the GIL
/// later wait forever in stay().
void end() {
    ending_thread = std::this_thread::get_id();
    is_ending = true;
    const py::gil_scoped_release released;
    const auto latest = std::chrono::steady_clock::now() + kLongestWait;
    while (beside_count > 0 && std::chrono::steady_clock::now() < latest) std::this_thread::sleep_for(kLook);
}

}  // namespace

void wait_for_threads_at_exit() {
    py::module_::import("atexit").attr("register")(py::cpp_function(&end));
    // After a fork, the child process has only the forking thread. The total count therefore becomes the count of this
    // thread.
    py::module_::import("os").attr("register_at_fork")(py::arg("after_in_child") =
                                                           py::cpp_function([] { beside_count = own_count; }));
}

// The thread that ends the interpreter does not wait, because it may still call functions of this module.
void stay_if_ending() {
    if (is_ending && std::this_thread::get_id() != ending_thread) stay();
}

detail::Beside::Beside() {
    ++beside_count;
    ++own_count;
}

detail::Beside::~Beside() {
    --beside_count;
    --own_count;
}

}  // namespace ricochet::python
