#include "ricochet/dynamics/mutual_forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/stability.h"

namespace ricochet {
namespace {

/// Members per unit of parallel work.
constexpr std::size_t kMutualForcesBlock = 4096;

std::vector<double> column_of(const Particles& particles, const std::string& name,
                              std::span<const std::uint32_t> members, std::span<const std::uint32_t> slots) {
    const auto column = particles.attributes.find(name);
    if (!column) {
        throw InputError(
            fmt::format("force between particles: it needs the attribute \"{}\", which no particle has", name));
    }
    const int components = particles.attributes.columns()[*column].components;
    std::vector<double> values;
    values.reserve(slots.size() * static_cast<std::size_t>(components));
    for (const std::uint32_t slot : slots) {
        const AttributeValue value = particles.attributes.value(*column, members[slot]);
        for (int c = 0; c < components; ++c) values.push_back(value[c]);
    }
    return values;
}

bool is_in_range(const Vec3& v) { return is_finite(v) && max_abs(v) <= kLargestJudged; }

/// Throws RunError for a non-finite acceleration, except in states out of range, which integrators may try.
void refuse_if_not_finite(const ParticlesForce& force, std::size_t number, const ParticlesView& view,
                          std::span<const Vec3> accelerations) {
    const auto wrong =
        std::find_if_not(accelerations.begin(), accelerations.end(), [](const Vec3& a) { return is_finite(a); });
    if (wrong == accelerations.end()) return;
    // Valid forces of these kinds may overflow, for example if two particles almost coincide.
    if (steepness_of(force) || lacks_softening(force)) return;
    if (!std::ranges::all_of(view.positions, is_in_range)) return;
    if (!std::ranges::all_of(view.velocities, is_in_range)) return;
    const auto k = static_cast<std::size_t>(wrong - accelerations.begin());
    const std::string name = force.name();
    const Vec3& x = view.positions[k];
    throw RunError(
        fmt::format("{}: found the acceleration [{}, {}, {}] m/s^2 of particle {} at [{:.6g}, {:.6g}, {:.6g}] m and "
                    "{:.6g} s, expected finite numbers",
                    name.empty() ? fmt::format("particle_forces[{}]", number) : name, wrong->x, wrong->y, wrong->z,
                    view.ids[k], x.x, x.y, x.z, view.time));
}

std::vector<Vec3> gather(std::span<const Vec3> from, std::span<const std::uint32_t> slots) {
    std::vector<Vec3> result(slots.size());
    for (std::size_t k = 0; k < slots.size(); ++k) result[k] = from[slots[k]];
    return result;
}

}  // namespace

MutualForces::MutualForces(std::vector<ParticlesForceEntry> entries) : entries_(std::move(entries)) {
    for (std::size_t k = 0; k < entries_.size(); ++k) {
        ParticlesForceEntry& entry = entries_[k];
        if (!entry.force) {
            throw InputError(fmt::format("force between particles {}: found a null pointer, expected a force", k));
        }
        std::ranges::sort(entry.particles);
        std::ranges::sort(entry.emitters);
    }
}

bool MutualForces::acts_on(const ParticlesForceEntry& entry, const Particles& particles, std::size_t i) const {
    if (entry.particles.empty() && entry.emitters.empty()) return true;
    if (std::ranges::binary_search(entry.particles, particles.id[i])) return true;
    return !entry.emitters.empty() && std::ranges::binary_search(entry.emitters, particles.origin[i].emitter);
}

bool MutualForces::act_on(const Particles& particles, std::size_t i) const {
    return std::ranges::any_of(entries_,
                               [&](const ParticlesForceEntry& entry) { return acts_on(entry, particles, i); });
}

bool MutualForces::depend_on_velocity() const {
    return std::ranges::any_of(entries_,
                               [](const ParticlesForceEntry& entry) { return entry.force->depends_on_velocity(); });
}

void MutualForces::assign(const Particles& particles, std::span<const std::uint32_t> members) {
    seen_.clear();
    for (const ParticlesForceEntry& entry : entries_) seen_.push_back(seen_by(entry, particles, members));
}

MutualForces::Seen MutualForces::seen_by(const ParticlesForceEntry& entry, const Particles& particles,
                                         std::span<const std::uint32_t> members) const {
    Seen seen;
    for (std::size_t k = 0; k < members.size(); ++k) {
        const std::uint32_t i = members[k];
        if (particles.frozen[i] != 0 || !acts_on(entry, particles, i)) continue;
        seen.slots.push_back(static_cast<std::uint32_t>(k));
        seen.ids.push_back(particles.id[i]);
        seen.masses.push_back(particles.mass[i]);
        seen.radii.push_back(particles.radius[i]);
    }
    seen.is_all = seen.slots.size() == members.size();
    for (const std::string& name : entry.force->attributes()) {
        seen.attributes.push_back(column_of(particles, name, members, seen.slots));
    }
    return seen;
}

ParticlesView MutualForces::view_of(const Seen& seen, double time, std::span<const Vec3> positions,
                                    std::span<const Vec3> velocities, Gathered& gathered) {
    ParticlesView view{time, seen.ids, positions, velocities, seen.masses, seen.radii};
    if (!seen.is_all) {
        gathered = {gather(positions, seen.slots), gather(velocities, seen.slots)};
        view.positions = gathered.positions;
        view.velocities = gathered.velocities;
    }
    for (const std::vector<double>& values : seen.attributes) view.attributes.emplace_back(values);
    return view;
}

void MutualForces::accelerations(double time, std::span<const Vec3> positions, std::span<const Vec3> velocities,
                                 std::span<Vec3> result) const {
    std::ranges::fill(result, Vec3{});
    for (std::size_t e = 0; e < seen_.size(); ++e) {
        const Seen& seen = seen_[e];
        Gathered gathered;
        const ParticlesView view = view_of(seen, time, positions, velocities, gathered);
        if (seen.is_all) {
            entries_[e].force->add_accelerations(view, result);
            refuse_if_not_finite(*entries_[e].force, e, view, result);
            continue;
        }
        std::vector<Vec3> own(seen.slots.size());
        entries_[e].force->add_accelerations(view, own);
        refuse_if_not_finite(*entries_[e].force, e, view, own);
        parallel_for_blocks(own.size(), kMutualForcesBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) result[seen.slots[k]] += own[k];
        });
    }
}

std::optional<double> MutualForces::potential_energy(double time, std::span<const Vec3> positions,
                                                     std::span<const Vec3> velocities) const {
    double sum = 0.0;
    for (std::size_t e = 0; e < seen_.size(); ++e) {
        Gathered gathered;
        const auto energy =
            entries_[e].force->potential_energy(view_of(seen_[e], time, positions, velocities, gathered));
        if (!energy) return std::nullopt;
        sum += *energy;
    }
    return sum;
}

}  // namespace ricochet
