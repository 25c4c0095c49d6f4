#include "ricochet/simulation/member_pairs.h"

#include <algorithm>
#include <numeric>

namespace ricochet {
namespace {

/// Smallest number of members whose pairs are stored by particle numbers. For fewer members, a new search is as fast.
constexpr std::size_t kMany = 512;

/// Largest range of the particles' numbers, as a multiple of the number of members.
constexpr std::size_t kMostSlots = 2;

}  // namespace

void MemberPairs::collect_numbers(std::span<const IslandMember> members) {
    is_by_particle_ = members.size() >= kMany;
    if (!is_by_particle_) return;
    const auto [lowest, highest] = std::ranges::minmax_element(members, {}, &IslandMember::particle);
    const std::size_t first = lowest->particle;
    const std::size_t slots = highest->particle - first + 1;
    is_by_particle_ = slots <= kMostSlots * members.size();
    if (!is_by_particle_) return;
    slots_.resize(members.size());
    member_at_.resize(slots);
    for (std::uint32_t i = 0; i < members.size(); ++i) {
        slots_[i] = static_cast<std::uint32_t>(members[i].particle - first);
        member_at_[slots_[i]] = i;
    }
}

void MemberPairs::find(std::span<const IslandMember> members, std::span<const Box3> boxes) {
    collect_numbers(members);
    if (!is_by_particle_) {
        static_cast<void>(near_.find(boxes));
        return;
    }
    boxes_.assign(member_at_.size(), {});
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes_[slots_[i]] = boxes[i];
    static_cast<void>(near_.find(boxes_));
}

void MemberPairs::update(std::span<const Box3> boxes, std::span<const std::uint32_t> changed) {
    if (!is_by_particle_) {
        static_cast<void>(near_.update(boxes, changed));
        return;
    }
    changed_.clear();
    for (const std::uint32_t i : changed) {
        boxes_[slots_[i]] = boxes[i];
        changed_.push_back(slots_[i]);
    }
    std::ranges::sort(changed_);
    static_cast<void>(near_.update(boxes_, changed_));
}

/// Sorts by the second numbers, and then by the first numbers. The second sort keeps the order of the second numbers.
std::span<const NeighbourPair> MemberPairs::sorted() {
    const std::vector<NeighbourPair>& all = near_.all();
    if (!is_by_particle_) return all;
    first_ends_.assign(slots_.size(), 0);
    second_ends_.assign(slots_.size(), 0);
    sorted_.resize(all.size());
    by_second_.resize(all.size());
    for (std::size_t n = 0; n < all.size(); ++n) {
        const auto [first, second] = std::minmax(member_at_[all[n].first], member_at_[all[n].second]);
        sorted_[n] = {first, second};
        ++first_ends_[first];
        ++second_ends_[second];
    }
    std::exclusive_scan(first_ends_.begin(), first_ends_.end(), first_ends_.begin(), 0U);
    std::exclusive_scan(second_ends_.begin(), second_ends_.end(), second_ends_.begin(), 0U);
    for (const NeighbourPair& pair : sorted_) by_second_[second_ends_[pair.second]++] = pair;
    for (const NeighbourPair& pair : by_second_) sorted_[first_ends_[pair.first]++] = pair;
    return sorted_;
}

}  // namespace ricochet
