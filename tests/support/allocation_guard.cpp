#include "support/allocation_guard.h"

#include <dlfcn.h>
#include <malloc.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

namespace {

std::atomic<std::size_t> in_use{0};
std::atomic<std::size_t> peak{0};

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
std::atomic<std::uint64_t> calls_made{0};
std::atomic<std::uint64_t> first_failure{kNever};  // value of calls_made at the first call that fails
std::atomic<bool> later_fail{false};

// Returns true if the code belongs to Embree. If an allocation inside Embree 3.13 fails, a thread's allocator keeps a
// reference to a destroyed allocator, and the next BVH is corrupt. The caller cannot repair that, so Embree's
// allocations never fail.
bool is_of_embree(const void* code) noexcept {
    Dl_info info{};
    return ::dladdr(code, &info) != 0 && info.dli_fname != nullptr &&
           std::strstr(info.dli_fname, "libembree") != nullptr;
}

bool is_to_fail(const void* caller) {
    const std::uint64_t call = ++calls_made;
    const std::uint64_t first = first_failure.load();
    return (call == first || (call > first && later_fail.load())) && !is_of_embree(caller);
}

void* counted(void* memory) {
    const std::size_t now = in_use += malloc_usable_size(memory);
    std::size_t seen = peak.load();
    while (now > seen && !peak.compare_exchange_weak(seen, now)) {
    }
    return memory;
}

// Returns null if no memory is available.
void* allocate(std::size_t size, const void* caller) noexcept {
    if (is_to_fail(caller)) return nullptr;
    void* memory = std::malloc(size == 0 ? 1 : size);
    return memory == nullptr ? nullptr : counted(memory);
}

void* allocate(std::size_t size, std::align_val_t alignment, const void* caller) noexcept {
    if (is_to_fail(caller)) return nullptr;
    void* memory = nullptr;
    if (posix_memalign(&memory, static_cast<std::size_t>(alignment), size == 0 ? 1 : size) != 0) return nullptr;
    return counted(memory);
}

// Returns the memory if it is not null. Otherwise calls the new-handler and throws std::bad_alloc, like the standard
// library.
void* required(void* memory) {
    if (memory != nullptr) return memory;
    if (const std::new_handler handler = std::get_new_handler()) handler();
    throw std::bad_alloc();
}

void release(void* memory) noexcept {
    if (memory == nullptr) return;
    in_use -= malloc_usable_size(memory);
    std::free(memory);
}

}  // namespace

// Requests for far more memory than the machine has also go through these operators. They fail with bad_alloc, which a
// test distinguishes from the expected InputError.
void* operator new(std::size_t size) { return required(allocate(size, __builtin_return_address(0))); }
void* operator new[](std::size_t size) { return required(allocate(size, __builtin_return_address(0))); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return required(allocate(size, alignment, __builtin_return_address(0)));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return required(allocate(size, alignment, __builtin_return_address(0)));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, __builtin_return_address(0));
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, __builtin_return_address(0));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace ricochet::test {

AllocationGuard::AllocationGuard() : start_(in_use.load()) { peak = start_; }

std::size_t AllocationGuard::peak_bytes() const { return peak.load() - start_; }

std::size_t bytes_in_use() { return in_use.load(); }

AllocationFault::AllocationFault(std::uint64_t number, Later later) {
    later_fail = later == Later::fail;
    calls_made = 0;
    first_failure = number;
}

AllocationFault::~AllocationFault() { end(); }

std::uint64_t AllocationFault::calls() const { return calls_made.load(); }

void AllocationFault::end() { first_failure = kNever; }

}  // namespace ricochet::test
