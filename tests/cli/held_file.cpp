#include "cli/held_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>

namespace ricochet::test {
namespace {

sigset_t lease_signal() {
    sigset_t signals;
    (void)::sigemptyset(&signals);
    (void)::sigaddset(&signals, SIGIO);
    return signals;
}

}  // namespace

HeldFile::HeldFile(const std::filesystem::path& file) : descriptor_(::open(file.c_str(), O_RDWR | O_CLOEXEC)) {
    // wait_for_reader() waits for this signal, which reports that a reader is waiting.
    const sigset_t signals = lease_signal();
    (void)::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    is_held_ = ::fcntl(descriptor_, F_SETLEASE, F_WRLCK) == 0;
}

HeldFile::~HeldFile() {
    (void)::fcntl(descriptor_, F_SETLEASE, F_UNLCK);
    (void)::close(descriptor_);
}

void HeldFile::wait_for_reader() const {
    const sigset_t signals = lease_signal();
    int signal = 0;
    (void)::sigwait(&signals, &signal);
}

}  // namespace ricochet::test
