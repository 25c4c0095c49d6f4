// Emitters of type child: particles that are born from other particles, and the clouds that they can form.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/cloud.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

// Keys of an emitter of type child. The name of the parent is resolved to a number when all emitters are known.
struct ChildKeys : ParentRule {
    std::string parent;
};

template <class Shape>
Field<Shape> radius() {
    return {"radius", &Shape::radius, kLength, "m", "Its radius.", kRequired};
}

Variant cone_variant() {
    using C = ConeShape;
    return variant<C>(
        "cone", "Uniform in a cone, launched along the line from its tip.",
        {{"apex", &C::apex, kCoordinate, "m", "Tip of the cone."},
         {"axis", &C::axis, kCoordinate, "", "Direction from the tip into the cone, of any length.", kRequired,
          kNotZero},
         {"angle", &C::angle_degrees, between(0.0, 89.9), "degrees", "Angle between the axis and the side.", kRequired},
         {"height", &C::height, kLength, "m", "Its height.", kRequired}});
}

void find_parents(const SceneContext& context, SimulationSetup& setup) {
    const std::vector<ObjectView> views = context.objects("emitters");
    std::vector<std::string_view> names;
    for (const EmitterDescription& emitter : setup.emitters) names.push_back(emitter.name);
    for (std::size_t k = 0; k < views.size(); ++k) {
        if (!setup.emitters[k].parent || !views[k].has("parent")) continue;
        const std::string name = views[k].text("parent");
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
            // An emitter can be its own parent, but its own name is not a useful suggestion.
            std::vector<std::string_view> others = names;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
            context.error(views[k], "parent", unknown_name("emitter", name, others.empty() ? names : others));
        } else {
            setup.emitters[k].parent->emitter = static_cast<std::uint32_t>(found - names.begin());
        }
    }
}

// Warns of emitters that are among their own ancestors. An emitter in such a cycle needs parents from the cycle, so
// none of its emitters ever emits.
void warn_of_parent_cycles(const SceneContext& context, const SimulationSetup& setup) {
    const std::vector<ObjectView> views = context.objects("emitters");
    for (std::size_t k = 0; k < views.size() && !context.failed(); ++k) {
        std::size_t ancestor = k;
        for (std::size_t n = 0; n < views.size() && setup.emitters[ancestor].parent; ++n) {
            ancestor = setup.emitters[ancestor].parent->emitter;
            if (ancestor != k) continue;
            context.warn(views[k], "parent", "leads back to this emitter, which no other begins: nothing is born here");
            break;
        }
    }
}

// Reports two emitters that distribute the mass of the same parents at the same event.
void check_mass_distribution(const SceneContext& context, const SimulationSetup& setup) {
    const std::vector<ObjectView> views = context.objects("emitters");
    std::set<std::pair<std::uint32_t, BirthEvent>> taken;
    for (std::size_t k = 0; k < views.size(); ++k) {
        const auto& rule = setup.emitters[k].parent;
        if (!rule || !rule->share) continue;
        bool free = taken.insert({rule->emitter, rule->on}).second;
        if (rule->recursive) free = taken.insert({static_cast<std::uint32_t>(k), rule->on}).second && free;
        if (!free) {
            context.error(views[k], "parent", "another emitter shares out the same parents at the same event");
        }
    }
}

}  // namespace

const ObjectSpec& cloud_spec() {
    using C = CloudRule;
    static const ObjectSpec spec = object<C>(
        "cloud",
        "Children that follow their parent. The shape, in coordinates relative to the parent, gives their target "
        "positions.",
        {{"turning", &C::turning, kCoordinate, "rad/s", "Angular velocity of the target positions about the parent."},
         {"pull", &C::pull, kNotNegative, "1/s^2",
          "Acceleration of a child towards its target position, per metre of distance from it."},
         {"damping", &C::damping, kNotNegative, "1/s",
          "Acceleration against the velocity relative to the target position, per m/s."},
         {"parent_ends", &C::end, "Behaviour of the children after the end of their parent.",
          Choices{choice(CloudEnd::free, "free", "they fly on as free particles"),
                  choice(CloudEnd::die, "die", "they end with it")}}},
        simple_shapes());
    return spec;
}

std::vector<Variant> simple_shapes() {
    using Disk = DiskShape;
    using Ball = SphereShape;
    return {variant<PointShape>("point", "All at one point.", {center(&PointShape::center)}),
            variant<Disk>(
                "disk", "Uniform on a flat disk.",
                {center(&Disk::center),
                 {"normal", &Disk::normal, kCoordinate, "", "Normal of the disk, of any length.", kRequired, kNotZero},
                 radius<Disk>()}),
            variant<BoxShape>("box", "Uniform in a box along the axes.",
                              {center(&BoxShape::center),
                               {"size", &BoxShape::size, kLengthOrZero, "m", "Full edge lengths.", kRequired}}),
            variant<Ball>("sphere", "Uniform in a ball, or on its surface.",
                          {center(&Ball::center),
                           radius<Ball>(),
                           {"surface", &Ball::surface, "true: only on the surface, launched outward."}}),
            cone_variant()};
}

EmitterShape simple_shape_of(const ObjectView& view) {
    if (view.type() == "disk") return view.read<DiskShape>();
    if (view.type() == "box") return view.read<BoxShape>();
    if (view.type() == "sphere") return view.read<SphereShape>();
    if (view.type() == "cone") return view.read<ConeShape>();
    if (view.type() == "point") return view.read<PointShape>();
    return PointShape{};  // the shape was refused
}

Variant child_variant() {
    using C = ChildKeys;
    using On = BirthEvent;
    return variant<C>(
        "child",
        "Children of another emitter's particles, born at their position with their velocity. `burst`, `start`, "
        "`stop`, `rate_per_frame`, `rate_per_area`, `rate_curve` and `births` do not apply.",
        {{"parent", &C::parent, "Name of the emitter whose particles are the parents.", kRequired},
         {"on", &C::on, "Event at which parents give birth.",
          Choices{choice(On::life, "life", "during their whole life, at `rate`, which is drawn once per parent"),
                  choice(On::death, "death", "at the end of their lifetime, or when a surface absorbs them"),
                  choice(On::impact, "impact", "at impacts of at least `threshold_impulse`"),
                  choice(On::birth, "birth", "at their own birth")}},
         {"count", &C::count, between(0.0, 1e6), "",
          "Number of children per death, impact or birth, rounded to a whole number.", &distribution_spec()},
         {"threshold_impulse", &C::threshold_impulse, kNotNegative, "N s",
          "Smallest impulse of an impact that gives birth."},
         {"share", &C::share,
          "true: the parent ends and its children share its mass and momentum. `mass` is the weight of a share. Radii "
          "follow from the same density. `speed` sets how fast the children fly apart.",
          Without{"true for impact, false otherwise"}},
         {"recursive", &C::recursive, "true: the children become parents, too, up to `simulation.max_depth`."},
         {"inherit_velocity", &C::inherit_velocity, kCoordinate, "",
          "Fraction of the parent's velocity that a child starts with. It is 1 for shares."},
         {"inherit_color", &C::inherit_color, kFraction, "",
          "Fraction of the parent's colour in the child's own `color`. Without a `color`, the child has the parent's "
          "colour."},
         {"cloud", &C::cloud,
          "The children follow their parent through flights and impacts. Each has its own target position near the "
          "parent.",
          &cloud_spec(), Without{"they fly freely"}}});
}

// Returns the rule of an emitter of type child. check_parents() sets the number of the parent.
ParentRule rule_of(const SceneContext& context, const ObjectView& view, const EmitterDescription& emitter) {
    ParentRule rule = view.read<ChildKeys>();
    if (!view.has("share")) rule.share = rule.on == BirthEvent::impact && !rule.cloud;
    for (const char* const key :
         {"burst", "start", "stop", "rate_per_frame", "rate_per_area", "rate_curve", "births"}) {
        if (view.has(key)) context.error(view, key, "is not for emitters of type \"child\", leave it out");
    }
    if (rule.share && (rule.on == BirthEvent::life || rule.on == BirthEvent::birth)) {
        context.error(view, "share",
                      "a parent that lives on cannot be shared out; expected \"on\": \"death\" or \"impact\"");
    }
    if (rule.share && view.has("particle_radius")) {
        context.error(view, "particle_radius", "radii follow from the parent's when it is shared out, leave it out");
    }
    if (rule.on != BirthEvent::life && view.has("rate")) {
        context.error(view, "rate", "only goes together with \"on\": \"life\"; expected \"count\"");
    }
    if (rule.cloud && (rule.share || rule.on == BirthEvent::death)) {
        context.error(
            view, "cloud",
            "a parent that has ended leads no cloud; expected \"on\": \"birth\", \"life\" or \"impact\", and no "
            "\"share\"");
    }
    if (rule.cloud && rule.inherit_velocity != 1.0) {
        context.error(view, "inherit_velocity",
                      "children of a cloud have all of their parent's velocity, leave it out");
    }
    if (!check_drawn(context, view, "count", rule.count, between(0.0, 1e6))) rule.count = 1.0;
    if (rule.on == BirthEvent::life && emitter.rate.mean + emitter.rate.spread == 0.0) {
        context.warn(view, "emits nothing: it has no rate");
    }
    return rule;
}

void check_parents(const SceneContext& context, SimulationSetup& setup) {
    find_parents(context, setup);
    warn_of_parent_cycles(context, setup);
    check_mass_distribution(context, setup);
}

void check_clouds(const SceneContext& context, const SimulationSetup& setup) {
    const std::vector<ObjectView> views = context.objects("emitters");
    const SimulationOptions& options = setup.options;
    for (std::size_t k = 0; k < views.size() && k < setup.emitters.size(); ++k) {
        if (!is_cloud(setup.emitters[k])) continue;
        const auto refuse = [&](bool refused, std::string_view what) {
            if (refused) context.error(views[k], "cloud", fmt::format("does not go together with {}", what));
        };
        refuse(options.response != ResponseKind::exact,
               fmt::format("the response \"{}\", expected \"exact\"", name_of(options.response)));
        refuse(options.flow != nullptr, "a flow that carries the particles, expected \"motion\": \"forces\"");
        refuse(options.particle_contacts.has_value(),
               "\"particle_contacts\": contacts of a cloud would have to act on its parent; leave out one of the two");
        refuse(!setup.springs.empty() || !context.objects("particle_forces").empty(),
               "springs and forces between particles, which would also have to act on the parent; leave out one of "
               "the two");
        refuse(!setup.bodies.empty(),
               "a frame's \"body\", which impulses move: give that frame \"motions\", or leave out the cloud");
        refuse(std::any_of(setup.colliders.begin(), setup.colliders.end(), is_deforming),
               "meshes that deform: give them a shape that stays, or leave out the cloud");
        const double turn = cloud_turn(*setup.emitters[k].parent->cloud, options.time_step);
        if (turn <= kMostCloudTurnOfStep) continue;
        context.error(
            views[k], "cloud",
            fmt::format("turns or swings by {:.3g} rad in a time step of {:g} s (by turning, the root of pull, "
                        "or damping), expected at most {:g}: take a shorter time step",
                        turn, options.time_step, kMostCloudTurnOfStep));
    }
}

}  // namespace ricochet::detail
