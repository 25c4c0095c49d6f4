// Keyed curves of a scene, and reference frames that move along them.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/keyed_curve.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

// Keys of a curve.
template <class Value>
struct CurveKeys {
    std::vector<CurveKey<Value>> keys;
    Interpolation interpolation = Interpolation::linear;
    CurveEnds ends = CurveEnds::hold;
};

template <class Value>
const ObjectSpec& curve_key_spec(std::string_view title, std::string_view description) {
    using K = CurveKey<Value>;
    static const ObjectSpec spec =
        object<K>(title, description,
                  {{"time", &K::time, kCoordinate, "s", "Time of the key, later than the previous key.", kRequired},
                   {"value", &K::value, kCoordinate, "", "Value of the curve at that time.", kRequired}});
    return spec;
}

template <class Value>
Fields<CurveKeys<Value>> curve_fields(const ObjectSpec& key_spec) {
    using C = CurveKeys<Value>;
    using I = Interpolation;
    return {{"keys", &C::keys, "Keys in order of time, at least one, each `{\"time\": ..., \"value\": ...}`.",
             kRequired, kNotEmpty, &key_spec},
            {"interpolation", &C::interpolation, "Interpolation between two keys.",
             Choices{choice(I::linear, "a straight line"),
                     choice(I::slow_in_slow_out, "3 s^2 - 2 s^3 of the distance, with zero rate at every key"),
                     choice(I::spline, "a smooth cubic (Catmull-Rom, also for uneven keys)"),
                     choice(I::cubic_spline, "the cubic spline with a continuous second derivative")}},
            {"ends", &C::ends, "Value before the first and after the last key.",
             Choices{choice(CurveEnds::hold, "hold", "the value of that key"),
                     choice(CurveEnds::repeat, "repeat",
                            "the keys repeat, and each round starts with the last value of the previous one")}}};
}

// Returns true if the keys are complete and their times increase. Reports the first wrong time. The tables of keys
// cannot express this rule.
bool are_good_keys(const std::vector<ObjectView>& keys, Diagnostics& diagnostics) {
    bool good = !keys.empty();
    double before = 0.0;
    for (const ObjectView& key : keys) {
        const double time = key.node("time").number().value_or(0.0);
        good = good && key.is_complete();
        if (&key != &keys.front() && good && !(before < time)) {
            diagnostics.error(
                key.location_of("time"), key.path_of("time"),
                fmt::format("found {} s, expected a time after the {} s of the key before", time, before));
            good = false;
        }
        before = time;
    }
    return good;
}

template <class Value>
KeyedCurve<Value> curve_of(const ObjectView& view, Diagnostics& diagnostics) {
    if (!are_good_keys(view.objects("keys"), diagnostics)) return KeyedCurve<Value>{};
    auto curve = view.read<CurveKeys<Value>>();
    try {
        return KeyedCurve<Value>(std::move(curve.keys), curve.interpolation, curve.ends);
    } catch (const InputError& problem) {
        diagnostics.error(view.location(), view.path(), problem.what());
        return KeyedCurve<Value>{};
    }
}

// Returns a scale curve, or the constant 1 if an error has been reported.
KeyedCurve<Vec3> scale_curve_of(const ObjectView& view, Diagnostics& diagnostics) {
    KeyedCurve<Vec3> curve = curve_of<Vec3>(view, diagnostics);
    return diagnostics.failed() ? KeyedCurve<Vec3>({1, 1, 1}) : curve;
}

// Pose of a collider, with a scale.
struct ScaledPose : KeyPose {
    Vec3 scale{1, 1, 1};
};

const ObjectSpec& motion_spec() {
    using Turn = KeyedRotation;
    static const ObjectSpec spec = object<Unbound>(
        "frame motion", "A motion of a frame, in the axes that result from the motions before it.", {},
        {variant<Turn>(
             "rotation", "A rotation about an axis through the frame's origin, by the right-hand rule.",
             {{"axis", &Turn::axis, kCoordinate, "", "Direction of the axis, of any length.", kRequired, kNotZero},
              {"angle", ValueType::object, "Rotation angle: a curve.", &number_curve_spec(), Unit{"degrees"},
               kRequired}}),
         variant<Spin>(
             "spin", "A steady rotation about an axis through the frame's origin.",
             {{"axis", &Spin::axis, kCoordinate, "", "Direction of the axis, of any length.", kRequired, kNotZero},
              {"rate", &Spin::rate, kCoordinate, "degrees/s",
               "Angular rate, by the right-hand rule. The angle is 0 at 0 s.", kRequired}}),
         variant<Swing>(
             "swing", "An oscillating rotation about an axis through the frame's origin.",
             {{"axis", &Swing::axis, kCoordinate, "", "Direction of the axis, of any length.", kRequired, kNotZero},
              {"amplitude", &Swing::amplitude, kCoordinate, "degrees", "Largest angle.", kRequired},
              {"frequency", &Swing::frequency, kCoordinate, "Hz", "Oscillations per second.", kRequired},
              {"phase", &Swing::phase, kCoordinate, "degrees", "Phase of the sine at 0 s."}}),
         variant<Oscillation>(
             "oscillation", "An oscillating translation.",
             {{"amplitude", &Oscillation::amplitude, kCoordinate, "m", "Largest offset of the origin.", kRequired},
              {"frequency", &Oscillation::frequency, kCoordinate, "Hz", "Oscillations per second.", kRequired},
              {"phase", &Oscillation::phase, kCoordinate, "degrees", "Phase of the sine at 0 s."}}),
         variant<Unbound>("translation", "A translation along a curve.",
                          {{"way", ValueType::object, "Path of the origin: a curve of [x, y, z].", &vector_curve_spec(),
                            Unit{"m"}, kRequired}}),
         variant<Unbound>("scale",
                          "A scale along the frame's axes, about its origin. It applies to later motions and to "
                          "everything that stands on the frame. Colliders in it must be meshes or boxes.",
                          {{"factor", ValueType::object, "Scale factor: a curve of numbers, or of [x, y, z].",
                            &scale_curve_spec(), kRequired}})});
    return spec;
}

FrameDescription frame_of(const NamedObject& named, Diagnostics& diagnostics) {
    auto frame = named.view.read<FrameDescription>();
    frame.name = named.name;
    frame.is_driven = named.view.has("body");
    for (const ObjectView& motion : named.view.objects("motions")) {
        if (motion.type() == "rotation") {
            auto rotation = motion.read<KeyedRotation>();
            rotation.degrees = number_curve_of(motion.object("angle"), diagnostics);
            frame.motions.emplace_back(std::move(rotation));
        } else if (motion.type() == "spin") {
            frame.motions.emplace_back(motion.read<Spin>());
        } else if (motion.type() == "swing") {
            frame.motions.emplace_back(motion.read<Swing>());
        } else if (motion.type() == "oscillation") {
            frame.motions.emplace_back(motion.read<Oscillation>());
        } else if (motion.type() == "translation") {
            frame.motions.emplace_back(KeyedTranslation{vector_curve_of(motion.object("way"), diagnostics)});
        } else if (motion.type() == "scale" && motion.has("factor")) {
            frame.motions.emplace_back(KeyedScale{scale_curve_of(motion.object("factor"), diagnostics)});
        }
    }
    return frame;
}

// Returns true if all parents exist and form no cycle. Reports unknown parents and cycles.
bool are_good_parents(const SceneContext& context, const std::vector<FrameDescription>& frames,
                      const std::vector<ObjectView>& views) {
    std::vector<std::string_view> names;
    for (const FrameDescription& frame : frames) names.push_back(frame.name);
    const std::unordered_set<std::string_view> known(names.begin(), names.end());
    bool good = true;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::string& parent = frames[i].parent;
        if (parent.empty() || known.contains(parent)) continue;
        context.error(views[i], "parent", unknown_name("frame", parent, names));
        good = false;
    }
    if (const auto circle = frame_in_circle(frames)) {
        context.error(views[*circle], "parent",
                      "the frame's parents lead back to it, expected one that stands in the world in the end");
        good = false;
    }
    return good;
}

}  // namespace

const ObjectSpec& number_curve_spec() {
    static const ObjectSpec spec =
        object("curve", "A number over time, in the unit of the key that contains the curve.",
               curve_fields<double>(curve_key_spec<double>("curve key", "A number at a time.")));
    return spec;
}

const ObjectSpec& vector_curve_spec() {
    static const ObjectSpec spec =
        object("vector curve", "A vector over time: a curve whose values are [x, y, z].",
               curve_fields<Vec3>(curve_key_spec<Vec3>("vector curve key", "A vector at a time.")));
    return spec;
}

const ObjectSpec& scale_curve_spec() {
    using K = CurveKey<Vec3>;
    static const ObjectSpec key =
        object<K>("scale curve key", "A factor at a time.",
                  {{"time", &K::time, kCoordinate, "s", "Time of the key, later than the previous key.", kRequired},
                   {"value", &K::value, positive_up_to(kLargestCoordinate), "",
                    "Scale factor at that time, or one for each axis.", ValueType::scale, kRequired}});
    static const ObjectSpec spec =
        object("scale curve", "Scale factors over time: a curve whose values are numbers or [x, y, z], all above 0.",
               curve_fields<Vec3>(key));
    return spec;
}

KeyedCurve<double> number_curve_of(const ObjectView& view, Diagnostics& diagnostics) {
    return curve_of<double>(view, diagnostics);
}

KeyedCurve<Vec3> vector_curve_of(const ObjectView& view, Diagnostics& diagnostics) {
    return curve_of<Vec3>(view, diagnostics);
}

const ObjectSpec& frame_spec() {
    using F = FrameDescription;
    static const ObjectSpec spec =
        object<F>("frame",
                  "A moving frame of reference for emitters and colliders. Its pose in the parent consists of the "
                  "translation, the rotation, and then the motions in their order.",
                  {{"parent", &F::parent, "Name of the parent frame in `frames`.", Without{"the world"}},
                   {"translation", &F::translation, kCoordinate, "m", "Position of its origin in the parent's axes."},
                   {"rotation",
                    [](F& f) {
                        return RotationTarget{f.rotation_axis, f.rotation_degrees};
                    },
                    "Rotation about its origin.", Without{"no rotation"}, &rotation_spec()},
                   {"motions", ValueType::list, "Motions of the frame, in their order.", &motion_spec()},
                   {"body", ValueType::object, "Makes it a rigid body that particles and forces move.",
                    Without{"its motions move it"}, &body_spec()}});
    return spec;
}

std::vector<FrameDescription> frames_of(const SceneContext& context) {
    std::vector<FrameDescription> frames;
    std::vector<ObjectView> views;
    for (const NamedObject& named : context.root().named_objects("frames")) {
        views.push_back(named.view);
        frames.push_back(frame_of(named, context.diagnostics()));
    }
    if (!are_good_parents(context, frames, views) || context.failed()) {
        for (FrameDescription& frame : frames) frame.parent.clear();  // frames without parents still have valid names
    }
    for (FrameDescription& frame : frames) {
        if (!frame.is_driven) continue;  // build_bodies() reports the keys that a body must not have
        frame.parent.clear();
        frame.motions.clear();
    }
    if (context.failed()) std::erase_if(frames, [](const auto& frame) { return frame.name.empty(); });
    return frames;
}

bool is_frame_named(const SceneContext& context, const ObjectView& view, const FrameTree& frames) {
    const std::string name = view.text("frame");
    if (frames.find(name)) return true;
    std::vector<std::string_view> names;
    for (std::size_t k = 0; k < frames.size(); ++k) names.push_back(frames.description(k).name);
    context.error(view, "frame", unknown_name("frame", name, names));
    return false;
}

const ObjectSpec& key_pose_spec() {
    using P = ScaledPose;
    static const ObjectSpec spec = object<P>(
        "key pose",
        "Pose of a collider's frame at a time. Between two keys it moves, rotates and scales at constant rates.",
        {{"time", &P::time, kCoordinate, "s", "Time of the key, later than the previous key.", kRequired},
         {"position", &P::position, kCoordinate, "m", "Position of the frame's origin."},
         {"rotation",
          [](P& p) {
              return RotationTarget{p.axis, p.degrees};
          },
          "Rotation at that time.", Without{"no rotation"}, &rotation_spec()},
         {"scale", &P::scale, positive_up_to(kLargestCoordinate), "",
          "Scale factor, or one for each of the frame's axes. Only for meshes and boxes, because it moves their "
          "vertices.",
          ValueType::scale}});
    return spec;
}

FrameDescription frame_through(const std::vector<ObjectView>& views, Diagnostics& diagnostics) {
    FrameDescription frame;
    std::vector<KeyPose> poses;
    std::vector<CurveKey<Vec3>> scales;  // factors along the frame's axes
    if (!are_good_keys(views, diagnostics)) return frame;
    for (const ObjectView& view : views) {
        const auto pose = view.read<ScaledPose>();
        poses.push_back(pose);
        scales.push_back({pose.time, pose.scale});
    }
    const auto has_scale = [](const ObjectView& view) { return view.has("scale"); };
    try {
        frame.motions = motions_through(poses);
        if (std::any_of(views.begin(), views.end(), has_scale)) {
            frame.motions.emplace_back(KeyedScale{KeyedCurve<Vec3>(std::move(scales))});
        }
    } catch (const InputError& problem) {
        diagnostics.error(views.front().location(), views.front().path(), problem.what());
    }
    return frame;
}

}  // namespace ricochet::detail
