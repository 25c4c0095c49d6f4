#include "ricochet/response/coulomb_problem.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace ricochet {
namespace {

/// Number of Gauss-Seidel sweeps before Newton's method is tried again. anew: true if the sweeps start from zero
/// forces. Local: only starting points of a search.
struct Start {
    bool anew;
    int sweeps;
};
constexpr std::array<Start, 5> kStarts{{{false, 20}, {true, 30}, {false, 300}, {true, 1000}, {true, 6000}}};
/// Number of short starts. Longer starts begin with zero forces, so a failure at one compliance repeats at the next.
/// They are tried only once per problem, with its full friction. Local: the result is checked.
constexpr std::size_t kShortStarts = 3;
/// Compliances at which another solution with full friction is searched for if forces diverge. The second array
/// contains the numbers of sweeps from zero forces at each. One in a hundred of 1200 random problems with diverging
/// forces has such a solution. Local: only starting points of a search.
constexpr std::array kOthersAt{kStiffCompliance, 1e-8, 1e-6};
constexpr std::array kSweepsToOther{30, 300};
/// First and last compliance of a short search, and number of sweeps before its second attempt. Reason: this search
/// solves all but one of 1600 problems of a ball that rolls over concave edges. Continuation from soft contacts solves
/// only half of them. One in eighty of the random problems that both solve has several solutions, and the searches find
/// different ones. Local: the result is checked.
constexpr std::array kStiffAtOnce{1e-6, kStiffCompliance};
constexpr int kSweepsAtOnce = 3;
/// Largest factor between successive compliances in a short search, number of parts in which friction is increased, and
/// sweeps for each part. Local, because kCoulombResidual decides when the problem is solved.
constexpr double kSomeStiffening = 0.2;
constexpr int kFrictionParts = 16;
constexpr int kSweepsOfPart = 100;

}  // namespace

bool CoulombProblem::solve(Effort effort, double friction) {
    residual_ = 0.0;
    const double scale = set_up(friction);
    if (scale == 0.0) return true;
    if (are_independent()) {
        residual_ = solve_independent();
    } else if (!(contacts() > 1 ? effort == Effort::some && solve_at_once() : solve_single())) {
        follow({}, effort);
        if (effort == Effort::all && runs_away_ && !(residual_ <= kNearlySolved)) look_elsewhere();
    }
    cut_to_bounds(scale);
    return residual_ <= kCoulombResidual;
}

double CoulombProblem::solve_with_most(Effort effort, double friction) {
    for (const double part : kTriedFriction) {
        if (solve(effort, part * friction) || residual_ <= kNearlySolved) return part;
        effort = std::min(effort, Effort::most);
    }
    return kTriedFriction.back();
}

/// Solves a single contact as a rigid one, without continuation from soft contacts. A single contact shares its load
/// with no other, and friction cannot wedge it. Returns false if Newton's method finds no solution from zero forces.
bool CoulombProblem::solve_single() {
    if (newton({}, kCoulombStage)) {
        make_rigid();
        residual_ = find_defects({});
        if (residual_ <= kCoulombResidual) return true;
    }
    set_forces({});
    return false;
}

/// Solves almost rigid contacts without continuation from soft contacts. The first compliance is large enough to leave
/// no internal stress. Returns false if no solution is found.
bool CoulombProblem::solve_at_once() {
    const auto solve_stiff = [&](double compliance) { return newton({compliance, {}}, kCoulombStage); };
    bool is_found = solve_stiff(kStiffAtOnce.front());
    if (!is_found) {
        set_forces({});
        static_cast<void>(relax({kStiffAtOnce.front(), {}}, kSweepsAtOnce));
        is_found = solve_stiff(kStiffAtOnce.front());
    }
    if (is_found && solve_stiff(kStiffAtOnce.back())) {
        make_rigid();
        residual_ = find_defects({});
        if (residual_ <= kCoulombResidual) return true;
    }
    set_forces({});
    return false;
}

/// Makes contacts rigid, starting from a stage that is already solved.
void CoulombProblem::follow(const Reached& reached, Effort effort) {
    const bool is_stiff = make_stiff(reached, effort);
    if (is_stiff) make_rigid();
    residual_ = find_defects({});
    if (!is_stiff || !(residual_ < kHopelessResidual)) residual_ = kHopelessResidual;
}

/// Follows the solution from soft contacts, for which it is unique, to stiff contacts (numerical continuation). If a
/// long step loses the solution, tries shorter steps. Returns false if they lose it, too.
bool CoulombProblem::make_stiff(Reached reached, Effort effort) {
    may_try_long_ = effort == Effort::all;
    runs_away_ = false;
    double factor = kStiffening;
    Unknowns kept = forces();
    Compliance compliance{reached.force > 0.0 ? factor * reached.compliance : 1.0, {}};
    while (true) {
        compliance.value = std::max(kStiffCompliance, compliance.value);
        bool is_found = newton(compliance, kCoulombStage);
        runs_away_ = runs_away(reached, compliance.value, is_found);
        if (runs_away_ && !is_found) return false;
        if (is_found || solve_at(compliance, kept, effort)) {
            if (compliance.value <= kStiffCompliance) return true;
            kept = forces();
            reached = reached.next(compliance.value, largest_force());
        } else {
            factor = std::sqrt(factor);
            if (factor > (effort == Effort::some ? kSomeStiffening : kShortestStiffening)) return false;
            set_forces(kept);
        }
        compliance.value = factor * reached.compliance;
    }
}

/// Searches for a solution whose forces do not diverge. Used if forces diverge in the continuation from soft contacts.
void CoulombProblem::look_elsewhere() {
    const Unknowns kept = forces();
    const double residual = residual_;
    for (const double compliance : kOthersAt) {
        if (!find_other({compliance, {}})) continue;
        follow({compliance, largest_force(), false}, Effort::most);
        if (residual_ <= kCoulombResidual) return;
    }
    set_forces(kept);
    residual_ = residual;
}

CoulombProblem::Reached CoulombProblem::Reached::next(double value, double largest) const {
    return {value, largest, value * largest >= kDivergingRatio * compliance * force};
}

/// Returns true if forces diverge as contacts become stiffer: they yield as much as before, so there is no rigid limit.
/// is_found: the solution at `compliance` is known; otherwise earlier growth decides.
bool CoulombProblem::runs_away(const Reached& reached, double compliance, bool is_found) const {
    const double giving = reached.compliance * reached.force;
    if (!is_found) return reached.is_steady && giving > kLostForce * compliance;
    const double force = largest_force();
    return force > kRunawayForce && force * compliance >= kDivergingRatio * giving;
}

/// Makes stiff contacts rigid by proximal point iterations. Each iteration moves the compliance's anchor to the current
/// forces, so that contacts yield only by the change of their forces. Weak contacts need a small compliance, nearly
/// redundant ones a large one. Each is used while it helps tenfold.
void CoulombProblem::make_rigid() {
    // Local, because find_defects() decides whether the search has succeeded.
    constexpr std::array kCompliances{1e-8, 1e-10, 1e-12, 1e-14, 1e-6, 1e-4};
    double residual = find_defects({});
    for (const double compliance : kCompliances) {
        for (double before = kHopelessResidual; residual < 0.1 * before;) {
            const double enough = kCoulombRounding * std::max(1.0, largest_force());
            if (residual <= enough) return;
            const Unknowns kept = forces();
            (void)newton({compliance, kept}, enough);
            before = residual;
            residual = find_defects({});
            if (residual < before) continue;
            set_forces(kept);
            residual = before;
        }
    }
}

/// Searches for a solution from other starting points, after Newton's method has failed from the given forces.
bool CoulombProblem::solve_at(const Compliance& compliance, const Unknowns& given, Effort effort) {
    const std::size_t most = std::exchange(may_try_long_, false) ? kStarts.size() : kShortStarts;
    const std::size_t starts = effort == Effort::some ? 1 : most;
    for (const Start& start : std::span(kStarts).first(starts)) {
        set_forces(start.anew ? Unknowns{} : given);
        const bool diverges = relax(compliance, start.sweeps);
        if (newton(compliance, kCoulombStage)) return true;
        if (diverges && start.anew) break;  // more sweeps from there diverge further
    }
    return effort != Effort::some && grow_friction(compliance);
}

/// Searches for another solution, starting from zero forces.
bool CoulombProblem::find_other(const Compliance& compliance) {
    const auto is_other = [&](bool is_found) { return is_found && largest_force() <= kRunawayForce; };
    for (const int sweeps : kSweepsToOther) {
        set_forces({});
        static_cast<void>(relax(compliance, sweeps));
        if (is_other(newton(compliance, kCoulombStage))) return true;
    }
    return is_other(grow_friction(compliance));
}

/// Starts without friction, for which the solution is unique, and increases friction in parts.
bool CoulombProblem::grow_friction(const Compliance& compliance) {
    const double whole = friction();
    set_forces({});
    for (int part = 0; part < kFrictionParts; ++part) {
        set_friction(whole * part / kFrictionParts);
        if (!newton(compliance, kCoulombStage)) {
            static_cast<void>(relax(compliance, kSweepsOfPart));
        }
    }
    set_friction(whole);
    return newton(compliance, kCoulombStage);
}

}  // namespace ricochet
