#include "fuzz/tiny_movers.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/core/frame_tree.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/geometry/mesh/mesh_motion.h"

namespace ricochet::fuzz {
namespace {

/// Returns a turn rate in degrees per second. In a step of 1/60 s it ranges from zero to half a turn. The speeds below
/// range from a creep to the width of the scene in one step.
double turn_rate(ByteChoices& choices) { return choices.part_of({0.0, 10.0, 360.0, 10800.0}); }
double speed(ByteChoices& choices) { return choices.part_of({0.0, 0.1, 2.0, 60.0}); }
Vec3 velocity(ByteChoices& choices) {
    const double most = speed(choices);
    return most * choices.direction();
}

FrameMotion motion(ByteChoices& choices, double duration) {
    const Vec3 axis = choices.direction();
    switch (choices.index(5)) {
        case 0:
            return Spin{axis, turn_rate(choices)};
        case 1: {
            const double degrees = 90.0 * choices.part();
            return Swing{axis, degrees, 20.0 * choices.part(), 0.0};
        }
        case 2: {
            const Vec3 amplitude = 0.5 * axis;
            return Oscillation{amplitude, 20.0 * choices.part(), 0.0};
        }
        case 3: {
            const double most = turn_rate(choices) * duration;
            const auto kind = choices.one_of<Interpolation>({Interpolation::linear, Interpolation::cubic_spline});
            return KeyedRotation{axis, KeyedCurve<double>({{0.0, 0.0}, {0.3 * duration, most}, {duration, 0.0}}, kind)};
        }
        default: {
            const Vec3 center_path = speed(choices) * duration * axis;
            return KeyedTranslation{KeyedCurve<Vec3>({{0.0, {}}, {0.4 * duration, center_path}, {duration, {}}})};
        }
    }
}

/// Adds one or two frames, the second attached to the first, or a single frame that is a body.
void add_frames(ByteChoices& choices, SimulationSetup& setup) {
    std::vector<FrameDescription> frames(1 + choices.index(2));
    // Bodies cannot be combined with emitters and springs.
    const bool is_body = choices.index(4) == 1 && setup.emitters.empty() && setup.springs.empty();
    if (is_body) frames.resize(1);
    for (std::size_t k = 0; k < frames.size(); ++k) {
        FrameDescription& frame = frames[k];
        frame.name = "frame " + std::to_string(k);
        if (k > 0) frame.parent = frames[k - 1].name;
        if (choices.yes()) frame.translation = choices.point();
        frame.is_driven = is_body;
        if (!is_body) frame.motions.push_back(motion(choices, setup.options.duration));
    }
    for (ColliderDescription& collider : setup.colliders) {
        if (choices.yes()) collider.frame = frames[choices.index(frames.size())].name;
    }
    if (is_body) {
        BodyDescription body;
        body.frame = frames[0].name;
        body.mass = choices.one_of<double>({1.0, 0.1, 100.0});
        body.inertia = {.xx = body.mass, .yy = 0.5 * body.mass, .zz = 0.75 * body.mass};
        body.joint = choices.one_of<JointKind>({JointKind::free, JointKind::hinge, JointKind::slider});
        body.axis = choices.direction();
        if (body.joint == JointKind::free) {
            body.velocity = velocity(choices);
            body.angular_velocity = choices.point();
        } else {
            body.rate = 5.0 * choices.part();
            body.settings.spring = 10.0 * choices.part();
            body.settings.friction = choices.part();
        }
        setup.bodies.push_back(std::move(body));
    }
    setup.frames = std::make_shared<const FrameTree>(std::move(frames));
}

/// Moves every vertex back and forth along its own path.
void deform(ByteChoices& choices, MeshShape& shape, double duration) {
    std::vector<std::vector<Vec3>> positions(3, shape.mesh->vertices);
    const double most = choices.one_of<double>({1e-6, 0.05, 0.5});
    for (Vec3& vertex : positions[1]) vertex += most * choices.point();
    shape.motion =
        std::make_shared<const MeshMotion>(std::vector<double>{0.0, 0.5 * duration, duration}, std::move(positions));
}

}  // namespace

void add_movers(ByteChoices& choices, SimulationSetup& setup) {
    const bool is_exact = setup.options.response == ResponseKind::exact;
    if (is_exact && choices.index(3) == 1) add_frames(choices, setup);
    if (choices.index(4) == 1) {
        Material& belt = setup.materials[choices.index(setup.materials.size())];
        belt.motion.velocity = velocity(choices);
        belt.motion.angular_velocity = choices.point();
    }
    if (is_exact && choices.index(4) == 1) {
        for (ColliderDescription& collider : setup.colliders) {
            auto* const mesh = std::get_if<MeshShape>(&collider.shape);
            if (mesh != nullptr && choices.yes()) deform(choices, *mesh, setup.options.duration);
        }
    }
    const bool may_meet = is_exact && setup.springs.empty() && setup.bodies.empty() && setup.options.flow == nullptr;
    if (may_meet && choices.index(3) == 1) {
        PairContactSettings pairs;
        pairs.restitution = choices.one_of<double>({1.0, 0.0, 0.5});
        pairs.friction = choices.one_of<double>({0.0, 0.5});
        pairs.rolling_friction = choices.one_of<double>({0.0, 0.1});
        pairs.method = choices.one_of<PairMethod>({PairMethod::automatic, PairMethod::events, PairMethod::contacts});
        pairs.impact_budget = setup.options.bounce_budget;
        setup.options.particle_contacts = pairs;
    }
}

}  // namespace ricochet::fuzz
