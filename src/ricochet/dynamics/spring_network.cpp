#include "ricochet/dynamics/springs.h"

#include <fmt/format.h>
#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/dynamics/settings_table.h"
#include "ricochet/dynamics/stability.h"

namespace ricochet {

namespace {

/// Number of springs per block of parallel work in the sum of the energy.
constexpr std::size_t kSpringNetworkBlock = 1024;

void check(const Spring& spring, std::size_t number) {
    const std::string name = fmt::format("spring {}: ", number);
    if (spring.first == spring.second) {
        throw InputError(fmt::format("{}both ends are particle {}, expected two particles", name, spring.first));
    }
    require_settings(spring, kSpringTable, name);
    require_settings(spring, kDampingTable<Spring>, name);
    if (spring.rest_length == 0.0 && spring.breaking_stretch < std::numeric_limits<double>::infinity()) {
        throw InputError(name + "a spring without a rest length has no breaking stretch; leave it out");
    }
}

/// Map from ids to indices.
class Indices {
public:
    explicit Indices(std::span<const std::uint64_t> ids) : ids_(ids), order_(ids.size()) {
        std::iota(order_.begin(), order_.end(), std::uint32_t{0});
        if (!std::is_sorted(ids.begin(), ids.end())) {
            std::ranges::sort(order_, [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
        }
        const auto twice = std::adjacent_find(order_.begin(), order_.end(),
                                              [&](std::uint32_t a, std::uint32_t b) { return ids[a] == ids[b]; });
        if (twice != order_.end()) throw InputError("particles of springs: found an id twice, expected each once");
    }
    [[nodiscard]] std::optional<std::uint32_t> of(std::uint64_t id) const {
        const auto found = std::ranges::lower_bound(
            order_, id, [&](std::uint32_t i, std::uint64_t wanted) { return ids_[i] < wanted; });
        if (found == order_.end() || ids_[*found] != id) return std::nullopt;
        return *found;
    }

private:
    std::span<const std::uint64_t> ids_;
    std::vector<std::uint32_t> order_;  // indices in ascending order of ids
};

}  // namespace

// If the ends are swapped, all differences only change their signs. The forces on the two ends are therefore exactly
// opposite.
Vec3 spring_force(const Spring& spring, const Vec3& x_first, const Vec3& v_first, const Vec3& x_second,
                  const Vec3& v_second) {
    const Vec3 d = x_second - x_first;
    const double distance = length(d);
    if (distance == 0.0) return {};
    const Vec3 along = d / distance;
    const double rate = dot(v_second - v_first, along);
    return along * (spring.stiffness * (distance - spring.rest_length) + spring.damping * rate);
}

SpringNetwork::SpringNetwork(std::vector<Spring> springs)
    : springs_(std::move(springs)), states_(springs_.size(), State::intact) {
    if (springs_.size() > std::numeric_limits<std::uint32_t>::max() / 2) {
        throw InputError(fmt::format("found {} springs, expected at most 2^31 - 1", springs_.size()));
    }
    for (std::size_t i = 0; i < springs_.size(); ++i) check(springs_[i], i);
    link_begin_.assign(1, 0);
}

void SpringNetwork::bind(std::span<const std::uint64_t> ids) {
    particle_count_ = ids.size();
    bonds_.clear();
    const Indices indices(ids);
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        if (!is_intact(i)) continue;
        const auto a = indices.of(springs_[i].first);
        const auto b = indices.of(springs_[i].second);
        if (a && b) {
            bonds_.push_back({static_cast<std::uint32_t>(i), *a, *b});
        } else {
            states_[i] = State::lost;
            ++lost_;
        }
    }
    compile_links();
}

// Bonds are in the order of spring numbers. A counting sort keeps this order in the list of every particle.
void SpringNetwork::compile_links() {
    link_begin_.assign(particle_count_ + 1, 0);
    for (const Bond& bond : bonds_) {
        ++link_begin_[bond.a + 1];
        ++link_begin_[bond.b + 1];
    }
    coupled_.clear();
    for (std::uint32_t i = 0; i < particle_count_; ++i) {
        if (link_begin_[i + 1] > 0) coupled_.push_back(i);
        link_begin_[i + 1] += link_begin_[i];
    }
    links_.resize(2 * bonds_.size());
    std::vector<std::uint32_t> next(link_begin_.begin(), link_begin_.end() - 1);
    for (const Bond& bond : bonds_) {
        links_[next[bond.a]++] = {bond.spring, bond.b};
        links_[next[bond.b]++] = {bond.spring, bond.a};
    }
}

// Without springs, bind() need not be called, so the number of particles may be unknown.
void SpringNetwork::require_entries(std::span<const Vec3> values) const {
    if (!empty()) require_same_length(values.size(), particle_count_, "positions and velocities of springs' particles");
}

void SpringNetwork::require_states() const {
    const auto count_of = [&](State state) { return static_cast<std::size_t>(std::ranges::count(states_, state)); };
    const std::size_t broken = count_of(State::broken);
    const std::size_t lost = count_of(State::lost);
    if (broken != broken_ || lost != lost_ || broken + lost + count_of(State::intact) != states_.size()) {
        throw InputError("the saved states of springs contradict each other");
    }
}

Vec3 SpringNetwork::force_on(std::uint32_t i, std::span<const Vec3> position, std::span<const Vec3> velocity) const {
    require_entries(position);
    require_entries(velocity);
    Vec3 sum;
    for (const Link& link : links(i)) {
        sum +=
            spring_force(springs_[link.spring], position[i], velocity[i], position[link.other], velocity[link.other]);
    }
    return sum;
}

double SpringNetwork::potential_energy(std::span<const Vec3> position) const {
    require_entries(position);
    return ordered_sum(bonds_.size(), kSpringNetworkBlock, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            const Bond& bond = bonds_[k];
            const Spring& spring = springs_[bond.spring];
            const double stretch = length(position[bond.b] - position[bond.a]) - spring.rest_length;
            sum += 0.5 * spring.stiffness * stretch * stretch;
        }
        return sum;
    });
}

std::size_t SpringNetwork::break_overstretched(std::span<const Vec3> position) {
    require_entries(position);
    const auto holds = [&](const Bond& bond) {
        const Spring& spring = springs_[bond.spring];
        const double limit = (1.0 + spring.breaking_stretch) * spring.rest_length;
        return spring.rest_length == 0.0 || !(length(position[bond.b] - position[bond.a]) > limit);
    };
    const auto first_broken = std::stable_partition(bonds_.begin(), bonds_.end(), holds);
    const auto count = static_cast<std::size_t>(bonds_.end() - first_broken);
    if (count == 0) return 0;
    std::for_each(first_broken, bonds_.end(), [&](const Bond& bond) { states_[bond.spring] = State::broken; });
    bonds_.erase(first_broken, bonds_.end());
    broken_ += count;
    compile_links();
    return count;
}

double longest_stable_step(IntegratorKind kind, std::span<const Spring> springs,
                           const std::vector<Particle>& particles) {
    return longest_stable_step(kind, rates_of(springs, particles));
}

OscillationRates rates_of(std::span<const Spring> springs, const std::vector<Particle>& particles) {
    OscillationRates largest;
    std::vector<OscillationRates> sums(particles.size());  // for every particle, over its springs
    for (const Spring& spring : springs) {
        if (spring.stiffness > 0.0) {
            largest.least_damper = std::min(largest.least_damper, spring.damping / spring.stiffness);
        }
        for (const std::uint64_t end : {spring.first, spring.second}) {
            require_index(end, particles.size(), "end of a spring");
            if (particles[end].pinned) continue;
            sums[end].omega_squared += spring.stiffness / particles[end].mass;
            sums[end].gamma += spring.damping / particles[end].mass;
        }
    }
    for (const OscillationRates& sum : sums) {
        largest.omega_squared = std::max(largest.omega_squared, 2.0 * sum.omega_squared);
        largest.gamma = std::max(largest.gamma, 2.0 * sum.gamma);
    }
    return largest;
}

}  // namespace ricochet
