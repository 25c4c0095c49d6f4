#include "ricochet/dynamics/pair_forces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/dynamics/stability.h"

namespace ricochet {
namespace {

/// Pairs and particles per unit of parallel work.
constexpr std::size_t kPairForcesBlock = 1024;

/// Returns a cube for every particle. The cubes of two particles overlap if the particles are within the cutoff.
/// Particles with non-finite positions get empty cubes.
std::vector<Box3> boxes_around(const ParticlesView& particles, double cutoff, bool between_surfaces) {
    // Each cube has half of the cutoff as its half edge, plus a margin for rounding. Local, because the computed
    // distance decides.
    constexpr double kRounding = 1.0 + 0x1p-40;
    std::vector<Box3> boxes(particles.size());
    parallel_for_blocks(boxes.size(), kPairForcesBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Vec3& p = particles.positions[k];
            if (!is_finite(p)) continue;
            const double half = kRounding * (0.5 * cutoff + (between_surfaces ? particles.radii[k] : 0.0));
            const double reach = half + 0x1p-40 * max_abs(p);
            boxes[k] = {p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}};
        }
    });
    return boxes;
}

/// Force by a law with the functions force(pair), potential(pair) and cutoff().
template <class Law>
class PairForce final : public ParticlesForce {
public:
    PairForce(Law law, bool between_surfaces, bool has_potential, bool depends_on_velocity)
        : law_(std::move(law)),
          between_surfaces_(between_surfaces),
          has_potential_(has_potential),
          depends_on_velocity_(depends_on_velocity) {}

    // Threads compute the force of each pair once. The forces are then added in the order of the pairs.
    void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const override {
        NeighbourGrid grid;
        const std::vector<NeighbourPair>& pairs = pairs_of(particles, grid);
        std::vector<Vec3> forces(pairs.size());
        parallel_for_blocks(pairs.size(), kPairForcesBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
            PairState state;
            for (std::size_t k = begin; k < end; ++k) {
                if (find_state(particles, pairs[k], state)) forces[k] = law_.force(state);
            }
        });
        std::vector<Vec3> sums(particles.size());
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            sums[pairs[k].first] += forces[k];
            sums[pairs[k].second] -= forces[k];
        }
        for (std::size_t k = 0; k < sums.size(); ++k) result[k] += sums[k] / particles.masses[k];
    }

    [[nodiscard]] std::optional<double> potential_energy(const ParticlesView& particles) const override {
        if (!has_potential_) return std::nullopt;
        NeighbourGrid grid;
        const std::vector<NeighbourPair>& pairs = pairs_of(particles, grid);
        return ordered_sum(pairs.size(), kPairForcesBlock, [&](std::size_t begin, std::size_t end) {
            double sum = 0.0;
            PairState state;
            for (std::size_t k = begin; k < end; ++k) {
                if (find_state(particles, pairs[k], state)) sum += law_.potential(state);
            }
            return sum;
        });
    }

    [[nodiscard]] bool depends_on_velocity() const override { return depends_on_velocity_; }
    [[nodiscard]] const Law& law() const { return law_; }

    [[nodiscard]] std::vector<SteepPair> steep_pairs(const ParticlesView& particles) const {
        NeighbourGrid grid;
        std::vector<SteepPair> steep;
        PairState state;
        for (const NeighbourPair& pair : pairs_of(particles, grid)) {
            if (!find_state(particles, pair, state)) continue;
            const PairSteepness here = law_.steepness_at(state);
            if (here.stiffness > 0.0) steep.push_back({pair.first, pair.second, state.direction, here});
        }
        return steep;
    }

private:
    [[nodiscard]] const std::vector<NeighbourPair>& pairs_of(const ParticlesView& particles,
                                                             NeighbourGrid& grid) const {
        return grid.find_pairs(boxes_around(particles, law_.cutoff(), between_surfaces_));
    }

    /// Computes the state of a pair. Returns false for pairs beyond the cutoff and for coincident particles.
    [[nodiscard]] bool find_state(const ParticlesView& particles, const NeighbourPair& pair, PairState& state) const {
        const std::size_t i = pair.first;
        const std::size_t j = pair.second;
        const Vec3 d = particles.positions[i] - particles.positions[j];
        const double reach = law_.cutoff() + (between_surfaces_ ? particles.radii[i] + particles.radii[j] : 0.0);
        const double square = length_squared(d);
        if (!(square < reach * reach) || square < kCoincidentDistance * kCoincidentDistance) return false;
        state.distance = std::sqrt(square);
        state.direction = d / state.distance;
        state.relative_velocity = particles.velocities[i] - particles.velocities[j];
        state.masses = {particles.masses[i], particles.masses[j]};
        state.radii = {particles.radii[i], particles.radii[j]};
        state.ids = {particles.ids[i], particles.ids[j]};
        return true;
    }

    Law law_;
    bool between_surfaces_;
    bool has_potential_;
    bool depends_on_velocity_;
};

class CallableLaw {
public:
    explicit CallableLaw(PairLaw law) : law_(std::move(law)) {}
    [[nodiscard]] Vec3 force(const PairState& pair) const { return law_.force(pair); }
    [[nodiscard]] double potential(const PairState& pair) const { return law_.potential(pair); }
    [[nodiscard]] double cutoff() const { return law_.cutoff; }

private:
    PairLaw law_;
};

class LennardJones {
public:
    explicit LennardJones(const LennardJonesSettings& settings)
        : depth_(settings.depth),
          diameter_(settings.diameter),
          cutoff_(settings.cutoff * settings.diameter),
          force_at_cutoff_(bare_force(cutoff_)),
          potential_at_cutoff_(bare_potential(cutoff_)) {}

    [[nodiscard]] Vec3 force(const PairState& pair) const {
        return (bare_force(pair.distance) - force_at_cutoff_) * pair.direction;
    }
    [[nodiscard]] double potential(const PairState& pair) const {
        return bare_potential(pair.distance) - potential_at_cutoff_ + (pair.distance - cutoff_) * force_at_cutoff_;
    }
    [[nodiscard]] double cutoff() const { return cutoff_; }
    /// Returns the second derivative at the minimum of the potential, r^6 = 2 diameter^6.
    [[nodiscard]] PairSteepness steepness() const {
        return {72.0 / std::cbrt(2.0) * (depth_ / (diameter_ * diameter_)), 0.0};
    }
    [[nodiscard]] PairSteepness steepness_at(const PairState& pair) const {
        const double s = sixth_power(diameter_ / pair.distance);
        return {24.0 * depth_ * (26.0 * s * s - 7.0 * s) / (pair.distance * pair.distance), 0.0};
    }

private:
    [[nodiscard]] double bare_force(double r) const {
        const double s = sixth_power(diameter_ / r);
        return 24.0 * depth_ / r * (2.0 * s * s - s);
    }
    [[nodiscard]] double bare_potential(double r) const {
        const double s = sixth_power(diameter_ / r);
        return 4.0 * depth_ * (s * s - s);
    }
    static double sixth_power(double q) { return (q * q) * (q * q) * (q * q); }

    double depth_;
    double diameter_;
    double cutoff_;
    double force_at_cutoff_;
    double potential_at_cutoff_;
};

class Cohesion {
public:
    explicit Cohesion(const CohesionSettings& settings) : settings_(settings) {}

    [[nodiscard]] Vec3 force(const PairState& pair) const {
        const double gap = gap_of(pair);
        const double left = gap > 0.0 ? 1.0 - gap / settings_.range : 1.0;
        const double approach = dot(pair.relative_velocity, pair.direction);
        return -(settings_.stiffness * gap + settings_.damping * approach) * (left * left) * pair.direction;
    }
    [[nodiscard]] double potential(const PairState& pair) const {
        const double gap = gap_of(pair);
        const double scale = settings_.stiffness * settings_.range * settings_.range;
        const double s = std::max(0.0, gap) / settings_.range;
        const double in_gap = scale * (s * s) * (0.5 - 2.0 / 3.0 * s + 0.25 * s * s);
        const double in_overlap = gap < 0.0 ? 0.5 * settings_.stiffness * gap * gap : 0.0;
        return in_gap + in_overlap - scale / 12.0;
    }
    [[nodiscard]] double cutoff() const { return settings_.range; }
    [[nodiscard]] PairSteepness steepness() const { return {settings_.stiffness, settings_.damping}; }
    [[nodiscard]] PairSteepness steepness_at(const PairState& pair) const {
        const double s = std::max(0.0, gap_of(pair)) / settings_.range;
        return {settings_.stiffness * (1.0 - s) * (1.0 - 3.0 * s), settings_.damping * (1.0 - s) * (1.0 - s)};
    }

private:
    static double gap_of(const PairState& pair) { return pair.distance - (pair.radii[0] + pair.radii[1]); }

    CohesionSettings settings_;
};

template <class Law>
const PairForce<Law>* pairs_in(const ParticlesForce& force) {
    return dynamic_cast<const PairForce<Law>*>(&force);
}

}  // namespace

std::optional<PairSteepness> steepness_of(const ParticlesForce& force) {
    if (const auto* const pairs = pairs_in<Cohesion>(force)) return pairs->law().steepness();
    if (const auto* const pairs = pairs_in<LennardJones>(force)) return pairs->law().steepness();
    return std::nullopt;
}

std::vector<SteepPair> steep_pairs(const ParticlesForce& force, const ParticlesView& particles) {
    if (const auto* const pairs = pairs_in<Cohesion>(force)) return pairs->steep_pairs(particles);
    if (const auto* const pairs = pairs_in<LennardJones>(force)) return pairs->steep_pairs(particles);
    return {};
}

std::shared_ptr<const ParticlesForce> make_pair_force(PairLaw law) {
    detail::require_positive(law.cutoff, "force of pairs: the cutoff", "m");
    if (!law.force) throw InputError("force of pairs: an empty function cannot be called");
    const bool between_surfaces = law.between_surfaces;
    const bool has_potential = static_cast<bool>(law.potential);
    const bool depends_on_velocity = law.depends_on_velocity;
    return std::make_shared<PairForce<CallableLaw>>(CallableLaw(std::move(law)), between_surfaces, has_potential,
                                                    depends_on_velocity);
}

std::shared_ptr<const ParticlesForce> make_lennard_jones(const LennardJonesSettings& settings) {
    detail::require_positive(settings.depth, "Lennard-Jones: the depth", "J");
    detail::require_positive(settings.diameter, "Lennard-Jones: the diameter", "m");
    if (!(settings.cutoff > 1.0) || !std::isfinite(settings.cutoff)) {
        throw InputError("Lennard-Jones: the cutoff: expected a finite number of diameters above 1");
    }
    return std::make_shared<PairForce<LennardJones>>(LennardJones(settings), false, true, false);
}

std::shared_ptr<const ParticlesForce> make_cohesion(const CohesionSettings& settings) {
    detail::require_not_negative(settings.stiffness, "cohesion: the stiffness", "N/m");
    detail::require_not_negative(settings.damping, "cohesion: the damping", "N s/m");
    detail::require_positive(settings.range, "cohesion: the range", "m");
    return std::make_shared<PairForce<Cohesion>>(Cohesion(settings), true, true, settings.damping > 0.0);
}

}  // namespace ricochet
