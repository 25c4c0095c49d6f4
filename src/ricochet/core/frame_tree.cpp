#include "ricochet/core/frame_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/portable_math.h"

namespace ricochet {
namespace {

std::optional<std::size_t> place_of(std::span<const FrameDescription> frames, std::string_view name) {
    const auto found =
        std::find_if(frames.begin(), frames.end(), [&](const auto& frame) { return frame.name == name; });
    if (name.empty() || found == frames.end()) return std::nullopt;
    return static_cast<std::size_t>(found - frames.begin());
}

// Moves the frame along its own axes.
void shift(MovingPose& pose, const Vec3& offset, const Vec3& rate) {
    AffineMap& map = pose.world_from_frame;
    const Vec3 moved = map.direction(offset);
    map.translation += moved;
    pose.velocity += cross(pose.angular_velocity, moved) + map.direction(rate);
}

// Rodrigues' formula, applied to each row of the rotation: row' = row R(axis, angle), the turn about -axis of the row.
Vec3 turned_row(const Vec3& row, const Vec3& axis, double sine, double cosine) {
    return cosine * row - sine * cross(axis, row) + ((1.0 - cosine) * dot(axis, row)) * axis;
}

// Turns the frame about one of its own axes, of unit length.
void turn(MovingPose& pose, const Vec3& axis, double degrees, double rate) {
    AffineMap& map = pose.world_from_frame;
    pose.angular_velocity += (rate * (std::numbers::pi / 180.0)) * map.direction(axis);
    const double turns = degrees / 360.0;
    const double sine = sine_of_turns(turns);
    const double cosine = sine_of_turns(turns + 0.25);
    for (Vec3* row : {&map.row_x, &map.row_y, &map.row_z}) *row = turned_row(*row, axis, sine, cosine);
}

/// A sine of amplitude 1, and its derivative, 1/s.
struct Wave {
    Wave(double frequency, double phase, double time) {
        // Whole periods are taken off before the phase is added, which would be lost in many.
        const double turns = std::remainder(frequency * time, 1.0) + phase / 360.0;
        value = sine_of_turns(turns);
        rate = 2.0 * std::numbers::pi * frequency * sine_of_turns(turns + 0.25);
    }
    double value, rate;
};

void move(MovingPose& pose, const KeyedRotation& motion, double time) {
    turn(pose, motion.axis, motion.degrees.value(time), motion.degrees.derivative(time));
}
void move(MovingPose& pose, const KeyedTranslation& motion, double time) {
    shift(pose, motion.path.value(time), motion.path.derivative(time));
}
void move(MovingPose& pose, const Spin& motion, double time) {
    turn(pose, motion.axis, motion.rate * time, motion.rate);
}
void move(MovingPose& pose, const Swing& motion, double time) {
    const Wave wave(motion.frequency, motion.phase, time);
    turn(pose, motion.axis, motion.amplitude * wave.value, motion.amplitude * wave.rate);
}
void move(MovingPose& pose, const Oscillation& motion, double time) {
    const Wave wave(motion.frequency, motion.phase, time);
    shift(pose, wave.value * motion.amplitude, wave.rate * motion.amplitude);
}

void step_into(MovingPose& pose, const FrameDescription& frame, double time) {
    shift(pose, frame.translation, {});
    if (frame.rotation_degrees != 0.0) turn(pose, frame.rotation_axis, frame.rotation_degrees, 0.0);
    for (const FrameMotion& motion : frame.motions) {
        std::visit([&](const auto& m) { move(pose, m, time); }, motion);
    }
}

// Checks a frame by itself; axes become unit vectors.
void prepare(FrameDescription& frame) {
    const auto of_frame = [&](const char* what) { return fmt::format("frame '{}': {}", frame.name, what); };
    detail::require_finite(frame.translation, of_frame("the translation"), "m");
    detail::require_finite(frame.rotation_degrees, of_frame("the rotation"), "degrees");
    frame.rotation_axis = detail::unit_direction(frame.rotation_axis, of_frame("the rotation's axis"));
    const auto check_wave = [&](double frequency, double phase) {
        detail::require_finite(frequency, of_frame("a motion's frequency"), "Hz");
        detail::require_finite(phase, of_frame("a motion's phase"), "degrees");
    };
    for (FrameMotion& motion : frame.motions) {
        std::visit(
            [&](auto& m) {
                if constexpr (requires { m.axis; })
                    m.axis = detail::unit_direction(m.axis, of_frame("a motion's axis"));
                if constexpr (requires { m.rate; })
                    detail::require_finite(m.rate, of_frame("a motion's rate"), "degrees/s");
                if constexpr (requires { m.frequency; }) check_wave(m.frequency, m.phase);
            },
            motion);
        if (const auto* swing = std::get_if<Swing>(&motion)) {
            detail::require_finite(swing->amplitude, of_frame("a motion's amplitude"), "degrees");
        } else if (const auto* way = std::get_if<Oscillation>(&motion)) {
            detail::require_finite(way->amplitude, of_frame("a motion's amplitude"), "m");
        }
    }
}

}  // namespace

std::optional<std::size_t> frame_in_circle(std::span<const FrameDescription> frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
        auto above = place_of(frames, frames[i].parent);
        for (std::size_t steps = 0; above && steps < frames.size(); ++steps) {
            if (*above == i) return i;
            above = place_of(frames, frames[*above].parent);
        }
    }
    return std::nullopt;
}

FrameTree::FrameTree(std::vector<FrameDescription> frames) : frames_(std::move(frames)) {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        FrameDescription& frame = frames_[i];
        if (frame.name.empty()) throw InputError(fmt::format("frame {} has no name", i));
        if (place_of(frames_, frame.name) != i)
            throw InputError(fmt::format("frame '{}': the name is taken", frame.name));
        if (!frame.parent.empty() && !place_of(frames_, frame.parent)) {
            throw InputError(fmt::format("frame '{}': there is no parent '{}'", frame.name, frame.parent));
        }
        prepare(frame);
    }
    if (const auto circle = frame_in_circle(frames_)) {
        throw InputError(fmt::format("frame '{}': its parents lead back to it", frames_[*circle].name));
    }
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        std::vector<std::size_t> chain;
        for (std::optional<std::size_t> k = i; k; k = place_of(frames_, frames_[*k].parent)) chain.push_back(*k);
        std::reverse(chain.begin(), chain.end());
        chains_.push_back(std::move(chain));
    }
}

std::optional<std::size_t> FrameTree::find(std::string_view name) const { return place_of(frames_, name); }

const FrameDescription& FrameTree::description(std::size_t frame) const {
    require_index(frame, size(), "frame");
    return frames_[frame];
}

MovingPose FrameTree::at(std::size_t frame, double time) const {
    require_index(frame, size(), "frame");
    MovingPose pose;
    for (const std::size_t k : chains_[frame]) step_into(pose, frames_[k], time);
    return pose;
}

}  // namespace ricochet
