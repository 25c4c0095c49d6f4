/// \file
/// Private: small algorithms on arrays that the standard library lacks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ricochet {

/// Calls visit(i), in ascending order, for every i in [begin, end) with predicate(i). Fast where matches are rare and
/// the predicate, which must not have side effects, compiles to vector instructions: blocks of 16 without a match are
/// skipped at once.
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

/// Reserves capacity for `more` entries at the list's end: exactly for a large batch, geometrically for many small
/// ones, so that appending neither reallocates time and again nor holds millions of entries twice.
template <class T>
void grow_capacity_by(std::vector<T>& list, std::size_t more) {
    const std::size_t wanted = list.size() + more;
    if (wanted > list.capacity()) list.reserve(std::max(wanted, list.capacity() + list.capacity() / 2));
}

/// Keeps the entries whose mark is not 0, in their order; each mark stands for `width` entries in a row. Moves runs of
/// entries at once: fast where few go. Marks beyond the list's end stand for nothing.
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
