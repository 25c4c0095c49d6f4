/// \file
/// Private to the responses: the small problem of rigid contact with Coulomb friction, for any mix of surfaces that
/// touch one sphere or point at once, solved to rounding. coulomb_equations.h defines it.
///
/// Rigid contacts can share their load in more than one way, and friction can hold a particle by wedging. The answer is
/// the limit of the answers of compliant contacts as they become stiff. It has no internal stress without a cause, and
/// it is the same every time. A short search (Effort::some) takes any answer of almost rigid contacts.
///
/// Source: R. T. Rockafellar, "Monotone operators and the proximal point algorithm", SIAM J. Control and Optimization
/// 14 (1976), for the way from compliant to rigid contacts.
#pragma once

#include <array>
#include <cstddef>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/coulomb_equations.h"

namespace ricochet {

/// The problem, and its answer. Large: keep it where it is.
class CoulombProblem {
public:
    static constexpr std::size_t kMostContacts = CoulombEquations::kMostContacts;
    static constexpr std::size_t kMostResistances = CoulombEquations::kMostResistances;

    /// How long an answer is searched for: `some` finds all but a few in a hundred of the answers that exist, `most`
    /// all but one in a thousand.
    enum class Effort { some, most, all };

    /// Removes all contacts and resistances.
    void clear() { equations_.clear(); }
    /// At most kMostContacts.
    void add(const CoulombContact& contact) { equations_.add(contact); }
    /// At most kMostResistances, of contacts that have been added.
    void add(const CoulombResistance& resistance) { equations_.add(resistance); }
    [[nodiscard]] std::size_t contacts() const { return equations_.contacts(); }

    /// Returns true if the conditions are met to kCoulombResidual of the largest rate. An answer always exists if
    /// nothing is moving, the rates belong to one motion, and another motion leaves all contacts. Otherwise wedging can
    /// prevent one. friction: a factor on all bounds, 0..1.
    bool solve(Effort effort, double friction = 1.0);

    /// Solves with as much of the friction as has an answer. All of it also counts if rounding leaves the conditions
    /// met only to kNearlySolved, as between surfaces that press against each other. Otherwise less friction is tried,
    /// down to none, with the effort `most` at most. Returns the part of the friction.
    double solve_with_most(Effort effort, double friction = 1.0);

    /// Returns false if the last answer meets the conditions only to kNearlySolved, or not at all.
    [[nodiscard]] bool is_solved() const { return residual_ <= kCoulombResidual; }

    /// Number of sweeps over the contacts since clear(): the cost of an answer, or of finding that there is none.
    [[nodiscard]] std::size_t sweeps() const { return equations_.sweeps(); }

    /// Returns the force of a contact.
    [[nodiscard]] double reaction(std::size_t contact) const { return equations_.forces()[contact]; }
    /// Returns the forces of a resistance along its directions.
    [[nodiscard]] std::array<double, 2> force_of(std::size_t resistance) const {
        return equations_.force_of(resistance);
    }
    /// Returns the change of the motion by all forces together.
    [[nodiscard]] MotionVector change() const { return equations_.change(); }

private:
    using Unknowns = CoulombEquations::Unknowns;
    using Compliance = CoulombEquations::Compliance;

    /// A stage on the way to stiff contacts.
    struct Reached {
        double compliance = 1.0;
        double force = 0.0;      ///< the largest
        bool is_steady = false;  ///< contacts yield by as much as before, though they are stiffer
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

    CoulombEquations equations_;
    bool may_try_long_ = false;  // for this answer
    bool runs_away_ = false;     // on the last way to stiff contacts
    double residual_ = 0.0;      // of the last answer, as a part of the largest rate
};

}  // namespace ricochet
