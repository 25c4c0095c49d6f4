/// \file
/// Temporary files that must be removed if a signal ends the process, and the programs that write them.
#pragma once

#include <filesystem>

namespace ricochet {

/// Registers a temporary file for the lifetime of the object, so that remove_unfinished_files() removes it. The object
/// neither creates nor removes the file itself. Any number of objects can exist, on any threads.
class UnfinishedFile {
public:
    explicit UnfinishedFile(const std::filesystem::path& path);
    ~UnfinishedFile();
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;

    /// Sets the child process that writes the file. It is killed before the file is removed. Pass 0 once waitpid() has
    /// returned its status.
    void set_writer(int process);

private:
    struct Entry;
    friend void remove_unfinished_files() noexcept;
    // Head of the list. It has no destructor, since the last file may be destroyed after objects of static lifetime.
    static Entry* first_;
    Entry* entry_;
};

/// Kills the programs that write unfinished files and removes the files. Safe in a signal handler. The process has to
/// end right afterwards: writers do not know that their files are removed, and threads that create or destroy an
/// UnfinishedFile wait forever.
void remove_unfinished_files() noexcept;

}  // namespace ricochet
