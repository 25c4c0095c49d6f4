/// \file
/// Counts the memory that a test program has in use, and makes allocations fail. The program must compile
/// allocation_guard.cpp, which defines the counting operators.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ricochet::test {

/// Measures the peak of heap memory in use by all threads, minus the memory in use at the guard's construction. Only
/// one guard may exist at a time.
class AllocationGuard {
public:
    AllocationGuard();
    [[nodiscard]] std::size_t peak_bytes() const;

private:
    std::size_t start_;
};

/// Returns the bytes of the whole program that operator new has allocated and that are not freed yet.
[[nodiscard]] std::size_t bytes_in_use();

/// Makes one call of operator new fail during the lifetime of the object. Calls of all threads count. The failing call
/// throws std::bad_alloc, or returns null in its non-throwing form. Embree's own calls never fail. Only one fault may
/// exist at a time.
class AllocationFault {
public:
    enum class Later { succeed, fail };
    /// number: index of the call that fails, counted from 1. later: whether the calls after it succeed or fail.
    explicit AllocationFault(std::uint64_t number, Later later = Later::succeed);
    ~AllocationFault();
    AllocationFault(const AllocationFault&) = delete;
    AllocationFault& operator=(const AllocationFault&) = delete;

    /// Returns the number of calls since construction.
    [[nodiscard]] std::uint64_t calls() const;
    /// Lets all further calls succeed.
    void end();
};

}  // namespace ricochet::test
