#include "ricochet/dynamics/particles.h"

#include <algorithm>
#include <numeric>

#include "ricochet/core/reserve_more.h"

namespace ricochet {
namespace {

template <typename T>
void compact_array(std::vector<T>& values, const std::vector<std::uint8_t>& keep) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (keep[i] != 0) values[kept++] = values[i];
    }
    values.resize(kept);
}

// Ids lie close together as a rule, and then a table of who has which is faster than sorting. False, and nothing done,
// where they do not, or are not all different.
bool put_in_order_by_table(const std::vector<std::uint64_t>& id, std::vector<std::uint32_t>& order) {
    constexpr std::uint64_t kMostPlacesAnEntry = 8;
    constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
    const auto [lowest, highest] = std::minmax_element(id.begin(), id.end());
    if ((*highest - *lowest) / kMostPlacesAnEntry >= id.size()) return false;
    std::vector<std::uint32_t> owner(*highest - *lowest + 1, kNobody);
    for (std::uint32_t i = 0; i < id.size(); ++i) {
        std::uint32_t& place = owner[id[i] - *lowest];
        if (place != kNobody) return false;
        place = i;
    }
    std::copy_if(owner.begin(), owner.end(), order.begin(), [](std::uint32_t i) { return i != kNobody; });
    return true;
}

}  // namespace

void Particles::append(const Particle& particle) {
    id.push_back(particle.id);
    position.push_back(particle.position);
    velocity.push_back(particle.velocity);
    spin.push_back(particle.spin);
    mass.push_back(particle.mass);
    radius.push_back(particle.radius);
    birth_time.push_back(particle.birth_time);
    lifetime.push_back(particle.lifetime);
    unsimulated_time.push_back(0.0);
    contacts.push_back(0);
    frozen.push_back(0);
    resting.push_back(0);
    held.push_back(0);
    absorbed.push_back(0);
    draws.push_back(0);
    support.push_back({kNoSupport, kNoSupport, kNoSupport});
    cascade_left.push_back(0.0);
    pinned.push_back(particle.pinned ? 1 : 0);
    accounted_until.push_back(0.0);
    attributes.append(particle.attributes);
    if (keeps_origin) origin.push_back(particle.origin);
}

void Particles::reserve(std::size_t more) {
    reserve_more(id, more);
    reserve_more(position, more);
    reserve_more(velocity, more);
    reserve_more(spin, more);
    reserve_more(mass, more);
    reserve_more(radius, more);
    reserve_more(birth_time, more);
    reserve_more(lifetime, more);
    reserve_more(unsimulated_time, more);
    reserve_more(contacts, more);
    reserve_more(frozen, more);
    reserve_more(resting, more);
    reserve_more(held, more);
    reserve_more(absorbed, more);
    reserve_more(draws, more);
    reserve_more(support, more);
    reserve_more(cascade_left, more);
    reserve_more(pinned, more);
    reserve_more(accounted_until, more);
    attributes.reserve(more);
    if (keeps_origin) reserve_more(origin, more);
}

Particle Particles::at(std::size_t i) const {
    Particle particle{id[i],         position[i], velocity[i], mass[i],       radius[i],
                      birth_time[i], lifetime[i], spin[i],     pinned[i] != 0};
    if (keeps_origin) particle.origin = origin[i];
    if (!attributes.empty()) particle.attributes = attributes.at(i);
    return particle;
}

void Particles::compact(const std::vector<std::uint8_t>& keep) {
    compact_array(id, keep);
    compact_array(position, keep);
    compact_array(velocity, keep);
    compact_array(spin, keep);
    compact_array(mass, keep);
    compact_array(radius, keep);
    compact_array(birth_time, keep);
    compact_array(lifetime, keep);
    compact_array(unsimulated_time, keep);
    compact_array(contacts, keep);
    compact_array(frozen, keep);
    compact_array(resting, keep);
    compact_array(held, keep);
    compact_array(absorbed, keep);
    compact_array(draws, keep);
    compact_array(support, keep);
    compact_array(cascade_left, keep);
    compact_array(pinned, keep);
    compact_array(accounted_until, keep);
    attributes.compact(keep);
    if (keeps_origin) compact_array(origin, keep);
}

std::vector<std::uint32_t> Particles::order_by_id() const {
    std::vector<std::uint32_t> order(size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    if (std::is_sorted(id.begin(), id.end()) || put_in_order_by_table(id, order)) return order;
    std::sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) { return id[a] < id[b]; });
    return order;
}

}  // namespace ricochet
