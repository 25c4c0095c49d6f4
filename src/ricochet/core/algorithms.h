/// \file
/// Private: small algorithms on arrays that the standard library lacks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ricochet {

/// Calls visit(i), in ascending order, for every i in [begin, end) with is_one(i). Fast where they are few and
/// is_one(i), which must not have effects, compiles to vector instructions: runs without any are passed over at once.
template <class Predicate, class Visit>
void for_each_if(std::size_t begin, std::size_t end, const Predicate& is_one, const Visit& visit) {
    constexpr std::size_t kRun = 16;
    for (; begin + kRun <= end; begin += kRun) {
        unsigned any = 0;
        for (std::size_t k = 0; k < kRun; ++k) any |= is_one(begin + k) ? 1U : 0U;
        if (any == 0) continue;
        for (std::size_t i = begin; i < begin + kRun; ++i) {
            if (is_one(i)) visit(i);
        }
    }
    for (; begin < end; ++begin) {
        if (is_one(begin)) visit(begin);
    }
}

/// Makes room for `more` entries at the list's end, so that millions are neither moved time and again while they are
/// appended nor held twice over. Many calls for a few entries each do not copy the list every time.
template <class T>
void grow_capacity_by(std::vector<T>& list, std::size_t more) {
    const std::size_t wanted = list.size() + more;
    if (wanted > list.capacity()) list.reserve(std::max(wanted, list.capacity() + list.capacity() / 2));
}

}  // namespace ricochet
