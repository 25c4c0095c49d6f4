#include "ricochet/response/advect.h"

#include <algorithm>

#include "ricochet/collision/safe_position.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/advector.h"

namespace ricochet {
namespace {

/// Halvings of a step in search of the time at which the flow turns away from a wall: to the last bit of the time.
constexpr int kReleaseHalvings = 60;

}  // namespace

MoveOutcome AdvectResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    return Advector(rules_, particle, duration, scratch).run();
}

MoveOutcome Advector::run() {
    manifold_.touch_again(particle_.contact, touch_rule());
    particle_.contact = {};
    while (remaining_ > 0.0 && !outcome_.frozen) {
        if (outcome_.bounces + stretches_ >= rules_.settings.bounce_budget) {
            outcome_.unsimulated_time = remaining_;
            break;
        }
        const bool is_stopped = rules_.settings.walls == WallRule::stop && is_pressed_at(state_.time);
        if (is_stopped) {
            wait();
        } else {
            go_on();
        }
    }
    if (!outcome_.frozen) finish();
    return outcome_;
}

/// One piece of way: to the end of the step or of the surface under it, or to the next contact.
void Advector::go_on() {
    const FlowAlong along(flow_, manifold_.normals());
    const FlowPath way =
        flow_path(rules_.settings.integrator, along, state_.position, state_.time, remaining_, next_duration_);
    next_duration_ = way.next_duration;
    Path path = way.path;
    const auto pressed = can_be_followed(path) ? hardest_pressed() : std::nullopt;
    if (pressed) {
        ++stretches_;
        const ContactSurface support = manifold_[*pressed];
        if (support.flat) path = held_down(path, support.normal, along);
        path = stretch_on(support, path);
        if (!(path.duration > 0.0)) {  // it is past that surface's end
            manifold_.remove(*pressed);
            return;
        }
    }
    const auto contact = follow(path);
    if (outcome_.frozen) return;
    manifold_.touch_again(touch_rule());
    if (contact) answer(*contact);
}

/// A path along a flat surface, up to where the flow turns away from it. The cubic through both ends would dip into the
/// surface before an end that leaves it; up to there it has no part along the normal.
Path Advector::held_down(const Path& path, const Vec3& normal, const FlowField& along) const {
    Path held = path;
    const auto leaves = [&](double s) { return dot(flow_.velocity(path.position(s), state_.time + s), normal) > 0.0; };
    if (leaves(path.duration)) {
        double before = 0.0;
        double after = path.duration;
        for (int k = 0; k < kReleaseHalvings; ++k) {
            const double middle = 0.5 * (before + after);
            (leaves(middle) ? after : before) = middle;
        }
        held = flow_path(rules_.settings.integrator, along, state_.position, state_.time, after, after).path;
    }
    for (std::size_t k = 1; k < held.c.size(); ++k) held.c[k] -= dot(held.c[k], normal) * normal;
    held.end -= dot(held.end - held.c[0], normal) * normal;
    return held;
}

/// Time passes at a wall, until the flow turns away.
void Advector::wait() {
    const double release = time_to_release();
    state_.time += release;
    remaining_ = std::max(0.0, remaining_ - release);
    if (remaining_ > 0.0) manifold_.clear();  // it is free
}

bool Advector::is_pressed_at(double time) const {
    const Vec3 g = flow_.velocity(state_.position, time);
    const auto normals = manifold_.normals();
    return std::any_of(normals.begin(), normals.end(), [&](const Vec3& normal) { return dot(g, normal) < 0.0; });
}

double Advector::time_to_release() const {
    if (flow_.is_steady() || is_pressed_at(state_.time + remaining_)) return remaining_;
    double held = 0.0;
    double free = remaining_;
    for (int k = 0; k < kReleaseHalvings; ++k) {
        const double middle = 0.5 * (held + free);
        (is_pressed_at(state_.time + middle) ? held : free) = middle;
    }
    return free;
}

/// Moves the particle along the path: to its end, or to the contact that is returned.
std::optional<Contact> Advector::follow(const Path& path) {
    if (!can_be_followed(path)) {
        outcome_.frozen = true;
        return std::nullopt;
    }
    const ContactQueryResult found = find_first_contact(geometry_, {path, state_.radius}, scratch_.contacts);
    std::optional<Contact> contact = found.contact;
    const bool starts_there = contact ? contact->time == 0.0 : state_.radius > 0.0 && found.near.starts_in_overlap();
    if (starts_there && !found.near.surfaces_at(path.c[0]).empty()) {
        leave_surface(found.near);
        return std::nullopt;
    }
    if (contact) {
        const SafePosition safe_position = find_safe_position(found.near, path, *contact, scratch_.contacts.chain);
        outcome_.stayed += safe_position.stayed ? 1 : 0;
        state_.position = safe_position.position;
    } else {
        const CertifiedPath followed = follow_path(found.near, path, path.duration, path.end, scratch_.contacts.chain);
        state_.position = followed.reached;
        if (followed.blocker) contact = contact_with_blocker(found.near, path, followed);
    }
    accept_chain();
    const double elapsed = contact ? contact->time : path.duration;
    state_.velocity = path.velocity(elapsed);
    state_.time += elapsed;
    remaining_ = std::max(0.0, remaining_ - elapsed);
    return contact;
}

/// A centre that was put exactly on a surface has no side yet: it gets the one that the normal points to.
void Advector::leave_surface(const NearSurfaces& near) {
    if (const auto place = step_off(near, state_.position)) {
        if (scratch_.record_segments) scratch_.segments.push_back({state_.position, *place, state_.time});
        state_.position = *place;
        return;
    }
    outcome_.unsimulated_time = remaining_;
    remaining_ = 0.0;
}

void Advector::accept_chain() {
    if (!scratch_.record_segments) return;
    const std::vector<Vec3>& chain = scratch_.contacts.chain;
    for (std::size_t k = 1; k < chain.size(); ++k) scratch_.segments.push_back({chain[k - 1], chain[k], state_.time});
}

/// Counts an impact; the surfaces met come first among those touched.
void Advector::answer(const Contact& contact) {
    ++outcome_.bounces;
    manifold_.replace(contact.all(), touch_rule());
    const Vec3 arriving = state_.velocity;
    const bool stops = rules_.settings.walls == WallRule::stop && is_pressed_at(state_.time);
    state_.velocity = stops ? Vec3{} : project_off(flow_now(), manifold_.normals());
    for (const ContactSurface& surface : contact.all()) {
        impact_.push(surface.surface, Vec3{}, true);
        impact_.record(surface, arriving);
    }
}

/// The velocity that the particle goes on with, and what it is pressed onto.
void Advector::finish() {
    const bool pressed = is_pressed_at(state_.time);
    const bool stopped = pressed && rules_.settings.walls == WallRule::stop;
    state_.velocity = stopped ? Vec3{} : FlowAlong(flow_, manifold_.normals()).velocity(state_.position, state_.time);
    outcome_.resting = pressed && state_.velocity == Vec3{};
    // In a steady flow what does not move never will.
    outcome_.held = outcome_.resting && flow_.is_steady() && outcome_.unsimulated_time == 0.0;
    if (pressed) particle_.contact = manifold_.kept();
}

}  // namespace ricochet
