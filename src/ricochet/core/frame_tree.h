/// \file
/// Moving frames of reference that stand on each other, like the links of an arm: where each is at a time, and how it
/// moves then, differentiated exactly along the chain.
/// Method: forward kinematics of serial chains; velocities of composed rigid motions as in J. J. Craig, "Introduction
/// to Robotics: Mechanics and Control", 3rd ed., 2005, chapter 5.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ricochet/core/keyed_curve.h"
#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// A turn about an axis through the frame's origin, by the right-hand rule.
struct KeyedRotation {
    Vec3 axis{0, 0, 1};          ///< of any length but zero
    KeyedCurve<double> degrees;  ///< the angle
};
/// The trajectory of the frame's origin.
struct KeyedTranslation {
    KeyedCurve<Vec3> path;  ///< m
};
/// A steady turn about an axis through the frame's origin.
struct Spin {
    Vec3 axis{0, 0, 1};  ///< of any length but zero
    double rate = 0.0;   ///< degrees/s, by the right-hand rule; the angle is 0 at 0 s
};
/// A turn to and fro, by the angle amplitude sin(2 pi (frequency t + phase / 360)).
struct Swing {
    Vec3 axis{0, 0, 1};      ///< of any length but zero
    double amplitude = 0.0;  ///< degrees
    double frequency = 0.0;  ///< Hz
    double phase = 0.0;      ///< degrees
};
/// A way to and fro, by the offset amplitude sin(2 pi (frequency t + phase / 360)).
struct Oscillation {
    Vec3 amplitude;          ///< m
    double frequency = 0.0;  ///< Hz
    double phase = 0.0;      ///< degrees
};
using FrameMotion = std::variant<KeyedRotation, KeyedTranslation, Spin, Swing, Oscillation>;

/// One frame as it stands in its parent: moved, turned, and then moved by its motions one after the other, each in the
/// axes that those before it have led to.
struct FrameDescription {
    std::string name;
    std::string parent;                  ///< empty: the world
    Vec3 translation;                    ///< m, of the origin in the parent's axes
    Vec3 rotation_axis{0, 0, 1};         ///< of any length but zero
    double rotation_degrees = 0.0;       ///< about rotation_axis, right-hand rule
    std::vector<FrameMotion> motions{};  ///< in order
};

/// Where a frame is at one time, and how it moves.
struct MovingPose {
    AffineMap world_from_frame;  ///< a rotation and the origin's position, m
    Vec3 velocity;               ///< of the origin, m/s
    Vec3 angular_velocity;       ///< rad/s, in world axes

    /// Velocity, in world axes, of the frame's own point at p (frame coordinates): v + w x (R p), m/s.
    [[nodiscard]] Vec3 velocity_of(const Vec3& p) const {
        return velocity + cross(angular_velocity, world_from_frame.direction(p));
    }
};

/// The first frame whose parents lead back to it; nothing when there is none. Unknown parents count as the world.
[[nodiscard]] std::optional<std::size_t> frame_in_circle(std::span<const FrameDescription> frames);

/// Frames by name. Immutable: safe from any number of threads; the same bits on every system.
class FrameTree {
public:
    FrameTree() = default;
    /// Throws InputError, naming the frame, for a name that is empty or taken, an unknown parent, parents that lead
    /// back, an axis without length, or an offset that is not finite.
    explicit FrameTree(std::vector<FrameDescription> frames);

    [[nodiscard]] std::size_t size() const { return frames_.size(); }
    /// Throws InputError unless frame < size(), as at() does.
    [[nodiscard]] const FrameDescription& description(std::size_t frame) const;
    /// The number of the frame of that name.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
    /// The frame's pose and motion at a time (s).
    [[nodiscard]] MovingPose at(std::size_t frame, double time) const;

private:
    std::vector<FrameDescription> frames_;
    std::vector<std::vector<std::size_t>> chains_;  // of each frame: from the one that stands in the world to itself
};

}  // namespace ricochet
