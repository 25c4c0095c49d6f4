#include "ricochet/simulation/start_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ricochet/core/symmetric_matrix.h"

namespace ricochet {
namespace {

/// Returns the largest eigenvalue of a positive semi-definite matrix (O. K. Smith, "Eigenvalues of a symmetric 3 x 3
/// matrix", CACM 4(4), 1961).
double largest_eigenvalue(const SymmetricMatrix& a) {
    const double mean = a.trace() / 3.0;
    const SymmetricMatrix rest = a + diagonal_matrix(-mean);
    const double squares = rest.xx * rest.xx + rest.yy * rest.yy + rest.zz * rest.zz +
                           2.0 * (rest.xy * rest.xy + rest.xz * rest.xz + rest.yz * rest.yz);
    const double spread = std::sqrt(squares / 6.0);
    if (!(spread > 0.0)) return mean;
    const double cosine = std::clamp(0.5 * ((1.0 / spread) * rest).determinant(), -1.0, 1.0);
    return mean + 2.0 * spread * std::cos(std::acos(cosine) / 3.0);
}

/// Particles between which a force acts, as lists.
struct Members {
    std::vector<std::uint64_t> ids;
    std::vector<Vec3> positions;
    std::vector<Vec3> velocities;
    std::vector<double> masses;
    std::vector<double> radii;
    std::vector<double> inverse_masses;  ///< 1/kg, 0 for a pinned particle

    void add(const Particle& particle, std::uint64_t id) {
        ids.push_back(id);
        positions.push_back(particle.position);
        velocities.push_back(particle.velocity);
        masses.push_back(particle.mass);
        radii.push_back(particle.radius);
        inverse_masses.push_back(particle.pinned ? 0.0 : 1.0 / particle.mass);
    }
    [[nodiscard]] ParticlesView view() const { return {0.0, ids, positions, velocities, masses, radii}; }
};

Members members_of(const SimulationSetup& setup, const ParticlesForceEntry& entry) {
    Members members;
    if (entry.particles.empty() && entry.emitters.empty()) {
        for (std::size_t i = 0; i < setup.particles.size(); ++i) members.add(setup.particles[i], i);
    }
    for (const std::uint64_t id : entry.particles) {
        if (id < setup.particles.size()) members.add(setup.particles[id], id);
    }
    return members;
}

}  // namespace

OscillationRates rates_at_start(const SimulationSetup& setup, const ParticlesForceEntry& entry) {
    const Members members = members_of(setup, entry);
    std::vector<SymmetricMatrix> stiffness(members.ids.size());
    std::vector<SymmetricMatrix> damping(members.ids.size());
    for (const SteepPair& pair : steep_pairs(*entry.force, members.view())) {
        const double mobility = members.inverse_masses[pair.first] + members.inverse_masses[pair.second];
        const SymmetricMatrix along = mobility * outer_product(pair.direction);
        for (const std::size_t i : {pair.first, pair.second}) {
            stiffness[i] = stiffness[i] + pair.steepness.stiffness * along;
            damping[i] = damping[i] + pair.steepness.damping * along;
        }
    }
    OscillationRates rates;
    for (std::size_t i = 0; i < stiffness.size(); ++i) {
        rates.omega_squared = std::max(rates.omega_squared, largest_eigenvalue(stiffness[i]));
        rates.gamma = std::max(rates.gamma, largest_eigenvalue(damping[i]));
    }
    return rates;
}

}  // namespace ricochet
