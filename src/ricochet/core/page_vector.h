/// \file
/// Private: lists that have memory pages of their own if they are large. Processes of one machine with equal lists can
/// then share these pages.
#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <vector>

namespace ricochet {

/// Smallest size, in bytes, of a list with pages of its own; smaller lists are not worth the system calls.
inline constexpr std::size_t kLeastOwnPages = std::size_t{1} << 18;

/// Returns zeroed pages that contain no other data. Throws std::bad_alloc.
[[nodiscard]] void* take_pages(std::size_t bytes);
void give_pages_back(void* pages, std::size_t bytes) noexcept;

/// Allocator for std::vector.
template <class T>
struct PageAllocator {
    using value_type = T;
    /// The type needs more than the default alignment of operator new.
    static constexpr bool kIsWide = alignof(T) > __STDCPP_DEFAULT_NEW_ALIGNMENT__;

    PageAllocator() = default;
    template <class U>
    PageAllocator(const PageAllocator<U>& /*other*/) {}  // NOLINT(google-explicit-constructor): allocators convert

    [[nodiscard]] T* allocate(std::size_t count) {
        if (has_own_pages(count)) return static_cast<T*>(take_pages(count * sizeof(T)));
        if constexpr (kIsWide) return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(alignof(T))));
        return static_cast<T*>(::operator new(count * sizeof(T)));
    }
    void deallocate(T* list, std::size_t count) noexcept {
        if (has_own_pages(count)) return give_pages_back(list, count * sizeof(T));
        if constexpr (kIsWide) return ::operator delete(list, std::align_val_t(alignof(T)));
        ::operator delete(list);
    }
    [[nodiscard]] static bool has_own_pages(std::size_t count) { return count >= kLeastOwnPages / sizeof(T); }
    template <class U>
    bool operator==(const PageAllocator<U>& /*other*/) const {
        return true;
    }
};

template <class T>
using PageVector = std::vector<T, PageAllocator<T>>;

/// Returns the pages of a list that has pages of its own; an empty span for a smaller list. Once the list no longer
/// changes, other pages with the same bytes may replace them, even read-only ones.
template <class T>
[[nodiscard]] std::span<const std::byte> own_pages(const PageVector<T>& list) {
    if (list.empty() || !PageAllocator<T>::has_own_pages(list.capacity())) return {};
    return std::as_bytes(std::span<const T>(list));
}

}  // namespace ricochet
