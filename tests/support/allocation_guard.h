/// \file
/// Counts the memory that a test program has in use. One source file of the program must define the counting operators:
/// allocation_guard.cpp.
#pragma once

#include <cstddef>

namespace ricochet::test {

/// Measures the largest amount of heap memory in use at one time, beyond what was in use when it was made, over all
/// threads. One at a time.
class AllocationGuard {
public:
    AllocationGuard();
    [[nodiscard]] std::size_t peak_bytes() const;

private:
    std::size_t start_;
};

}  // namespace ricochet::test
