/// \file
/// The direct contact solver, an augmented Lagrangian Newton method with a factorization. It solves networks whose
/// masses differ so much that sweeps hardly converge.
///
/// Example: a light sphere transmits the load of a heavy one to a floor. The number of plain sweeps needed is then of
/// the order of the mass ratio, because each sweep moves only the light sphere. Here all velocities are solved
/// together. Impulses come from stiff dampers between surfaces, in addition to multipliers p from earlier passes:
///
///     P_n = max(0, p_n - k (u_n + bound)),   P_t = p_t - k u_t, limited to the friction cone
///
/// The friction cone uses the normal impulses P_n at the same velocities. Each pass finds the velocities at which these
/// impulses balance the momentum. For fixed limits of friction, these velocities minimise a convex function, so
/// Newton's method finds them. The impulses are the multipliers of the next pass. The stiffness k is a multiple of the
/// heaviest mass. Each pass therefore removes all but a small part of the violation, however light the other spheres
/// are.
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

/// A network: states without impulses (`before`), and with them (`states`). The first `bodies` are spheres, then walls.
struct SolverSystem {
    std::span<const SolverState> before;
    std::span<SolverState> states;
    std::size_t bodies = 0;
    std::span<ContactConstraint> rows;
    std::span<RollingConstraint> rolling;
};

/// Direct contact solver, which reuses its memory for the next network.
class DirectContactSolver {
public:
    /// Improves the impulses and states of a network until the conditions are violated by at most the tolerance, in
    /// m/s. Returns false if it does not reach the tolerance or would cost too much.
    [[nodiscard]] bool improve(const SolverSystem& parts, double tolerance);

private:
    /// Indices of a row's off-diagonal matrix blocks, by the velocities and turnings of a and b that they couple.
    struct BlockIndices {
        std::uint32_t velocities, a_turning_a, a_turning_b, b_turning_a, b_turning_b, turnings;
    };
    /// Impulses of a row at the current velocities, with the limits of friction and without them.
    struct ImpulseResponse {
        double normal = 0.0;
        Vec3 tangential;
        Vec3 moment;
        Vec3 wish;         // tangential impulse before the limit
        Vec3 wish_moment;  // moment before the limit
    };

    void begin_passes(double most_defect);
    void number_unknowns();
    void find_block_indices();
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
    void compute_velocities();

    SolverSystem parts_;
    double heaviest_ = 0.0;  // in kg
    double lightest_ = 0.0;
    double stiffness_ = 0.0;            // in kg
    bool is_smooth_ = true;             // true if the last Newton step had its full length
    std::vector<std::uint32_t> slots_;  // index of each state's velocity among the unknowns, or kFixed
    std::size_t moving_ = 0;            // number of bodies that are not fixed; turnings follow all velocities
    std::vector<BlockIndices> block_indices_;
    std::vector<BlockCholesky::Pair> pairs_;
    BlockCholesky cholesky_;
    double operations_left_ = 0.0;  // budget of the remaining factorizations
    BlockMatrix matrix_;
    std::vector<ImpulseResponse> responses_;  // one per row
    std::vector<std::uint8_t> ahead_;         // one per row: 1 if the full Newton step would give it a normal impulse
    std::vector<double> gradient_;            // in kg m/s, three numbers per unknown
};

}  // namespace ricochet
