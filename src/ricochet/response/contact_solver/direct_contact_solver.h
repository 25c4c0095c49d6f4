/// \file
/// Private to the solver of contact networks: Newton's method with a factorization, for networks in which masses differ
/// so much that sweeps hardly get on.
///
/// What a light sphere passes on from a heavy one to a floor takes sweeps some times the ratio of the masses, since
/// each of them moves the light one alone. Here all velocities are unknowns together. Impulses are those of stiff
/// dampers between surfaces, beside what earlier passes have found (multipliers),
///
///     P_n = max(0, p_n - k (u_n + bound)),   P_t = what the cone leaves of (p_t - k u_t),
///
/// with friction limited by the normal impulses at the same velocities. Each pass looks for the velocities at which
/// these impulses balance: with friction as it is just limited they are the minimum of a convex function, which
/// Newton's method finds. Its impulses are the next multipliers. The stiffness k is some times the heaviest mass: every
/// pass takes away all but a small part of what is violated, whatever the light ones weigh.
///
/// Source: P. Alart, A. Curnier, "A mixed formulation for frictional contact problems prone to Newton like solution
/// methods", Comput. Methods Appl. Mech. Engrg. 92 (1991).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/dynamics/block_cholesky.h"
#include "ricochet/response/contact_solver/contact_constraints.h"

namespace ricochet {

/// The network: velocities without impulses and with those of the rows; the first `bodies` states are spheres, the
/// others walls.
struct SolverSystem {
    std::span<const SolverState> before;
    std::span<SolverState> states;
    std::size_t bodies = 0;
    std::span<ContactConstraint> rows;
    std::span<RollingConstraint> rolling;
};

/// Keeps its memory from one network to the next.
class DirectContactSolver {
public:
    /// Improves the impulses of a network, and its states with them, until the conditions are violated by no more than
    /// the tolerance, m/s. False where it does not come to that, or would cost too much.
    [[nodiscard]] bool improve(const SolverSystem& parts, double tolerance);

private:
    /// Numbers of a row's pairs of blocks in the matrix, by what they join: velocities and turnings of a and b.
    struct BlockIndices {
        std::uint32_t velocities, a_turning_a, a_turning_b, b_turning_a, b_turning_b, turnings;
    };
    /// Impulses at the velocities that there are, and how they change with these.
    struct ImpulseResponse {
        double normal = 0.0;
        Vec3 tangential;
        Vec3 moment;
        Vec3 wish;         // tangential impulse that would stop the slip
        Vec3 wish_moment;  // moment that would stop the rolling
    };

    void begin_passes(double most_defect);
    void number_unknowns();
    void find_places();
    [[nodiscard]] std::uint32_t pair_of(std::uint32_t first, std::uint32_t second);
    [[nodiscard]] ImpulseResponse response_to(std::size_t row) const;
    [[nodiscard]] double radius_of(std::size_t row) const;
    void evaluate();
    [[nodiscard]] double largest_defect() const;
    void assemble();
    void add_row(std::size_t row);
    void add_rolling(std::size_t row);
    [[nodiscard]] bool minimise(double most_defect, int most_steps);
    void go_along(std::span<const double> direction, double part);
    [[nodiscard]] double slope_along(std::span<const double> direction) const;
    [[nodiscard]] bool search_along(std::span<const double> direction);
    [[nodiscard]] double update_multipliers();
    void hand_over();

    SolverSystem parts_;
    double heaviest_ = 0.0;  // kg
    double lightest_ = 0.0;
    double stiffness_ = 0.0;            // kg
    bool is_smooth_ = true;             // the last step could be gone to its end
    std::vector<std::uint32_t> slots_;  // of each state's velocity among the blocks of rows; kFixed
    std::size_t moving_ = 0;            // bodies; their turnings follow their velocities
    std::vector<BlockIndices> places_;
    std::vector<BlockCholesky::Pair> pairs_;
    BlockCholesky cholesky_;
    double operations_left_ = 0.0;  // that factorizations may still take
    BlockMatrix matrix_;
    std::vector<ImpulseResponse> responses_;  // by row
    std::vector<std::uint8_t> ahead_;  // by row: 1 where the last step, gone to its end, would press the two together
    std::vector<double> gradient_;     // kg m/s, three numbers a row of blocks
};

}  // namespace ricochet
