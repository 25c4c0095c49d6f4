/// \file
/// The equations of rigid contact with Coulomb friction for one sphere or point, and Newton's method and Gauss-Seidel
/// sweeps on them.
///
/// A motion has six coordinates: the velocity v and the turning sqrt(2/5) r omega of a solid sphere, so that all have
/// the same inertia. A contact has a force N >= 0 along one direction of that space. Its resistances (to sliding,
/// rolling and spinning) have forces of at most `bound` times N along one or two further directions. The equations
/// apply to forces per mass, which change accelerations, and to impulses per mass, which change velocities.
///
/// Sources: D. E. Stewart, "Rigid-body dynamics with friction and impact", SIAM Review 42 (2000), for the problem;
/// P. Alart, A. Curnier, "A mixed formulation for frictional contact problems prone to Newton like solution methods",
/// Computer Methods in Applied Mechanics and Engineering 92 (1991), for the equations and Newton's method on them;
/// J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988), for Gauss-Seidel
/// sweeps over contacts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace ricochet {

/// A direction in the space of motions: three components of the velocity and three of sqrt(2/5) r omega.
using MotionVector = std::array<double, 6>;

[[nodiscard]] inline double dot(const MotionVector& a, const MotionVector& b) {
    double sum = 0.0;
    for (std::size_t c = 0; c < a.size(); ++c) sum += a[c] * b[c];
    return sum;
}

inline void add_multiple(MotionVector& sum, double factor, const MotionVector& direction) {
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += factor * direction[c];
}

/// One contact: 0 <= N, 0 <= rate, N rate = 0.
struct CoulombContact {
    MotionVector direction{};  ///< the surface's normal
    double rate = 0.0;         ///< rate along the direction if no contact force acts
};

/// One resistance at a contact: |T| <= bound N. If a rate remains, T opposes it with the largest allowed force.
struct CoulombResistance {
    std::uint32_t contact = 0;  ///< number of its contact, in the order of addition
    std::uint32_t size = 2;     ///< 1 or 2 directions
    double bound = 0.0;         ///< >= 0: a coefficient of friction, or a length over the radius
    std::array<MotionVector, 2> direction{};
    std::array<double, 2> rate{};     ///< rates along the directions if no contact force acts
    bool is_moving = false;           ///< true: the resistance acts against `heading`, independently of the rates
    std::array<double, 2> heading{};  ///< unit vector; used if `is_moving`
};

/// The equations, their unknown forces, and iterative solvers for them. Rates and forces are scaled: the largest free
/// rate is 1. Objects are large, so do not copy them.
class CoulombEquations {
public:
    static constexpr std::size_t kMostContacts = 8;
    static constexpr std::size_t kMostResistances = 3 * kMostContacts;
    static constexpr std::size_t kMostUnknowns = kMostContacts + 2 * kMostResistances;
    using Unknowns = std::array<double, kMostUnknowns>;

    /// Compliance of contacts and resistances. Each one yields by `value` times (force - anchor).
    struct Compliance {
        double value = 0.0;
        Unknowns anchor{};
    };

    /// Removes all contacts and resistances.
    void clear() { contact_count_ = resistance_count_ = sweeps_ = 0; }
    /// Adds a contact. There can be at most kMostContacts.
    void add(const CoulombContact& contact) { contacts_[contact_count_++] = contact; }
    /// Adds a resistance of a contact that has been added. There can be at most kMostResistances.
    void add(const CoulombResistance& resistance) { resistances_[resistance_count_++] = resistance; }
    [[nodiscard]] std::size_t contacts() const { return contact_count_; }
    /// Returns the number of Gauss-Seidel sweeps since clear(), a measure of the cost.
    [[nodiscard]] std::size_t sweeps() const { return sweeps_; }

    /// Sets all forces to 0 and scales the rates. friction: factor on all bounds. Returns the scale, or 0 without
    /// rates.
    [[nodiscard]] double set_up(double friction);
    [[nodiscard]] double friction() const { return friction_; }
    void set_friction(double factor) { friction_ = factor; }

    /// Returns the forces of the contacts, followed by the forces of the resistances.
    [[nodiscard]] const Unknowns& forces() const { return force_; }
    void set_forces(const Unknowns& forces) { force_ = forces; }
    /// Returns the forces of a resistance along its directions.
    [[nodiscard]] std::array<double, 2> force_of(std::size_t resistance) const;
    [[nodiscard]] double largest_force() const;
    [[nodiscard]] double largest_change_from(const Unknowns& before) const;
    /// Returns the change of the motion by all forces together.
    [[nodiscard]] MotionVector change() const;
    /// Limits forces that exceed their bounds by rounding, and multiplies all forces by the scale.
    void cut_to_bounds(double scale);

    /// Returns true if no force changes the rate of another one, as on one surface without rolling resistance.
    [[nodiscard]] bool are_independent() const;
    /// Solves independent equations. Returns the largest defect.
    [[nodiscard]] double solve_independent();
    /// Returns the largest defect of the equations.
    double find_defects(const Compliance& compliance);
    /// Applies Newton's method, with steps halved until they help. Returns true if the largest defect is at most
    /// `enough`.
    [[nodiscard]] bool newton(const Compliance& compliance, double enough);
    /// Makes Gauss-Seidel sweeps. Returns true if forces diverge, as in a wedge that friction jams: late sweeps change
    /// them as much as early sweeps.
    [[nodiscard]] bool relax(const Compliance& compliance, int sweeps);

private:
    /// The force of a resistance that would remove its rate, and the bound.
    struct Wish {
        std::array<double, 2> force{};
        double size = 0.0;
        double most = 0.0;
        double gain = 0.0;
        bool is_cut = false;  ///< true: the force exceeds `most` and is limited to it

        /// Returns the factor on the force that limits it to `most`.
        [[nodiscard]] double part() const { return is_cut ? most / size : 1.0; }
    };

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

    std::size_t unknowns_ = 0;
    std::array<std::size_t, kMostResistances> first_;  // first unknown of each resistance
    std::array<MotionVector, kMostUnknowns> direction_;
    std::array<Unknowns, kMostUnknowns> delassus_;  // dot products of the directions
    Unknowns free_rate_;
    Unknowns force_;
    Unknowns rate_;
    Unknowns defect_;  // after eliminate(): the Newton step, to be subtracted from the forces
    std::array<Unknowns, kMostUnknowns> matrix_;
};

}  // namespace ricochet
