// Motion of a frame through given poses, with one rotation from each pose to the next.
#include <algorithm>
#include <utility>

#include "ricochet/core/frame_tree.h"
#include "ricochet/core/portable_math.h"

namespace ricochet {
namespace {

/// A unit quaternion.
struct Quaternion {
    double w = 1.0;
    Vec3 v{};
};

Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
}

Quaternion turn_of(const KeyPose& pose) {
    const double size = length(pose.axis);
    if (!(size > 0.0) || pose.degrees == 0.0) return {};
    const double half = pose.degrees / 720.0;  // turns
    return {sine_of_turns(half + 0.25), (sine_of_turns(half) / size) * pose.axis};
}

/// Returns the smallest rotation that a quaternion describes. Its angle grows from 0 at time `from` to the full angle
/// at time `to`. A whole turn becomes no rotation.
KeyedRotation shortest_turn(Quaternion q, double from, double to) {
    if (q.w < 0.0) q = {-q.w, -q.v};
    const double sine = length(q.v);
    KeyedRotation turn;
    if (sine == 0.0) return turn;
    const double degrees = 720.0 * turns_of(sine, q.w);
    turn.axis = q.v / sine;
    turn.degrees = KeyedCurve<double>({{from, 0.0}, {to, degrees}});
    return turn;
}

}  // namespace

std::vector<FrameMotion> motions_through(const std::vector<KeyPose>& poses) {
    std::vector<CurveKey<Vec3>> translation;
    translation.reserve(poses.size());
    for (const KeyPose& pose : poses) translation.push_back({pose.time, pose.position});
    std::vector<FrameMotion> motions{KeyedTranslation{KeyedCurve<Vec3>(std::move(translation))}};
    const KeyPose& first = poses.front();
    if (first.degrees != 0.0) motions.emplace_back(KeyedRotation{first.axis, KeyedCurve<double>(first.degrees)});
    for (std::size_t k = 1; k < poses.size(); ++k) {
        const Quaternion before = turn_of(poses[k - 1]);
        const Quaternion back{before.w, -before.v};
        KeyedRotation turn = shortest_turn(product(back, turn_of(poses[k])), poses[k - 1].time, poses[k].time);
        if (turn.degrees.keys().size() > 1) motions.emplace_back(std::move(turn));
    }
    return motions;
}

}  // namespace ricochet
