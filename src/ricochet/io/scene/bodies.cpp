// Rigid bodies that impulses move: the key "body" of a frame.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/collision_queries.h"
#include "ricochet/core/box3.h"
#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/settings_table.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/mass_moments.h"
#include "ricochet/geometry/mesh/winding_number.h"
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

std::optional<MassMoments> moments(const PlaneShape& /*plane*/) { return std::nullopt; }
std::optional<MassMoments> moments(const MeshShape& shape) {
    if (!shape.mesh || shape.mesh->triangles.empty()) return std::nullopt;
    const ClosedSurface closed = closed_surface(*shape.mesh);
    if (!closed.closed || !closed.oriented) return std::nullopt;
    const MassMoments found = moments_of(transformed(counted_surface(*shape.mesh), shape.placement));
    // The triangles of a mesh with a negative volume face inward.
    if (found.volume < 0.0) return MassMoments{-found.volume, -found.first, (-1.0) * found.second};
    return found;
}
std::optional<MassMoments> moments(const BallShape& shape) { return moments_of_ball(world_from_unit(shape)); }
std::optional<MassMoments> moments(const CylinderShape& shape) { return moments_of_cylinder(world_from_unit(shape)); }
std::optional<MassMoments> moments(const CuboidShape& shape) {
    return moments_of(transformed(cuboid_mesh(shape.size), shape.placement));
}

/// Returns the reason why a mesh has no moments, as a part of a message; empty for other shapes.
std::string_view cause_in(const ColliderShape& shape) {
    const auto* const mesh = std::get_if<MeshShape>(&shape);
    if (mesh == nullptr || !mesh->mesh) return "";
    const ClosedSurface closed = closed_surface(*mesh->mesh);
    if (!closed.closed) return " because its mesh is open";
    return closed.oriented ? "" : " because its faces are wound both ways";
}

/// Returns the mass moments of all colliders in a frame. Returns nothing after reporting a collider without a volume.
std::optional<MassMoments> frame_moments(const SceneContext& context, const SimulationSetup& setup,
                                         const ObjectView& view, const std::string& frame) {
    std::string refused;
    MassMoments all;
    for (const ColliderDescription& collider : setup.colliders) {
        if (collider.frame != frame) continue;
        const auto one = std::visit([](const auto& shape) { return moments(shape); }, collider.shape);
        if (!one) {
            refused = fmt::format("the collider \"{}\" has no volume{}", collider.name, cause_in(collider.shape));
            break;
        }
        all = all + *one;
    }
    if (refused.empty() && !(all.volume > 0.0)) refused = "no closed collider stands in the frame";
    if (refused.empty()) return all;
    context.error(view, refused + ", expected closed colliders, or \"mass\", \"center\" and \"inertia\"");
    return std::nullopt;
}

/// Reports keys that belong to another kind of joint.
void refuse_other_joints_keys(const SceneContext& context, const ObjectView& view, JointKind joint) {
    using Keys = std::vector<std::string_view>;
    const bool is_free = joint == JointKind::free;
    const Keys keys = is_free ? Keys{"axis",  "rate",     "spring",     "spring_rest", "damping",
                                     "drive", "friction", "motor_rate", "motor_most"}
                              : Keys{"velocity", "angular_velocity"};
    for (const std::string_view key : keys) {
        if (!view.has(key)) continue;
        context.error(view, key,
                      is_free ? "a free body has no joint, expected a \"joint\" hinge or slider"
                              : "a body on a joint starts with its \"rate\"");
    }
}

/// Largest product of the numbers of triangles and test points. Local: it limits the cost of a warning.
constexpr double kMostSolidAngles = 1e7;
constexpr double kMostPoints = 4096;
constexpr double kLeastPoints = 64;

/// Largest share of points in overlaps, among all points inside, that is not reported. Local, because it affects only a
/// warning.
constexpr double kNegligibleShare = 0.01;

/// One closed collider in the coordinates of its frame.
class ClosedPart {
public:
    explicit ClosedPart(const ColliderDescription& collider) : name_(collider.name) {
        if (const auto* mesh = std::get_if<MeshShape>(&collider.shape)) {
            mesh_ = transformed(counted_surface(*mesh->mesh), mesh->placement);
            box_ = bounds(mesh_);
            return;
        }
        ColliderDescription own = collider;
        own.frame.clear();
        queries_ = std::make_unique<CollisionQueries>(std::vector{std::move(own)});
        std::visit([&](const auto& shape) { include(shape); }, collider.shape);
    }

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const Box3& box() const { return box_; }
    [[nodiscard]] std::size_t triangles() const { return mesh_.triangles.size(); }
    /// Returns the number of times that the collider encloses a point.
    [[nodiscard]] int count(const Vec3& p) const {
        if (!box_.contains(p)) return 0;
        if (queries_) return queries_->is_inside(p) ? 1 : 0;
        return static_cast<int>(std::lround(std::fabs(winding_number(mesh_, p))));
    }

private:
    void include(const PlaneShape& /*plane*/) {}
    void include(const MeshShape& /*mesh*/) {}
    void include(const CuboidShape& cuboid) {
        for (const Vec3& corner : transformed(cuboid_mesh(cuboid.size), cuboid.placement).vertices) {
            box_.include(corner);
        }
    }
    template <class Round>
    void include(const Round& shape) {
        for (const Vec3& corner : cuboid_mesh({2, 2, 2}).vertices) box_.include(world_from_unit(shape).point(corner));
    }

    std::string name_;
    TriangleMesh mesh_;
    std::unique_ptr<CollisionQueries> queries_;
    Box3 box_;
};

/// Counts of the test points, and the first overlap found.
struct Shares {
    std::size_t inside = 0;  ///< number of points inside at least one collider
    std::size_t again = 0;   ///< number of points that colliders enclose more than once
    std::string first;       ///< name of a collider around the first point that is enclosed more than once
    /// Name of another collider around this point; empty if `first` alone encloses the point several times.
    std::string second;
};

void look_at(const Vec3& p, const std::vector<ClosedPart>& parts, Shares& shares) {
    int all = 0;
    std::vector<const ClosedPart*> within;
    for (const ClosedPart& part : parts) {
        const int count = part.count(p);
        all += count;
        if (count > 0) within.push_back(&part);
    }
    shares.inside += all > 0 ? 1 : 0;
    if (all < 2 || shares.again++ > 0) return;
    shares.first = within[0]->name();
    if (within.size() > 1) shares.second = within[1]->name();
}

/// Returns a message if closed colliders in a frame overlap, or if a mesh among them intersects itself. Otherwise
/// returns nothing. A mass computed from a density would include an overlap twice. The test uses random points in the
/// bounding box, which are the same in every run. Overlaps below about one hundredth of the enclosed volume may be
/// missed.
std::optional<std::string> doubly_filled(const SimulationSetup& setup, const std::string& frame) {
    std::vector<ClosedPart> parts;
    Box3 box;
    std::size_t triangles = 1;
    for (const ColliderDescription& collider : setup.colliders) {
        if (collider.frame != frame) continue;
        parts.emplace_back(collider);
        box.include(parts.back().box());
        triangles += parts.back().triangles();
    }
    const auto points =
        static_cast<int>(std::clamp(kMostSolidAngles / static_cast<double>(triangles), kLeastPoints, kMostPoints));
    RandomSequence random(0, 0, 0);
    Shares shares;
    for (int k = 0; k < points; ++k) {
        const Vec3 size = box.size();
        const double x = random.uniform();
        const double y = random.uniform();
        const double z = random.uniform();
        look_at(box.lower + Vec3{x * size.x, y * size.y, z * size.z}, parts, shares);
    }
    const double share =
        static_cast<double>(shares.again) / static_cast<double>(std::max<std::size_t>(1, shares.inside));
    if (share < kNegligibleShare) return std::nullopt;
    const std::string where =
        shares.second.empty()
            ? fmt::format("the mesh \"{}\" crosses itself, or nests shells that are wound alike", shares.first)
            : fmt::format("the colliders \"{}\" and \"{}\" overlap", shares.first, shares.second);
    return fmt::format(
        "{}: about {:.2g} % of the inside of the body's colliders is included more than once in its mass, centre and "
        "inertia; let them touch only, reverse the inner shell of a cavity, or give \"mass\", \"center\" and "
        "\"inertia\"",
        where, 100.0 * share);
}

/// Sets mass, centre and inertia. Returns false after reporting an error. Warns of overlapping colliders if a value
/// follows from their volume.
bool set_mass(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view, BodyKeys& keys) {
    BodyDescription& body = keys.body;
    const bool is_given = keys.mass && keys.center && keys.inertia;
    const auto shape = is_given ? std::nullopt : frame_moments(context, setup, view, body.frame);
    if (!is_given && !shape) return false;
    body.mass = keys.mass ? *keys.mass : *keys.density * shape->volume;
    body.center = keys.center ? *keys.center : shape->center();
    if (keys.inertia) {
        const Vec3& d = *keys.inertia;
        const Vec3& p = keys.inertia_products;
        body.inertia = {d.x, d.y, d.z, p.x, p.y, p.z};
    } else {
        body.inertia = (body.mass / shape->volume) * shape->inertia();
    }
    const auto warning = shape ? doubly_filled(setup, body.frame) : std::nullopt;
    if (warning) context.warn(view, *warning);
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
            if (!setup.materials[k].suits_bodies()) random = &setup.materials[k];
        });
        if (random == nullptr) continue;
        context.error(view,
                      fmt::format("the material \"{}\" of the collider \"{}\" absorbs, reflects diffusely, or has a "
                                  "tangential factor, expected none that does on a body that impulses move",
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
            if (!named.view.has(key)) continue;
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
        if (!set_mass(context, setup, view, keys)) continue;
        try {
            static_cast<void>(DrivenBody(keys.body, AffineMap{}));
            setup.bodies.push_back(std::move(keys.body));
        } catch (const InputError& problem) {
            context.error(view, problem.what());
        }
    }
}

}  // namespace ricochet::detail
