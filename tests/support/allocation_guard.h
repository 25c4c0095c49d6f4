/// \file
/// Counts the memory that a test program has in use, and lets allocations fail. One source file of the program must
/// define the counting operators: allocation_guard.cpp.
#pragma once

#include <cstddef>
#include <cstdint>

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

/// Bytes that operator new has given and nobody has given back yet, of the whole program.
[[nodiscard]] std::size_t bytes_in_use();

/// While it lives, the number-th call of operator new from now on, over all threads, throws std::bad_alloc, or gives
/// null where it is of the kind that does not throw. Embree's own calls never fail. One at a time.
class AllocationFault {
public:
    enum class Later { succeed, fail };
    /// number: from 1; later: what becomes of the calls after it.
    explicit AllocationFault(std::uint64_t number, Later later = Later::succeed);
    ~AllocationFault();
    AllocationFault(const AllocationFault&) = delete;
    AllocationFault& operator=(const AllocationFault&) = delete;

    /// Calls since it was made.
    [[nodiscard]] std::uint64_t calls() const;
    /// No more calls fail.
    void end();
};

}  // namespace ricochet::test
