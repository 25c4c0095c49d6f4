/// \file
/// Records the parts of a particle's step in their order.
#pragma once

#include <array>
#include <span>
#include <utility>

#include "ricochet/core/motion_part.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/response/reference_frame.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Records the motion of a particle, if MoveScratch::record_motions is set. Each call records the motion since the
/// previous call. All arguments must outlive the object.
class MotionLog {
public:
    MotionLog(const ResponseRules& rules, const MovingParticle& particle, MoveScratch& scratch,
              const ReferenceFrame& reference)
        : rules_(rules), particle_(particle), scratch_(scratch), reference_(reference) {
        if (!scratch.record_motions) return;
        scratch.supported_by.clear();
        last_ = motion(), time_ = particle.state.time;
    }

    void note_flight() {
        if (!scratch_.record_motions) return;
        if (particle_.state.time > time_) scratch_.supported_by.clear();
        add(MotionPart::Kind::flight, {}, true);
    }
    /// Records an instantaneous change of motion, by impacts on surfaces or by release from them, if there is any.
    void note_impact() {
        if (!scratch_.record_motions) return;
        const bool is_driven = std::exchange(scratch_.driven, false) || reference_.is_moving();
        if (motion() == last_) return;
        add(is_driven ? MotionPart::Kind::driven : MotionPart::Kind::impact, {}, true);
    }
    /// Records contact along the first part of a path. force: force per unit mass at the start, in m/s^2. acts: false
    /// if the velocity contains the forces since the start of the step. supported_by: the supporting surfaces.
    void note_contact(const Vec3& force, const Path& path, bool acts, std::span<const SurfaceId> supported_by) {
        if (!acts) return note_stay(supported_by);
        if (!scratch_.record_motions) return;
        const bool is_steady = rules_.forces.is_uniform_for(particle_.state);
        ForceInput middle = particle_.state;
        const double elapsed = middle.time - time_;
        middle.time -= 0.5 * elapsed;
        middle.position = path.position(0.5 * elapsed);
        middle.velocity = path.velocity(0.5 * elapsed);
        const Vec3 half_way = is_steady ? force : rules_.forces.acceleration(middle);
        add_contact({force, half_way, rules_.forces.acceleration(particle_.state)}, is_steady, supported_by);
    }
    /// Records contact in which no force has done work.
    void note_stay(std::span<const SurfaceId> supported_by) {
        if (scratch_.record_motions) add_contact({}, true, supported_by);
    }

private:
    [[nodiscard]] RecordedMotion motion() const {
        return reference_.in_world(particle_.recorded_motion(), particle_.state.time);
    }
    void add_contact(const std::array<Vec3, 3>& forces, bool steady, std::span<const SurfaceId> supported_by) {
        const bool is_driven = std::exchange(scratch_.driven, false) || reference_.is_moving();
        add(is_driven ? MotionPart::Kind::driven : MotionPart::Kind::contact, forces, steady);
        scratch_.supported_by.assign(supported_by.begin(), supported_by.end());
    }
    void add(MotionPart::Kind kind, const std::array<Vec3, 3>& forces, bool steady) {
        const RecordedMotion begin = std::exchange(last_, motion());
        const double time = std::exchange(time_, particle_.state.time);
        scratch_.motions.push_back({kind, time, time_ - time, particle_.state.radius, begin, last_, forces, steady});
    }

    const ResponseRules& rules_;
    const MovingParticle& particle_;
    MoveScratch& scratch_;
    const ReferenceFrame& reference_;
    RecordedMotion last_;
    double time_ = 0.0;  // s
};

}  // namespace ricochet
