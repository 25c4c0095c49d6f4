#include "ricochet/response/coulomb_equations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Largest number of steps of Newton's method, and of halvings of one step. Four or five steps usually suffice. More
/// steps do not help if the iteration cycles. Local: the result is checked.
constexpr int kNewtonSteps = 14;
constexpr int kHalvings = 4;
/// Number of sweeps before the first comparison of changes, see kSteadyChange. Local: the result is checked.
constexpr int kFirstComparison = 32;

}  // namespace

double CoulombEquations::set_up(double friction) {
    friction_ = friction;
    unknowns_ = 0;
    const auto add_unknown = [&](const MotionVector& direction, double rate) {
        direction_[unknowns_] = direction;
        free_rate_[unknowns_] = rate;
        force_[unknowns_++] = 0.0;
    };
    for (std::size_t k = 0; k < contact_count_; ++k) add_unknown(contacts_[k].direction, contacts_[k].rate);
    for (std::size_t k = 0; k < resistance_count_; ++k) {
        first_[k] = unknowns_;
        const CoulombResistance& r = resistances_[k];
        for (std::size_t d = 0; d < r.size; ++d) add_unknown(r.direction[d], r.rate[d]);
    }
    for (std::size_t i = 0; i < unknowns_; ++i) {
        for (std::size_t j = 0; j <= i; ++j) delassus_[i][j] = delassus_[j][i] = dot(direction_[i], direction_[j]);
    }
    double scale = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) scale = std::max(scale, std::fabs(free_rate_[i]));
    for (std::size_t i = 0; i < unknowns_ && scale > 0.0; ++i) free_rate_[i] /= scale;
    return scale;
}

std::array<double, 2> CoulombEquations::force_of(std::size_t resistance) const {
    const std::size_t i = first_[resistance];
    return {force_[i], resistances_[resistance].size == 2 ? force_[i + 1] : 0.0};
}

double CoulombEquations::largest_force() const { return largest_change_from({}); }

double CoulombEquations::largest_change_from(const Unknowns& before) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) largest = std::max(largest, std::fabs(force_[i] - before[i]));
    return largest;
}

MotionVector CoulombEquations::change() const {
    MotionVector sum{};
    for (std::size_t i = 0; i < unknowns_; ++i) add_multiple(sum, force_[i], direction_[i]);
    return sum;
}

void CoulombEquations::cut_to_bounds(double scale) {
    for (std::size_t k = 0; k < contact_count_; ++k) force_[k] = std::max(0.0, force_[k]);
    for (std::size_t k = 0; k < resistance_count_; ++k) {
        const CoulombResistance& r = resistances_[k];
        double* const force = &force_[first_[k]];
        const double most = friction_ * r.bound * force_[r.contact];
        const double size = r.size == 2 ? std::sqrt(force[0] * force[0] + force[1] * force[1]) : std::fabs(force[0]);
        for (std::size_t d = 0; d < r.size && size > most; ++d) force[d] *= most / size;
    }
    for (std::size_t i = 0; i < unknowns_; ++i) force_[i] *= scale;
}

bool CoulombEquations::are_independent() const {
    for (std::size_t i = 0; i < unknowns_; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (std::fabs(delassus_[i][j]) > kCoulombRounding * delassus_[j][j]) return false;
        }
    }
    return true;
}

double CoulombEquations::solve_independent() {
    for (std::size_t k = 0; k < contact_count_; ++k) force_[k] = std::max(0.0, -free_rate_[k] / delassus_[k][k]);
    (void)find_defects({});
    for (std::size_t k = 0; k < resistance_count_; ++k) {
        const Wish wish = wish_of(k, {});
        const double part = wish.part();
        for (std::size_t d = 0; d < resistances_[k].size; ++d) force_[first_[k] + d] = part * wish.force[d];
    }
    return find_defects({});
}

bool CoulombEquations::newton(const Compliance& compliance, double enough) {
    double defect = find_defects(compliance);
    for (int step = 0; step < kNewtonSteps && defect > enough; ++step) {
        find_matrix(compliance);
        if (!eliminate()) return false;
        const Unknowns before = force_;
        const Unknowns change = defect_;
        double part = 1.0;
        double found = 0.0;
        for (int halving = 0; halving < kHalvings; ++halving, part *= 0.5) {
            for (std::size_t i = 0; i < unknowns_; ++i) force_[i] = before[i] - part * change[i];
            found = find_defects(compliance);
            if (found <= enough || found < (1.0 - 0.1 * part) * defect) break;
        }
        if (!(found < kHopelessResidual)) return false;
        defect = found;
    }
    return defect <= enough;
}

bool CoulombEquations::relax(const Compliance& compliance, int sweeps) {
    MotionVector all = change();
    const auto find_rate = [&](std::size_t i) {
        rate_[i] = free_rate_[i] + dot(direction_[i], all) + compliance.value * (force_[i] - compliance.anchor[i]);
    };
    const auto set = [&](std::size_t i, double value) {
        add_multiple(all, value - force_[i], direction_[i]);
        force_[i] = value;
    };
    int comparison = kFirstComparison;
    Unknowns before;
    double last_change = 0.0;
    bool diverges = false;
    sweeps_ += static_cast<std::size_t>(sweeps);
    for (int sweep = 1; sweep <= sweeps; ++sweep) {
        if (sweep == comparison) before = force_;
        for (std::size_t k = 0; k < contact_count_; ++k) {
            find_rate(k);
            set(k, std::max(0.0, force_[k] - gain_of(k, compliance) * rate_[k]));
        }
        for (std::size_t k = 0; k < resistance_count_; ++k) {
            const CoulombResistance& r = resistances_[k];
            for (std::size_t d = 0; d < r.size; ++d) find_rate(first_[k] + d);
            const Wish wish = wish_of(k, compliance);
            const double part = wish.part();
            for (std::size_t d = 0; d < r.size; ++d) set(first_[k] + d, part * wish.force[d]);
        }
        if (sweep != comparison) continue;
        const double now = largest_change_from(before);
        diverges = now > kCoulombStage && std::fabs(now - last_change) <= kSteadyChange * now;
        last_change = now;
        comparison *= 2;
    }
    return diverges;
}

double CoulombEquations::gain_of(std::size_t contact, const Compliance& compliance) const {
    return 1.0 / (delassus_[contact][contact] + compliance.value);
}

/// Returns the force that would remove the rate. A moving resistance always acts with its largest force.
CoulombEquations::Wish CoulombEquations::wish_of(std::size_t resistance, const Compliance& compliance) const {
    const CoulombResistance& r = resistances_[resistance];
    const std::size_t i = first_[resistance];
    Wish wish;
    wish.most = friction_ * r.bound * std::max(0.0, force_[r.contact]);
    if (r.is_moving) {
        wish.size = 1.0;
        wish.force = {-r.heading[0], -r.heading[1]};
        wish.is_cut = true;
        return wish;
    }
    double diagonal = delassus_[i][i];
    if (r.size == 2) diagonal = std::max(diagonal, delassus_[i + 1][i + 1]);
    wish.gain = 1.0 / (diagonal + compliance.value);
    for (std::size_t d = 0; d < r.size; ++d) wish.force[d] = force_[i + d] - wish.gain * rate_[i + d];
    wish.size = std::sqrt(wish.force[0] * wish.force[0] + wish.force[1] * wish.force[1]);
    wish.is_cut = wish.size > wish.most;
    return wish;
}

/// Evaluates the equations of Alart and Curnier: N = max(0, N - gain rate), and T is the wish, limited to its bound.
double CoulombEquations::find_defects(const Compliance& compliance) {
    const MotionVector all = change();
    for (std::size_t i = 0; i < unknowns_; ++i) {
        rate_[i] = free_rate_[i] + dot(direction_[i], all) + compliance.value * (force_[i] - compliance.anchor[i]);
    }
    for (std::size_t k = 0; k < contact_count_; ++k) {
        defect_[k] = force_[k] - std::max(0.0, force_[k] - gain_of(k, compliance) * rate_[k]);
    }
    for (std::size_t k = 0; k < resistance_count_; ++k) {
        const Wish wish = wish_of(k, compliance);
        const double part = wish.part();
        for (std::size_t d = 0; d < resistances_[k].size; ++d) {
            defect_[first_[k] + d] = force_[first_[k] + d] - part * wish.force[d];
        }
    }
    double largest = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) largest = std::max(largest, std::fabs(defect_[i]));
    return largest;
}

/// Computes the derivatives of the defects with respect to the forces.
void CoulombEquations::find_matrix(const Compliance& compliance) {
    for (std::size_t k = 0; k < contact_count_; ++k) {
        const double gain = gain_of(k, compliance);
        const bool is_closed = force_[k] > gain * rate_[k];
        for (std::size_t j = 0; j < unknowns_; ++j) matrix_[k][j] = is_closed ? gain * delassus_[k][j] : 0.0;
        matrix_[k][k] = 1.0;
    }
    for (std::size_t k = 0; k < resistance_count_; ++k) find_rows_of(k, compliance);
}

void CoulombEquations::find_rows_of(std::size_t resistance, const Compliance& compliance) {
    const CoulombResistance& r = resistances_[resistance];
    const std::size_t i = first_[resistance];
    const Wish wish = wish_of(resistance, compliance);
    const bool cut = wish.is_cut;
    const double part = wish.part();
    const std::array unit{cut ? wish.force[0] / wish.size : 0.0, cut ? wish.force[1] / wish.size : 0.0};
    for (std::size_t d = 0; d < r.size; ++d) {
        for (std::size_t j = 0; j < unknowns_; ++j) {
            double of_wish = 0.0;  // derivative of the limited wish
            for (std::size_t e = 0; e < r.size && !r.is_moving; ++e) {
                const double own = i + e == j ? 1.0 - wish.gain * compliance.value : 0.0;
                const double turned = (d == e ? 1.0 : 0.0) - unit[d] * unit[e];
                of_wish += part * turned * (own - wish.gain * delassus_[i + e][j]);
            }
            matrix_[i + d][j] = (i + d == j ? 1.0 : 0.0) - of_wish;
        }
        if (cut && force_[r.contact] > 0.0) matrix_[i + d][r.contact] -= friction_ * r.bound * unit[d];
    }
}

/// Solves for the Newton step by Gaussian elimination with partial pivoting. Returns false if the matrix is singular.
bool CoulombEquations::eliminate() {
    for (std::size_t c = 0; c < unknowns_; ++c) {
        std::size_t pivot = c;
        for (std::size_t i = c + 1; i < unknowns_; ++i) {
            if (std::fabs(matrix_[i][c]) > std::fabs(matrix_[pivot][c])) pivot = i;
        }
        if (!(std::fabs(matrix_[pivot][c]) > 0.0)) return false;
        if (pivot != c) {
            for (std::size_t j = c; j < unknowns_; ++j) std::swap(matrix_[pivot][j], matrix_[c][j]);
            std::swap(defect_[pivot], defect_[c]);
        }
        const double inverse = 1.0 / matrix_[c][c];
        for (std::size_t i = c + 1; i < unknowns_; ++i) {
            const double factor = matrix_[i][c] * inverse;
            if (factor == 0.0) continue;
            for (std::size_t j = c + 1; j < unknowns_; ++j) matrix_[i][j] -= factor * matrix_[c][j];
            defect_[i] -= factor * defect_[c];
        }
    }
    for (std::size_t c = unknowns_; c-- > 0;) {
        double sum = defect_[c];
        for (std::size_t j = c + 1; j < unknowns_; ++j) sum -= matrix_[c][j] * defect_[j];
        defect_[c] = sum / matrix_[c][c];
    }
    return true;
}

}  // namespace ricochet
