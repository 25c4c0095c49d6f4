#include "ricochet/simulation/modules.h"

#include <algorithm>
#include <utility>

#include "ricochet/dynamics/settings_table.h"
#include "ricochet/simulation/state_archive.h"

namespace ricochet {

BodiesModule::BodiesModule(std::vector<BodyDescription> bodies, const ModuleParts& parts)
    : parts_(parts),
      motion_(std::move(bodies), parts.scene.frames(), parts.scene.moving(), parts.response.rules().forces,
              parts.options) {
    if (motion_.is_active()) motion_.plan(0.0, parts.options.time_step, 0.0);
}

void BodiesModule::begin_step(const TimeSpan& step) {
    if (!motion_.is_active()) return;
    motion_.begin_step();
    motion_.plan(step.begin, step.end, oldest_position());
}

void BodiesModule::before_generation(const ParticleRange& generation, const TimeSpan& /*step*/) {
    if (motion_.is_active() && !generation.are_children) parts_.mover.begin_step();
}

/// Children repeat the substeps that the other particles have already taken, with the bodies on the same paths.
double BodiesModule::plan(const ParticleRange& generation, const TimeSpan& rest) {
    if (!motion_.is_active()) return rest.end;
    TimeSpan part = rest;
    if (generation.are_children) {
        part.end = motion_.repeat_substep(rest.begin);
    } else {
        part.end = motion_.next_substep_end(rest.begin, rest.end);
        motion_.plan(part.begin, part.end, oldest_position());
        if (!parts_.scene.moving().empty()) part.end = settle(generation, part);
    }
    parts_.scene.begin_step(part);
    return part.end;
}

/// Plans a substep repeatedly, until planned loads agree with the particles' loads. Returns its end, in s.
double BodiesModule::settle(const ParticleRange& generation, TimeSpan part) {
    for (int round = 0;; ++round) {
        parts_.scene.begin_step(part);
        const std::vector<ColliderLoad> preview = parts_.mover.preview(generation, part);
        const bool is_planned_again = motion_.plan_again(preview, motion_.cut_by(preview), round);
        part.end = motion_.planned_end();
        if (!is_planned_again) return part.end;
    }
}

/// Returns the earliest time, in s, of a stored position, at most the step's start, where children may start.
double BodiesModule::oldest_position() const {
    const ParticleStore& store = parts_.population.store();
    const double now = parts_.clock.time_at(parts_.recorder.statistics().steps);
    double oldest = now;
    for (std::size_t i = 0; i < store.size(); ++i) oldest = std::min(oldest, store.stored_time(i, now));
    return oldest;
}

void BodiesModule::record(const ParticleRange& generation, const std::vector<BlockRecord>& /*blocks*/,
                          std::vector<ColliderLoad>& loads) {
    if (!motion_.is_active()) return;
    const std::vector<ColliderLoad> given = loads;
    for (ColliderLoad& load : loads) load.work += motion_.work_by_yielding(load);
    if (generation.are_children) {
        motion_.take(given);
        return;
    }
    motion_.follow(given);
    ++parts_.recorder.statistics().body_parts;
}

const char* BodiesModule::fault(double time) const {
    if (!motion_.is_active()) return nullptr;
    if (!motion_.is_sound(time)) return "a body with an impossible path";
    const auto is_sound = [](const DrivenBody& body) {
        return is_in_range(body.center()) && is_in_range(body.velocity()) && is_in_range(body.angular_velocity());
    };
    const bool are_sound = std::ranges::all_of(bodies(), is_sound);
    return are_sound ? nullptr : "a body with a position or velocity out of range";
}

void BodiesModule::add_to_fingerprint(StateHash& hash) const {
    for (const DrivenBody& body : bodies()) {
        const BodyDescription& b = body.description();
        add_numbers(hash, b.mass, b.inertia.xx, b.inertia.yy, b.inertia.zz, b.inertia.xy, b.inertia.xz, b.inertia.yz,
                    b.joint);
        add_settings(hash, b.settings, kJointTable);
        add_numbers(hash, b.feels_forces);
        hash.add(b.center);
        hash.add(b.axis);
    }
}

template <class Archive>
void BodiesModule::archive_bodies(Archive& a) {
    expect(a, static_cast<std::uint64_t>(bodies().size()), "the state belongs to other bodies");
    motion_.archive(a);
}

void BodiesModule::archive(BinaryWriter& a) { archive_bodies(a); }
void BodiesModule::archive(BinaryReader& a) { archive_bodies(a); }

}  // namespace ricochet
