/// \file
/// Tree of moving frames of reference, like the links of an arm. Computes the pose, velocity and acceleration of each
/// frame at a time. The derivatives are exact along the chain of ancestors.
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

/// Rotation about an axis through the frame's origin, by the right-hand rule.
struct KeyedRotation {
    Vec3 axis{0, 0, 1};          ///< of any nonzero length
    KeyedCurve<double> degrees;  ///< the angle
};
/// Trajectory of the frame's origin.
struct KeyedTranslation {
    KeyedCurve<Vec3> path;  ///< m
};
/// Rotation at a constant rate about an axis through the frame's origin.
struct Spin {
    Vec3 axis{0, 0, 1};  ///< of any nonzero length
    double rate = 0.0;   ///< degrees/s, by the right-hand rule; the angle is 0 at 0 s
};
/// Oscillating rotation by the angle amplitude * sin(2 pi (frequency t + phase / 360)).
struct Swing {
    Vec3 axis{0, 0, 1};      ///< of any nonzero length
    double amplitude = 0.0;  ///< degrees
    double frequency = 0.0;  ///< Hz
    double phase = 0.0;      ///< degrees
};
/// Oscillating translation by the offset amplitude * sin(2 pi (frequency t + phase / 360)).
struct Oscillation {
    Vec3 amplitude;          ///< m
    double frequency = 0.0;  ///< Hz
    double phase = 0.0;      ///< degrees
};
/// Scale along the frame's axes, about its origin. The scale also applies to the later motions of the frame and to its
/// children.
struct KeyedScale {
    KeyedCurve<Vec3> factors;  ///< all above 0 at keys
};
using FrameMotion = std::variant<KeyedRotation, KeyedTranslation, Spin, Swing, Oscillation, KeyedScale>;

/// Description of a frame relative to its parent: a translation, a rotation, and then its motions one after the other.
/// Each motion acts in the axes that result from the motions before it.
struct FrameDescription {
    std::string name;
    std::string parent;                  ///< empty: the world
    Vec3 translation;                    ///< position of the origin in the parent's axes, in m
    Vec3 rotation_axis{0, 0, 1};         ///< of any nonzero length
    double rotation_degrees = 0.0;       ///< about rotation_axis, right-hand rule
    std::vector<FrameMotion> motions{};  ///< in order
    /// The frame belongs to a dynamic body: it starts at the given pose and then follows the paths from set_paths().
    /// Its parent is the world, and the frame has no motions.
    bool is_driven = false;
};

/// Pose of a frame at one time: a rotation about an axis through its origin, and the position of the origin.
struct KeyPose {
    double time = 0.0;     ///< s
    Vec3 position;         ///< m
    Vec3 axis{0, 0, 1};    ///< of any nonzero length
    double degrees = 0.0;  ///< by the right-hand rule
};

/// Returns the motions of a frame that passes through the given poses. Between two poses the origin moves at constant
/// velocity. The frame rotates about one axis at a constant rate, by the smaller of the two possible angles. Before the
/// first pose and after the last the frame is at rest. Throws InputError like KeyedCurve. Source: K. Shoemake,
/// "Animating rotation with quaternion curves", SIGGRAPH 1985.
[[nodiscard]] std::vector<FrameMotion> motions_through(const std::vector<KeyPose>& poses);

/// Returns the first frame that is its own ancestor, if there is one. Unknown parents count as the world.
[[nodiscard]] std::optional<std::size_t> frame_in_circle(std::span<const FrameDescription> frames);

/// Frames by name. Any number of threads may read it, but not while set_paths() runs. Results have the same bits on
/// every system.
class FrameTree {
public:
    FrameTree() = default;
    /// Throws InputError, naming the frame, for:
    /// - a name that is empty or used twice;
    /// - an unknown parent, or a frame that is its own ancestor;
    /// - an axis without length, an offset that is not finite, or factors that are not above 0;
    /// - a driven frame that has a parent or motions.
    explicit FrameTree(std::vector<FrameDescription> frames);

    [[nodiscard]] std::size_t size() const { return frames_.size(); }
    /// Returns the description of a frame. Like at(), throws InputError unless frame < size().
    [[nodiscard]] const FrameDescription& description(std::size_t frame) const;
    /// Returns the number of the frame with that name.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
    /// Returns true if a motion of the frame or of one of its ancestors is a scale. Such a frame is not rigid.
    [[nodiscard]] bool is_scaled(std::size_t frame) const;
    /// Returns pose and motion, at a time in s, of a frame that is not scaled. Throws InputError for a scaled frame.
    [[nodiscard]] MovingPose at(std::size_t frame, double time) const;
    /// Returns the map from any frame into the world at a time, in s, including all scales.
    [[nodiscard]] AffineMap map(std::size_t frame, double time) const;
    /// Returns bounds of the frame's motion over [from, to], in s. Scales count as part of the rotation. The bounds
    /// include the derivatives on both sides of a key.
    [[nodiscard]] MotionBounds bounds(std::size_t frame, double from, double to) const;
    /// Returns the first time after `time`, in s, with a key in a curve of the frame or its ancestors; infinity if
    /// there is none. Derivatives can jump at a key.
    [[nodiscard]] double next_key(std::size_t frame, double time) const;
    /// Returns a hash of the motion: the descriptions of the frame and its ancestors, without names.
    [[nodiscard]] std::uint64_t hash(std::size_t frame) const;

    /// Sets the past and future motion of a driven frame. paths: at least one; each continues the path before it
    /// without a gap. The first path also applies before its interval, and the last one after its interval. Throws
    /// InputError for frames that are not driven.
    void set_paths(std::size_t frame, std::vector<BodyPath> paths);
    /// Change the list of paths in place. These functions append a path, replace the last path, or remove the paths
    /// that end before a time, in s. The last path is never removed.
    void append_path(std::size_t frame, const BodyPath& path);
    void replace_last_path(std::size_t frame, const BodyPath& path);
    void forget_paths(std::size_t frame, double before);
    [[nodiscard]] const std::vector<BodyPath>& paths(std::size_t frame) const { return paths_[frame]; }

private:
    void require_driven(std::size_t frame, bool has_paths) const;
    void step_into(MovingPose& pose, std::size_t frame, double time) const;

    std::vector<FrameDescription> frames_;
    std::vector<std::vector<BodyPath>> paths_;      // one list per frame; empty except for driven frames with paths
    std::vector<std::vector<std::size_t>> chains_;  // per frame: stored chain of frames that ends with it
    std::vector<bool> is_scaled_;                   // one per frame
};

}  // namespace ricochet
