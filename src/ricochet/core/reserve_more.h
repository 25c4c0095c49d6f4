/// \file
/// Room in a list for entries that come one by one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ricochet {

/// Makes room for `more` entries at the list's end, so that millions are neither moved time and again while they are
/// appended nor held twice over. Many calls for a few entries each do not copy the list every time.
template <class T>
void reserve_more(std::vector<T>& list, std::size_t more) {
    const std::size_t wanted = list.size() + more;
    if (wanted > list.capacity()) list.reserve(std::max(wanted, list.capacity() + list.capacity() / 2));
}

}  // namespace ricochet
