#include "ricochet/response/contact_solver/iterative_contact_solver.h"

#include <algorithm>

#include "ricochet/core/parallel.h"
#include "ricochet/core/prefetch.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Contacts per block of parallel work. Sums are computed by these blocks for any number of threads.
constexpr std::size_t kBlock = 512;

/// Number of restarts per additional sweep without momentum. After this many restarts, one such sweep follows each
/// restart, after twice as many two. Reason: friction can make the iteration cycle. Large networks that converge
/// restart a few dozen times. Local: the residual decides.
constexpr int kRestartsAPlainSweep = 64;

/// Returns the ratio of the heavier to the lighter mass of two bodies, or 1 if one of them is a wall.
double ratio_of(const SolverState& a, const SolverState& b) {
    const auto [low, high] = std::minmax(a.inverse_mass, b.inverse_mass);
    return low > 0.0 ? high / low : 1.0;
}

}  // namespace

SolverReport IterativeContactSolver::solve(std::span<SolverBody> bodies, std::span<const SolverContact> contacts,
                                           const SolverSettings& settings) {
    SolverReport report;
    set_up(bodies, contacts, settings.duration);
    apply_start();
    gains_.clear();
    if (may_rebound()) {
        rebound(contacts, settings, report);
    } else {
        iterate(settings, report);
    }
    if (gains_.empty()) find_gains();
    remove_energy_gains(report);
    write_back(bodies);
    return report;
}

void IterativeContactSolver::set_up(std::span<const SolverBody> bodies, std::span<const SolverContact> contacts,
                                    double duration) {
    coloring_.assign(bodies.size(), contacts);
    bodies_ = bodies.size();
    before_.clear();
    for (const SolverBody& body : bodies) {
        const double inverse_inertia = body.radius * body.radius * body.inverse_inertia;
        before_.push_back({body.velocity, body.radius * body.spin, body.inverse_mass, inverse_inertia});
    }
    before_.push_back({});  // all walls at rest
    rows_.clear();
    rolling_.clear();
    partings_.clear();
    restitutions_.clear();
    mass_ratio_ = 1.0;
    against_start_ = 0.0;
    const std::span<const std::uint32_t> order = coloring_.order();
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k + kPrefetchDistance < order.size()) prefetch_whole(contacts[order[k + kPrefetchDistance]]);
        add_row(contacts[order[k]], bodies, duration);
    }
    states_ = before_;
    last_.resize(bodies_);
    impulses_.resize(contacts.size());
    rebounds_.resize(contacts.size());
}

void IterativeContactSolver::add_row(const SolverContact& contact, std::span<const SolverBody> bodies,
                                     double duration) {
    ContactConstraint& row = rows_.emplace_back();
    partings_.push_back(0.0);
    set_row(row, contact, bodies, duration);
    if (contact.rolling_friction > 0.0) add_rolling(contact, bodies);
    restitutions_.push_back(contact.touched ? 0.0 : contact.restitution);
    mass_ratio_ = std::max(mass_ratio_, ratio_of(before_[row.a], before_[row.b]));
    add_work(row, row.bound, before_, against_start_);
}

void IterativeContactSolver::set_row(ContactConstraint& row, const SolverContact& contact,
                                     std::span<const SolverBody> bodies, double duration) {
    row.a = contact.a;
    row.b = contact.b;
    if (contact.b == SolverContact::kWall) {
        row.b = static_cast<std::uint32_t>(bodies_);
        if (contact.wall_velocity != Vec3{}) {
            row.b = static_cast<std::uint32_t>(before_.size());
            before_.push_back({contact.wall_velocity, {}, 0.0, 0.0});
        }
    }
    row.normal = contact.normal;
    row.rolling = ContactConstraint::kNone;
    row.friction = contact.friction;
    row.strictness = contact.exactness * contact.exactness;
    if (contact.gap > 0.0) {
        row.bound = contact.gap / duration;
    } else {
        const bool is_pair = contact.b != SolverContact::kWall;
        const double radius =
            is_pair ? std::min(bodies[contact.a].radius, bodies[contact.b].radius) : bodies[contact.a].radius;
        const double parting = std::clamp(-kOverlapRelease * contact.gap, 0.0, kMostParting * radius) / duration;
        partings_.back() = std::min(parting, contact.most_parting);
        row.bound = -partings_.back();
    }
    if (inverse_mass_of(before_[row.a], before_[row.b]) == 0.0) {
        row.bound = INFINITY;  // both are fixed; sweeps skip the row, as they divide by the inverse mass
        return;
    }
    row.impulse.normal = std::max(0.0, contact.start.normal);
    const Vec3& friction = contact.start.tangential;
    row.impulse.tangential =
        shortened(friction - dot(friction, row.normal) * row.normal, row.friction * row.impulse.normal);
}

void IterativeContactSolver::add_rolling(const SolverContact& contact, std::span<const SolverBody> bodies) {
    ContactConstraint& row = rows_.back();
    RollingConstraint rolling;
    rolling.row = static_cast<std::uint32_t>(rows_.size() - 1);
    rolling.friction = contact.rolling_friction;
    rolling.wall_turning = contact.wall_turning;
    const auto per_radius = [&](std::uint32_t body) {
        return body < bodies.size() && bodies[body].radius > 0.0 ? 1.0 / bodies[body].radius : 0.0;
    };
    rolling.per_radius_a = per_radius(row.a);
    rolling.per_radius_b = per_radius(row.b);
    const auto inverse_inertia_of = [&](std::uint32_t body, double inverse_radius) {
        return before_[body].inverse_inertia * inverse_radius * inverse_radius;
    };
    const double inverse_inertia =
        inverse_inertia_of(row.a, rolling.per_radius_a) + inverse_inertia_of(row.b, rolling.per_radius_b);
    if (!(inverse_inertia > 0.0)) return;
    rolling.inertia = 1.0 / inverse_inertia;
    const Vec3& moment = contact.start.moment;
    rolling.moment = shortened(moment - dot(moment, row.normal) * row.normal, rolling.friction * row.impulse.normal);
    row.rolling = static_cast<std::uint32_t>(rolling_.size());
    rolling_.push_back(rolling);
}

/// Applies all start impulses, or none if their total work is positive, for example after a reversal of forces.
/// Applying only a fraction of each would disturb all spheres at rest.
void IterativeContactSolver::apply_start() {
    if (against_start_ > 0.0) {
        for (ContactConstraint& row : rows_) row.impulse = {};
        for (RollingConstraint& rolling : rolling_) rolling.moment = {};
        return;
    }
    for (const ContactConstraint& row : rows_) {
        if (row.impulse.normal == 0.0) continue;
        apply(row, row.impulse, states_[row.a], states_[row.b]);
        if (row.rolling != ContactConstraint::kNone)
            apply_moment(rolling_[row.rolling], rolling_[row.rolling].moment, states_[row.a], states_[row.b]);
    }
}

/// Adds the work of a contact's impulses to a sum, in J. The normal impulse works on the separation speed plus `bound`.
void IterativeContactSolver::add_work(const ContactConstraint& row, double bound, std::span<const SolverState> states,
                                      double& sum) const {
    if (row.impulse.normal == 0.0) return;
    const SolverState& a = states[row.a];
    const SolverState& b = states[row.b];
    sum +=
        row.impulse.normal * (separation_speed_of(row, a, b) + bound) + dot(row.impulse.tangential, slip_of(row, a, b));
    if (row.rolling == ContactConstraint::kNone) return;
    const RollingConstraint& rolling = rolling_[row.rolling];
    sum += dot(rolling.moment, rolling_of(row, rolling, a, b));
}

/// Sweeps with Nesterov's momentum, which restarts whenever a sweep changes more than the one before. If masses differ
/// much and the sweeps do not converge, the direct contact solver is used. Further sweeps check its result, which is
/// undone if the residual has grown.
void IterativeContactSolver::iterate(const SolverSettings& settings, SolverReport& report) {
    const bool are_very_unlike = mass_ratio_ > kVeryUnlikeMasses;
    const int first = are_very_unlike ? std::min(settings.sweeps, settings.most_sweeps) : settings.most_sweeps;
    if (sweep_until(settings, first, report) || !(mass_ratio_ > kUnlikeMasses)) return;
    const double residual = report.residual;
    const Impulses swept{rows_, rolling_, states_};
    const double tolerance = std::max(settings.tolerance, kDirectShare * settings.enough);
    static_cast<void>(direct_.improve({before_, states_, bodies_, rows_, rolling_}, tolerance));
    if (sweep_until(settings, settings.most_sweeps, report) || report.residual <= residual) return;
    rows_ = swept.rows;
    rolling_ = swept.rolling;
    states_ = swept.states;
    sweep_until(settings, settings.most_sweeps, report);
}

/// Sweeps until the tolerances of the settings are met. Returns false if `most` sweeps do not meet them.
bool IterativeContactSolver::sweep_until(const SolverSettings& settings, int most, SolverReport& report) {
    const double enough = std::max(settings.tolerance, settings.enough);
    double before = 0.0;
    double factor = 0.0;
    int momentum = 0;  // sweeps with momentum since its last restart
    int restarts = 0;
    int plain = 0;  // remaining sweeps without momentum
    for (int k = 1;; ++k) {
        const SweepChange change = sweep(factor);
        ++report.sweeps;
        report.residual = change.worst();
        report.is_converged = change.is_within(enough, settings.slip);
        if (change.is_within(k < settings.sweeps ? settings.tolerance : enough, settings.slip)) return true;
        if (k >= most) return false;
        if (before > 0.0 && change.squared > before) {
            plain = ++restarts / kRestartsAPlainSweep;
            momentum = 0;
        } else if (plain > 0) {
            --plain;
        } else if (before > 0.0) {
            ++momentum;
        }
        factor = static_cast<double>(momentum) / (momentum + 3);
        before = change.squared;
    }
}

/// Solves every contact once, after a momentum step of contacts and bodies: `factor` times their last change.
SweepChange IterativeContactSolver::sweep(double factor) {
    go_on(factor);
    const auto sweep_part = [&](std::size_t begin, std::size_t end, VectorUnit unit) {
        return sweep_rows({std::span(rows_).subspan(begin, end - begin), rolling_, states_}, factor, unit);
    };
    SweepChange all;
    for (std::size_t color = 0; color < coloring_.colors(); ++color) {
        const std::size_t first = coloring_.begin_of(color);
        const std::size_t count = coloring_.end_of(color) - first;
        const bool is_serial = coloring_.is_serial(color);
        const VectorUnit unit = is_serial ? VectorUnit::baseline : vector_units().back();
        if (count <= kBlock || is_serial) {
            all.add(sweep_part(first, first + count, unit));
            continue;
        }
        blocks_.assign((count + kBlock - 1) / kBlock, {});
        parallel_for_blocks(count, kBlock, [&](std::size_t k, std::size_t begin, std::size_t end) {
            blocks_[k] = sweep_part(first + begin, first + end, unit);
        });
        for (const SweepChange& block : blocks_) all.add(block);
    }
    return all;
}

/// Applies the momentum step to all bodies. Each row applies the same step to its impulse when it is solved.
void IterativeContactSolver::go_on(double factor) {
    const auto go = [&](std::size_t, std::size_t begin, std::size_t end) {
        const std::size_t count = end - begin;
        ricochet::go_on(std::span(states_).subspan(begin, count), std::span(last_).subspan(begin, count), factor,
                        vector_units().back());
    };
    if (bodies_ <= kBlock) {
        go(0, 0, bodies_);
    } else {
        parallel_for_blocks(bodies_, kBlock, go);
    }
}

}  // namespace ricochet
