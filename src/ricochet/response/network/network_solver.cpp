#include "ricochet/response/network/network_solver.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/parallel.h"
#include "ricochet/core/prefetch.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Contacts per block of parallel work. Sums are computed by these blocks for any number of threads.
constexpr std::size_t kBlock = 512;

/// Largest distance that a step separates an overlap by, relative to the smaller radius. Reason: it is four times the
/// need of poured spheres. Spheres that surfaces press together without room overlap deeply, and would be thrown.
constexpr double kMostParting = 0.01;

/// Ratio of two masses in contact above which the direct contact solver is used if the sweeps do not converge. The
/// number of sweeps grows with the root of the ratio. Reason: sweeps are faster if radii differ by a factor of up to
/// four, a mass ratio of 64.
constexpr double kUnlikeMasses = 100.0;

/// Tolerance of the direct contact solver, relative to `enough`. Sweeps do the rest.
constexpr double kDirect = 0.25;

/// Number of restarts of the momentum that adds one plain sweep (without momentum) after each further restart. Reason:
/// friction can make the momentum cycle. Large networks that converge restart a few dozen times.
constexpr int kRestartsAPlainSweep = 64;

/// Ratio above which the direct contact solver is used already after NetworkSettings::sweeps.
constexpr double kVeryUnlikeMasses = 1e4;

/// Returns the limits for a tolerance in m/s.
NetworkLimits limits_of(const NetworkSettings& settings, double tolerance) {
    return {tolerance, std::max(tolerance, settings.slip)};
}

/// Returns the heavier over the lighter mass of two bodies, or 1 if one of them is a wall.
double ratio_of(const NetworkState& a, const NetworkState& b) {
    const auto [low, high] = std::minmax(a.mobility, b.mobility);
    return low > 0.0 ? high / low : 1.0;
}

}  // namespace

NetworkReport NetworkSolver::solve(std::span<NetworkBody> bodies, std::span<const NetworkContact> contacts,
                                   const NetworkSettings& settings) {
    NetworkReport report;
    set_up(bodies, contacts, settings.duration);
    apply_start();
    gains_.clear();
    if (may_rebound()) {
        rebound(contacts, settings, report);
    } else {
        iterate(settings, report);
    }
    if (gains_.empty()) find_gains();
    take_back_gains(report);
    hand_over(bodies);
    return report;
}

void NetworkSolver::set_up(std::span<const NetworkBody> bodies, std::span<const NetworkContact> contacts,
                           double duration) {
    coloring_.assign(bodies.size(), contacts);
    bodies_ = bodies.size();
    before_.clear();
    for (const NetworkBody& body : bodies) {
        const double turnability = body.radius * body.radius * body.inverse_inertia;
        before_.push_back({body.velocity, body.radius * body.spin, body.inverse_mass, turnability});
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

void NetworkSolver::add_row(const NetworkContact& contact, std::span<const NetworkBody> bodies, double duration) {
    NetworkRow& row = rows_.emplace_back();
    partings_.push_back(0.0);
    set_row(row, contact, bodies, duration);
    if (contact.rolling_friction > 0.0) add_rolling(contact, bodies);
    restitutions_.push_back(contact.touched ? 0.0 : contact.restitution);
    mass_ratio_ = std::max(mass_ratio_, ratio_of(before_[row.a], before_[row.b]));
    add_gain(row, before_, against_start_);
}

void NetworkSolver::set_row(NetworkRow& row, const NetworkContact& contact, std::span<const NetworkBody> bodies,
                            double duration) {
    row.a = contact.a;
    row.b = contact.b;
    if (contact.b == NetworkContact::kWall) {
        row.b = static_cast<std::uint32_t>(bodies_);
        if (contact.wall_velocity != Vec3{}) {
            row.b = static_cast<std::uint32_t>(before_.size());
            before_.push_back({contact.wall_velocity, {}, 0.0, 0.0});
        }
    }
    row.normal = contact.normal;
    row.rolling = NetworkRow::kNone;
    row.friction = contact.friction;
    row.strictness = contact.exactness * contact.exactness;
    if (contact.gap > 0.0) {
        row.bound = contact.gap / duration;
    } else {
        const bool is_pair = contact.b != NetworkContact::kWall;
        const double radius =
            is_pair ? std::min(bodies[contact.a].radius, bodies[contact.b].radius) : bodies[contact.a].radius;
        const double parting = std::clamp(-kNetworkPushOut * contact.gap, 0.0, kMostParting * radius) / duration;
        partings_.back() = std::min(parting, contact.most_parting);
        row.bound = -partings_.back();
    }
    if (mobility_of(before_[row.a], before_[row.b]) == 0.0) {
        row.bound = INFINITY;  // both are fixed; sweeps, which divide by the mobility, skip them
        return;
    }
    row.push.normal = std::max(0.0, contact.start.normal);
    const Vec3& friction = contact.start.tangential;
    row.push.tangential = shortened(friction - dot(friction, row.normal) * row.normal, row.friction * row.push.normal);
}

void NetworkSolver::add_rolling(const NetworkContact& contact, std::span<const NetworkBody> bodies) {
    NetworkRow& row = rows_.back();
    RollingRow rolling;
    rolling.row = static_cast<std::uint32_t>(rows_.size() - 1);
    rolling.friction = contact.rolling_friction;
    rolling.wall_turning = contact.wall_turning;
    const auto per_radius = [&](std::uint32_t body) {
        return body < bodies.size() && bodies[body].radius > 0.0 ? 1.0 / bodies[body].radius : 0.0;
    };
    rolling.per_radius_a = per_radius(row.a);
    rolling.per_radius_b = per_radius(row.b);
    const auto looseness = [&](std::uint32_t body, double inverse_radius) {
        return before_[body].turnability * inverse_radius * inverse_radius;
    };
    const double loose = looseness(row.a, rolling.per_radius_a) + looseness(row.b, rolling.per_radius_b);
    if (!(loose > 0.0)) return;
    rolling.inertia = 1.0 / loose;
    const Vec3& moment = contact.start.moment;
    rolling.moment = shortened(moment - dot(moment, row.normal) * row.normal, rolling.friction * row.push.normal);
    row.rolling = static_cast<std::uint32_t>(rolling_.size());
    rolling_.push_back(rolling);
}

/// Applies all start impulses, or none if they would not oppose the motion, for example after a reversal of forces.
/// Most contacts keep their impulses from step to step, and sweeps soon correct the others. A fraction of all start
/// impulses would disturb all spheres at rest.
void NetworkSolver::apply_start() {
    if (against_start_ > 0.0) {
        for (NetworkRow& row : rows_) row.push = {};
        for (RollingRow& rolling : rolling_) rolling.moment = {};
        return;
    }
    for (const NetworkRow& row : rows_) {
        if (row.push.normal == 0.0) continue;
        apply(row, row.push, states_[row.a], states_[row.b]);
        if (row.rolling != NetworkRow::kNone)
            apply_moment(rolling_[row.rolling], rolling_[row.rolling].moment, states_[row.a], states_[row.b]);
    }
}

/// Adds the work of a contact's impulses at the given velocities to a sum, in J.
void NetworkSolver::add_gain(const NetworkRow& row, std::span<const NetworkState> states, double& sum) const {
    if (row.push.normal == 0.0) return;
    const NetworkState& a = states[row.a];
    const NetworkState& b = states[row.b];
    sum += row.push.normal * (approach_of(row, a, b) + row.bound) + dot(row.push.tangential, slip_of(row, a, b));
    if (row.rolling == NetworkRow::kNone) return;
    const RollingRow& rolling = rolling_[row.rolling];
    sum += dot(rolling.moment, rolling_of(row, rolling, a, b));
}

/// Sweeps with Nesterov's momentum, which restarts whenever a sweep changes more than the one before. If masses differ
/// much and the sweeps do not converge, the direct contact solver is used. More sweeps then check its result, and the
/// state before it is restored if the residual has grown.
void NetworkSolver::iterate(const NetworkSettings& settings, NetworkReport& report) {
    const bool are_few = mass_ratio_ > kVeryUnlikeMasses;
    const int first = are_few ? std::min(settings.sweeps, settings.most_sweeps) : settings.most_sweeps;
    if (sweep_until(settings, first, report) || !(mass_ratio_ > kUnlikeMasses)) return;
    const double residual = report.residual;
    const Impulses swept{rows_, rolling_, states_};
    const double tolerance = std::max(settings.tolerance, kDirect * settings.enough);
    static_cast<void>(direct_.improve({before_, states_, bodies_, rows_, rolling_}, tolerance));
    if (sweep_until(settings, settings.most_sweeps, report) || report.residual <= residual) return;
    rows_ = swept.rows;
    rolling_ = swept.rolling;
    states_ = swept.states;
    sweep_until(settings, settings.most_sweeps, report);
}

/// Returns false if `most` sweeps do not meet the settings.
bool NetworkSolver::sweep_until(const NetworkSettings& settings, int most, NetworkReport& report) {
    const NetworkLimits wished = limits_of(settings, settings.tolerance);
    const NetworkLimits enough = limits_of(settings, std::max(settings.tolerance, settings.enough));
    double before = 0.0;
    double factor = 0.0;
    int momentum = 0;  // sweeps with momentum since its last restart
    int restarts = 0;
    int plain = 0;  // remaining sweeps without momentum
    for (int k = 1;; ++k) {
        const SweepChange change = sweep(factor);
        ++report.sweeps;
        report.residual = change.worst();
        report.is_converged = change.is_within(enough);
        if (change.is_within(k < settings.sweeps ? wished : enough)) return true;
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
SweepChange NetworkSolver::sweep(double factor) {
    go_on(factor);
    SweepChange all;
    for (std::size_t color = 0; color < coloring_.colors(); ++color) {
        const std::size_t first = coloring_.begin_of(color);
        const std::size_t count = coloring_.end_of(color) - first;
        const bool is_serial = coloring_.is_serial(color);
        const SweepWay way = is_serial ? SweepWay::one_by_one : sweep_ways().back();
        if (count <= kBlock || is_serial) {
            all.add(sweep_rows(factor, first, first + count, way));
            continue;
        }
        blocks_.assign((count + kBlock - 1) / kBlock, {});
        parallel_for_blocks(count, kBlock, [&](std::size_t k, std::size_t begin, std::size_t end) {
            blocks_[k] = sweep_rows(factor, first + begin, first + end, way);
        });
        for (const SweepChange& block : blocks_) all.add(block);
    }
    return all;
}

/// Applies the momentum step to all bodies. Velocities are linear in the impulses, so each row can apply the same step
/// to its impulse later, when it is solved.
void NetworkSolver::go_on(double factor) {
    const auto go = [&](std::size_t, std::size_t begin, std::size_t end) {
        const std::size_t count = end - begin;
        ricochet::go_on(std::span(states_).subspan(begin, count), std::span(last_).subspan(begin, count), factor,
                        sweep_ways().back());
    };
    if (bodies_ <= kBlock) {
        go(0, 0, bodies_);
    } else {
        parallel_for_blocks(bodies_, kBlock, go);
    }
}

SweepChange NetworkSolver::sweep_rows(double factor, std::size_t begin, std::size_t end, SweepWay way) {
    return ricochet::sweep_rows({std::span(rows_).subspan(begin, end - begin), rolling_, states_}, factor, way);
}

}  // namespace ricochet
