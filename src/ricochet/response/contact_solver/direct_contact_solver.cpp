#include "ricochet/response/contact_solver/direct_contact_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/response/contact_solver/block_tools.h"

namespace ricochet {
namespace {

constexpr std::uint32_t kFixed = std::numeric_limits<std::uint32_t>::max();

/// Stiffness of the dampers, relative to the heaviest mass: each pass reduces the violation to a hundredth. For spheres
/// of a billionth of that mass, rounding causes errors of 1e-5 of the speeds. Local: SolverSettings has the tolerance.
constexpr double kStiffness = 100.0;

/// Factor between successive stiffnesses, which grow from that for the lightest mass to that for the heaviest. The
/// second constant is the number of Newton steps at each stiffness and in the first attempt.
constexpr double kStiffer = 100.0;
constexpr int kFewSteps = 8;

/// Largest number of passes after the first, and of Newton steps in each. Networks that need more have no solution, or
/// friction makes them cycle.
constexpr int kMostPasses = 3;
constexpr int kMostSteps = 80;

/// Largest momentum residual at the end of a pass, and largest violation of the conditions after the last pass,
/// relative to the tolerance. Local: the sweeps afterwards decide whether the solution is accepted.
constexpr double kDefect = 0.25;
constexpr double kViolated = 0.5;

/// Largest slope at the end of a line search, relative to the slope at its start, and largest number of trials. Local:
/// the residual decides.
constexpr double kSlopeLeft = 0.2;
constexpr int kMostTrials = 40;

/// Largest number of operations of all factorizations of a network, about a second of work. Reason: the operations grow
/// with the third power of the number of contacts that a cut through the network crosses. A thousand spheres, some of
/// them a thousand times as heavy, took minutes per step. Local: a limit of the work, after which sweeps continue.
constexpr double kMostOperations = 1e9;

/// Stiffness of sliding friction along the slip, relative to its stiffness across the slip. It is above 0 so that no
/// matrix is singular. Local: the residual decides.
constexpr double kSlipStiffness = 1e-9;

/// Returns the derivative, with respect to `wish`, of the tangential part of `wish` limited to the length `most`.
Block3 kept_change(const Vec3& normal, const Vec3& wish, double most, bool is_smooth) {
    Block3 result{};
    const double size = length(wish);
    const double kept = size <= most ? 1.0 : most / size;
    add_identity(result, kept);
    add_square(result, -kept, normal);
    if (is_smooth && size > most) add_square(result, (kSlipStiffness - 1.0) * kept, wish / size);
    return result;
}

Vec3 block_at(std::span<const double> values, std::size_t row) {
    return {values[3 * row], values[3 * row + 1], values[3 * row + 2]};
}

void add_to(std::span<double> values, std::size_t row, const Vec3& v) {
    values[3 * row] += v.x;
    values[3 * row + 1] += v.y;
    values[3 * row + 2] += v.z;
}

}  // namespace

bool DirectContactSolver::improve(const SolverSystem& parts, double tolerance) {
    parts_ = parts;
    number_unknowns();
    if (moving_ == 0) return false;
    find_block_indices();
    operations_left_ = kMostOperations;
    if (cholesky_.operations() > operations_left_) return false;
    begin_passes(kDefect * tolerance);
    double violated = update_multipliers();
    bool is_solved = false;
    for (int pass = 0; pass < kMostPasses && !is_solved; ++pass) {
        const bool is_balanced = minimise(kDefect * tolerance, kMostSteps);
        violated = update_multipliers();
        is_solved = is_balanced && violated <= kViolated * tolerance;
    }
    compute_velocities();
    return is_solved;
}

/// Makes the first pass, at full stiffness if the start is near the solution, as for spheres at rest. Otherwise the
/// stiffness grows in stages, because stiff dampers would throw light spheres back and forth.
void DirectContactSolver::begin_passes(double most_defect) {
    const double stiffest = kStiffness * heaviest_;
    const std::vector<SolverState> start(parts_.states.begin(), parts_.states.end());
    stiffness_ = stiffest;
    if (minimise(most_defect, kFewSteps)) return;
    std::copy(start.begin(), start.end(), parts_.states.begin());
    for (stiffness_ = kStiffness * lightest_; stiffness_ < stiffest; stiffness_ *= kStiffer) {
        static_cast<void>(minimise(most_defect, kFewSteps));
        static_cast<void>(update_multipliers());
    }
    stiffness_ = stiffest;
    static_cast<void>(minimise(most_defect, kMostSteps));
}

void DirectContactSolver::number_unknowns() {
    slots_.assign(parts_.states.size(), kFixed);
    moving_ = 0;
    heaviest_ = 0.0;
    lightest_ = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < parts_.bodies; ++i) {
        const double inverse_mass = parts_.before[i].inverse_mass;
        if (!(inverse_mass > 0.0)) continue;
        slots_[i] = static_cast<std::uint32_t>(moving_++);
        heaviest_ = std::max(heaviest_, 1.0 / inverse_mass);
        lightest_ = std::min(lightest_, 1.0 / inverse_mass);
    }
}

std::uint32_t DirectContactSolver::pair_of(std::uint32_t first, std::uint32_t second) {
    pairs_.push_back({first, second});
    return static_cast<std::uint32_t>(pairs_.size() - 1);
}

void DirectContactSolver::find_block_indices() {
    pairs_.clear();
    block_indices_.clear();
    const auto turning = static_cast<std::uint32_t>(moving_);
    for (const ContactConstraint& row : parts_.rows) {
        const std::uint32_t a = slots_[row.a];
        const std::uint32_t b = slots_[row.b];
        const bool both = a != kFixed && b != kFixed;
        const bool turns = row.friction > 0.0;
        BlockIndices slots{kFixed, kFixed, kFixed, kFixed, kFixed, kFixed};
        if (both) slots.velocities = pair_of(a, b);
        if (turns && a != kFixed) slots.a_turning_a = pair_of(a, turning + a);
        if (turns && b != kFixed) slots.b_turning_b = pair_of(b, turning + b);
        if (turns && both) {
            slots.a_turning_b = pair_of(a, turning + b);
            slots.b_turning_a = pair_of(b, turning + a);
        }
        if (both && (turns || row.rolling != ContactConstraint::kNone))
            slots.turnings = pair_of(turning + a, turning + b);
        block_indices_.push_back(slots);
    }
    cholesky_ = BlockCholesky(2 * moving_, pairs_);
}

DirectContactSolver::ImpulseResponse DirectContactSolver::response_to(std::size_t i) const {
    const ContactConstraint& row = parts_.rows[i];
    const SolverState& a = parts_.states[row.a];
    const SolverState& b = parts_.states[row.b];
    ImpulseResponse response;
    response.normal = std::max(0.0, row.impulse.normal - stiffness_ * (separation_speed_of(row, a, b) + row.bound));
    if (row.friction > 0.0) {
        response.wish = row.impulse.tangential - stiffness_ * slip_of(row, a, b);
        response.tangential = shortened(response.wish, row.friction * response.normal);
    }
    if (row.rolling != ContactConstraint::kNone) {
        const RollingConstraint& rolling = parts_.rolling[row.rolling];
        const double radius = radius_of(i);
        response.wish_moment = rolling.moment - stiffness_ * radius * radius * rolling_of(row, rolling, a, b);
        response.moment = shortened(response.wish_moment, rolling.friction * response.normal);
    }
    return response;
}

/// Returns the radius, in m, of the smaller sphere of a row with rolling resistance.
double DirectContactSolver::radius_of(std::size_t i) const {
    const RollingConstraint& rolling = parts_.rolling[parts_.rows[i].rolling];
    return 1.0 / std::max(rolling.per_radius_a, rolling.per_radius_b);
}

/// Computes the impulses and the momentum residual at the current velocities.
void DirectContactSolver::evaluate() {
    gradient_.assign(6 * moving_, 0.0);
    for (std::size_t i = 0; i < parts_.bodies; ++i) {
        if (slots_[i] == kFixed) continue;
        const SolverState& before = parts_.before[i];
        const SolverState& state = parts_.states[i];
        add_to(gradient_, slots_[i], (state.velocity - before.velocity) / before.inverse_mass);
        if (before.inverse_inertia > 0.0)
            add_to(gradient_, moving_ + slots_[i], (state.turning - before.turning) / before.inverse_inertia);
    }
    responses_.resize(parts_.rows.size());
    for (std::size_t i = 0; i < responses_.size(); ++i) {
        const ContactConstraint& row = parts_.rows[i];
        const ImpulseResponse& response = responses_[i] = response_to(i);
        const Vec3 impulse = response.normal * row.normal + response.tangential;
        const Vec3 turn = -cross(row.normal, response.tangential);
        const bool rolls = row.rolling != ContactConstraint::kNone;
        const auto give = [&](std::uint32_t body, double sign) {
            const std::uint32_t slot = slots_[body];
            if (slot == kFixed) return;
            add_to(gradient_, slot, -sign * impulse);
            if (!(parts_.before[body].inverse_inertia > 0.0)) return;
            Vec3 turned = turn;
            if (rolls) {
                const RollingConstraint& rolling = parts_.rolling[row.rolling];
                turned += (sign > 0.0 ? rolling.per_radius_a : -rolling.per_radius_b) * response.moment;
            }
            add_to(gradient_, moving_ + slot, -turned);
        };
        give(row.a, 1.0);
        give(row.b, -1.0);
    }
}

/// Returns the largest velocity error, in m/s, from the momentum residual.
double DirectContactSolver::largest_defect() const {
    double largest = 0.0;
    for (std::size_t i = 0; i < parts_.bodies; ++i) {
        if (slots_[i] == kFixed) continue;
        const SolverState& before = parts_.before[i];
        largest = std::max(largest, before.inverse_mass * length(block_at(gradient_, slots_[i])));
        largest = std::max(largest, before.inverse_inertia * length(block_at(gradient_, moving_ + slots_[i])));
    }
    return largest;
}

void DirectContactSolver::assemble() {
    matrix_.own.assign(2 * moving_, {});
    matrix_.between.assign(pairs_.size(), {});
    for (std::size_t i = 0; i < parts_.bodies; ++i) {
        if (slots_[i] == kFixed) continue;
        const SolverState& before = parts_.before[i];
        add_identity(matrix_.own[slots_[i]], 1.0 / before.inverse_mass);
        const double inverse_inertia = before.inverse_inertia > 0.0 ? before.inverse_inertia : before.inverse_mass;
        add_identity(matrix_.own[moving_ + slots_[i]], 1.0 / inverse_inertia);
    }
    for (std::size_t i = 0; i < parts_.rows.size(); ++i) {
        add_row(i);
        if (parts_.rows[i].rolling != ContactConstraint::kNone) add_rolling(i);
    }
}

void DirectContactSolver::add_row(std::size_t i) {
    const ContactConstraint& row = parts_.rows[i];
    const ImpulseResponse& response = responses_[i];
    const BlockIndices& slots = block_indices_[i];
    const std::uint32_t a = slots_[row.a];
    const std::uint32_t b = slots_[row.b];
    const double most = row.friction * response.normal;
    Block3 slipping{};
    if (most > 0.0) add(slipping, stiffness_, kept_change(row.normal, response.wish, most, is_smooth_));
    Block3 moving = slipping;
    if (response.normal > 0.0 || ahead_[i] != 0) add_square(moving, stiffness_, row.normal);
    if (a != kFixed) add(matrix_.own[a], 1.0, moving);
    if (b != kFixed) add(matrix_.own[b], 1.0, moving);
    if (slots.velocities != kFixed) add(matrix_.between[slots.velocities], -1.0, moving);
    if (!(most > 0.0)) return;
    // The slip is the tangential part of the relative velocity plus normal x (sum of the turnings).
    const Block3 turning = product(slipping, cross_matrix(row.normal));
    const Block3 turns = product(transposed(cross_matrix(row.normal)), turning);
    const auto add_turning = [&](std::uint32_t slot, double sign) {
        if (slot != kFixed) add(matrix_.between[slot], sign, turning);
    };
    add_turning(slots.a_turning_a, 1.0);
    add_turning(slots.a_turning_b, 1.0);
    add_turning(slots.b_turning_a, -1.0);
    add_turning(slots.b_turning_b, -1.0);
    if (a != kFixed) add(matrix_.own[moving_ + a], 1.0, turns);
    if (b != kFixed) add(matrix_.own[moving_ + b], 1.0, turns);
    if (slots.turnings != kFixed) add(matrix_.between[slots.turnings], 1.0, turns);
}

void DirectContactSolver::add_rolling(std::size_t i) {
    const ContactConstraint& row = parts_.rows[i];
    const RollingConstraint& rolling = parts_.rolling[row.rolling];
    const double most = rolling.friction * responses_[i].normal;
    if (!(most > 0.0)) return;
    const double radius = radius_of(i);
    const Block3 change = kept_change(row.normal, responses_[i].wish_moment, most, is_smooth_);
    const double stiffness = stiffness_ * radius * radius;
    const auto add_own = [&](std::uint32_t slot, double per_radius) {
        if (slot != kFixed) add(matrix_.own[moving_ + slot], stiffness * per_radius * per_radius, change);
    };
    add_own(slots_[row.a], rolling.per_radius_a);
    add_own(slots_[row.b], rolling.per_radius_b);
    if (block_indices_[i].turnings != kFixed)
        add(matrix_.between[block_indices_[i].turnings], -stiffness * rolling.per_radius_a * rolling.per_radius_b,
            change);
}

/// Finds the velocities at which the impulses of dampers and multipliers balance the changes of momentum. Returns false
/// if the residual, in m/s, remains above `most_defect`.
bool DirectContactSolver::minimise(double most_defect, int most_steps) {
    is_smooth_ = true;
    ahead_.assign(parts_.rows.size(), 0);
    evaluate();
    for (int step = 0; step < most_steps && largest_defect() > most_defect; ++step) {
        operations_left_ -= cholesky_.operations();
        if (operations_left_ < 0.0) return false;
        assemble();
        if (!cholesky_.factorize(matrix_)) return false;
        std::vector<double> direction = gradient_;
        for (double& value : direction) value = -value;
        cholesky_.solve(direction);
        if (!(slope_along(direction) < 0.0)) break;  // only rounding remains
        is_smooth_ = search_along(direction);
    }
    return largest_defect() <= most_defect;
}

void DirectContactSolver::go_along(std::span<const double> direction, double part) {
    for (std::size_t i = 0; i < parts_.bodies; ++i) {
        if (slots_[i] == kFixed) continue;
        parts_.states[i].velocity += part * block_at(direction, slots_[i]);
        parts_.states[i].turning += part * block_at(direction, moving_ + slots_[i]);
    }
    evaluate();
}

double DirectContactSolver::slope_along(std::span<const double> direction) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < direction.size(); ++i) sum += gradient_[i] * direction[i];
    return sum;
}

/// Moves along a direction until the slope of the minimised function is nearly 0; the slope increases along the
/// direction. Returns false if the step was shortened.
bool DirectContactSolver::search_along(std::span<const double> direction) {
    const double first = slope_along(direction);
    double low = 0.0;
    double low_slope = first;
    double high = 1.0;
    double at = 1.0;
    go_along(direction, 1.0);
    double slope = slope_along(direction);
    if (slope <= kSlopeLeft * std::fabs(first)) {
        std::ranges::fill(ahead_, 0);
        return true;
    }
    for (std::size_t i = 0; i < responses_.size(); ++i) ahead_[i] = responses_[i].normal > 0.0 ? 1 : 0;
    double high_slope = slope;
    for (int trial = 0; trial < kMostTrials && std::fabs(slope) > kSlopeLeft * std::fabs(first); ++trial) {
        // Alternates between the zero of the line through both slopes and the midpoint.
        const double part = trial % 2 == 0 ? low_slope / (low_slope - high_slope) : 0.5;
        const double next = low + std::clamp(part, 0.01, 0.99) * (high - low);
        go_along(direction, next - at);
        at = next;
        slope = slope_along(direction);
        (slope > 0.0 ? high : low) = at;
        (slope > 0.0 ? high_slope : low_slope) = slope;
    }
    if (slope > kSlopeLeft * std::fabs(first)) go_along(direction, low - at);
    return false;
}

/// Stores the impulses as the new multipliers. Returns the largest violation of the conditions, in m/s.
double DirectContactSolver::update_multipliers() {
    double worst = 0.0;
    for (std::size_t i = 0; i < responses_.size(); ++i) {
        ContactConstraint& row = parts_.rows[i];
        const ImpulseResponse& response = responses_[i];
        worst = std::max(worst, std::fabs(response.normal - row.impulse.normal) / stiffness_);
        if (row.friction > 0.0) {
            worst = std::max(worst, length(response.tangential - row.impulse.tangential) / stiffness_);
        }
        row.impulse.normal = response.normal;
        row.impulse.tangential = response.tangential;
        if (row.rolling != ContactConstraint::kNone) {
            RollingConstraint& rolling = parts_.rolling[row.rolling];
            const double change = length(response.moment - rolling.moment) / (stiffness_ * radius_of(i));
            worst = std::max(worst, change);
            rolling.moment = response.moment;
        }
    }
    return worst;
}

/// Limits the impulses to the friction cone and computes the velocities, so that momentum is conserved to rounding.
void DirectContactSolver::compute_velocities() {
    std::copy(parts_.before.begin(), parts_.before.end(), parts_.states.begin());
    for (ContactConstraint& row : parts_.rows) {
        row.impulse.tangential = shortened(row.impulse.tangential, row.friction * row.impulse.normal);
        if (row.impulse.normal > 0.0) apply(row, row.impulse, parts_.states[row.a], parts_.states[row.b]);
        if (row.rolling == ContactConstraint::kNone) continue;
        RollingConstraint& rolling = parts_.rolling[row.rolling];
        rolling.moment = shortened(rolling.moment, rolling.friction * row.impulse.normal);
        apply_moment(rolling, rolling.moment, parts_.states[row.a], parts_.states[row.b]);
    }
}

}  // namespace ricochet
