#include "ricochet/response/coulomb_problem.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Most steps of Newton's method, and halvings of a step. Four or five steps suffice as a rule, and more do not help an
/// iteration that circles. Local: a limit of this search, whose result is checked.
constexpr int kNewtonSteps = 14;
constexpr int kHalvings = 4;
/// Gauss-Seidel sweeps before Newton's method is tried again, and whether they begin without forces. Local: starts of
/// this search.
struct Start {
    bool anew;
    int sweeps;
};
constexpr std::array<Start, 5> kStarts{{{false, 20}, {true, 30}, {false, 300}, {true, 1000}, {true, 6000}}};
/// Number of short starts. The long ones begin without forces, and a failure at one compliance repeats at the next.
/// They are tried once for a problem, with its full friction. Local: a limit of this search, whose result is checked.
constexpr std::size_t kShortStarts = 3;
/// Compliances, and sweeps without initial forces at each, at which another solution with full friction is searched for
/// if forces diverge. One in a hundred of 1200 random problems with diverging forces has one. Local: starts of this
/// search.
constexpr std::array kOthersAt{kStiffCompliance, 1e-8, 1e-6};
constexpr std::array kSweepsToOther{30, 300};
/// Local: sweeps before the first comparison of changes, see kSteadyChange; the fastest stiffening of a short search;
/// parts of the friction, and sweeps for each. kCoulombResidual decides when the problem is solved.
constexpr int kFirstLook = 32;
constexpr double kSomeStiffening = 0.2;
constexpr int kFrictionParts = 16;
constexpr int kSweepsOfPart = 100;

}  // namespace

bool CoulombProblem::solve(Effort effort, double friction) {
    friction_ = friction;
    set_up();
    double scale = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) scale = std::max(scale, std::fabs(free_rate_[i]));
    residual_ = 0.0;
    if (scale == 0.0) return true;
    for (std::size_t i = 0; i < unknowns_; ++i) free_rate_[i] /= scale;
    if (is_apart()) {
        solve_apart();
        residual_ = find_defects({});
    } else if (contact_count_ > 1 || !solve_single()) {
        follow({}, effort);
        if (effort == Effort::all && runs_away_ && !(residual_ <= kNearlySolved)) look_elsewhere();
    }
    cut_to_bounds();
    for (std::size_t i = 0; i < unknowns_; ++i) force_[i] *= scale;
    return residual_ <= kCoulombResidual;
}

double CoulombProblem::solve_with_most(Effort effort, double friction) {
    for (const double part : kTriedFriction) {
        if (solve(effort, part * friction) || residual_ <= kNearlySolved) return part;
        effort = std::min(effort, Effort::most);
    }
    return kTriedFriction.back();
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

/// A single contact shares its load with none, and friction cannot wedge it: it is solved as a rigid one at once. False
/// where Newton's method does not find the answer from none.
bool CoulombProblem::solve_single() {
    if (newton({}, kCoulombStage)) {
        make_rigid();
        residual_ = find_defects({});
        if (residual_ <= kCoulombResidual) return true;
    }
    force_ = {};
    return false;
}

/// From where the way has come to, to the end.
void CoulombProblem::follow(const Reached& reached, Effort effort) {
    const bool is_stiff = make_stiff(reached, effort);
    if (is_stiff) make_rigid();
    residual_ = find_defects({});
    if (!is_stiff || !(residual_ < kHopelessResidual)) residual_ = kHopelessResidual;
}

/// From soft contacts, which have one answer, to stiff ones; by shorter ways where a long one loses it.
bool CoulombProblem::make_stiff(Reached reached, Effort effort) {
    may_try_long_ = effort == Effort::all;
    runs_away_ = false;
    double factor = kStiffening;
    Unknowns kept = force_;
    Compliance compliance{reached.force > 0.0 ? factor * reached.compliance : 1.0, {}};
    while (true) {
        compliance.value = std::max(kStiffCompliance, compliance.value);
        bool is_found = newton(compliance, kCoulombStage);
        runs_away_ = runs_away(reached, compliance.value, is_found);
        if (runs_away_ && !is_found) return false;
        if (is_found || solve_at(compliance, kept, effort)) {
            if (compliance.value <= kStiffCompliance) return true;
            kept = force_;
            reached = reached.next(compliance.value, largest_force());
        } else {
            factor = std::sqrt(factor);
            if (factor > (effort == Effort::some ? kSomeStiffening : kShortestStiffening)) return false;
            force_ = kept;
        }
        compliance.value = factor * reached.compliance;
    }
}

/// For an answer whose forces do not run away, where those do that have been come to from soft contacts.
void CoulombProblem::look_elsewhere() {
    const Unknowns kept = force_;
    const double residual = residual_;
    for (const double compliance : kOthersAt) {
        if (!find_other({compliance, {}})) continue;
        follow({compliance, largest_force(), false}, Effort::most);
        if (residual_ <= kCoulombResidual) return;
    }
    force_ = kept;
    residual_ = residual;
}

CoulombProblem::Reached CoulombProblem::Reached::next(double value, double largest) const {
    return {value, largest, value * largest >= kSteadyGiving * compliance * force};
}

/// True where forces grow as contacts become stiff, so that these give way by as much as before: no rigid ones have
/// such an answer. is_found: that at the compliance is; else it is said by how forces have grown before.
bool CoulombProblem::runs_away(const Reached& reached, double compliance, bool is_found) const {
    const double giving = reached.compliance * reached.force;
    if (!is_found) return reached.is_steady && giving > kLostForce * compliance;
    const double force = largest_force();
    return force > kRunawayForce && force * compliance >= kSteadyGiving * giving;
}

/// Contacts that have given way already, by as much as their forces make them, give way no more: proximal points. Weak
/// ones need little compliance for that, nearly redundant ones much. Each is kept while it gains a digit at a time.
void CoulombProblem::make_rigid() {
    // Local: steps of this search. find_defects() decides.
    constexpr std::array kCompliances{1e-8, 1e-10, 1e-12, 1e-14, 1e-6, 1e-4};
    double residual = find_defects({});
    for (const double compliance : kCompliances) {
        for (double before = kHopelessResidual; residual < 0.1 * before;) {
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

/// What Newton's method has not found from the forces given.
bool CoulombProblem::solve_at(const Compliance& compliance, const Unknowns& given, Effort effort) {
    const std::size_t most = std::exchange(may_try_long_, false) ? kStarts.size() : kShortStarts;
    const std::size_t starts = effort == Effort::some ? 1 : most;
    for (const Start& start : std::span(kStarts).first(starts)) {
        force_ = start.anew ? Unknowns{} : given;
        const bool diverges = relax(compliance, start.sweeps);
        if (newton(compliance, kCoulombStage)) return true;
        if (diverges && start.anew) break;  // more sweeps from there lead on
    }
    return effort != Effort::some && grow_friction(compliance);
}

/// Begins without forces.
bool CoulombProblem::find_other(const Compliance& compliance) {
    const auto is_other = [&](bool is_found) { return is_found && largest_force() <= kRunawayForce; };
    for (const int sweeps : kSweepsToOther) {
        force_ = {};
        static_cast<void>(relax(compliance, sweeps));
        if (is_other(newton(compliance, kCoulombStage))) return true;
    }
    return is_other(grow_friction(compliance));
}

/// Without friction there is one answer; from there on.
bool CoulombProblem::grow_friction(const Compliance& compliance) {
    const double whole = friction_;
    force_ = {};
    for (int part = 0; part < kFrictionParts; ++part) {
        friction_ = whole * part / kFrictionParts;
        if (!newton(compliance, kCoulombStage)) static_cast<void>(relax(compliance, kSweepsOfPart));
    }
    friction_ = whole;
    return newton(compliance, kCoulombStage);
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
        if (!(found < kHopelessResidual)) return false;
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
    sweeps_ += static_cast<std::size_t>(sweeps);
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
        runs_away = now > kCoulombStage && std::fabs(now - change_at_look) <= kSteadyChange * now;
        change_at_look = now;
        look *= 2;
    }
    return runs_away;
}

double CoulombProblem::largest_force() const {
    double largest = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) largest = std::max(largest, std::fabs(force_[i]));
    return largest;
}

double CoulombProblem::largest_change_from(const Unknowns& before) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < unknowns_; ++i) largest = std::max(largest, std::fabs(force_[i] - before[i]));
    return largest;
}

}  // namespace ricochet
