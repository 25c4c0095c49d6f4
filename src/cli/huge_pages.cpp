// Memory for large arrays on large pages, for the whole program: particles and meshes are visited in no order, and with
// small pages most visits also miss the processor's table of pages (measured: about a tenth of a run with a million
// particles and triangles). Where the system has none to give, nothing changes. Replaces the global operator new, which
// a program may and a library must not do; sanitizers bring their own.
#include "cli/huge_pages.h"

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RICOCHET_HAS_OWN_NEW 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define RICOCHET_HAS_OWN_NEW 1
#endif
#endif

#if !defined(__linux__) || defined(RICOCHET_HAS_OWN_NEW)

bool ricochet::cli::requests_huge_pages() { return false; }

#else

bool ricochet::cli::requests_huge_pages() { return true; }

namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;
/// Smaller arrays could waste a page of them.
constexpr std::size_t kLeastSize = 4 * kLargePage;

void* allocate(std::size_t size, std::size_t alignment) {
    const std::size_t whole = (size + alignment - 1) / alignment * alignment;
    if (whole < size) throw std::bad_alloc();  // more than there are addresses
    void* const memory = alignment <= alignof(std::max_align_t) ? std::malloc(size == 0 ? 1 : size)
                                                                : std::aligned_alloc(alignment, whole);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

void* allocate_large(std::size_t size, std::size_t alignment) {
    void* const memory = allocate(size, alignment < kLargePage ? kLargePage : alignment);
    (void)madvise(memory, size, MADV_HUGEPAGE);  // advice only: a refusal costs speed
    return memory;
}

}  // namespace

void* operator new(std::size_t size) {
    return size < kLeastSize ? allocate(size, alignof(std::max_align_t)) : allocate_large(size, kLargePage);
}

void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto bytes = static_cast<std::size_t>(alignment);
    return size < kLeastSize ? allocate(size, bytes) : allocate_large(size, bytes);
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept { std::free(memory); }

#endif
