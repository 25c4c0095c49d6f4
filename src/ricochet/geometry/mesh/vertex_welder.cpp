#include "ricochet/geometry/mesh/vertex_welder.h"

#include <algorithm>
#include <bit>

namespace ricochet {
namespace {

constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

constexpr std::size_t kMinSlots = 64;

// Mixing step of MurmurHash3's 64-bit finaliser (A. Appleby, public domain).
std::uint64_t mixed(std::uint64_t x) {
    x ^= x >> 33;
    x *= 0xff51afd7ed558ccdULL;
    x ^= x >> 33;
    x *= 0xc4ceb9fe1a85ec53ULL;
    return x ^ (x >> 33);
}

std::uint64_t hash(const Vec3& p) {
    return mixed(std::bit_cast<std::uint64_t>(p.x) +
                 mixed(std::bit_cast<std::uint64_t>(p.y) + mixed(std::bit_cast<std::uint64_t>(p.z))));
}

}  // namespace

std::size_t VertexWelder::slot_of(const Vec3& position) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash(position) & mask;
    while (slots_[slot] != kFree && vertices_[slots_[slot]] != position) slot = (slot + 1) & mask;
    return slot;
}

std::uint32_t VertexWelder::index_of(const Vec3& position) {
    if (slots_.size() <= 2 * vertices_.size()) set_slots(slots_.empty() ? kMinSlots : 2 * slots_.size());
    const Vec3 key = position + Vec3{};  // -0 + 0 = 0
    const std::size_t slot = slot_of(key);
    if (slots_[slot] == kFree) {
        slots_[slot] = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(key);
    }
    return slots_[slot];
}

void VertexWelder::reserve(std::size_t positions) {
    const std::size_t count = std::bit_ceil(2 * positions + 1);
    if (count > std::max(slots_.size(), kMinSlots)) set_slots(count);
    vertices_.reserve(positions);
}

void VertexWelder::set_slots(std::size_t count) {
    slots_.assign(count, kFree);
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) slots_[slot_of(vertices_[i])] = i;
}

}  // namespace ricochet
