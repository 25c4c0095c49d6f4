#include "ricochet/dynamics/neighbour_pairs.h"

#include <algorithm>
#include <cstddef>

namespace ricochet {
namespace {

/// Where more than such a part of the boxes have changed all are looked for anew.
constexpr std::size_t kFew = 8;

bool comes_before(const NeighbourPair& a, const NeighbourPair& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
}

}  // namespace

const std::vector<NeighbourPair>& NeighbourPairs::find(std::span<const Box3> boxes) {
    pairs_ = grid_.find_pairs(boxes);
    later_.clear();
    static_cast<void>(later_grid_.find_pairs({}));
    is_later_.assign(boxes.size(), 0);
    is_changed_.assign(boxes.size(), 0);
    return pairs_;
}

const std::vector<NeighbourPair>& NeighbourPairs::update(std::span<const Box3> boxes,
                                                         std::span<const std::uint32_t> changed) {
    if (changed.empty()) return pairs_;
    if (changed.size() + later_.size() > boxes.size() / kFew) return find(boxes);
    for (const std::uint32_t k : changed) {
        if (is_later_[k] == 0) later_.push_back(k);
        is_later_[k] = is_changed_[k] = 1;
    }
    std::sort(later_.begin(), later_.end());
    std::erase_if(pairs_, [&](const NeighbourPair& pair) {
        return is_changed_[pair.first] != 0 || is_changed_[pair.second] != 0;
    });
    std::vector<NeighbourPair> news;
    std::vector<std::uint32_t> near;
    for (const std::uint32_t k : changed) {
        near.clear();
        grid_.find_near(boxes[k], near);
        for (const std::uint32_t other : near) {
            if (is_later_[other] == 0) news.push_back({std::min(k, other), std::max(k, other)});
        }
    }
    std::vector<Box3> later_boxes;
    for (const std::uint32_t k : later_) later_boxes.push_back(boxes[k]);
    for (const NeighbourPair& pair : later_grid_.find_pairs(later_boxes)) {
        const NeighbourPair both{later_[pair.first], later_[pair.second]};
        if (is_changed_[both.first] != 0 || is_changed_[both.second] != 0) news.push_back(both);
    }
    std::sort(news.begin(), news.end(), comes_before);
    const auto middle = static_cast<std::ptrdiff_t>(pairs_.size());
    pairs_.insert(pairs_.end(), news.begin(), news.end());
    std::inplace_merge(pairs_.begin(), pairs_.begin() + middle, pairs_.end(), comes_before);
    for (const std::uint32_t k : changed) is_changed_[k] = 0;
    return pairs_;
}

void NeighbourPairs::find_near(const Box3& box, std::vector<std::uint32_t>& found) const {
    const auto begin = static_cast<std::ptrdiff_t>(found.size());
    grid_.find_near(box, found);
    if (later_.empty()) return;
    found.erase(std::remove_if(found.begin() + begin, found.end(), [&](std::uint32_t k) { return is_later_[k] != 0; }),
                found.end());
    std::vector<std::uint32_t> near;
    later_grid_.find_near(box, near);
    for (const std::uint32_t k : near) found.push_back(later_[k]);
}

}  // namespace ricochet
