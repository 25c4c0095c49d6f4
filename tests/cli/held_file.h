/// \file
/// A file that a program waits for, to be found reading.
#pragma once

#include <filesystem>

namespace ricochet::test {

/// A file that nobody else can open while it lives: who tries waits (a lease, fcntl(2), which the kernel takes away
/// after 45 seconds).
class HeldFile {
public:
    explicit HeldFile(const std::filesystem::path& file);
    ~HeldFile();
    HeldFile(const HeldFile&) = delete;
    HeldFile& operator=(const HeldFile&) = delete;

    /// False where the file system has no leases.
    [[nodiscard]] bool is_held() const { return is_held_; }
    /// Waits until somebody waits for the file.
    void wait_for_reader() const;

private:
    int descriptor_ = -1;
    bool is_held_ = false;
};

}  // namespace ricochet::test
