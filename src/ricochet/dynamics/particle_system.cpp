#include "ricochet/dynamics/particle_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ricochet/core/parallel.h"
#include "ricochet/dynamics/implicit_euler.h"
#include "ricochet/dynamics/mutual_forces.h"

namespace ricochet {
namespace {

/// Members per unit of parallel work.
constexpr std::size_t kParticleSystemBlock = 256;

constexpr std::uint32_t kNoMember = std::numeric_limits<std::uint32_t>::max();

void require_length(std::size_t found, std::size_t expected) {
    if (found == expected) return;
    throw InputError(fmt::format("phase-space vector: found {} entries, expected {}, six for each member of the system",
                                 found, expected));
}

Vec3 read(std::span<const double> state, std::size_t at) { return {state[at], state[at + 1], state[at + 2]}; }

void write(std::span<double> state, std::size_t at, const Vec3& value) {
    state[at] = value.x;
    state[at + 1] = value.y;
    state[at + 2] = value.z;
}

}  // namespace

void ParticleSystem::assign(const Particles& particles, std::span<const std::uint32_t> members, double time) {
    if (std::adjacent_find(members.begin(), members.end(), std::greater_equal<>()) != members.end()) {
        throw InputError("members of a system: expected ascending numbers of particles");
    }
    if (!members.empty()) require_index(members.back(), particles.size(), "member of a system");
    members_.assign(members.begin(), members.end());
    time_ = time;
    constants_.resize(size());
    position_.resize(size());
    velocity_.resize(size());
    for (std::size_t k = 0; k < size(); ++k) {
        const std::uint32_t i = members_[k];
        constants_[k] = {particles.id[i], particles.mass[i], particles.radius[i], particles.pinned[i] != 0};
        position_[k] = particles.position[i];
        velocity_[k] = constants_[k].pinned ? Vec3{} : particles.velocity[i];
    }
    link(particles.size());
}

void ParticleSystem::expect_reactions(std::span<const Vec3> reactions) {
    require_same_length(reactions.size(), size(), "reactions on the members of a system");
    for (std::size_t k = 0; k < size(); ++k) constants_[k].reaction = reactions[k];
}

// Collects the springs between two members. The caller must handle springs that have only one end among the members.
void ParticleSystem::link(std::size_t particle_count) {
    std::vector<std::uint32_t> member_of(particle_count, kNoMember);
    for (std::size_t k = 0; k < size(); ++k) member_of[members_[k]] = static_cast<std::uint32_t>(k);
    bonds_.clear();
    first_link_.assign(size() + 1, 0);
    for (const SpringNetwork::Bond& bond : springs_.bonds()) {
        require_index(std::max(bond.a, bond.b), particle_count, "end of a spring");
        const Bond own{bond.spring, member_of[bond.a], member_of[bond.b]};
        if (own.first == kNoMember || own.second == kNoMember) continue;
        bonds_.push_back(own);
        ++first_link_[own.first + 1];
        ++first_link_[own.second + 1];
    }
    for (std::size_t k = 0; k < size(); ++k) first_link_[k + 1] += first_link_[k];
    links_.resize(2 * bonds_.size());
    std::vector<std::uint32_t> next(first_link_.begin(), first_link_.end() - 1);
    for (const Bond& bond : bonds_) {
        links_[next[bond.first]++] = {bond.spring, bond.second, true};
        links_[next[bond.second]++] = {bond.spring, bond.first, false};
    }
}

void ParticleSystem::require_state(std::span<const Vec3> positions, std::span<const Vec3> velocities) const {
    require_same_length(positions.size(), size(), "positions of a system");
    require_same_length(velocities.size(), size(), "velocities of a system");
}

void ParticleSystem::get_state(std::span<double> state) const {
    require_length(state.size(), dimension());
    for (std::size_t i = 0; i < size(); ++i) {
        write(state, 6 * i, position_[i]);
        write(state, 6 * i + 3, velocity_[i]);
    }
}

void ParticleSystem::set_state(std::span<const double> state) {
    require_length(state.size(), dimension());
    for (std::size_t i = 0; i < size(); ++i) {
        if (is_pinned(i)) continue;
        position_[i] = read(state, 6 * i);
        velocity_[i] = read(state, 6 * i + 3);
    }
}

void ParticleSystem::derivative(double time, std::span<double> result) const {
    std::vector<double> state(dimension());
    get_state(state);
    derivative(time, state, result);
}

void ParticleSystem::derivative(double time, std::span<const double> state, std::span<double> result) const {
    require_length(state.size(), dimension());
    require_length(result.size(), dimension());
    std::vector<Vec3> x(size());
    std::vector<Vec3> v(size());
    std::vector<Vec3> a(size());
    for (std::size_t i = 0; i < size(); ++i) {
        x[i] = is_pinned(i) ? position_[i] : read(state, 6 * i);
        v[i] = is_pinned(i) ? Vec3{} : read(state, 6 * i + 3);
    }
    accelerations(time, x, v, a);
    for (std::size_t i = 0; i < size(); ++i) {
        write(result, 6 * i, v[i]);
        write(result, 6 * i + 3, a[i]);
    }
}

void ParticleSystem::set_phase(std::span<const Vec3> positions, std::span<const Vec3> velocities) {
    require_state(positions, velocities);
    for (std::size_t i = 0; i < size(); ++i) {
        if (is_pinned(i)) continue;
        position_[i] = positions[i];
        velocity_[i] = velocities[i];
    }
}

void ParticleSystem::accelerations(double time, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                                   std::span<Vec3> result) const {
    accelerations(time, positions, velocities, mutual_accelerations(time, positions, velocities), result);
}

void ParticleSystem::accelerations(double time, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                                   std::span<const Vec3> mutual, std::span<Vec3> result) const {
    require_state(positions, velocities);
    require_same_length(result.size(), size(), "accelerations of a system");
    parallel_for_blocks(size(), kParticleSystemBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            result[i] = is_pinned(i) ? Vec3{}
                                     : spring_force_on(i, positions, velocities) / mass(i) +
                                           own_acceleration(i, time, positions[i], velocities[i]);
            if (!mutual.empty() && !is_pinned(i)) result[i] += mutual[i];
            if (!is_pinned(i) && expected_reaction(i) != Vec3{}) result[i] += expected_reaction(i);
        }
    });
}

std::vector<Vec3> ParticleSystem::mutual_accelerations(double time, std::span<const Vec3> positions,
                                                       std::span<const Vec3> velocities) const {
    if (mutual_ == nullptr || mutual_->empty()) return {};
    require_state(positions, velocities);
    std::vector<Vec3> result(size());
    mutual_->accelerations(time, positions, velocities, result);
    return result;
}

bool ParticleSystem::has_mutual_damping() const { return mutual_ != nullptr && mutual_->depend_on_velocity(); }

Vec3 ParticleSystem::spring_force_on(std::size_t i, std::span<const Vec3> positions,
                                     std::span<const Vec3> velocities) const {
    require_state(positions, velocities);
    struct State {
        const Vec3& position;
        const Vec3& velocity;
    };
    return spring_force_in(i, [&](std::size_t k) { return State{positions[k], velocities[k]}; });
}

Vec3 ParticleSystem::own_acceleration(std::size_t i, double time, const Vec3& position, const Vec3& velocity) const {
    return forces_.acceleration(input(i, time, position, velocity));
}

std::array<Vec3, 3> ParticleSystem::own_slope(std::size_t i, const Vec3& end_velocity, double duration) const {
    require_index(i, size(), "member of a system");
    return acceleration_slope(forces_, input(i, time_, position_[i], velocity_[i]), end_velocity, duration);
}

double ParticleSystem::spring_energy(std::span<const Vec3> positions) const {
    require_same_length(positions.size(), size(), "positions of a system");
    return ordered_sum(bonds_.size(), kParticleSystemBlock, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t k = begin; k < end; ++k) {
            const Spring& spring = spring_of(bonds_[k]);
            const double stretch =
                length(positions[bonds_[k].first] - positions[bonds_[k].second]) - spring.rest_length;
            sum += 0.5 * spring.stiffness * stretch * stretch;
        }
        return sum;
    });
}

ForceInput ParticleSystem::input(std::size_t i, double time, const Vec3& position, const Vec3& velocity) const {
    const Constants& own = constants(i);
    return {position, velocity, own.mass, own.radius, time, own.id};
}

}  // namespace ricochet
