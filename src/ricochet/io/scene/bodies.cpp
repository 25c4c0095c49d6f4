// Rigid bodies that impulses move: the key "body" of a frame.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/settings_table.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/mass_moments.h"
#include "ricochet/io/scene/body_volume.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

/// Values of the keys of a body. Some of them must be converted to members of BodyDescription.
struct BodyKeys {
    BodyDescription body;
    std::optional<double> mass;
    std::optional<double> density;
    std::optional<Vec3> center;
    std::optional<Vec3> inertia;
    Vec3 inertia_products;
};

template <class Member>
auto of_body(Member BodyDescription::*member) {
    return [member](BodyKeys& k) -> Member& { return k.body.*member; };
}

Fields<BodyKeys> mass_fields() {
    using B = BodyKeys;
    return {
        {"mass", &B::mass, kPositive, "kg", "Mass. Give either this or `density`.", Without{"computed from `density`"}},
        {"density", &B::density, kPositive, "kg/m^3",
         "Mass per volume. The volume is that of the closed colliders in the frame, which must not overlap.",
         Without{"computed from `mass`"}},
        {"center", &B::center, kCoordinate, "m", "Centre of mass, in the frame's coordinates.",
         Without{"from its closed colliders, at uniform density"}},
        {"inertia", &B::inertia, kPositive, "kg m^2",
         "Moments of inertia about the axes of the frame through the centre of mass: [xx, yy, zz].",
         Without{"from its closed colliders, at uniform density"}},
        {"inertia_products", &B::inertia_products, kAnyNumber, "kg m^2",
         "Elements xy, xz and yz of the inertia tensor: minus the sums of mass times x y, x z and y z.",
         Needs{"inertia"}}};
}

Fields<BodyKeys> joint_fields() {
    using B = BodyDescription;
    return {{"joint", of_body(&B::joint), "Joint that constrains the body.",
             Choices{choice(JointKind::free, "free", "no joint"),
                     choice(JointKind::hinge, "hinge", "rotation about an axis through the frame's origin"),
                     choice(JointKind::slider, "slider", "translation along an axis, without rotation")}},
            {"axis", of_body(&B::axis), kCoordinate, "",
             "Direction of the axis of a hinge or slider, of any length, in the frame's axes at 0 s.", kNotZero}};
}

Fields<BodyKeys> motion_fields() {
    return joined<BodyKeys>({fields_of_part<BodyKeys>(&BodyKeys::body, kBodyMotionTable),
                             fields_of_part<BodyKeys>(of_body(&BodyDescription::settings), kJointTable)});
}

Fields<BodyKeys> force_fields() {
    return {{"feels_forces", of_body(&BodyDescription::feels_forces),
             "true: the scene's forces act on it like on a point particle with its mass, at its centre of mass."}};
}

/// Computes the mass moments of all colliders in a frame, and reports colliders without a volume.
class FrameMoments {
public:
    FrameMoments(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view)
        : context_(context), setup_(setup), view_(view) {}

    [[nodiscard]] std::optional<MassMoments> of(const std::string& frame) const {
        MassMoments all;
        for (const ColliderDescription& collider : setup_.colliders) {
            if (collider.frame != frame) continue;
            const auto one = std::visit([&](const auto& shape) { return moments(shape); }, collider.shape);
            if (!one) {
                return refuse(
                    fmt::format("the collider \"{}\" has no volume{}", collider.name, cause_in(collider.shape)));
            }
            all = all + *one;
        }
        if (!(all.volume > 0.0)) return refuse("no closed collider stands in the frame");
        return all;
    }

private:
    [[nodiscard]] std::optional<MassMoments> refuse(const std::string& why) const {
        context_.error(view_, why + ", expected closed colliders, or \"mass\", \"center\" and \"inertia\"");
        return std::nullopt;
    }
    /// Returns the reason why a mesh has no moments, as a part of a message; empty for other shapes.
    [[nodiscard]] static std::string_view cause_in(const ColliderShape& shape) {
        const auto* const mesh = std::get_if<MeshShape>(&shape);
        if (mesh == nullptr || !mesh->mesh) return "";
        const ClosedSurface closed = closed_surface(*mesh->mesh);
        if (!closed.closed) return " because its mesh is open";
        return closed.oriented ? "" : " because its faces are wound both ways";
    }
    [[nodiscard]] static std::optional<MassMoments> moments(const PlaneShape& /*plane*/) { return std::nullopt; }
    [[nodiscard]] static std::optional<MassMoments> moments(const MeshShape& shape) {
        if (!shape.mesh || shape.mesh->triangles.empty()) return std::nullopt;
        const ClosedSurface closed = closed_surface(*shape.mesh);
        if (!closed.closed || !closed.oriented) return std::nullopt;
        const MassMoments found = moments_of(transformed(counted_surface(*shape.mesh), shape.placement));
        // The triangles of a mesh with a negative volume face inward.
        return found.volume < 0.0 ? negative(found) : found;
    }
    [[nodiscard]] static std::optional<MassMoments> moments(const BallShape& shape) {
        return moments_of_ball(world_from_unit(shape));
    }
    [[nodiscard]] static std::optional<MassMoments> moments(const CylinderShape& shape) {
        return moments_of_cylinder(world_from_unit(shape));
    }
    [[nodiscard]] static std::optional<MassMoments> moments(const CuboidShape& shape) {
        return moments_of(transformed(cuboid_mesh(shape.size), shape.placement));
    }
    [[nodiscard]] static MassMoments negative(const MassMoments& m) { return {-m.volume, -m.first, (-1.0) * m.second}; }

    const SceneContext& context_;
    const SimulationSetup& setup_;
    const ObjectView& view_;
};

/// Reports keys that belong to another kind of joint.
void refuse_other_joints_keys(const SceneContext& context, const ObjectView& view, JointKind joint) {
    const std::vector<std::string_view> keys =
        joint == JointKind::free
            ? std::vector<std::string_view>{"axis",  "rate",     "spring",     "spring_rest", "damping",
                                            "drive", "friction", "motor_rate", "motor_most"}
            : std::vector<std::string_view>{"velocity", "angular_velocity"};
    for (const std::string_view key : keys) {
        if (!view.has(std::string(key))) continue;
        context.error(view, key,
                      joint == JointKind::free ? "a free body has no joint, expected a \"joint\" hinge or slider"
                                               : "a body on a joint starts with its \"rate\"");
    }
}

/// Sets mass, centre and inertia. Returns false after reporting an error. Sets has_volume to true if a value follows
/// from the volume of the colliders.
bool set_mass(const FrameMoments& moments, const std::string& frame, BodyKeys& keys, bool& has_volume) {
    BodyDescription& body = keys.body;
    const bool is_given = keys.mass && keys.center && keys.inertia;
    const std::optional<MassMoments> shape = is_given ? std::nullopt : moments.of(frame);
    if (!is_given && !shape) return false;
    has_volume = shape.has_value();
    body.mass = keys.mass ? *keys.mass : *keys.density * shape->volume;
    body.center = keys.center ? *keys.center : shape->center();
    if (keys.inertia) {
        const Vec3& d = *keys.inertia;
        const Vec3& p = keys.inertia_products;
        body.inertia = {d.x, d.y, d.z, p.x, p.y, p.z};
    } else {
        body.inertia = (body.mass / shape->volume) * shape->inertia();
    }
    return true;
}

/// Reports frames and materials that cannot be combined with a body.
void refuse_company(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                    const std::vector<FrameDescription>& frames, const std::string& frame) {
    for (const FrameDescription& other : frames) {
        if (other.parent != frame) continue;
        context.error(
            view,
            fmt::format(
                "the frame \"{}\" stands on this body, expected none: all colliders of a body stand in its own frame",
                other.name));
    }
    for (const ColliderDescription& collider : setup.colliders) {
        if (collider.frame != frame) continue;
        const Material* random = nullptr;
        visit_materials(collider, [&](std::uint32_t k) {
            if (setup.materials[k].is_random()) random = &setup.materials[k];
        });
        if (random == nullptr) continue;
        context.error(view, fmt::format("the material \"{}\" of the collider \"{}\" absorbs or reflects diffusely, "
                                        "expected none that does on a body that impulses move",
                                        random->name, collider.name));
    }
}

}  // namespace

const ObjectSpec& body_spec() {
    static const ObjectSpec spec =
        object<BodyKeys>("body",
                         "A rigid body that impulses of particles and the scene's forces move. Its frame stands in the "
                         "world and has no motions. The frame's translation and rotation give the start pose. Bodies "
                         "collide neither with each other nor with colliders at rest.",
                         joined<BodyKeys>({mass_fields(), joint_fields(), motion_fields(), force_fields()}));
    return spec;
}

void build_bodies(const SceneContext& context, SimulationSetup& setup, const std::vector<FrameDescription>& frames) {
    for (const NamedObject& named : context.root().named_objects("frames")) {
        if (!named.view.has("body")) continue;
        const ObjectView view = named.view.object("body");
        for (const std::string_view key : {"parent", "motions"}) {
            if (!named.view.has(std::string(key))) continue;
            context.error(named.view, key, "forces and impulses move a body in the world; expected no such key");
        }
        auto keys = view.read<BodyKeys>();
        if (!context.objects("springs").empty()) {
            context.error(named.view, "body",
                          "bodies that impulses move and springs do not go together yet, expected "
                          "a scene without the one or the other");
        }
        const bool is_refused = context.failed();  // refused values are treated as absent
        if (view.has("mass") == view.has("density") && !(is_refused && !view.has("mass"))) {
            context.error(view, view.has("mass") ? "found both \"mass\" and \"density\", expected one of them"
                                                 : "found neither \"mass\" nor \"density\", expected one of them");
        }
        refuse_other_joints_keys(context, view, keys.body.joint);
        refuse_company(context, setup, view, frames, named.name);
        if (context.failed()) continue;
        keys.body.frame = named.name;
        bool has_volume = false;
        if (!set_mass(FrameMoments(context, setup, view), named.name, keys, has_volume)) continue;
        if (const auto warning = has_volume ? doubly_filled(setup, named.name) : std::nullopt) {
            context.warn(view, *warning);
        }
        try {
            static_cast<void>(DrivenBody(keys.body, AffineMap{}));
            setup.bodies.push_back(std::move(keys.body));
        } catch (const InputError& problem) {
            context.error(view, problem.what());
        }
    }
}

}  // namespace ricochet::detail
