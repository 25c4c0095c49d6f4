/// \file File that blocks its readers, so that tests can interrupt a program while it reads.
#pragma once

#include <filesystem>

namespace ricochet::test {

/// File that no other process can open during its lifetime. Readers wait for a lease (fcntl(2)), which the kernel
/// breaks after 45 seconds.
class HeldFile {
public:
    explicit HeldFile(const std::filesystem::path& file);
    ~HeldFile();
    HeldFile(const HeldFile&) = delete;
    HeldFile& operator=(const HeldFile&) = delete;

    /// Returns false if the file system does not support leases.
    [[nodiscard]] bool is_held() const { return is_held_; }
    /// Waits until a process waits for the file.
    void wait_for_reader() const;

private:
    int descriptor_ = -1;
    bool is_held_ = false;
};

}  // namespace ricochet::test
