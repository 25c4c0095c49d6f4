/// \file
/// Temporary files that a signal must not leave behind, and the programs that write them.
#pragma once

#include <filesystem>

namespace ricochet {

/// Notes a temporary file for as long as it lives: remove_unfinished_files() removes it. Neither makes nor removes the
/// file by itself. Any number of them, on any threads.
class UnfinishedFile {
public:
    explicit UnfinishedFile(const std::filesystem::path& path);
    ~UnfinishedFile();
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;

    /// Another program writes it: a child process by its number, to be killed first; 0 once it has been waited for.
    void set_writer(int process);

private:
    struct Entry;
    friend void remove_unfinished_files() noexcept;
    static Entry* first_;  // of a list; without a destructor, since the last file may go after other objects
    Entry* entry_;
};

/// Kills the programs that write unfinished files and removes the files. Safe in a signal handler. The process has to
/// end right afterwards: whoever writes such a file does not know that it is gone, and whoever begins or ends one
/// waits.
void remove_unfinished_files() noexcept;

}  // namespace ricochet
