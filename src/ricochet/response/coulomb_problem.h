/// \file
/// Private to the responses: the small problem of rigid contact with Coulomb friction, for any mix of surfaces that
/// hold one sphere or point at once, solved to rounding.
///
/// What moves has six coordinates: the velocity v and the turning sqrt(2/5) r omega of a solid sphere, so that all have
/// the same inertia. A contact pushes along one direction of that space with a force N >= 0; what resists there
/// (sliding, rolling, spinning) pushes along one or two more with a force of at most `bound` N. The answers may be
/// forces, which change accelerations, or impulses, which change velocities: the problem is the same.
///
/// Rigid contacts share their load in more than one way, and what is held by friction may be held by wedging. The
/// answer is the one to which compliant contacts tend as they become stiff: without stress that nothing asks for, and
/// the same every time.
///
/// Sources: D. E. Stewart, "Rigid-body dynamics with friction and impact", SIAM Review 42 (2000), for the problem;
/// P. Alart, A. Curnier, "A mixed formulation for frictional contact problems prone to Newton like solution methods",
/// Computer Methods in Applied Mechanics and Engineering 92 (1991), for its equations and Newton's method on them;
/// R. T. Rockafellar, "Monotone operators and the proximal point algorithm", SIAM J. Control and Optimization 14
/// (1976), for the way from compliant to rigid contacts; J. J. Moreau, "Unilateral contact and dry friction in finite
/// freedom dynamics", CISM 302 (1988), for Gauss-Seidel sweeps over contacts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ricochet/core/tolerances.h"

namespace ricochet {

/// A direction in the space of motions: three components of the velocity and three of sqrt(2/5) r omega.
using MotionVector = std::array<double, 6>;

/// The sum of the products of the coordinates.
[[nodiscard]] inline double dot(const MotionVector& a, const MotionVector& b) {
    double sum = 0.0;
    for (std::size_t c = 0; c < a.size(); ++c) sum += a[c] * b[c];
    return sum;
}

/// One contact: 0 <= N, 0 <= rate, N rate = 0.
struct CoulombContact {
    MotionVector direction{};  ///< the surface's normal
    double rate = 0.0;         ///< along it, of the motion that there would be without forces
};

/// What resists at a contact: |T| <= bound N, against the rate where there is one.
struct CoulombResistance {
    std::uint32_t contact = 0;  ///< its number, in the order in which contacts were added
    std::uint32_t size = 2;     ///< 1 or 2 directions
    double bound = 0.0;         ///< >= 0: a coefficient of friction, or a length over the radius
    std::array<MotionVector, 2> direction{};
    std::array<double, 2> rate{};     ///< along them, of the motion that there would be without forces
    bool is_moving = false;           ///< it resists along `heading`, whatever the rates
    std::array<double, 2> heading{};  ///< unit; used where it is moving
};

/// The problem, and its answer. Large: keep it where it is.
class CoulombProblem {
public:
    static constexpr std::size_t kMostContacts = 8;
    static constexpr std::size_t kMostResistances = 3 * kMostContacts;

    /// How long an answer is looked for: `some` finds all but a few in a hundred of those that there are, `most` all
    /// but one in a thousand.
    enum class Effort { some, most, all };

    /// Forgets all contacts and resistances.
    void clear() { contact_count_ = resistance_count_ = sweeps_ = 0; }
    /// At most kMostContacts.
    void add(const CoulombContact& contact) { contacts_[contact_count_++] = contact; }
    /// At most kMostResistances, of contacts that were added.
    void add(const CoulombResistance& resistance) { resistances_[resistance_count_++] = resistance; }
    [[nodiscard]] std::size_t contacts() const { return contact_count_; }

    /// True when the conditions are met to kCoulombResidual of the largest rate. There is always an answer where
    /// nothing is moving, the rates are those of one motion, and another motion leaves all contacts; elsewhere wedging
    /// can leave none. friction: a factor on all bounds, 0..1.
    bool solve(Effort effort, double friction = 1.0);

    /// Solves with as much of the friction as there is an answer for: all of it, also where rounding leaves the
    /// conditions met to kNearlySolved only, as between surfaces that press against each other; else less, down to
    /// none; the parts with `most` at most. Returns the part of the friction that it was solved with.
    double solve_with_most(Effort effort, double friction = 1.0);

    /// False where the last answer meets the conditions to kNearlySolved only, or not at all.
    [[nodiscard]] bool is_solved() const { return residual_ <= kCoulombResidual; }

    /// Sweeps over the contacts since clear(): what an answer has cost, or finding that there is none.
    [[nodiscard]] std::size_t sweeps() const { return sweeps_; }

    /// Force of a contact.
    [[nodiscard]] double reaction(std::size_t contact) const { return force_[contact]; }
    /// Force of a resistance along its directions.
    [[nodiscard]] std::array<double, 2> force_of(std::size_t resistance) const;
    /// What all forces together change the motion by.
    [[nodiscard]] MotionVector change() const;

private:
    static constexpr std::size_t kMostUnknowns = kMostContacts + 2 * kMostResistances;
    using Unknowns = std::array<double, kMostUnknowns>;

    /// Contacts that give way by compliance times (force - anchor).
    struct Compliance {
        double value = 0.0;
        Unknowns anchor{};
    };
    /// A resistance as it would be without its bound, and what the bound makes of it.
    struct Wish {
        std::array<double, 2> force{};
        double size = 0.0;
        double most = 0.0;
        double gain = 0.0;
        bool is_cut = false;  ///< to `most`
    };

    /// How far the way to stiff contacts has come.
    struct Reached {
        double compliance = 1.0;
        double force = 0.0;      ///< the largest
        bool is_steady = false;  ///< contacts gave way by as much as before, though stiffer
        [[nodiscard]] Reached next(double value, double largest) const;
    };

    void set_up();
    [[nodiscard]] bool is_apart() const;
    void solve_apart();
    [[nodiscard]] bool solve_single();
    void follow(const Reached& reached, Effort effort);
    [[nodiscard]] bool make_stiff(Reached reached, Effort effort);
    void look_elsewhere();
    void make_rigid();
    void cut_to_bounds();
    [[nodiscard]] bool runs_away(const Reached& reached, double compliance, bool is_found) const;
    [[nodiscard]] bool solve_at(const Compliance& compliance, const Unknowns& given, Effort effort);
    [[nodiscard]] bool find_other(const Compliance& compliance);
    [[nodiscard]] bool grow_friction(const Compliance& compliance);
    [[nodiscard]] bool newton(const Compliance& compliance, double enough);
    [[nodiscard]] bool relax(const Compliance& compliance, int sweeps);
    [[nodiscard]] double largest_force() const;
    [[nodiscard]] double largest_change_from(const Unknowns& before) const;
    double find_defects(const Compliance& compliance);
    void find_matrix(const Compliance& compliance);
    void find_rows_of(std::size_t resistance, const Compliance& compliance);
    bool eliminate();
    [[nodiscard]] double gain_of(std::size_t contact, const Compliance& compliance) const;
    [[nodiscard]] Wish wish_of(std::size_t resistance, const Compliance& compliance) const;

    std::array<CoulombContact, kMostContacts> contacts_;
    std::array<CoulombResistance, kMostResistances> resistances_;
    std::size_t contact_count_ = 0;
    std::size_t resistance_count_ = 0;
    std::size_t sweeps_ = 0;
    double friction_ = 1.0;
    bool may_try_long_ = false;  // of this answer
    bool runs_away_ = false;     // on the last way to stiff contacts
    double residual_ = 0.0;      // of the last answer, as a part of the largest rate

    // The unknown forces: of the contacts, then of the resistances.
    std::size_t unknowns_ = 0;
    std::array<std::size_t, kMostResistances> first_;  // unknown of a resistance
    std::array<MotionVector, kMostUnknowns> direction_;
    std::array<Unknowns, kMostUnknowns> delassus_;  // products of the directions
    Unknowns free_rate_;                            // the largest is 1
    Unknowns force_;
    Unknowns rate_;
    Unknowns defect_;  // of the equations; after eliminate() the step that would remove it
    std::array<Unknowns, kMostUnknowns> matrix_;
};

}  // namespace ricochet
