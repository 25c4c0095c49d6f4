#include "ricochet/response/event_island.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/geometry/sweep/pair_sweep.h"

namespace ricochet {
namespace {

PairBody body_of(const IslandMember& member) {
    const MovingParticle& moving = member.moving;
    const double radius = member.radius();
    const bool is_fixed = member.is_fixed || member.is_cut_off;
    // A core spins faster than the whole sphere, so that both surfaces move at the same speed.
    PairBody body = pair_body(moving.state.position, is_fixed ? Vec3{} : moving.state.velocity,
                              (moving.state.radius / radius) * moving.spin, moving.state.mass, radius, is_fixed);
    body.material = member.material;
    return body;
}

}  // namespace

void EventIsland::begin(std::vector<IslandMember>& members, MoveScratch& scratch) {
    members_ = &members;
    scratch_ = &scratch;
    impacts_.clear();
    meetings_.clear();
    most_of_one_ = 0;
    last_impact_ = kStartOfStep;
    if (predictions_.size() < members.size()) predictions_.resize(members.size());
    boxes_.assign(members.size(), {});
    partners_.assign(members.size(), 0);
    changed_at_.assign(members.size(), kStartOfStep);
    repeated_.assign(members.size(), {});
    is_pressed_ = false;
    times_.reset(members.size());
    resumed_.resize(std::max(resumed_.size(), members.size()));
    for (std::size_t m = 0; m < members.size(); ++m) predict(m);
    neighbours_.begin(boxes_);
}

std::optional<double> EventIsland::run(std::vector<IslandMember>& members, MoveScratch& scratch,
                                       const ImpactLimit& limit) {
    scratch.record_flown = true;
    const std::optional<double> handover = solve(members, scratch, limit);
    scratch.record_flown = false;
    return handover;
}

std::optional<double> EventIsland::solve(std::vector<IslandMember>& members, MoveScratch& scratch,
                                         const ImpactLimit& limit) {
    budget_ = limit.budget;
    if (!limit.allows_sinking) start_ = members;
    begin(members, scratch);
    if (!limit.allows_pressing && presses()) return kStartOfStep;
    resolve_until(std::numeric_limits<double>::infinity(), limit);
    const std::optional<double> handover = time_of_handover(limit);
    if (!handover) {
        for (std::size_t m = 0; m < members.size(); ++m) commit(m);
        return std::nullopt;
    }
    if (*handover != last_impact_ || *handover == kStartOfStep) {
        members = start_;
        begin(members, scratch);
        resolve_until(*handover, {});
    }
    if (*handover != kStartOfStep) {
        for (std::size_t m = 0; m < members.size(); ++m) {
            if (!is_still(m)) go_to(m, std::min(*handover, members[m].end));
        }
    }
    return handover;
}

/// Resolves the impacts up to a time, in s, in order.
void EventIsland::resolve_until(double last, const ImpactLimit& limit) {
    find_all();
    while (!exceeds(limit)) {
        const double time = times_.earliest();
        if (!std::isfinite(time) || time > last) return;
        last_impact_ = time;
        std::vector<PairContact> contacts = contacts_at(time);
        keep_fastest(contacts, time);
        resolve(contacts, time);
    }
}

/// Returns the time at which contacts begin to last, or nothing if none lasts. A kick at the start of the step cannot
/// be divided, so an island with one is handed over at the start.
std::optional<double> EventIsland::time_of_handover(const ImpactLimit& limit) const {
    std::optional<double> time;
    if (exceeds(limit)) time = last_impact_;
    if (!time && !limit.allows_sinking) time = time_of_sinking();
    const bool is_kicked = kicks_first(response_.rules().settings.integrator.kind);
    return time && (is_kicked || !limit.keeps_impacts) ? kStartOfStep : time;
}

/// Calls visit(m, other) for the pairs of members that press on each other until the end of the step, see has_sunk().
template <class Visit>
void EventIsland::visit_sunk_pairs(const Visit& visit) const {
    const auto is_there = [](const IslandMember& member) { return !member.is_gone() && !member.is_cut_off; };
    for (std::size_t m = 0; m < members_->size(); ++m) {
        const IslandMember& member = (*members_)[m];
        for (const std::uint32_t other : neighbours_.of(m)) {
            const IslandMember& neighbour = (*members_)[other];
            const bool is_pair = other > m && is_there(member) && is_there(neighbour) && member.end == neighbour.end;
            if (!is_pair || predictions_[m].outcome.is_absorbed() || predictions_[other].outcome.is_absorbed())
                continue;
            const Vec3 apart = state_of(other, member.end).position - state_of(m, member.end).position;
            const double smaller = std::min(member.radius(), neighbour.radius());
            const Vec3 before = start_[other].moving.state.position - start_[m].moving.state.position;
            if (has_sunk(member.radius() + neighbour.radius(), smaller, before, apart)) visit(m, other);
        }
    }
}

/// Returns the earliest time from which two members press on each other: the last impact of one of them.
std::optional<double> EventIsland::time_of_sinking() const {
    std::optional<double> earliest;
    visit_sunk_pairs([&](std::size_t m, std::size_t other) {
        const double time = std::max(changed_at_[m], changed_at_[other]);
        earliest = std::min(earliest.value_or(time), time);
    });
    return earliest;
}

/// Returns true if two members press on each other before any impact. Such a pair would make impacts without rebound
/// and never complete the step. A member that bounces off a wall is excluded, because it rebounds.
bool EventIsland::presses() const {
    const double resting = response_.rules().settings.resting_speed;
    bool is_found = false;
    visit_sunk_pairs([&](std::size_t m, std::size_t other) {
        const IslandMember& a = (*members_)[m];
        const IslandMember& b = (*members_)[other];
        if (predictions_[m].outcome.bounces > 0 || predictions_[other].outcome.bounces > 0) return;
        const Vec3 apart = b.moving.state.position - a.moving.state.position;
        const double distance = length(apart);
        const double touching = a.radius() + b.radius() + kPressedOverlap * std::min(a.radius(), b.radius());
        const double approach = -dot(b.moving.state.velocity - a.moving.state.velocity, apart);
        is_found = is_found || (distance <= touching && approach <= resting * distance);
    });
    return is_found;
}

/// Predicts the path of a member to the end of its part of the step.
void EventIsland::predict(std::size_t m) {
    IslandMember& member = (*members_)[m];
    Prediction& prediction = predictions_[m];
    prediction.moved = member.moving;
    prediction.outcome = {};
    prediction.lists.clear();
    prediction.flown.clear();
    if (member.is_gone()) {
        boxes_[m] = {};
        return;
    }
    const double duration = member.time_left();
    if (member.is_fixed || member.is_cut_off || !(duration > 0.0)) {
        stay(m);
        return;
    }
    if (member.is_free) {
        prediction.flown.assign(1, free_piece(response_.rules(), member.moving.state, member.end));
        const Path& path = prediction.flown[0].path;
        boxes_[m] = grown(box_of(path, path.duration), member.radius());
        return;
    }
    scratch_->flown.clear();
    prediction.moved.step_end = member.end;
    prediction.outcome = response_.move(prediction.moved, duration, *scratch_);
    prediction.lists.take(*scratch_);
    prediction.flown.swap(scratch_->flown);
    // Without a flown path the member keeps its position: its path cannot be followed, or no time is left.
    if (prediction.flown.empty()) {
        stay(m);
        return;
    }
    // A member without bounce budget waits at the last wall, which may carry it, and other members may reach it.
    if (const double left = prediction.outcome.unsimulated_time; left > 0.0 && !prediction.outcome.is_absorbed()) {
        const FlownPiece& last = prediction.flown.back();
        const double begin = last.begin + last.duration;
        const double waits = std::max(0.0, member.end - begin);
        const Vec3 from = last.path.position(last.duration);
        const Vec3 carried = prediction.moved.state.position - from;
        const Path trajectory = line_path(from, waits > 0.0 ? carried / waits : Vec3{}, waits);
        prediction.flown.push_back({trajectory, begin, trajectory.duration, Vec3{}, Vec3{}, false});
    }
    Box3 box;
    for (const FlownPiece& piece : prediction.flown) box.include(box_of(piece.path, piece.duration));
    box.include(prediction.moved.state.position);
    boxes_[m] = grown(box, member.radius());
}

void EventIsland::stay(std::size_t m) {
    const IslandMember& member = (*members_)[m];
    const ForceInput& state = member.moving.state;
    const double duration = std::max(0.0, member.end - state.time);
    predictions_[m].flown.assign(
        1, {line_path(state.position, Vec3{}, duration), state.time, duration, Vec3{}, Vec3{}, false});
    boxes_[m] = grown({state.position, state.position}, member.radius());
}

/// Moves a member to a time along its predicted path. A bounce off a wall at the same time comes first, as for a member
/// on a floor that another one hits.
void EventIsland::bring(std::size_t m, double time) {
    const IslandMember& member = (*members_)[m];
    if (is_still(m)) return;
    go_to(m, time);
    const double just_after = std::nextafter(time, std::numeric_limits<double>::infinity());
    if (!member.is_gone() && just_after < member.end && bounces_at(m, time)) go_to(m, just_after);
}

/// Returns true if a predicted contact of two members does not occur. One may be gone or late, or differ from its
/// prediction, because arcs are planned again up to the time of impact.
bool EventIsland::is_missed(const PairContact& contact, double time) const {
    const IslandMember& a = (*members_)[contact.first];
    const IslandMember& b = (*members_)[contact.second];
    if (a.is_gone() || b.is_gone()) return true;
    const PhaseState first{a.moving.state.position, a.moving.state.velocity};
    const PhaseState second{b.moving.state.position, b.moving.state.velocity};
    const double touching = a.radius() + b.radius();
    const double trajectory = a.contact_path + b.contact_path;
    const double bound = trajectory > 0.0 ? kBoundMetGap * (std::min(a.radius(), b.radius()) + trajectory) : 0.0;
    const double rounding = kSameImpactUlps * (ulp(max_abs(first.position)) + ulp(max_abs(second.position)) +
                                               ulp(time) * (length(first.velocity) + length(second.velocity)));
    return length(second.position - first.position) > touching + kMetGap * touching + bound + rounding;
}

bool EventIsland::bounces_at(std::size_t m, double time) const {
    const Vec3& now = (*members_)[m].moving.state.velocity;
    const auto is_it = [&](const FlownPiece& piece) {
        const double most = kPairApproachRounding * (length(now) + length(piece.start_velocity));
        return std::fabs(piece.begin - time) <= kSameImpactUlps * ulp(time) &&
               length(piece.start_velocity - now) > most;
    };
    const std::vector<FlownPiece>& flown = predictions_[m].flown;
    return !kicks_first(response_.rules().settings.integrator.kind) && std::ranges::any_of(flown, is_it);
}

void EventIsland::go_to(std::size_t m, double time) {
    IslandMember& member = (*members_)[m];
    MovingParticle& moving = member.moving;
    const double duration = time == member.end ? member.time_left() : time - moving.state.time;
    if (!(duration > 0.0)) return;
    scratch_->flown.clear();
    if (member.is_free && !scratch_->record_segments) {
        fly_freely(member, duration);
        moving.stored_time = time;
    } else {
        moving.beyond = member.end - time;
        moving.step_end = time;
        member.outcome.add(response_.move(moving, duration, *scratch_));
        moving.beyond = 0.0;
    }
    moving.planned = nullptr;
    member.is_free = false;
    if (!member.is_gone()) moving.state.time = time;
    member.lists.append(*scratch_);
    scratch_->MoveLists::clear();
    member.append_off_bounds(scratch_->flown);
    Box3 box;
    for (const FlownPiece& piece : scratch_->flown) {
        box.include(box_of(piece.path, piece.duration));
        if (!piece.is_free) member.contact_path += length(piece.path.position(piece.duration) - piece.path.c[0]);
    }
    box.include(moving.state.position);
    member.swept.include(grown(box, member.radius()));
}

/// Moves a member that is known to meet no wall, like response_.move(), but without the certificate.
void EventIsland::fly_freely(IslandMember& member, double duration) {
    const ResponseRules& rules = response_.rules();
    ForceInput& state = member.moving.state;
    const Flight flight = begin_flight(rules.settings.integrator, rules.forces, state, member.end - state.time);
    const Vec3 initial_velocity = state.velocity;
    const double begin = state.time;
    state.velocity = velocity_at(rules.settings.integrator, rules.forces, flight, duration);
    state.position = flight.path.position(duration);
    scratch_->flown.push_back({flight.path, begin, duration, initial_velocity, state.velocity, true});
}

/// Stores the prediction of a member as its result.
void EventIsland::commit(std::size_t m) {
    IslandMember& member = (*members_)[m];
    Prediction& prediction = predictions_[m];
    member.swept.include(boxes_[m]);
    const bool has_left_bounds = member.impacts > 0;
    if (has_left_bounds) member.moving.planned = nullptr;
    if (has_left_bounds || member.moving.state.coupling != nullptr) member.append_off_bounds(prediction.flown);
    if (is_still(m) || member.is_free) return;
    if (member.keeps_path && !member.has_left_bounds) member.trajectory = prediction.flown;
    member.moving = prediction.moved;
    if (has_left_bounds) member.moving.planned = nullptr;
    member.outcome.add(prediction.outcome);
    member.lists.append(prediction.lists);
}

std::optional<double> EventIsland::meeting_of(std::size_t a, std::size_t b) const {
    if ((*members_)[a].is_fixed && (*members_)[b].is_fixed) return std::nullopt;
    // The order is fixed, so that both members find the same time.
    if ((*members_)[a].particle > (*members_)[b].particle) std::swap(a, b);
    const std::vector<FlownPiece>& first = predictions_[a].flown;
    const std::vector<FlownPiece>& second = predictions_[b].flown;
    const double distance = (*members_)[a].radius() + (*members_)[b].radius();
    const auto speed = [&](std::size_t m) { return length((*members_)[m].moving.state.velocity); };
    const double rounding = kPairApproachRounding * (speed(a) + speed(b));
    return first_meeting(std::span(first), std::span(second), distance, rounding);
}

/// Records a contact of a member if it is earlier than the recorded one.
void EventIsland::note(std::size_t m, double time, std::size_t partner) {
    if (!(time < times_.time_of(m))) return;
    times_.set(m, time);
    partners_[m] = partner;
}

/// Records the next contact of two members for both.
void EventIsland::note_meeting(std::size_t m, std::size_t other) {
    const auto time = meeting_of(m, other);
    if (!time) return;
    note(m, *time, other);
    note(other, *time, m);
}

void EventIsland::find_all() {
    for (std::size_t m = 0; m < members_->size(); ++m) {
        const std::vector<std::uint32_t>& near = neighbours_.of(m);
        for (auto other = std::upper_bound(near.begin(), near.end(), m); other != near.end(); ++other) {
            note_meeting(m, *other);
        }
    }
}

void EventIsland::find_next(std::size_t m) {
    times_.set(m, std::numeric_limits<double>::infinity());
    for (const std::uint32_t other : neighbours_.of(m)) {
        if (const auto time = meeting_of(m, other)) note(m, *time, other);
    }
}

/// Predicts new paths of changed members, and finds the next contacts with them.
void EventIsland::predict_anew(const std::vector<std::size_t>& changed) {
    const auto is_changed = [&](std::size_t m) { return std::binary_search(changed.begin(), changed.end(), m); };
    std::vector<std::size_t> left;  // unchanged members whose next contact was with a changed member
    for (const std::size_t m : changed) {
        for (const std::uint32_t other : neighbours_.of(m)) {
            const bool is_left = partners_[other] == m && std::isfinite(times_.time_of(other));
            if (is_left && !is_changed(other)) left.push_back(other);
        }
    }
    for (const std::size_t m : changed) predict(m);
    neighbours_.update(changed);
    for (const std::size_t other : left) find_next(other);
    for (const std::size_t m : changed) {
        times_.set(m, std::numeric_limits<double>::infinity());
        for (const std::uint32_t other : neighbours_.of(m)) {
            note_meeting(m, other);
        }
    }
}

PhaseState EventIsland::state_of(std::size_t m, double time) const {
    const std::vector<FlownPiece>& flown = predictions_[m].flown;
    const auto next = std::upper_bound(flown.begin() + 1, flown.end(), time,
                                       [](double t, const FlownPiece& piece) { return t < piece.begin; });
    const FlownPiece& piece = *(next - 1);
    const double s = std::clamp(time - piece.begin, 0.0, piece.duration);
    return {piece.path.position(s), piece.path.velocity(s)};
}

/// Returns all contacts at a time, with members in ascending order.
std::vector<PairContact> EventIsland::contacts_at(double time) const {
    const double until = time + kSameImpactUlps * ulp(time);
    std::vector<PairContact> contacts;
    std::vector<std::size_t> first;
    times_.collect(until, first);
    for (const std::size_t m : first) {
        for (const std::uint32_t other : neighbours_.of(m)) {
            const bool is_known = other < m && times_.time_of(other) <= until;  // already found from the other member
            if (is_known) continue;
            const auto meeting = meeting_of(m, other);
            if (meeting && *meeting <= until) {
                contacts.push_back({std::min<std::size_t>(m, other), std::max<std::size_t>(m, other)});
            }
        }
    }
    return contacts;
}

/// Keeps only the contacts with the highest approach speed, so that the order of members does not matter.
void EventIsland::keep_fastest(std::vector<PairContact>& contacts, double time) const {
    if (contacts.size() < 2) return;
    double fastest = -std::numeric_limits<double>::infinity();
    for (PairContact& contact : contacts) {
        const PhaseState a = state_of(contact.first, time);
        const PhaseState b = state_of(contact.second, time);
        contact.approach = approach_of({a.position, a.velocity, {}}, {b.position, b.velocity, {}});
        fastest = std::max(fastest, contact.approach);
    }
    // Because of rounding, all contacts may be separating. One of them still counts as an impact, so that members
    // continue.
    const double least = fastest > 0.0 ? fastest * (1.0 - kSameApproach) : fastest;
    std::erase_if(contacts, [&](const PairContact& contact) { return contact.approach < least; });
}

/// Moves the members of contacts to the time, resolves their impacts, and lets them continue.
void EventIsland::resolve(std::vector<PairContact>& contacts, double time) {
    std::vector<std::size_t> changed;
    for (const PairContact& contact : contacts) changed.push_back(contact.first), changed.push_back(contact.second);
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const std::size_t m : changed) {
        bring(m, time);
        changed_at_[m] = time;
    }
    for (const PairContact& contact : contacts) count_repetition(contact, time);
    // Missed contacts count as impacts, too, so that every step ends.
    for (const PairContact& contact : contacts) {
        for (const std::size_t m : {contact.first, contact.second}) {
            most_of_one_ = std::max(most_of_one_, ++(*members_)[m].impacts);
        }
    }
    std::erase_if(contacts, [&](const PairContact& c) { return is_missed(c, time); });
    std::vector<PairBody> bodies;
    for (const std::size_t m : changed) bodies.push_back(body_of((*members_)[m]));
    const std::vector<PairBody> before = bodies;
    const auto number = [&](std::size_t m) {
        return static_cast<std::size_t>(std::lower_bound(changed.begin(), changed.end(), m) - changed.begin());
    };
    std::vector<std::uint8_t> is_hit(changed.size(), 0);
    for (PairContact& contact : contacts) {
        contact.first = number(contact.first), contact.second = number(contact.second);
        is_hit[contact.first] = is_hit[contact.second] = 1;
    }
    // Members with the same centre, such as children spawned at one position, have no normal.
    std::erase_if(contacts,
                  [&](const PairContact& c) { return before[c.first].position == before[c.second].position; });
    if (!contacts.empty()) {
        resolve_pair_impacts(materials_, response_.rules().settings.resting_speed, bodies, contacts);
        for (const PairContact& contact : contacts) record(contact, changed, before, bodies, time);
        if (scratch_->record_motions) record_meeting(contacts, changed, before, bodies, time);
    }
    for (std::size_t k = 0; k < changed.size(); ++k) {
        const std::size_t m = changed[k];
        if (is_still(m)) continue;
        if (is_hit[k] != 0) write_back(m, bodies[k]);
        go_on(m);
    }
    predict_anew(changed);
}

/// Counts the impacts of a pair that follow each other without other impacts, and without parting in between. Forces
/// then press the pair together. Elastic spheres would go on like this for ever.
void EventIsland::count_repetition(const PairContact& contact, double time) {
    const IslandMember& a = (*members_)[contact.first];
    const IslandMember& b = (*members_)[contact.second];
    Repetition& first = repeated_[contact.first];
    Repetition& second = repeated_[contact.second];
    const ForceInput& at_a = a.moving.state;
    const ForceInput& at_b = b.moving.state;
    const double approach = approach_of({at_a.position, at_a.velocity, {}}, {at_b.position, at_b.velocity, {}});
    // Spheres with the same centre have no approach. They do not part.
    const bool has_parted =
        std::fabs(approach) * (time - first.time) > kPressedOverlap * std::min(a.radius(), b.radius());
    const bool is_repeated = first.partner == contact.second && second.partner == contact.first && !has_parted;
    const std::uint32_t count = is_repeated ? first.count + 1 : 1;
    first = {contact.second, count, time};
    second = {contact.first, count, time};
    const PairMaterial& law = materials_.of(a.material, b.material);
    // Without losses there is always a rebound. The sign of a slow approach is only rounding.
    const bool rebounds = law.restitution_at(approach) == 1.0 ||
                          rebound_speed(law, response_.rules().settings.resting_speed, approach) > 0.0;
    is_pressed_ = is_pressed_ || count > (rebounds ? kMostRepeatedImpacts : kMostDeadImpacts);
}

/// Sets a member's motion after an impact. Its contacts with surfaces are found again.
void EventIsland::write_back(std::size_t m, const PairBody& body) {
    IslandMember& member = (*members_)[m];
    member.is_free = false;  // go_to() does not clear it for a member that is hit at the start of the step
    MovingParticle& moving = member.moving;
    const RecordedMotion before = moving.recorded_motion();
    member.pair_velocity_change += body.velocity - moving.state.velocity;
    moving.state.velocity = body.velocity;
    moving.planned = nullptr;
    if (moving.state.radius > 0.0) moving.spin = (member.radius() / moving.state.radius) * body.spin;
    moving.contact = {};
    moving.attachment.reset();
    moving.candidates = {};
    if (scratch_->record_motions) {
        MotionPart part;
        part.kind = MotionPart::Kind::driven;
        part.time = moving.state.time;
        part.radius = moving.state.radius;
        part.begin = before;
        part.end = moving.recorded_motion();
        member.lists.motions.push_back(part);
    }
}

/// Lets a member continue from its present position, unless it has spent its impact budget.
void EventIsland::go_on(std::size_t m) {
    IslandMember& member = (*members_)[m];
    resume(m);
    if (member.impacts < budget_) return;
    member.is_cut_off = true;
    member.outcome.unsimulated_time += member.end - member.moving.state.time;
    member.moving.step_end = member.end;
}

/// Plans the rest of a step in which forces have already acted as a kick at the start.
void EventIsland::resume(std::size_t m) {
    const ResponseRules& rules = response_.rules();
    MovingParticle& moving = (*members_)[m].moving;
    if (!kicks_first(rules.settings.integrator.kind)) return;
    Flight before;
    before.kick_duration = rules.settings.time_step;
    resumed_[m] = resume_flight(rules.settings.integrator, rules.forces, moving.state, before,
                                (*members_)[m].end - moving.state.time);
    moving.planned = &resumed_[m];
}

void EventIsland::record(const PairContact& contact, const std::vector<std::size_t>& changed,
                         const std::vector<PairBody>& before, const std::vector<PairBody>& after, double time) {
    std::size_t first = contact.first;
    std::size_t second = contact.second;
    const auto moving_of = [&](std::size_t k) -> const MovingParticle& { return (*members_)[changed[k]].moving; };
    double sign = 1.0;
    if (moving_of(first).id > moving_of(second).id) std::swap(first, second), sign = -1.0;
    impacts_.push_back({time, moving_of(first).id, moving_of(second).id, before[first].position, -sign * contact.normal,
                        before[first].velocity, after[first].velocity, sign * contact.impulse, contact.approach,
                        moving_of(first).state.mass, before[first].radius});
}

void EventIsland::record_meeting(std::span<const PairContact> contacts, const std::vector<std::size_t>& changed,
                                 const std::vector<PairBody>& before, const std::vector<PairBody>& after, double time) {
    PairMeeting meeting{time, {}, {}};
    for (std::size_t k = 0; k < changed.size(); ++k) {
        const MovingParticle& moving = (*members_)[changed[k]].moving;
        const PairBody& body = before[k];
        meeting.spheres.push_back({moving.id,
                                   moving.state.mass,
                                   body.radius,
                                   body.inverse_mass == 0.0,
                                   {body.position, body.velocity, body.spin},
                                   {after[k].position, after[k].velocity, after[k].spin},
                                   body.material,
                                   (*members_)[changed[k]].contact_path});
    }
    for (const PairContact& contact : contacts) {
        meeting.contacts.push_back({contact.first, contact.second, contact.impulse});
    }
    meetings_.push_back(std::move(meeting));
}

}  // namespace ricochet
