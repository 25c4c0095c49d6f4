#include "ricochet/simulation/driven_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Returns the power, in W, of a wrench (N, N m) on a body. The moment is about the body's moment_center().
double power_of(const DrivenBody& body, const Wrench& load) {
    const double turning = dot(load.moment, body.angular_velocity());
    return body.description().joint == JointKind::hinge ? turning : turning + dot(load.impulse, body.velocity());
}

std::vector<DrivenBody> make_bodies(std::vector<BodyDescription> descriptions, const FrameTree* frames) {
    std::vector<DrivenBody> bodies;
    for (BodyDescription& description : descriptions) {
        const auto frame = frames == nullptr ? std::nullopt : frames->find(description.frame);
        if (!frame || !frames->description(*frame).is_driven) {
            throw InputError(fmt::format("body '{}': there is no driven frame of that name", description.frame));
        }
        bodies.emplace_back(std::move(description), frames->at(*frame, 0.0).world_from_frame);
    }
    return bodies;
}

}  // namespace

DrivenMotion::DrivenMotion(std::vector<BodyDescription> bodies, FrameTree* frames, MovingColliders& colliders,
                           const ForceField& forces, const ResponseSettings& settings)
    : bodies_(make_bodies(std::move(bodies), frames)),
      paths_(bodies_, frames, colliders, forces),
      slow_(settings.resting_speed),
      time_step_(settings.time_step),
      shortest_substep_(kShortestPart * settings.time_step),
      loads_(bodies_.size()),
      resting_loads_(bodies_.size()),
      contacts_(bodies_.size()),
      relaxations_(bodies_.size()) {}

void DrivenMotion::begin_step() {
    for (std::size_t k = 0; k < bodies_.size() && resting_time_ > 0.0; ++k) {
        const Wrench& lain = resting_loads_[k];
        loads_[k] = {lain.impulse / resting_time_, lain.moment / resting_time_};
        resting_loads_[k] = {};
    }
    resting_time_ = 0.0;
    substeps_ = 0;
    for (BodyContacts& contacts : contacts_) contacts.begin_step();
}

double DrivenMotion::work_by_yielding(const ColliderLoad& load) const {
    const auto body = loads_on_bodies().body_of(load);
    if (!body) return 0.0;
    const AffineMap map = paths_.planned(*body).at(load.time).world_from_frame;
    const Mobility mobility = bodies_[*body].mobility().seen_by(map);
    return mobility.energy_by(wrench_of(load, mobility.center));
}

double DrivenMotion::next_substep_end(double begin, double end) const {
    // Local: this factor prevents a last substep that is much shorter than the others.
    constexpr double kAboutAll = 1.1;
    return end - begin > kAboutAll * longest_substep_ ? begin + longest_substep_ : end;
}

void DrivenMotion::plan(double begin, double end, double oldest) {
    paths_.set_shares({});
    paths_.set_oldest(oldest);
    was_shortened_ = was_cut_ = has_given_up_ = false;
    paths_.plan(loads_, begin, end);
}

std::vector<double> DrivenMotion::shares_of(std::span<const ColliderLoad> preview, double end) const {
    std::vector<ImpactTally> tallies = paths_.no_impacts();
    for (const ColliderLoad& load : preview) {
        const auto body = load.impact && load.time <= end ? loads_on_bodies().body_of(load) : std::nullopt;
        if (body) tallies[*body].add(load);
    }
    std::vector<double> shares;
    for (const ImpactTally& tally : tallies) shares.push_back(tally.reaction_factor(end));
    return shares;
}

double DrivenMotion::cut_by(std::vector<ColliderLoad> preview) const {
    // Slow impacts are ignored, because resting particles land again after every change of the body's velocity.
    std::erase_if(preview, [&](const ColliderLoad& load) {
        return !load.impact || load.approach <= slow_ || !loads_on_bodies().body_of(load);
    });
    std::ranges::stable_sort(preview, [](const ColliderLoad& a, const ColliderLoad& b) {
        return std::tie(a.time, a.particle) < std::tie(b.time, b.particle);
    });
    const double end = paths_.planned(0).end;
    const double begin = paths_.planned(0).begin;
    const auto end_of = [&](const std::vector<ImpactTally>& taken, double time, double next) {
        const double least = substeps_ < kManyParts ? begin : begin + shortest_substep_;
        return std::min(end, std::max(least, end_after(taken, time, next, begin, shortest_substep_)));
    };
    std::vector<ImpactTally> tallies = paths_.no_impacts();
    for (std::size_t first = 0, next = 0; first < preview.size(); first = next) {
        const std::vector<ImpactTally> before = tallies;
        bool is_heavy = false;
        for (; next < preview.size() && preview[next].time == preview[first].time; ++next) {
            const std::size_t body = *loads_on_bodies().body_of(preview[next]);
            tallies[body].add(preview[next]);
            is_heavy = is_heavy || loads_on_bodies().heaviness_on(body, preview[next]) > kHeavyLoad;
        }
        const auto at_once = std::span(preview).subspan(first, next - first);
        const bool is_too_much =
            first > 0 && std::ranges::any_of(at_once, [&](const ColliderLoad& load) {
                const std::size_t body = *loads_on_bodies().body_of(load);
                return tallies[body].changes_energy(load.time) ||
                       changes_velocity(load, before[body].wrench(), tallies[body], contacts_[body]);
            });
        if (is_too_much) return end_of(before, preview[first - 1].time, preview[first].time);
        // The couple of a heavy particle that waits for the body turns the body strongly, see end_of_waits(), so the
        // substep ends soon.
        if (is_heavy && substeps_ < kManyParts) {
            const double until = next < preview.size() ? preview[next].time : end;
            return std::min(end, soon_after_impact(preview[first].time, until));
        }
    }
    return preview.empty() ? end : end_of(tallies, preview.back().time, end);
}

RestingLoad DrivenMotion::resting_load_on(std::size_t body, std::span<const ColliderLoad> preview, double until) const {
    // In a whole substep all loads count, because rounding may put the time of a load slightly after the end.
    const bool is_whole = until >= planned_end();
    return loads_on_bodies().resting_load_on(body, preview, is_whole ? std::numeric_limits<double>::infinity() : until);
}

/// Returns the fraction of a duration after which the substep must end, because the resting load on a body ends. The
/// load then acts during the whole shortened substep.
double DrivenMotion::substep_with_load(std::size_t body, std::span<const ColliderLoad> preview, double begin,
                                       double duration) const {
    const double part = (loads_on_bodies().left_at(body, preview) - begin) / duration;
    return part > kLoadEndMargin && part < 1.0 - kLoadEndMargin ? part : 1.0;
}

/// Returns the velocity change, in m/s, of a body by a wrench (N, N m) in a duration, in s, also at the radius of
/// gyration.
double DrivenMotion::change_by(std::size_t body, const Wrench& load, double duration) const {
    const Wrench whole{duration * load.impulse, duration * load.moment};
    return std::sqrt(2.0 * bodies_[body].quadratic_energy(whole) / bodies_[body].description().mass);
}

/// Returns the end of the substep, in s, which is at most `end`. After an impact, a particle that waits for a body
/// moves with the body's surface and not in the direction of its own momentum. A couple on the body then conserves the
/// angular momentum. The rotation by the couple grows with the waiting time, so a strong couple shortens the substep.
double DrivenMotion::end_of_waits(std::span<const ColliderLoad> preview, double end) const {
    const double begin = paths_.planned(0).begin;
    for (std::size_t i = 0; i < preview.size(); ++i) {
        const ColliderLoad& load = preview[i];
        const bool waits = !load.impact && load.impulse == Vec3{} && load.couple != Vec3{};
        const auto body = waits ? loads_on_bodies().body_of(load) : std::nullopt;
        if (!body) continue;
        const bool is_known = i > 0 && preview[i - 1].particle == load.particle;
        const double since = is_known ? std::max(begin, preview[i - 1].time) : begin;
        const double change = change_by(*body, wrench_of(load, bodies_[*body].moment_center()), 1.0);
        const double part = most_change(*body) / change;
        const double least = substeps_ < kManyParts ? 0.0 : shortest_substep_;
        if (since < end && part < 1.0) end = std::min(end, since + std::max(least, part * (load.time - since)));
    }
    return end;
}

/// Returns the largest velocity change of a body, in m/s, that need not be planned.
double DrivenMotion::most_change(std::size_t body) const {
    const double speed = std::sqrt(2.0 * bodies_[body].kinetic_energy() / bodies_[body].description().mass);
    return std::max(slow_, kMostBodyChange * speed);
}

DrivenMotion::Fit DrivenMotion::fit_of(std::size_t body, const RestingLoad& resting_load, double duration) const {
    const Wrench& planned = loads_[body];
    // In a substep that impacts have shortened, a slow impact must not count as a large lasting force.
    const double lasts = std::max(duration, kShortestLoad * shortest_substep_);
    const Wrench back{resting_load.wrench.impulse / lasts, resting_load.wrench.moment / lasts};
    const Wrench lacks{back.impulse - planned.impulse, back.moment - planned.moment};
    const double at_once = change_by(body, back, shortest_substep_) / (1.0 + resting_load.heaviness);
    const double most = std::max(most_change(body), at_once);
    const Wrench varies = relaxations_[body].variation(planned, back, resting_load.heaviness);
    const double change = change_by(body, varies, duration);
    const double lacking = change_by(body, lacks, duration);
    return {back, change > 1.1 * most ? most / change : 1.0, lacking <= kLoadResidual * most, lacking <= most};
}

/// Returns true if the substep must end at a time, in s, while a large load rests on a body. The load is recorded only
/// after that time. The share of the load before that time is then unknown.
bool DrivenMotion::is_cut_in_contact(std::span<const ColliderLoad> preview, double end) const {
    if (end >= planned_end()) return false;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        if (!(loads_on_bodies().left_at(k, preview) > end)) continue;
        const RestingLoad resting_load = resting_load_on(k, preview, planned_end());
        const double duration = planned_end() - paths_.planned(k).begin;
        if (resting_load.heaviness > 0.0 &&
            (relaxations_[k].concerns(resting_load) || !fit_of(k, resting_load, duration).is_near))
            return true;
    }
    return false;
}

/// Begins a round of planning. Returns false if bodies react otherwise to impacts than in the preview.
bool DrivenMotion::begin_round(std::span<const ColliderLoad> preview, double end, int round) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        if (round % kMostLoadRounds == 0) relaxations_[k].begin_search();
        if (round == 0) relaxations_[k].begin_substep(loads_[k]);
    }
    if (round > 0 && !was_cut_) return true;
    was_cut_ = false;
    std::vector<double> shares = shares_of(preview, end);
    const bool are_same = shares == paths_.shares();
    paths_.set_shares(std::move(shares));
    return are_same;
}

bool DrivenMotion::plan_again(std::span<const ColliderLoad> preview, double cut, int round) {
    const double begin = paths_.planned(0).begin;
    // A substep that has been cut once is not cut again at the same impact.
    double end = round == 0 || cut < begin + 0.5 * (planned_end() - begin) ? cut : planned_end();
    end = end_of_waits(preview, end);
    bool fits = begin_round(preview, end, round);
    if (is_cut_in_contact(preview, end)) {
        was_cut_ = true;
        paths_.plan(loads_, begin, end);
        return true;
    }
    if (has_given_up_) {
        accept(preview, end);
        return false;
    }
    const double duration = end - begin;
    const bool can_shorten = duration > 1.5 * shortest_substep_;
    const int most_rounds = can_shorten ? kMostLoadRounds : kFewLoadRounds;
    const bool is_last = round % kMostLoadRounds >= most_rounds - 1;
    double longest = 1.0;  // fraction of the duration
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const RestingLoad resting_load = resting_load_on(k, preview, end);
        const Fit fit = fit_of(k, resting_load, duration);
        if (fit.is_near && !relaxations_[k].concerns(resting_load)) continue;
        if (can_shorten) longest = std::min(longest, fit.longest);
        if (can_shorten && fit.fits) longest = std::min(longest, substep_with_load(k, preview, begin, duration));
        if (!fit.fits || longest < 1.0)
            loads_[k] = relaxations_[k].next(bodies_[k], loads_[k], fit.back, resting_load.heaviness);
        fits = fits && fit.fits;
    }
    if (!fits && is_last && can_shorten) longest = std::min(longest, 0.25);
    const bool gives_up = is_last && !can_shorten;
    if ((fits && longest == 1.0) || gives_up) {
        if (!can_shorten && plan_without_loads(preview, begin, end)) return true;
        accept(preview, end);
        return false;
    }
    if (longest < 1.0) {
        was_shortened_ = true;
        end = begin + std::max(shortest_substep_, longest * duration);
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            if (relaxations_[k].is_searching()) loads_[k] = relaxations_[k].shortened((end - begin) / duration);
        }
    }
    paths_.plan(loads_, begin, end);
    return true;
}

/// Returns true if a planned load and the load of the preview together give a body more energy than the particles lose.
bool DrivenMotion::gains_energy(std::size_t body, std::span<const ColliderLoad> preview, double end) const {
    const Wrench& planned_load = paths_.load(body);
    if (planned_load.impulse == Vec3{} && planned_load.moment == Vec3{}) return false;
    BodyPath path = paths_.planned(body);
    const bool is_whole = end >= path.end;
    path.end = end;
    const double duration = end - path.begin;
    const Wrench load{duration * planned_load.impulse, duration * planned_load.moment};
    Wrench taken;
    double given = 0.0;
    for (const ColliderLoad& part : preview) {
        if (loads_on_bodies().body_of(part) != body || (part.time > end && !is_whole)) continue;
        taken += wrench_of(part, bodies_[body].moment_center());
        given += part.work + (part.impact ? work_by_yielding(part) : 0.0);
    }
    DrivenBody as_planned = bodies_[body];
    as_planned.follow(path, planned_load, load);
    const double by_load = 0.5 * (power_of(bodies_[body], load) + power_of(as_planned, load));
    DrivenBody comes = bodies_[body];
    comes.follow(path, planned_load, taken);
    const double gained = comes.kinetic_energy() - as_planned.kinetic_energy() + by_load - given;
    return gained > kMostLoadGain * (bodies_[body].kinetic_energy() + comes.kinetic_energy());
}

/// Accepts the plan up to a time, in s.
void DrivenMotion::accept(std::span<const ColliderLoad> preview, double end) {
    const double duration = end - paths_.planned(0).begin;
    for (std::size_t k = 0; k < bodies_.size(); ++k) relaxations_[k].end_substep(resting_load_on(k, preview, end));
    paths_.end_at(end);
    limit_next_substep(duration);
}

/// Plans bodies without resting loads if no load fits even the shortest substep, for example a body that a much heavier
/// particle jams. Impacts then see the body's inverse mass. Returns false if no body needs this.
bool DrivenMotion::plan_without_loads(std::span<const ColliderLoad> preview, double begin, double end) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        if (!gains_energy(k, preview, end)) continue;
        loads_[k] = {};
        has_given_up_ = true;
    }
    if (has_given_up_) paths_.plan(loads_, begin, end);
    return has_given_up_;
}

/// Limits the next substep, so that substeps grow gradually. Only the mean of a resting load over a substep is known.
/// The mean can be small in a long substep in which a load comes and goes.
void DrivenMotion::limit_next_substep(double duration) {
    // Local: a rule of this step control, which checks each substep.
    constexpr double kGrowth = 2.0;
    if (was_shortened_) {
        longest_substep_ = kGrowth * duration;
    } else if (duration > longest_substep_ / kGrowth) {
        longest_substep_ *= kGrowth;
    }
    if (!(longest_substep_ < time_step_)) longest_substep_ = std::numeric_limits<double>::infinity();
}

void DrivenMotion::follow(std::span<const ColliderLoad> loads) {
    const std::vector<Wrench> wrenches = loads_on_bodies().sums(loads);
    std::vector<std::vector<std::uint64_t>> touching(bodies_.size());
    for (const ColliderLoad& load : loads) {
        const auto body = loads_on_bodies().body_of(load);
        if (!body) continue;
        touching[*body].push_back(load.particle);
        if (!load.impact) resting_loads_[*body] += wrench_of(load, bodies_[*body].moment_center());
    }
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const BodyPath& path = paths_.planned(k);
        const double lain = path.end - path.begin;
        contacts_[k].add(touching[k]);
        contacts_[k].taken += wrenches[k];
        // Uses the loads of the path, which are not those of the next plan if the search was given up.
        const Wrench& load = paths_.load(k);
        contacts_[k].taken += {-lain * load.impulse, -lain * load.moment};
        bodies_[k].follow(path, load, wrenches[k]);
    }
    if (!bodies_.empty()) resting_time_ += paths_.planned(0).end - paths_.planned(0).begin;
    paths_.set_followed();
    ++substeps_;
}

void DrivenMotion::take(std::span<const ColliderLoad> loads) {
    const std::vector<Wrench> wrenches = loads_on_bodies().sums(loads);
    for (std::size_t k = 0; k < bodies_.size(); ++k) bodies_[k].take(wrenches[k]);
}

bool DrivenMotion::is_sound(double time) const {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const std::vector<std::uint64_t>& ids = contacts_[k].now;
        const bool is_whole = paths_.is_sound(k) && is_finite(resting_loads_[k].impulse) &&
                              is_finite(resting_loads_[k].moment) && relaxations_[k].is_sound() &&
                              std::ranges::is_sorted(ids);
        if (!is_whole) return false;
    }
    // A substep that does not advance the time would be repeated forever.
    return resting_time_ >= 0.0 && std::isfinite(resting_time_) && time + longest_substep_ > time;
}

}  // namespace ricochet
