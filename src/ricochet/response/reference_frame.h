/// \file
/// Reference frames of bodies, for particles in contact with them.
#pragma once

#include <memory>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/motion_part.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// The frame in which a particle's motion is given: the world frame, or the frame of a body.
class ReferenceFrame {
public:
    /// The bodies must outlive the object.
    explicit ReferenceFrame(const MovingColliders& bodies, BodyId body = kWorldBody) : bodies_(&bodies), body_(body) {}
    /// Returns a frame that is always the world frame.
    [[nodiscard]] static const ReferenceFrame& world() {
        static const ReferenceFrame frame;
        return frame;
    }

    [[nodiscard]] BodyId body() const { return body_; }
    [[nodiscard]] bool is_moving() const { return body_ != kWorldBody; }
    void set(BodyId body) { body_ = body; }

    /// Transforms a motion from the frame into the world at a time, in s.
    [[nodiscard]] RecordedMotion in_world(const RecordedMotion& motion, double time) const;
    /// Transforms a motion from the world into the frame at a time, in s.
    [[nodiscard]] RecordedMotion in_frame(const RecordedMotion& motion, double time) const;
    /// Transforms a vector, such as an impulse, from the frame into the world, or from the world into the frame.
    [[nodiscard]] Vec3 direction_in_world(const Vec3& d, double time) const;
    [[nodiscard]] Vec3 direction_in_frame(const Vec3& d, double time) const;

private:
    ReferenceFrame() = default;

    const MovingColliders* bodies_ = nullptr;
    BodyId body_ = kWorldBody;
};

/// The forces of a scene in a body's frame, with the inertial forces and the change of spin that the frame's motion
/// adds. Source: H. Goldstein, C. Poole, J. Safko, "Classical Mechanics", 3rd ed., section 4.10.
class FrameForces final : public Force {
public:
    /// The forces and the bodies must outlive the object.
    FrameForces(const ForceField& forces, const MovingColliders& bodies, BodyId body)
        : forces_(forces), bodies_(bodies), body_(body) {}

    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override;
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& /*input*/) const override {
        return std::nullopt;
    }
    [[nodiscard]] bool is_steady() const override { return false; }
    /// Returns the change of a free particle's spin, in rad/s^2. The spin is relative to the frame and in its axes.
    [[nodiscard]] Vec3 spin_change(const Vec3& spin, double time) const;

private:
    const ForceField& forces_;
    const MovingColliders& bodies_;
    BodyId body_;
};

/// The rules of a run in the frame of each body.
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
