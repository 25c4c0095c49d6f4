#include "ricochet/response/island_neighbours.h"

#include <algorithm>
#include <bit>

#include "ricochet/core/box_tools.h"

namespace ricochet {
namespace {

/// Largest number of boxes for which each search tests all boxes.
constexpr std::size_t kFew = 48;
/// The grid is rebuilt if more than one in this number of boxes has changed, because each search tests all of these.
constexpr std::size_t kChangedShare = 8;

}  // namespace

void EarliestTime::reset(std::size_t count) {
    leaves_ = std::bit_ceil(std::max<std::size_t>(count, 1));
    minima_.assign(2 * leaves_, std::numeric_limits<double>::infinity());
}

void EarliestTime::set(std::size_t index, double time) {
    std::size_t node = leaves_ + index;
    minima_[node] = time;
    while (node > 1) {
        node /= 2;
        const double least = std::min(minima_[2 * node], minima_[2 * node + 1]);
        if (minima_[node] == least) return;
        minima_[node] = least;
    }
}

void EarliestTime::collect(std::size_t node, double until, std::vector<std::size_t>& found) const {
    if (!(minima_[node] <= until)) return;
    if (node >= leaves_) {
        found.push_back(node - leaves_);
        return;
    }
    collect(2 * node, until, found);
    collect(2 * node + 1, until, found);
}

void IslandNeighbours::begin(const std::vector<Box3>& boxes) {
    boxes_ = &boxes;
    if (near_.size() < boxes.size()) near_.resize(boxes.size());
    for (std::size_t k = 0; k < boxes.size(); ++k) near_[k].clear();
    sort_all();
    if (boxes.size() > kFew) return;
    for (std::uint32_t k = 0; k < boxes.size(); ++k) {
        for (std::uint32_t other = k + 1; other < boxes.size(); ++other) {
            if (!overlap(boxes[k], boxes[other])) continue;
            near_[k].push_back(other);
            near_[other].push_back(k);
        }
    }
}

/// Sorts the boxes into a grid if there are many.
void IslandNeighbours::sort_all() {
    if (boxes_->size() <= kFew) return;
    has_changed_.assign(boxes_->size(), 0);
    changed_.clear();
    for (std::size_t k = 0; k < boxes_->size(); ++k) near_[k].clear();
    for (const NeighbourPair& pair : grid_.find_pairs(*boxes_)) {
        near_[pair.first].push_back(pair.second);
        near_[pair.second].push_back(pair.first);
    }
}

void IslandNeighbours::update(std::span<const std::size_t> changed) {
    const auto erase = [&](std::vector<std::uint32_t>& list, std::size_t k) {
        const auto at = std::lower_bound(list.begin(), list.end(), k);
        if (at != list.end() && *at == k) list.erase(at);
    };
    for (const std::size_t k : changed) {
        for (const std::uint32_t other : near_[k]) erase(near_[other], k);
        near_[k].clear();
        if (boxes_->size() <= kFew || has_changed_[k] != 0) continue;
        has_changed_[k] = 1;
        changed_.push_back(static_cast<std::uint32_t>(k));
    }
    if (boxes_->size() > kFew && changed_.size() > kFew + boxes_->size() / kChangedShare) {
        sort_all();
        return;
    }
    for (const std::size_t k : changed) {
        find(k);
        for (const std::uint32_t other : near_[k]) {
            std::vector<std::uint32_t>& list = near_[other];
            const auto at = std::lower_bound(list.begin(), list.end(), k);
            if (at == list.end() || *at != k) list.insert(at, static_cast<std::uint32_t>(k));
        }
    }
}

void IslandNeighbours::find(std::size_t index) {
    const Box3& box = (*boxes_)[index];
    std::vector<std::uint32_t>& near = near_[index];
    near.clear();
    const auto look_at = [&](std::uint32_t other) {
        if (other != index && overlap(box, (*boxes_)[other])) near.push_back(other);
    };
    if (boxes_->size() <= kFew) {
        for (std::uint32_t other = 0; other < boxes_->size(); ++other) look_at(other);
        return;
    }
    if (box.empty()) return;
    grid_.find_near(box, near);
    std::erase_if(near, [&](std::uint32_t other) { return has_changed_[other] != 0; });
    for (const std::uint32_t other : changed_) look_at(other);
    std::ranges::sort(near);
}

}  // namespace ricochet
