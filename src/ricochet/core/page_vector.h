/// \file
/// Private: lists that take pages of their own where they are large, so that processes of one machine that hold the
/// same list can have its pages in common.
#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <vector>

namespace ricochet {

/// Bytes from which on a list takes pages of its own: less is not worth the calls.
inline constexpr std::size_t kLeastOwnPages = std::size_t{1} << 18;

/// Pages that hold nothing else, zero. Throws std::bad_alloc.
[[nodiscard]] void* take_pages(std::size_t bytes);
void give_pages_back(void* pages, std::size_t bytes) noexcept;

/// Of std::vector.
template <class T>
struct PageAllocator {
    using value_type = T;
    /// Aligned to more than memory is by itself.
    static constexpr bool kIsWide = alignof(T) > __STDCPP_DEFAULT_NEW_ALIGNMENT__;

    PageAllocator() = default;
    template <class U>
    PageAllocator(const PageAllocator<U>& /*other*/) {}  // NOLINT(google-explicit-constructor): as allocators convert

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

/// The pages of a list that has some of its own; nothing of a smaller one. They may be replaced by others with the same
/// bytes, also such that cannot be written, once the list stays as it is.
template <class T>
[[nodiscard]] std::span<const std::byte> own_pages(const PageVector<T>& list) {
    if (list.empty() || !PageAllocator<T>::has_own_pages(list.capacity())) return {};
    return std::as_bytes(std::span<const T>(list));
}

}  // namespace ricochet
