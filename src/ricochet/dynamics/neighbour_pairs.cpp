#include "ricochet/dynamics/neighbour_pairs.h"

#include <algorithm>
#include <cstddef>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

/// Enlargement of a kept box on each side, relative to its size. In a settling pile whose spheres move by 1e-3 of their
/// size per step, a twentieth of the spheres leave their kept boxes in ten steps. With twice the enlargement, a tenth
/// more pairs must be tested. Local, because only the cost depends on this value.
constexpr double kLarger = 0.02;
constexpr std::size_t kFew = 8;       // update() searches all boxes again if more than 1 / kFew have changed
constexpr std::size_t kFewLeft = 32;  // find() does so if more than 1 / kFewLeft have left their kept boxes
constexpr std::size_t kMany = 512;    // smallest number of boxes for which the cache saves time
/// Number of searches without enlargement after a search whose enlarged boxes were not reused.
constexpr int kUnenlargedSearches = 16;
/// Boxes or pairs per unit of parallel work.
constexpr std::size_t kNeighbourPairsBlock = 8192;

bool comes_before(const NeighbourPair& a, const NeighbourPair& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/// Returns the box. An empty box is replaced by the default box, which overlaps no box.
Box3 box_or_default(const Box3& box) { return box.empty() ? Box3{} : box; }

Box3 larger(const Box3& box) {
    const Vec3 size = box.size();
    return box.empty() ? Box3{} : grown(box, kLarger * std::max({size.x, size.y, size.z}));
}

bool contains(const Box3& outer, const Box3& inner) {
    return inner.empty() || (outer.contains(inner.lower) && outer.contains(inner.upper));
}

/// Merges the list `news` into `pairs`. Both lists are ascending.
void merge_into(std::vector<NeighbourPair>& pairs, const std::vector<NeighbourPair>& news) {
    auto end = static_cast<std::ptrdiff_t>(pairs.size());
    pairs.resize(pairs.size() + news.size());
    for (auto k = static_cast<std::ptrdiff_t>(news.size()) - 1; k >= 0;
         --k) {  // backwards, shifting pairs that come after the new one
        const NeighbourPair& pair = news[static_cast<std::size_t>(k)];
        const auto at = std::upper_bound(pairs.begin(), pairs.begin() + end, pair, comes_before);
        std::move_backward(at, pairs.begin() + end, pairs.begin() + end + k + 1);
        end = at - pairs.begin();
        pairs[static_cast<std::size_t>(end + k)] = pair;
    }
}

/// Removes the gaps between the blocks. The first left[k] items of block k are kept. Returns the number of kept items.
template <class T>
std::size_t close_gaps(std::vector<T>& items, const std::vector<std::size_t>& left) {
    std::size_t count = 0;
    for (std::size_t block = 0; block < left.size(); ++block) {
        const auto begin = items.begin() + static_cast<std::ptrdiff_t>(block * kNeighbourPairsBlock);
        std::copy(begin, begin + static_cast<std::ptrdiff_t>(left[block]),
                  items.begin() + static_cast<std::ptrdiff_t>(count));
        count += left[block];
    }
    return count;
}

std::size_t blocks_of(std::size_t count) { return (count + kNeighbourPairsBlock - 1) / kNeighbourPairsBlock; }

}  // namespace

const std::vector<NeighbourPair>& NeighbourPairs::find(std::span<const Box3> boxes) {
    if (!take_later(boxes)) {
        rebuild(boxes);
        return pairs_;
    }
    was_useful_ = true;
    take(boxes);
    select_kept_pairs();
    add_pairs_of(later_);
    return pairs_;
}

void NeighbourPairs::take(std::span<const Box3> boxes) {
    boxes_.resize(boxes.size());
    std::transform(boxes.begin(), boxes.end(), boxes_.begin(), box_or_default);
}

/// Collects in later_ the boxes that have left their kept boxes. Returns false if there are too many of them.
bool NeighbourPairs::take_later(std::span<const Box3> boxes) {
    if (boxes.size() != kept_.size() || boxes.size() < kMany) return false;
    const std::size_t most = boxes.size() / kFewLeft;
    later_.clear();
    for (std::uint32_t k = 0; k < boxes.size() && later_.size() <= most; ++k) {
        if (!contains(kept_[k], boxes[k])) later_.push_back(k);
    }
    return later_.size() <= most;
}

void NeighbourPairs::rebuild(std::span<const Box3> boxes) {
    if (is_larger_ && !was_useful_) unenlarged_searches_ = kUnenlargedSearches;
    is_larger_ = boxes.size() >= kMany && unenlarged_searches_ == 0;
    if (unenlarged_searches_ > 0) --unenlarged_searches_;
    was_useful_ = false;
    take(boxes);
    kept_ = boxes_;
    if (is_larger_) std::transform(boxes_.begin(), boxes_.end(), kept_.begin(), larger);
    static_cast<void>(grid_.find_pairs(kept_));
    later_.clear();
    static_cast<void>(later_grid_.find_pairs({}));
    is_changed_.assign(boxes.size(), 0);
    if (is_larger_) {
        select_kept_pairs();
    } else {
        is_later_.assign(boxes.size(), 0);
        pairs_ = grid_.pairs();
    }
}

/// Sets pairs_ to the pairs of kept boxes whose current boxes overlap, except pairs with a box in later_.
void NeighbourPairs::select_kept_pairs() {
    is_later_.assign(boxes_.size(), 0);
    for (const std::uint32_t k : later_) is_later_[k] = 1;
    const std::vector<NeighbourPair>& kept = grid_.pairs();
    pairs_.resize(kept.size());
    std::vector<std::size_t> left(blocks_of(kept.size()));
    parallel_for_blocks(kept.size(), kNeighbourPairsBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        std::size_t at = begin;
        for (std::size_t n = begin; n < end; ++n) {  // without branches, because overlaps are random
            const NeighbourPair& pair = kept[n];
            const unsigned is_later = is_later_[pair.first] | is_later_[pair.second];
            pairs_[at] = pair;
            at += static_cast<unsigned>(overlap(boxes_[pair.first], boxes_[pair.second])) & (1U - is_later);
        }
        left[block] = at - begin;
    });
    pairs_.resize(close_gaps(pairs_, left));
}

const std::vector<NeighbourPair>& NeighbourPairs::update(std::span<const Box3> boxes,
                                                         std::span<const std::uint32_t> changed) {
    if (changed.empty()) return pairs_;
    if (changed.size() + later_.size() > boxes.size() / kFew) return find(boxes);
    for (const std::uint32_t k : changed) {
        boxes_[k] = box_or_default(boxes[k]);
        if (is_later_[k] == 0) later_.push_back(k);
        is_later_[k] = is_changed_[k] = 1;
    }
    std::sort(later_.begin(), later_.end());
    std::erase_if(pairs_, [&](const NeighbourPair& pair) {
        return is_changed_[pair.first] != 0 || is_changed_[pair.second] != 0;
    });
    for (const std::uint32_t k : changed) is_changed_[k] = 0;
    add_pairs_of(changed);
    return pairs_;
}

/// Adds the pairs of the boxes `some`, which are in later_. Their old pairs must have been removed.
void NeighbourPairs::add_pairs_of(std::span<const std::uint32_t> some) {
    std::vector<Box3> later_boxes;
    for (const std::uint32_t k : later_) later_boxes.push_back(boxes_[k]);
    const std::vector<NeighbourPair>& later_pairs = later_grid_.find_pairs(later_boxes);
    if (some.empty()) return;
    std::vector<NeighbourPair> news;
    std::vector<std::uint32_t> near;
    for (const std::uint32_t k : some) {
        is_changed_[k] = 1;
        near.clear();
        grid_.find_near(boxes_[k], near);
        for (const std::uint32_t other : near) {
            if (is_later_[other] == 0 && overlap(boxes_[other], boxes_[k]))
                news.push_back({std::min(k, other), std::max(k, other)});
        }
    }
    for (const NeighbourPair& pair : later_pairs) {
        const NeighbourPair both{later_[pair.first], later_[pair.second]};
        if (is_changed_[both.first] != 0 || is_changed_[both.second] != 0) news.push_back(both);
    }
    for (const std::uint32_t k : some) is_changed_[k] = 0;
    std::sort(news.begin(), news.end(), comes_before);
    merge_into(pairs_, news);
}

void NeighbourPairs::find_near(const Box3& box, std::vector<std::uint32_t>& found) const {
    const auto begin = static_cast<std::ptrdiff_t>(found.size());
    grid_.find_near(box, found);
    const auto is_elsewhere = [&](std::uint32_t k) { return is_later_[k] != 0 || !overlap(boxes_[k], box); };
    found.erase(std::remove_if(found.begin() + begin, found.end(), is_elsewhere), found.end());
    if (later_.empty()) return;
    std::vector<std::uint32_t> near;
    later_grid_.find_near(box, near);
    for (const std::uint32_t k : near) found.push_back(later_[k]);
}

}  // namespace ricochet
