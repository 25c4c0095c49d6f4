#include "ricochet/core/frame_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "ricochet/core/checks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/portable_math.h"

namespace ricochet {
namespace {

/// Largest number of frames in one stored chain. A longer chain starts at an ancestor that stores the rest of the
/// chain. The memory of deep trees is thus proportional to their number of frames.
constexpr std::size_t kLongestChain = 16;

/// Frame number that stands for the world in lists of parents.
constexpr std::size_t kWorld = std::numeric_limits<std::size_t>::max();

using Chains = std::vector<std::vector<std::size_t>>;

/// Calls visit(k) for all ancestors of a frame, starting at the one whose parent is the world, and then for the frame.
template <class Visit>
void for_each_in_chain(const std::vector<FrameDescription>& frames, const Chains& chains, std::size_t frame,
                       const Visit& visit) {
    const std::vector<std::size_t>& chain = chains[frame];
    const bool goes_on = !frames[chain.front()].parent.empty();
    if (goes_on) for_each_in_chain(frames, chains, chain.front(), visit);
    for (std::size_t n = goes_on ? 1 : 0; n < chain.size(); ++n) visit(chain[n]);
}

std::unordered_map<std::string_view, std::size_t> numbers_of(std::span<const FrameDescription> frames) {
    std::unordered_map<std::string_view, std::size_t> numbers;
    for (std::size_t i = 0; i < frames.size(); ++i) numbers.emplace(frames[i].name, i);
    return numbers;
}

/// Returns the number of each frame's parent, or kWorld. Unknown parents count as the world.
std::vector<std::size_t> parents_of(std::span<const FrameDescription> frames) {
    const std::unordered_map<std::string_view, std::size_t> numbers = numbers_of(frames);
    std::vector<std::size_t> parents;
    for (const FrameDescription& frame : frames) {
        const auto found = frame.parent.empty() ? numbers.end() : numbers.find(frame.parent);
        parents.push_back(found == numbers.end() ? kWorld : found->second);
    }
    return parents;
}

/// Returns the numbers of all frames in an order in which each frame follows its parent. The parents must not form a
/// cycle.
std::vector<std::size_t> parents_first(const std::vector<std::size_t>& parents) {
    std::vector<std::size_t> order;
    std::vector<std::uint8_t> is_known(parents.size(), 0);
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < parents.size(); ++i) {
        for (std::size_t k = i; k != kWorld && is_known[k] == 0; k = parents[k]) open.push_back(k), is_known[k] = 1;
        order.insert(order.end(), open.rbegin(), open.rend());
        open.clear();
    }
    return order;
}

/// Value of a sine of amplitude 1, with its derivatives, in 1/s and 1/s^2.
struct Wave {
    Wave(double frequency, double phase, double time) {
        // Whole periods are removed before the phase is added, because adding the phase to a large number of periods
        // would round it away.
        const double turns = std::remainder(frequency * time, 1.0) + phase / 360.0;
        const double pulsation = 2.0 * std::numbers::pi * frequency;
        value = sine_of_turns(turns);
        rate = pulsation * sine_of_turns(turns + 0.25);
        second = -pulsation * pulsation * value;
    }
    double value, rate, second;
};

void move(MovingPose& pose, const KeyedRotation& motion, double time) {
    const KeyedCurve<double>& angle = motion.degrees;
    turn(pose, motion.axis, angle.value(time), angle.derivative(time), angle.second_derivative(time));
}
void move(MovingPose& pose, const KeyedTranslation& motion, double time) {
    shift(pose, motion.path.value(time), motion.path.derivative(time), motion.path.second_derivative(time));
}
void move(MovingPose& pose, const Spin& motion, double time) {
    turn(pose, motion.axis, motion.rate * time, motion.rate);
}
void move(MovingPose& pose, const Swing& motion, double time) {
    const Wave wave(motion.frequency, motion.phase, time);
    const double size = motion.amplitude;
    turn(pose, motion.axis, size * wave.value, size * wave.rate, size * wave.second);
}
void move(MovingPose& pose, const Oscillation& motion, double time) {
    const Wave wave(motion.frequency, motion.phase, time);
    const Vec3& size = motion.amplitude;
    shift(pose, wave.value * size, wave.rate * size, wave.second * size);
}

void move(MovingPose& pose, const KeyedScale& motion, double time) {
    scale(pose.world_from_frame, motion.factors.value(time));
}

DerivativeBounds wave_bounds(double amplitude, double frequency) {
    const double pulsation = 2.0 * std::numbers::pi * std::fabs(frequency);
    DerivativeBounds bounds{amplitude};
    for (std::size_t n = 1; n < bounds.size(); ++n) bounds[n] = pulsation * bounds[n - 1];
    return bounds;
}

/// Visitor that extends the bounds of a chain by one motion after the other.
struct BoundsOf {
    MotionBounds& bounds;
    double from, to;

    void shift(const DerivativeBounds& offset) const {
        const DerivativeBounds moved = product(bounds.rotation, offset);
        for (std::size_t n = 1; n < moved.size(); ++n) bounds.origin[n] += moved[n];
    }
    void turn(const DerivativeBounds& degrees) const {
        bounds.rotation = product(bounds.rotation, turn_bounds(degrees));
    }
    void operator()(const KeyedRotation& motion) const { turn(motion.degrees.bounds(from, to)); }
    void operator()(const KeyedTranslation& motion) const { shift(motion.path.bounds(from, to)); }
    void operator()(const Spin& motion) const { turn({0.0, std::fabs(motion.rate), 0.0, 0.0, 0.0}); }
    void operator()(const Swing& motion) const { turn(wave_bounds(std::fabs(motion.amplitude), motion.frequency)); }
    void operator()(const Oscillation& motion) const { shift(wave_bounds(length(motion.amplitude), motion.frequency)); }
    void operator()(const KeyedScale& motion) const {
        bounds.rotation = product(bounds.rotation, motion.factors.bounds(from, to));
    }
};

double next_key_of(const FrameMotion& motion, double time) {
    if (const auto* turning = std::get_if<KeyedRotation>(&motion)) return turning->degrees.next_key(time);
    if (const auto* moving = std::get_if<KeyedTranslation>(&motion)) return moving->path.next_key(time);
    if (const auto* growing = std::get_if<KeyedScale>(&motion)) return growing->factors.next_key(time);
    return std::numeric_limits<double>::infinity();
}

/// Visitor that adds the parameters of a motion to a hash.
struct HashOf {
    StateHash& hash;

    template <class... Values>
    void add(const Values&... values) const {
        (add_one(values), ...);
    }
    void add_one(double value) const { hash.add(value); }
    void add_one(const Vec3& value) const { hash.add(value); }
    template <class Value>
    void add_one(const KeyedCurve<Value>& curve) const {
        hash.add(static_cast<std::uint64_t>(curve.interpolation()));
        hash.add(static_cast<std::uint64_t>(curve.ends()));
        hash.add(static_cast<std::uint64_t>(curve.keys().size()));
        for (const CurveKey<Value>& key : curve.keys()) {
            hash.add(key.time);
            hash.add(key.value);
        }
    }
    void operator()(const KeyedRotation& motion) const { add(motion.axis, motion.degrees); }
    void operator()(const KeyedTranslation& motion) const { add(motion.path); }
    void operator()(const KeyedScale& motion) const { add(motion.factors); }
    void operator()(const Spin& motion) const { add(motion.axis, motion.rate); }
    void operator()(const Swing& motion) const { add(motion.axis, motion.amplitude, motion.frequency, motion.phase); }
    void operator()(const Oscillation& motion) const { add(motion.amplitude, motion.frequency, motion.phase); }
};

void require_factors(const FrameDescription& frame, const KeyedScale& motion) {
    for (const CurveKey<Vec3>& key : motion.factors.keys()) {
        for (int axis = 0; axis < 3; ++axis) {
            if (key.value[axis] > 0.0) continue;
            throw InputError(fmt::format("frame '{}': found the factor {} of a scale, expected one above 0", frame.name,
                                         key.value[axis]));
        }
    }
}

bool is_scale(const FrameMotion& motion) { return std::holds_alternative<KeyedScale>(motion); }

// Checks the values of one frame, without its parent, and normalises its axes.
void prepare(FrameDescription& frame) {
    const auto of_frame = [&](const char* what) { return fmt::format("frame '{}': {}", frame.name, what); };
    detail::require_finite(frame.translation, of_frame("the translation"), "m");
    detail::require_finite(frame.rotation_degrees, of_frame("the rotation"), "degrees");
    frame.rotation_axis = detail::unit_direction(frame.rotation_axis, of_frame("the rotation's axis"));
    for (FrameMotion& motion : frame.motions) {
        std::visit(
            [&](auto& m) {
                if constexpr (requires { m.axis; })
                    m.axis = detail::unit_direction(m.axis, of_frame("a motion's axis"));
                if constexpr (requires { m.rate; })
                    detail::require_finite(m.rate, of_frame("a motion's rate"), "degrees/s");
                if constexpr (requires { m.frequency; }) {
                    detail::require_finite(m.frequency, of_frame("a motion's frequency"), "Hz");
                    detail::require_finite(m.phase, of_frame("a motion's phase"), "degrees");
                    const bool is_angle = std::is_same_v<decltype(m.amplitude), double>;
                    detail::require_finite(m.amplitude, of_frame("a motion's amplitude"), is_angle ? "degrees" : "m");
                }
                if constexpr (requires { m.factors; }) require_factors(frame, m);
            },
            motion);
    }
}

/// Returns the path that is valid at a time. At the border between two paths this is the later one.
const BodyPath& path_at(const std::vector<BodyPath>& paths, double time) {
    const auto later = std::upper_bound(paths.begin(), paths.end(), time,
                                        [](double t, const BodyPath& path) { return t < path.begin; });
    return later == paths.begin() ? paths.front() : *(later - 1);
}

/// Returns the first path that ends at or after a time.
template <class Iterator>
Iterator first_path_to(Iterator begin, Iterator end, double time) {
    return std::partition_point(begin, end, [time](const BodyPath& path) { return path.end < time; });
}

/// Returns bounds of all paths that apply within [from, to].
MotionBounds bounds_of(const std::vector<BodyPath>& paths, double from, double to) {
    MotionBounds all;
    const auto first = first_path_to(paths.begin(), paths.end() - 1, from);
    for (auto path = first; path != paths.end(); ++path) {
        if (path->begin > to && path != first) break;
        const MotionBounds one = path->bounds(from, to);
        for (std::size_t n = 1; n < all.origin.size(); ++n) {
            all.origin[n] = std::max(all.origin[n], one.origin[n]);
            all.rotation[n] = std::max(all.rotation[n], one.rotation[n]);
        }
    }
    return all;
}

}  // namespace

// Every frame is visited once: each walk along the parents ends at the first frame that this or an earlier walk
// visited.
std::optional<std::size_t> frame_in_circle(std::span<const FrameDescription> frames) {
    const std::vector<std::size_t> parents = parents_of(frames);
    std::vector<std::size_t> walk_of(frames.size(), kWorld);  // first walk that visited the frame
    std::size_t first = kWorld;
    for (std::size_t walk = 0; walk < frames.size(); ++walk) {
        std::size_t i = walk;
        for (; i != kWorld && walk_of[i] == kWorld; i = parents[i]) walk_of[i] = walk;
        if (i == kWorld || walk_of[i] != walk) continue;
        first = std::min(first, i);
        for (std::size_t k = parents[i]; k != i; k = parents[k]) first = std::min(first, k);
    }
    return first == kWorld ? std::nullopt : std::optional(first);
}

FrameTree::FrameTree(std::vector<FrameDescription> frames) : frames_(std::move(frames)) {
    const std::unordered_map<std::string_view, std::size_t> numbers = numbers_of(frames_);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        FrameDescription& frame = frames_[i];
        if (frame.name.empty()) throw InputError(fmt::format("frame {} has no name", i));
        if (numbers.at(frame.name) != i) throw InputError(fmt::format("frame '{}': the name is taken", frame.name));
        if (!frame.parent.empty() && !numbers.contains(frame.parent)) {
            throw InputError(fmt::format("frame '{}': there is no parent '{}'", frame.name, frame.parent));
        }
        if (frame.is_driven && (!frame.parent.empty() || !frame.motions.empty())) {
            throw InputError(fmt::format("frame '{}': it is driven, expected no parent and no motions", frame.name));
        }
        prepare(frame);
    }
    paths_.resize(frames_.size());
    if (const auto circle = frame_in_circle(frames_)) {
        throw InputError(fmt::format("frame '{}': its parents lead back to it", frames_[*circle].name));
    }
    const std::vector<std::size_t> parents = parents_of(frames_);
    chains_.resize(frames_.size());
    is_scaled_.resize(frames_.size());
    for (const std::size_t i : parents_first(parents)) {
        const std::vector<FrameMotion>& motions = frames_[i].motions;
        const std::size_t parent = parents[i];
        is_scaled_[i] = (parent != kWorld && is_scaled_[parent]) || std::ranges::any_of(motions, is_scale);
        if (parent != kWorld) {
            const std::vector<std::size_t>& before = chains_[parent];
            chains_[i] = before.size() < kLongestChain ? before : std::vector{parent};
        }
        chains_[i].push_back(i);
    }
}

void FrameTree::require_driven(std::size_t frame, bool has_paths) const {
    require_index(frame, size(), "frame");
    if (!frames_[frame].is_driven || !has_paths) {
        throw InputError(fmt::format("frame '{}': it is not driven, or there are no paths", frames_[frame].name));
    }
}

void FrameTree::set_paths(std::size_t frame, std::vector<BodyPath> paths) {
    require_driven(frame, !paths.empty());
    paths_[frame] = std::move(paths);
}

void FrameTree::append_path(std::size_t frame, const BodyPath& path) {
    require_driven(frame, true);
    paths_[frame].push_back(path);
}

void FrameTree::replace_last_path(std::size_t frame, const BodyPath& path) {
    require_driven(frame, frame < size() && !paths_[frame].empty());
    paths_[frame].back() = path;
}

void FrameTree::forget_paths(std::size_t frame, double before) {
    require_driven(frame, frame < size() && !paths_[frame].empty());
    std::vector<BodyPath>& paths = paths_[frame];
    paths.erase(paths.begin(), first_path_to(paths.begin(), paths.end() - 1, before));
}

void FrameTree::step_into(MovingPose& pose, std::size_t frame, double time) const {
    if (!paths_[frame].empty()) {
        pose = path_at(paths_[frame], time).at(time);
        return;
    }
    const FrameDescription& description = frames_[frame];
    shift(pose, description.translation);
    if (description.rotation_degrees != 0.0) turn(pose, description.rotation_axis, description.rotation_degrees);
    for (const FrameMotion& motion : description.motions) {
        std::visit([&](const auto& m) { move(pose, m, time); }, motion);
    }
}

std::optional<std::size_t> FrameTree::find(std::string_view name) const {
    const auto found = std::ranges::find_if(frames_, [&](const auto& frame) { return frame.name == name; });
    if (name.empty() || found == frames_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - frames_.begin());
}

const FrameDescription& FrameTree::description(std::size_t frame) const {
    require_index(frame, size(), "frame");
    return frames_[frame];
}

bool FrameTree::is_scaled(std::size_t frame) const {
    require_index(frame, size(), "frame");
    return is_scaled_[frame];
}

MovingPose FrameTree::at(std::size_t frame, double time) const {
    require_index(frame, size(), "frame");
    if (is_scaled_[frame]) {
        throw InputError(
            fmt::format("frame '{}': it is scaled, expected one that keeps its size", frames_[frame].name));
    }
    MovingPose pose;
    for_each_in_chain(frames_, chains_, frame, [&](std::size_t k) { step_into(pose, k, time); });
    return pose;
}

AffineMap FrameTree::map(std::size_t frame, double time) const {
    require_index(frame, size(), "frame");
    MovingPose pose;
    for_each_in_chain(frames_, chains_, frame, [&](std::size_t k) { step_into(pose, k, time); });
    return pose.world_from_frame;
}

MotionBounds FrameTree::bounds(std::size_t frame, double from, double to) const {
    require_index(frame, size(), "frame");
    MotionBounds bounds;
    const BoundsOf add{bounds, from, to};
    for_each_in_chain(frames_, chains_, frame, [&](std::size_t k) {
        if (!paths_[k].empty()) {
            bounds = bounds_of(paths_[k], from, to);
            return;
        }
        add.shift({length(frames_[k].translation), 0.0, 0.0, 0.0, 0.0});
        for (const FrameMotion& motion : frames_[k].motions) std::visit(add, motion);
    });
    return bounds;
}

double FrameTree::next_key(std::size_t frame, double time) const {
    require_index(frame, size(), "frame");
    double next = std::numeric_limits<double>::infinity();
    for_each_in_chain(frames_, chains_, frame, [&](std::size_t k) {
        const std::vector<BodyPath>& paths = paths_[k];
        const auto later =
            std::partition_point(paths.begin(), paths.end(), [time](const BodyPath& path) { return path.end <= time; });
        if (later != paths.end()) next = std::min(next, later->end);
        for (const FrameMotion& motion : frames_[k].motions) next = std::min(next, next_key_of(motion, time));
    });
    return next;
}

std::uint64_t FrameTree::hash(std::size_t frame) const {
    require_index(frame, size(), "frame");
    StateHash hash;
    for_each_in_chain(frames_, chains_, frame, [&](std::size_t k) {
        const FrameDescription& link = frames_[k];
        hash.add(link.translation);
        hash.add(link.rotation_axis);
        hash.add(link.rotation_degrees);
        hash.add(static_cast<std::uint64_t>(link.motions.size()));
        for (const FrameMotion& motion : link.motions) {
            hash.add(static_cast<std::uint64_t>(motion.index()));
            std::visit(HashOf{hash}, motion);
        }
    });
    return hash.value();
}

}  // namespace ricochet
