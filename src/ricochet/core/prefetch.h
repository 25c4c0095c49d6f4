/// \file
/// Private to the library: prefetches memory that a loop needs soon.
#pragma once

#include <cstddef>

namespace ricochet {

/// Prefetches all cache lines of an object.
template <class T>
void prefetch_whole(const T& object) {
    constexpr std::size_t kLine = 64;
    const char* const begin = reinterpret_cast<const char*>(&object);
    for (std::size_t at = 0; at < sizeof(T); at += kLine) __builtin_prefetch(begin + at);
    __builtin_prefetch(begin + sizeof(T) - 1);
}

}  // namespace ricochet
