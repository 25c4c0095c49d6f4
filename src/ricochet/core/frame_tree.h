/// \file
/// Moving frames of reference that stand on each other, like the links of an arm: where each is at a time, and how it
/// moves then, differentiated exactly along the chain.
/// Method: forward kinematics of serial chains; velocities of composed rigid motions as in J. J. Craig, "Introduction
/// to Robotics: Mechanics and Control", 3rd ed., 2005, chapter 5.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ricochet/core/body_path.h"
#include "ricochet/core/keyed_curve.h"
#include "ricochet/core/moving_pose.h"
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
/// A scale along the frame's axes, about its origin. What comes after it, and what stands on the frame, is scaled too.
struct KeyedScale {
    KeyedCurve<Vec3> factors;  ///< all above 0 at keys
};
using FrameMotion = std::variant<KeyedRotation, KeyedTranslation, Spin, Swing, Oscillation, KeyedScale>;

/// One frame as it stands in its parent: moved, turned, and then moved by its motions one after the other, each in the
/// axes that those before it have led to.
struct FrameDescription {
    std::string name;
    std::string parent;                  ///< empty: the world
    Vec3 translation;                    ///< m, of the origin in the parent's axes
    Vec3 rotation_axis{0, 0, 1};         ///< of any length but zero
    double rotation_degrees = 0.0;       ///< about rotation_axis, right-hand rule
    std::vector<FrameMotion> motions{};  ///< in order
    /// It moves as set_paths() says from time to time, from where it stands at first: a body that is pushed. It stands
    /// in the world and has no motions.
    bool is_driven = false;
};

/// Where a frame is at a time: turned about an axis through its origin, which is at a position.
struct KeyPose {
    double time = 0.0;     ///< s
    Vec3 position;         ///< m
    Vec3 axis{0, 0, 1};    ///< of any length but zero
    double degrees = 0.0;  ///< by the right-hand rule
};

/// The motions of a frame through poses: between two of them its origin moves steadily on a straight line, and it turns
/// steadily about one axis by the shortest way; before the first and after the last it stands still. Throws InputError
/// as KeyedCurve does. Source: K. Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985.
[[nodiscard]] std::vector<FrameMotion> motions_through(const std::vector<KeyPose>& poses);

/// The first frame whose parents lead back to it; nothing when there is none. Unknown parents count as the world.
[[nodiscard]] std::optional<std::size_t> frame_in_circle(std::span<const FrameDescription> frames);

/// Frames by name. Safe from any number of threads, but not beside set_paths(); the same bits on every system.
class FrameTree {
public:
    FrameTree() = default;
    /// Throws InputError, naming the frame, for a name that is empty or taken, an unknown parent, parents that lead
    /// back, an axis without length, an offset that is not finite, factors that are not above 0, or a driven frame that
    /// has a parent or motions.
    explicit FrameTree(std::vector<FrameDescription> frames);

    [[nodiscard]] std::size_t size() const { return frames_.size(); }
    /// Throws InputError unless frame < size(), as at() does.
    [[nodiscard]] const FrameDescription& description(std::size_t frame) const;
    /// The number of the frame of that name.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
    /// True where its own motions, or those of a frame that it stands on, have a scale: it is no rigid frame.
    [[nodiscard]] bool is_scaled(std::size_t frame) const;
    /// The pose and motion, at a time (s), of a frame that is not scaled; throws InputError for one that is.
    [[nodiscard]] MovingPose at(std::size_t frame, double time) const;
    /// Where the points of any frame are at a time (s), with all scales.
    [[nodiscard]] AffineMap map(std::size_t frame, double time) const;
    /// Bounds of its motion over [from, to], s, its scales counted as part of the rotation; at keys within, of what is
    /// on both sides of them.
    [[nodiscard]] MotionBounds bounds(std::size_t frame, double from, double to) const;
    /// The first time after `time`, s, at which a curve of it or of the frames that it stands on has a key: derivatives
    /// may jump there; infinite when there is none.
    [[nodiscard]] double next_key(std::size_t frame, double time) const;
    /// Of all that says how it moves: its own description and those of the frames that it stands on, without names.
    [[nodiscard]] std::uint64_t hash(std::size_t frame) const;

    /// How a driven frame has moved, and will: paths that follow each other without a gap, at least one. What comes
    /// before and after is as the first and the last of them say. Throws InputError for other frames.
    void set_paths(std::size_t frame, std::vector<BodyPath> paths);
    /// Of the same list, without a copy of it: another path comes after the last one, or takes the place of the last
    /// one, and those in front are forgotten that end before a time, s, but for the last one.
    void append_path(std::size_t frame, const BodyPath& path);
    void replace_last_path(std::size_t frame, const BodyPath& path);
    void forget_paths(std::size_t frame, double before);
    [[nodiscard]] const std::vector<BodyPath>& paths(std::size_t frame) const { return paths_[frame]; }

private:
    void require_driven(std::size_t frame, bool has_paths) const;
    void step_into(MovingPose& pose, std::size_t frame, double time) const;

    std::vector<FrameDescription> frames_;
    std::vector<std::vector<BodyPath>> paths_;      // one list a frame; empty but for driven ones that have been set
    std::vector<std::vector<std::size_t>> chains_;  // of each frame: from the world, or another frame, to itself
    std::vector<bool> is_scaled_;                   // one a frame
};

}  // namespace ricochet
