#include "ricochet/response/coulomb_problem.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

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
/// Compliances at which a short search begins, and sweeps before its second attempt. Reason: this solves all but one of
/// 1600 problems of a ball that rolls over concave edges, and the way from soft contacts solves half. One in eighty of
/// the random problems that both solve has several answers and gets another one. Local: starts of this search, whose
/// result is checked.
constexpr std::array kStiffAtOnce{1e-6, kStiffCompliance};
constexpr int kSweepsAtOnce = 3;
/// Local: the fastest stiffening of a short search; parts of the friction, and sweeps for each. kCoulombResidual
/// decides when the problem is solved.
constexpr double kSomeStiffening = 0.2;
constexpr int kFrictionParts = 16;
constexpr int kSweepsOfPart = 100;

}  // namespace

bool CoulombProblem::solve(Effort effort, double friction) {
    residual_ = 0.0;
    const double scale = equations_.set_up(friction);
    if (scale == 0.0) return true;
    if (equations_.are_independent()) {
        residual_ = equations_.solve_independent();
    } else if (!(contacts() > 1 ? effort == Effort::some && solve_at_once() : solve_single())) {
        follow({}, effort);
        if (effort == Effort::all && runs_away_ && !(residual_ <= kNearlySolved)) look_elsewhere();
    }
    equations_.cut_to_bounds(scale);
    return residual_ <= kCoulombResidual;
}

double CoulombProblem::solve_with_most(Effort effort, double friction) {
    for (const double part : kTriedFriction) {
        if (solve(effort, part * friction) || residual_ <= kNearlySolved) return part;
        effort = std::min(effort, Effort::most);
    }
    return kTriedFriction.back();
}

/// Solves a single contact as a rigid one at once: it shares its load with none, and friction cannot wedge it. Returns
/// false if Newton's method does not find the answer without initial forces.
bool CoulombProblem::solve_single() {
    if (equations_.newton({}, kCoulombStage)) {
        make_rigid();
        residual_ = equations_.find_defects({});
        if (residual_ <= kCoulombResidual) return true;
    }
    equations_.set_forces({});
    return false;
}

/// Solves almost rigid contacts without the way from soft ones. The first compliance leaves no internal stress. Returns
/// false if that finds no answer.
bool CoulombProblem::solve_at_once() {
    const auto solve_stiff = [&](double compliance) { return equations_.newton({compliance, {}}, kCoulombStage); };
    bool is_found = solve_stiff(kStiffAtOnce.front());
    if (!is_found) {
        equations_.set_forces({});
        static_cast<void>(equations_.relax({kStiffAtOnce.front(), {}}, kSweepsAtOnce));
        is_found = solve_stiff(kStiffAtOnce.front());
    }
    if (is_found && solve_stiff(kStiffAtOnce.back())) {
        make_rigid();
        residual_ = equations_.find_defects({});
        if (residual_ <= kCoulombResidual) return true;
    }
    equations_.set_forces({});
    return false;
}

/// Makes contacts rigid, beginning at a stage that has been reached.
void CoulombProblem::follow(const Reached& reached, Effort effort) {
    const bool is_stiff = make_stiff(reached, effort);
    if (is_stiff) make_rigid();
    residual_ = equations_.find_defects({});
    if (!is_stiff || !(residual_ < kHopelessResidual)) residual_ = kHopelessResidual;
}

/// Follows the answer from soft contacts, for which it is unique, to stiff ones. If a long step loses it, tries shorter
/// ones.
bool CoulombProblem::make_stiff(Reached reached, Effort effort) {
    may_try_long_ = effort == Effort::all;
    runs_away_ = false;
    double factor = kStiffening;
    Unknowns kept = equations_.forces();
    Compliance compliance{reached.force > 0.0 ? factor * reached.compliance : 1.0, {}};
    while (true) {
        compliance.value = std::max(kStiffCompliance, compliance.value);
        bool is_found = equations_.newton(compliance, kCoulombStage);
        runs_away_ = runs_away(reached, compliance.value, is_found);
        if (runs_away_ && !is_found) return false;
        if (is_found || solve_at(compliance, kept, effort)) {
            if (compliance.value <= kStiffCompliance) return true;
            kept = equations_.forces();
            reached = reached.next(compliance.value, equations_.largest_force());
        } else {
            factor = std::sqrt(factor);
            if (factor > (effort == Effort::some ? kSomeStiffening : kShortestStiffening)) return false;
            equations_.set_forces(kept);
        }
        compliance.value = factor * reached.compliance;
    }
}

/// Searches for an answer whose forces do not diverge, if those on the way from soft contacts do.
void CoulombProblem::look_elsewhere() {
    const Unknowns kept = equations_.forces();
    const double residual = residual_;
    for (const double compliance : kOthersAt) {
        if (!find_other({compliance, {}})) continue;
        follow({compliance, equations_.largest_force(), false}, Effort::most);
        if (residual_ <= kCoulombResidual) return;
    }
    equations_.set_forces(kept);
    residual_ = residual;
}

CoulombProblem::Reached CoulombProblem::Reached::next(double value, double largest) const {
    return {value, largest, value * largest >= kSteadyGiving * compliance * force};
}

/// Returns true if forces grow as contacts become stiff, so that contacts yield by as much as before. Rigid contacts
/// then have no such answer. is_found: the answer at the compliance is known; else earlier growth decides.
bool CoulombProblem::runs_away(const Reached& reached, double compliance, bool is_found) const {
    const double giving = reached.compliance * reached.force;
    if (!is_found) return reached.is_steady && giving > kLostForce * compliance;
    const double force = equations_.largest_force();
    return force > kRunawayForce && force * compliance >= kSteadyGiving * giving;
}

/// Makes stiff contacts rigid by proximal points: contacts that have yielded by as much as their forces demand yield no
/// more. Weak contacts need little compliance for that, nearly redundant ones much. Each compliance is used while it
/// gains a digit at a time.
void CoulombProblem::make_rigid() {
    // Local: steps of this search. find_defects() decides.
    constexpr std::array kCompliances{1e-8, 1e-10, 1e-12, 1e-14, 1e-6, 1e-4};
    double residual = equations_.find_defects({});
    for (const double compliance : kCompliances) {
        for (double before = kHopelessResidual; residual < 0.1 * before;) {
            const double enough = kCoulombRounding * std::max(1.0, equations_.largest_force());
            if (residual <= enough) return;
            const Unknowns kept = equations_.forces();
            (void)equations_.newton({compliance, kept}, enough);
            before = residual;
            residual = equations_.find_defects({});
            if (residual < before) continue;
            equations_.set_forces(kept);
            residual = before;
        }
    }
}

/// Searches for an answer that Newton's method has not found from the given forces.
bool CoulombProblem::solve_at(const Compliance& compliance, const Unknowns& given, Effort effort) {
    const std::size_t most = std::exchange(may_try_long_, false) ? kStarts.size() : kShortStarts;
    const std::size_t starts = effort == Effort::some ? 1 : most;
    for (const Start& start : std::span(kStarts).first(starts)) {
        equations_.set_forces(start.anew ? Unknowns{} : given);
        const bool diverges = equations_.relax(compliance, start.sweeps);
        if (equations_.newton(compliance, kCoulombStage)) return true;
        if (diverges && start.anew) break;  // more sweeps from there diverge further
    }
    return effort != Effort::some && grow_friction(compliance);
}

/// Searches for another answer, without initial forces.
bool CoulombProblem::find_other(const Compliance& compliance) {
    const auto is_other = [&](bool is_found) { return is_found && equations_.largest_force() <= kRunawayForce; };
    for (const int sweeps : kSweepsToOther) {
        equations_.set_forces({});
        static_cast<void>(equations_.relax(compliance, sweeps));
        if (is_other(equations_.newton(compliance, kCoulombStage))) return true;
    }
    return is_other(grow_friction(compliance));
}

/// Begins without friction, for which the answer is unique, and adds friction in parts.
bool CoulombProblem::grow_friction(const Compliance& compliance) {
    const double whole = equations_.friction();
    equations_.set_forces({});
    for (int part = 0; part < kFrictionParts; ++part) {
        equations_.set_friction(whole * part / kFrictionParts);
        if (!equations_.newton(compliance, kCoulombStage)) {
            static_cast<void>(equations_.relax(compliance, kSweepsOfPart));
        }
    }
    equations_.set_friction(whole);
    return equations_.newton(compliance, kCoulombStage);
}

}  // namespace ricochet
