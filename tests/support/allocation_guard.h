/// \file
/// Counts the memory that a test program has in use, and makes allocations fail. One source file of the program must
/// define the counting operators: allocation_guard.cpp.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ricochet::test {

/// Measures the largest heap memory in use at one time, over all threads, beyond the memory in use at its construction.
/// Only one guard may exist at a time.
class AllocationGuard {
public:
    AllocationGuard();
    [[nodiscard]] std::size_t peak_bytes() const;

private:
    std::size_t start_;
};

/// Returns the bytes of the whole program that operator new has allocated and that are not freed yet.
[[nodiscard]] std::size_t bytes_in_use();

/// Makes one call of operator new fail, over all threads, during the lifetime of the object. The call throws
/// std::bad_alloc; its non-throwing form returns null. Embree's own calls never fail. Only one fault may exist at a
/// time.
class AllocationFault {
public:
    enum class Later { succeed, fail };
    /// number: the call that fails, counted from 1; later: the fate of the calls after it.
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
