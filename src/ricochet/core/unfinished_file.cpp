#include "ricochet/core/unfinished_file.h"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>

namespace ricochet {

/// List entry of a file. A signal handler can traverse the list.
struct UnfinishedFile::Entry {
    std::string path;
    pid_t writer = 0;
    Entry* next = nullptr;
};

namespace {

std::atomic_flag in_use = ATOMIC_FLAG_INIT;

void take_list() {
    while (in_use.test_and_set(std::memory_order_acquire)) continue;
}

/// Lock of the list. No signal handler runs on a thread that owns the lock, so a handler may wait for the lock. A
/// handler must not use locks of the standard library.
class ListLock {
public:
    ListLock() noexcept {
        sigset_t all;
        (void)::sigfillset(&all);
        (void)::pthread_sigmask(SIG_SETMASK, &all, &before_);
        take_list();
    }
    ~ListLock() {
        in_use.clear(std::memory_order_release);
        (void)::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    ListLock(const ListLock&) = delete;
    ListLock& operator=(const ListLock&) = delete;

private:
    sigset_t before_{};
};

}  // namespace

UnfinishedFile::Entry* UnfinishedFile::first_ = nullptr;

UnfinishedFile::UnfinishedFile(const std::filesystem::path& path) : entry_(new Entry{path.string()}) {
    const ListLock lock;
    entry_->next = first_;
    first_ = entry_;
}

UnfinishedFile::~UnfinishedFile() {
    {
        const ListLock lock;
        Entry** link = &first_;
        while (*link != entry_) link = &(*link)->next;
        *link = entry_->next;
    }
    delete entry_;
}

void UnfinishedFile::set_writer(int process) {
    const ListLock lock;
    entry_->writer = process;
}

void remove_unfinished_files() noexcept {
    using Entry = UnfinishedFile::Entry;
    take_list();  // never released, so that no other file is added
    for (const Entry* entry = UnfinishedFile::first_; entry != nullptr; entry = entry->next) {
        if (entry->writer > 0) (void)::kill(entry->writer, SIGKILL);
    }
    for (const Entry* entry = UnfinishedFile::first_; entry != nullptr; entry = entry->next) {
        // The file is removed after its writer has ended, because the writer could create the file again.
        while (entry->writer > 0 && ::waitpid(entry->writer, nullptr, 0) < 0 && errno == EINTR) continue;
        (void)::unlink(entry->path.c_str());
    }
}

}  // namespace ricochet
