#include "ricochet/response/coulomb_problem.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Newton's method needs four or five steps as a rule; where it circles, more do not help.
constexpr int kNewtonSteps = 14;
constexpr int kHalvings = 4;
/// Gauss-Seidel sweeps before Newton's method is tried again, and whether they begin without forces.
struct Start {
    bool anew;
    int sweeps;
};
constexpr std::array<Start, 5> kStarts{{{false, 20}, {true, 30}, {false, 300}, {true, 1000}, {true, 6000}}};
/// Sweeps after which what a sweep changes is looked at first, then after twice as many; and by which part it may
/// differ from the change then, so that forces run away: they would not settle in ten thousand.
constexpr int kFirstLook = 32;
constexpr double kSteadyChange = 1e-3;
constexpr double kSomeStiffening = 0.2;
constexpr int kFrictionParts = 16;
constexpr int kSweepsOfPart = 100;
/// Defects of the equations on the way, where the largest rate is 1, that are small enough to go on from.
constexpr double kEnoughOnTheWay = 1e-10;
constexpr double kHopeless = 1e6;

}  // namespace

bool CoulombProblem::solve(Effort effort, double friction) {
    friction_ = friction;
    set_up();
    double scale = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) scale = std::max(scale, std::fabs(free_rate_[i]));
    residual_ = 0.0;
    if (scale == 0.0) return true;
    for (std::size_t i = 0; i < unknowns_; ++i) free_rate_[i] /= scale;
    const bool apart = is_apart();
    if (apart) solve_apart();
    const bool is_stiff = apart || make_stiff(effort);
    if (is_stiff && !apart) make_rigid();
    residual_ = find_defects({});
    if (!is_stiff || !(residual_ < kHopeless)) residual_ = kHopeless;
    cut_to_bounds();
    for (std::size_t i = 0; i < unknowns_; ++i) force_[i] *= scale;
    return residual_ <= kCoulombResidual;
}

double CoulombProblem::solve_with_most(Effort effort, double friction) {
    constexpr std::array kParts{1.0, 0.999, 0.99, 0.9, 0.5, 0.0};
    for (const double part : kParts) {
        if (solve(effort, part * friction) || residual_ <= kNearlySolved) return part;
    }
    return kParts.back();
}

std::array<double, 2> CoulombProblem::force_of(std::size_t resistance) const {
    const std::size_t i = first_[resistance];
    return {force_[i], resistances_[resistance].size == 2 ? force_[i + 1] : 0.0};
}

MotionVector CoulombProblem::change() const {
    MotionVector sum{};
    for (std::size_t i = 0; i < unknowns_; ++i) {
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += force_[i] * direction_[i][c];
    }
    return sum;
}

void CoulombProblem::set_up() {
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
}

/// True where no force changes another's rate: on one surface without resistance to rolling, say.
bool CoulombProblem::is_apart() const {
    for (std::size_t i = 0; i < unknowns_; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (std::fabs(delassus_[i][j]) > kCoulombRounding * delassus_[j][j]) return false;
        }
    }
    return true;
}

void CoulombProblem::solve_apart() {
    for (std::size_t k = 0; k < contact_count_; ++k) force_[k] = std::max(0.0, -free_rate_[k] / delassus_[k][k]);
    (void)find_defects({});
    for (std::size_t k = 0; k < resistance_count_; ++k) {
        const Wish wish = wish_of(k, {});
        const double part = wish.is_cut ? wish.most / wish.size : 1.0;
        for (std::size_t d = 0; d < resistances_[k].size; ++d) force_[first_[k] + d] = part * wish.force[d];
    }
}

/// From soft contacts, which have one answer, to stiff ones; by shorter ways where a long one loses it.
bool CoulombProblem::make_stiff(Effort effort) {
    Compliance compliance{1.0, {}};
    double reached = 1.0;
    double factor = kStiffening;
    Unknowns kept = force_;
    while (true) {
        if (solve_at(compliance, effort)) {
            if (compliance.value <= kStiffCompliance) return true;
            kept = force_;
            reached = compliance.value;
        } else {
            factor = std::sqrt(factor);
            if (factor > (effort == Effort::all ? kShortestStiffening : kSomeStiffening)) return false;
            force_ = kept;
        }
        compliance.value = std::max(kStiffCompliance, factor * reached);
    }
}

/// Contacts that have given way already, by as much as their forces make them, give way no more: proximal points. Weak
/// ones need little compliance for that, nearly redundant ones much. Each is kept while it gains a digit at a time.
void CoulombProblem::make_rigid() {
    constexpr std::array kCompliances{1e-8, 1e-10, 1e-12, 1e-14, 1e-6, 1e-4};
    double residual = find_defects({});
    for (const double compliance : kCompliances) {
        for (double before = kHopeless; residual < 0.1 * before;) {
            double enough = 1.0;
            for (std::size_t i = 0; i < unknowns_; ++i) enough = std::max(enough, std::fabs(force_[i]));
            enough *= kCoulombRounding;
            if (residual <= enough) return;
            const Unknowns kept = force_;
            (void)newton({compliance, kept}, enough);
            before = residual;
            residual = find_defects({});
            if (residual < before) continue;
            force_ = kept;
            residual = before;
        }
    }
}

/// What rounding has left beyond them.
void CoulombProblem::cut_to_bounds() {
    for (std::size_t k = 0; k < contact_count_; ++k) force_[k] = std::max(0.0, force_[k]);
    for (std::size_t k = 0; k < resistance_count_; ++k) {
        const CoulombResistance& r = resistances_[k];
        double* const force = &force_[first_[k]];
        const double most = friction_ * r.bound * force_[r.contact];
        const double size = r.size == 2 ? std::sqrt(force[0] * force[0] + force[1] * force[1]) : std::fabs(force[0]);
        for (std::size_t d = 0; d < r.size && size > most; ++d) force[d] *= most / size;
    }
}

bool CoulombProblem::solve_at(const Compliance& compliance, Effort effort) {
    const Unknowns given = force_;
    if (newton(compliance, kEnoughOnTheWay)) return true;
    for (const Start& start : std::span(kStarts).first(effort == Effort::all ? kStarts.size() : 1)) {
        force_ = start.anew ? Unknowns{} : given;
        const bool runs_away = relax(compliance, start.sweeps);
        if (newton(compliance, kEnoughOnTheWay)) return true;
        if (runs_away && start.anew) break;  // more sweeps from there lead on
    }
    return effort == Effort::all && grow_friction(compliance);
}

/// Without friction there is one answer; from there on.
bool CoulombProblem::grow_friction(const Compliance& compliance) {
    const double whole = friction_;
    force_ = {};
    for (int part = 0; part < kFrictionParts; ++part) {
        friction_ = whole * part / kFrictionParts;
        if (!newton(compliance, kEnoughOnTheWay)) static_cast<void>(relax(compliance, kSweepsOfPart));
    }
    friction_ = whole;
    return newton(compliance, kEnoughOnTheWay);
}

/// Newton's method with a step that is halved while the largest defect does not shrink.
bool CoulombProblem::newton(const Compliance& compliance, double enough) {
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
        if (!(found < kHopeless)) return false;
        defect = found;
    }
    return defect <= enough;
}

/// Gauss-Seidel: every contact and resistance in turn answers what the others do. True where forces run away, as in a
/// wedge that friction jams: each sweep adds what the ones long before it did.
bool CoulombProblem::relax(const Compliance& compliance, int sweeps) {
    MotionVector all = change();
    const auto find_rate = [&](std::size_t i) {
        rate_[i] = free_rate_[i] + dot(direction_[i], all) + compliance.value * (force_[i] - compliance.anchor[i]);
    };
    const auto set = [&](std::size_t i, double value) {
        for (std::size_t c = 0; c < all.size(); ++c) all[c] += (value - force_[i]) * direction_[i][c];
        force_[i] = value;
    };
    int look = kFirstLook;
    Unknowns before;
    double change_at_look = 0.0;
    bool runs_away = false;
    for (int sweep = 1; sweep <= sweeps; ++sweep) {
        if (sweep == look) before = force_;
        for (std::size_t k = 0; k < contact_count_; ++k) {
            find_rate(k);
            set(k, std::max(0.0, force_[k] - gain_of(k, compliance) * rate_[k]));
        }
        for (std::size_t k = 0; k < resistance_count_; ++k) {
            const CoulombResistance& r = resistances_[k];
            for (std::size_t d = 0; d < r.size; ++d) find_rate(first_[k] + d);
            const Wish wish = wish_of(k, compliance);
            const double part = wish.is_cut ? wish.most / wish.size : 1.0;
            for (std::size_t d = 0; d < r.size; ++d) set(first_[k] + d, part * wish.force[d]);
        }
        if (sweep != look) continue;
        const double now = largest_change_from(before);
        runs_away = now > kEnoughOnTheWay && std::fabs(now - change_at_look) <= kSteadyChange * now;
        change_at_look = now;
        look *= 2;
    }
    return runs_away;
}

double CoulombProblem::largest_change_from(const Unknowns& before) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) largest = std::max(largest, std::fabs(force_[i] - before[i]));
    return largest;
}

double CoulombProblem::gain_of(std::size_t contact, const Compliance& compliance) const {
    return 1.0 / (delassus_[contact][contact] + compliance.value);
}

/// The force that would take the rate away. One that is moving wants more against its heading than it may have.
CoulombProblem::Wish CoulombProblem::wish_of(std::size_t resistance, const Compliance& compliance) const {
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

/// Alart and Curnier's equations: N = max(0, N - gain rate), T = the wish, cut to the bound. The largest defect.
double CoulombProblem::find_defects(const Compliance& compliance) {
    const MotionVector all = change();
    for (std::size_t i = 0; i < unknowns_; ++i) {
        rate_[i] = free_rate_[i] + dot(direction_[i], all) + compliance.value * (force_[i] - compliance.anchor[i]);
    }
    for (std::size_t k = 0; k < contact_count_; ++k) {
        defect_[k] = force_[k] - std::max(0.0, force_[k] - gain_of(k, compliance) * rate_[k]);
    }
    for (std::size_t k = 0; k < resistance_count_; ++k) {
        const Wish wish = wish_of(k, compliance);
        const double part = wish.is_cut ? wish.most / wish.size : 1.0;
        for (std::size_t d = 0; d < resistances_[k].size; ++d) {
            defect_[first_[k] + d] = force_[first_[k] + d] - part * wish.force[d];
        }
    }
    double largest = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) largest = std::max(largest, std::fabs(defect_[i]));
    return largest;
}

/// Their derivatives by the forces.
void CoulombProblem::find_matrix(const Compliance& compliance) {
    for (std::size_t k = 0; k < contact_count_; ++k) {
        const double gain = gain_of(k, compliance);
        const bool is_closed = force_[k] > gain * rate_[k];
        for (std::size_t j = 0; j < unknowns_; ++j) matrix_[k][j] = is_closed ? gain * delassus_[k][j] : 0.0;
        matrix_[k][k] = 1.0;
    }
    for (std::size_t k = 0; k < resistance_count_; ++k) find_rows_of(k, compliance);
}

void CoulombProblem::find_rows_of(std::size_t resistance, const Compliance& compliance) {
    const CoulombResistance& r = resistances_[resistance];
    const std::size_t i = first_[resistance];
    const Wish wish = wish_of(resistance, compliance);
    const bool cut = wish.is_cut;
    const double part = cut ? wish.most / wish.size : 1.0;
    const std::array unit{cut ? wish.force[0] / wish.size : 0.0, cut ? wish.force[1] / wish.size : 0.0};
    for (std::size_t d = 0; d < r.size; ++d) {
        for (std::size_t j = 0; j < unknowns_; ++j) {
            double of_wish = 0.0;  // derivative of what the bound leaves of the wish
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

/// Gaussian elimination with partial pivoting.
bool CoulombProblem::eliminate() {
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
