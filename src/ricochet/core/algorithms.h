/// \file
/// Private: small algorithms on arrays that the standard library lacks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ricochet {

/// Calls visit(i), in ascending order, for every i in [begin, end) for which predicate(i) is true. The predicate must
/// not have side effects. Fast if matches are rare and the predicate compiles to vector instructions: blocks of 16
/// without a match are skipped at once.
template <class Predicate, class Visit>
void for_each_if(std::size_t begin, std::size_t end, const Predicate& predicate, const Visit& visit) {
    constexpr std::size_t kBlock = 16;
    for (; begin + kBlock <= end; begin += kBlock) {
        unsigned any = 0;
        for (std::size_t k = 0; k < kBlock; ++k) any |= predicate(begin + k) ? 1U : 0U;
        if (any == 0) continue;
        for (std::size_t i = begin; i < begin + kBlock; ++i) {
            if (predicate(i)) visit(i);
        }
    }
    for (; begin < end; ++begin) {
        if (predicate(begin)) visit(begin);
    }
}

/// Reserves capacity for `more` further entries of a list. The capacity grows by at least half, so that many small
/// appends rarely reallocate. A larger request gets exactly its size, so that no memory for millions of unused entries
/// is reserved.
template <class T>
void grow_capacity_by(std::vector<T>& list, std::size_t more) {
    const std::size_t wanted = list.size() + more;
    if (wanted > list.capacity()) list.reserve(std::max(wanted, list.capacity() + list.capacity() / 2));
}

/// Keeps the entries whose mark is not 0, in their order. Each mark stands for `width` consecutive entries. Moves runs
/// of entries at once, which is fast if few are removed. Marks beyond the end of the list are ignored.
template <class T>
void keep_marked(std::vector<T>& list, const std::vector<std::uint8_t>& keep, std::size_t width = 1) {
    const auto entry = [&list, width](auto mark) { return list.begin() + mark * static_cast<std::ptrdiff_t>(width); };
    const auto last = keep.begin() + static_cast<std::ptrdiff_t>(std::min(keep.size(), list.size() / width));
    auto gap = std::find(keep.begin(), last, 0);
    auto kept = entry(gap - keep.begin());
    while (gap != last) {
        const auto run = std::find_if(gap, last, [](std::uint8_t mark) { return mark != 0; });
        gap = std::find(run, last, 0);
        kept = std::move(entry(run - keep.begin()), entry(gap - keep.begin()), kept);
    }
    list.erase(kept, list.end());
}

}  // namespace ricochet
