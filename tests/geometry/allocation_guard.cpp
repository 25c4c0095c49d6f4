#include "geometry/allocation_guard.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> in_use{0};
std::atomic<std::size_t> peak{0};

// Every block starts with its size; what follows stays aligned for every type.
constexpr std::size_t kPrefix = alignof(std::max_align_t);
static_assert(kPrefix >= sizeof(std::size_t));

void* allocate(std::size_t size) {
    void* const block = size > SIZE_MAX - kPrefix ? nullptr : std::malloc(size + kPrefix);
    if (block == nullptr) throw std::bad_alloc();
    *static_cast<std::size_t*>(block) = size;
    const std::size_t now = in_use += size;
    std::size_t seen = peak.load();
    while (now > seen && !peak.compare_exchange_weak(seen, now)) {
    }
    return static_cast<char*>(block) + kPrefix;
}

void release(void* memory) {
    if (memory == nullptr) return;
    void* const block = static_cast<char*>(memory) - kPrefix;
    in_use -= *static_cast<std::size_t*>(block);
    std::free(block);
}

}  // namespace

// An allocation that asks for far more than the machine has counts too, since it fails: bad_alloc is not InputError.
void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }

namespace ricochet::test {

AllocationGuard::AllocationGuard() : start_(in_use.load()) { peak = start_; }

std::size_t AllocationGuard::peak_bytes() const { return peak.load() - start_; }

}  // namespace ricochet::test
