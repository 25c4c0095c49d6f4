#include "ricochet/dynamics/frame_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/portable_math.h"
#include "ricochet/dynamics/checks.h"

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

void step_into(MovingPose& pose, const FrameDescription& frame, double time) {
    shift(pose, frame.translation, {});
    if (frame.rotation_degrees != 0.0) turn(pose, frame.rotation_axis, frame.rotation_degrees, 0.0);
    for (const FrameMotion& motion : frame.motions) {
        if (const auto* rotation = std::get_if<KeyedRotation>(&motion)) {
            turn(pose, rotation->axis, rotation->degrees.value(time), rotation->degrees.derivative(time));
        } else {
            const auto& path = std::get<KeyedTranslation>(motion).path;
            shift(pose, path.value(time), path.derivative(time));
        }
    }
}

// Checks a frame by itself; axes become unit vectors.
void prepare(FrameDescription& frame) {
    const auto of_frame = [&](const char* what) { return fmt::format("frame '{}': {}", frame.name, what); };
    detail::require_finite(frame.translation, of_frame("the translation"), "m");
    detail::require_finite(frame.rotation_degrees, of_frame("the rotation"), "degrees");
    frame.rotation_axis = detail::unit_direction(frame.rotation_axis, of_frame("the rotation's axis"));
    for (FrameMotion& motion : frame.motions) {
        if (auto* rotation = std::get_if<KeyedRotation>(&motion)) {
            rotation->axis = detail::unit_direction(rotation->axis, of_frame("a motion's axis"));
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
