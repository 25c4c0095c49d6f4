/// \file
/// Private to the exact response: how a particle in contact with a body that moves is seen from the body's frame.
#pragma once

#include <memory>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/motion_part.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// The frame that a particle is given in: the world, or that of a body.
class ReferenceFrame {
public:
    /// bodies: null where nothing moves.
    explicit ReferenceFrame(const MovingColliders* bodies) : bodies_(bodies) {}
    /// That of a scene in which nothing moves.
    [[nodiscard]] static const ReferenceFrame& world() {
        static const ReferenceFrame frame(nullptr);
        return frame;
    }

    [[nodiscard]] BodyId body() const { return body_; }
    [[nodiscard]] bool is_moving() const { return body_ != kWorldBody; }
    void set(BodyId body) { body_ = body; }
    /// Only where something moves.
    [[nodiscard]] const MovingColliders& bodies() const { return *bodies_; }

    /// A motion in the frame as the world sees it at a time, s.
    [[nodiscard]] RecordedMotion in_world(const RecordedMotion& motion, double time) const;
    /// The other way round.
    [[nodiscard]] RecordedMotion in_frame(const RecordedMotion& motion, double time) const;
    /// A vector, such as an impulse.
    [[nodiscard]] Vec3 direction_in_world(const Vec3& d, double time) const;
    [[nodiscard]] Vec3 direction_in_frame(const Vec3& d, double time) const;

private:
    const MovingColliders* bodies_;
    BodyId body_ = kWorldBody;
};

/// The forces of a scene as they are seen from a body's frame: with those that its motion adds, and what that adds to a
/// spin. Source: H. Goldstein, C. Poole, J. Safko, "Classical Mechanics", 3rd ed., section 4.10.
class FrameForces final : public Force {
public:
    /// Both must outlive it.
    FrameForces(const ForceField& forces, const MovingColliders& bodies, BodyId body)
        : forces_(forces), bodies_(bodies), body_(body) {}

    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override;
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& /*input*/) const override {
        return std::nullopt;
    }
    [[nodiscard]] bool is_steady() const override { return false; }
    /// rad/s^2, by which a spin (relative to the frame, in its axes) changes where nothing touches the particle.
    [[nodiscard]] Vec3 spin_change(const Vec3& spin, double time) const;

private:
    const ForceField& forces_;
    const MovingColliders& bodies_;
    BodyId body_;
};

/// The rules of a run as they hold in the frame of each body.
class FrameRules {
public:
    explicit FrameRules(const ResponseRules& rules);

    [[nodiscard]] const ResponseRules& rules_of(BodyId body) const { return frame_rules_[body]->rules; }

private:
    struct BodyRules {
        BodyRules(const ResponseRules& rules_at_rest, BodyId body, std::unique_ptr<FrameForces> seen);
        BodyRules(const BodyRules&) = delete;
        BodyRules& operator=(const BodyRules&) = delete;
        [[nodiscard]] static std::vector<std::unique_ptr<Force>> only(std::unique_ptr<FrameForces> force);

        const FrameForces& frame;
        ForceField forces;
        ResponseRules rules;
    };
    std::vector<std::unique_ptr<BodyRules>> frame_rules_;
};

}  // namespace ricochet
