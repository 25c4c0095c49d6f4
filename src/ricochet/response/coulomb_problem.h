/// \file
/// Solves the problem of rigid contact with Coulomb friction for one sphere or point, to rounding. Any mix of surfaces
/// may touch it at once. coulomb_equations.h defines the problem.
///
/// The problem can have several solutions, because rigid contacts can share their load differently and friction can
/// wedge a particle. The solver returns the limit of the solutions for compliant contacts as they become stiff. This
/// limit has no internal stress without a cause and is reproducible. A short search (Effort::some) accepts any solution
/// of almost rigid contacts.
///
/// Source: R. T. Rockafellar, "Monotone operators and the proximal point algorithm", SIAM J. Control and Optimization
/// 14 (1976), for the step from compliant to rigid contacts.
#pragma once

#include <cstddef>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/coulomb_equations.h"

namespace ricochet {

/// The problem and its solution. Objects are large, so do not copy them.
class CoulombProblem : CoulombEquations {
public:
    using CoulombEquations::kMostContacts;
    using CoulombEquations::kMostResistances;

    /// Effort of the search. `some` misses a solution in a few percent of all problems, and `most` in one of a
    /// thousand.
    enum class Effort { some, most, all };

    using CoulombEquations::add;
    using CoulombEquations::clear;
    using CoulombEquations::contacts;
    using CoulombEquations::sweeps;

    /// Solves the problem. Returns true if the conditions are met to kCoulombResidual times the largest rate. A
    /// solution always exists if no resistance is moving, all rates result from one motion, and some motion separates
    /// all contacts. Otherwise wedging can prevent a solution. friction: factor on all bounds, 0..1.
    bool solve(Effort effort, double friction = 1.0);

    /// Solves the problem with the largest part of the friction for which a solution is found, and returns this part. A
    /// residual of kNearlySolved is accepted, because surfaces that press against each other cause rounding. Parts
    /// below full friction are tried with an effort of at most `most`.
    double solve_with_most(Effort effort, double friction = 1.0);

    /// Returns false if the last solution meets the conditions only to kNearlySolved, or not at all.
    [[nodiscard]] bool is_solved() const { return residual_ <= kCoulombResidual; }

    // The solution.

    /// Returns the force of a contact.
    [[nodiscard]] double reaction(std::size_t contact) const { return forces()[contact]; }
    using CoulombEquations::change;
    using CoulombEquations::force_of;

private:
    /// A solved stage of the continuation from soft to stiff contacts.
    struct Reached {
        double compliance = 1.0;
        double force = 0.0;      ///< largest force
        bool is_steady = false;  ///< true: contacts yield as much as before, although they are stiffer
        [[nodiscard]] Reached next(double value, double largest) const;
    };

    [[nodiscard]] bool solve_single();
    [[nodiscard]] bool solve_at_once();
    void follow(const Reached& reached, Effort effort);
    [[nodiscard]] bool make_stiff(Reached reached, Effort effort);
    void look_elsewhere();
    void make_rigid();
    [[nodiscard]] bool runs_away(const Reached& reached, double compliance, bool is_found) const;
    [[nodiscard]] bool solve_at(const Compliance& compliance, const Unknowns& given, Effort effort);
    [[nodiscard]] bool find_other(const Compliance& compliance);
    [[nodiscard]] bool grow_friction(const Compliance& compliance);

    bool may_try_long_ = false;  // true: solve_at() may try the longer starts once
    bool runs_away_ = false;     // true if forces diverged in the last make_stiff()
    double residual_ = 0.0;      // of the last solution, relative to the largest rate
};

}  // namespace ricochet
