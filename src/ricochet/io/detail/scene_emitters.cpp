// Emitters of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/detail/attribute_keys.h"
#include "ricochet/io/detail/scene_context.h"

namespace ricochet::detail {
namespace {

constexpr double kMostParticles = 4294967295.0;  // their places in the arrays are 32-bit numbers

bool is_placed_well(const TriangleMesh& mesh) {
    return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [](const Vec3& v) { return is_finite(v) && max_abs(v) <= kLargestCoordinate; });
}

const MeshShape* mesh_collider(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view) {
    const std::string name = view.text("collider");
    std::vector<std::string_view> names;
    for (const ColliderDescription& collider : setup.colliders) {
        const auto* mesh = std::get_if<MeshShape>(&collider.shape);
        if (mesh != nullptr && collider.name == name) return mesh;
        if (mesh != nullptr) names.push_back(collider.name);
    }
    context.error(view, "collider", unknown_name("mesh collider", name, names));
    return nullptr;
}

// The mesh that an emitter stands on, in world coordinates. Null pointer after reporting.
std::shared_ptr<const TriangleMesh> surface_of(SceneContext& context, const SimulationSetup& setup,
                                               const ObjectView& view) {
    if (view.has("collider") && view.has("file")) return nullptr;  // reported already
    const bool is_collider = view.has("collider");
    std::shared_ptr<const TriangleMesh> mesh;
    Placement placement;
    if (!is_collider) {
        mesh = context.load_mesh(view);
        placement = SceneContext::placement_of(view);
    } else if (const MeshShape* collider = mesh_collider(context, setup, view)) {
        mesh = collider->mesh;
        placement = collider->placement;
    }
    if (!mesh) return nullptr;
    auto world = std::make_shared<const TriangleMesh>(transformed(*mesh, placement));
    const char* key = is_collider ? "collider" : "file";
    if (!is_placed_well(*world)) {
        context.error(view, key, fmt::format("a placed vertex is not finite or beyond {} m", kLargestCoordinate));
    } else if (!(surface_area(*world) > 0.0)) {
        context.error(view, key, "the mesh has no area to emit from");
    }
    return world;
}

EmitterShape shape_of(SceneContext& context, const SimulationSetup& setup, const ObjectView& view) {
    if (view.type() == "disk") return DiskShape{view.vector("center"), view.vector("normal"), view.number("radius")};
    if (view.type() == "box") return BoxShape{view.vector("center"), view.vector("size")};
    if (view.type() == "sphere") {
        return SphereShape{view.vector("center"), view.number("radius"), view.boolean("surface")};
    }
    if (view.type() == "mesh" && view.boolean("volume")) return MeshVolumeShape{surface_of(context, setup, view)};
    if (view.type() == "mesh") return MeshSurfaceShape{surface_of(context, setup, view)};
    if (view.type() == "cone") {
        return ConeShape{view.vector("apex"), view.vector("axis"), view.number("angle"), view.number("height")};
    }
    return PointShape{view.type() == "point" ? view.vector("center") : Vec3{}};
}

// False where a mesh was refused.
bool is_measurable(const EmitterShape& shape) {
    const auto* const surface = std::get_if<MeshSurfaceShape>(&shape);
    const auto* const volume = std::get_if<MeshVolumeShape>(&shape);
    return (surface == nullptr || surface->mesh) && (volume == nullptr || volume->mesh);
}

EmitterDescription emitter_of(const ObjectView& view) {
    EmitterDescription emitter;
    emitter.burst = view.whole_number("burst");
    emitter.rate = view.pair("rate");
    emitter.rate_per_frame = view.pair("rate_per_frame");
    emitter.rate_per_area = view.pair("rate_per_area");
    if (view.has("seed")) emitter.seed = view.whole_number("seed");
    emitter.start = view.number("start");
    if (view.has("stop")) emitter.stop = view.number("stop");
    if (view.has("limit")) emitter.limit = view.whole_number("limit");
    emitter.direction = view.vector("direction");
    emitter.cone_degrees = view.number("cone");
    emitter.speed = view.pair("speed");
    emitter.velocity = view.vector("velocity");
    emitter.mass = view.pair("mass");
    emitter.radius = view.pair("particle_radius");
    if (view.has("lifetime")) emitter.lifetime = view.pair("lifetime");
    return emitter;
}

// Lets the emitter stand in the frame that its key "frame" names.
void attach(const SceneContext& context, const ObjectView& view, const std::shared_ptr<const FrameTree>& frames,
            EmitterDescription& emitter) {
    if (!view.has("frame")) return;
    if (view.type() == "mesh" && view.has("collider")) {
        context.error(view, "frame",
                      "a collider's surface stands still, expected an emitter of another kind or a file");
        return;
    }
    if (view.type() == "child") {
        context.error(view, "frame", "children are born where their parents are, expected an emitter of another kind");
        return;
    }
    const std::string name = view.text("frame");
    if (const auto frame = frames->find(name)) {
        emitter.frames = frames;
        emitter.frame = *frame;
        return;
    }
    std::vector<std::string_view> names;
    for (std::size_t k = 0; k < frames->size(); ++k) names.push_back(frames->description(k).name);
    context.error(view, "frame", unknown_name("frame", name, names));
}

double most_of(const MeanSpread& rate) { return rate.mean + rate.spread; }

// Most particles a second; reports rates that cannot be.
double most_rate(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                 const EmitterDescription& emitter) {
    const double per_area = most_of(emitter.rate_per_area);
    const int rates = (most_of(emitter.rate) > 0.0) + (most_of(emitter.rate_per_frame) > 0.0) + (per_area > 0.0);
    if (rates > 1) {
        const char* const key = most_of(emitter.rate_per_frame) > 0.0 ? "rate_per_frame" : "rate_per_area";
        context.error(view, key,
                      "the emitter has another rate already, expected one of rate, rate_per_frame and rate_per_area");
    }
    double per_frame = most_of(emitter.rate_per_frame);
    if (per_area > 0.0 && !setup.reference_camera) {
        context.error(view, "rate_per_area", "only goes together with the scene's \"reference_camera\"");
    } else if (per_area > 0.0 && is_measurable(emitter.shape)) {
        try {
            per_frame += per_area * screen_area(emitter.shape, *setup.reference_camera);
        } catch (const InputError& problem) {
            context.error(view, "rate_per_area", problem.what());
        }
    }
    return most_of(emitter.rate) + per_frame * setup.options.frame_rate;
}

// Reports contradictions; returns the most births there can be.
double checked_births(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                      const EmitterDescription& emitter) {
    const double duration = setup.options.duration;
    if (emitter.stop < emitter.start) {
        context.error(view, "stop",
                      fmt::format("found {} s, expected a time after start ({} s)", emitter.stop, emitter.start));
    }
    const double most = most_rate(context, setup, view, emitter);
    const double time = std::max(0.0, std::min(duration, emitter.stop) - emitter.start);
    const double births = static_cast<double>(emitter.burst) + most * time;
    if ((emitter.burst == 0 && most == 0.0) || emitter.limit == 0) {
        context.diagnostics().warning(view.place(), view.path(), "emits nothing: it has neither a burst nor a rate");
    } else if (emitter.start >= duration) {
        context.warn(view, "start",
                     fmt::format("emits nothing: it begins at {} s, the scene ends at {} s", emitter.start, duration));
    }
    return std::min(births, static_cast<double>(emitter.limit));
}

// Volumes that cannot be filled are reported by their file.
void check_volume(const SceneContext& context, const ObjectView& view, const EmitterShape& shape) {
    const auto* const volume = std::get_if<MeshVolumeShape>(&shape);
    if (volume == nullptr || volume->mesh == nullptr) return;
    try {
        const ShapeSampler sampler(shape);
    } catch (const InputError& problem) {
        context.error(view, view.has("collider") ? "collider" : "file", problem.what());
    }
}

// The rule of an emitter of type child. The parent's number is found when all emitters are known.
ParentRule rule_of(const SceneContext& context, const ObjectView& view, const EmitterDescription& emitter) {
    ParentRule rule;
    rule.on = birth_event_from_name(view.text("on")).value_or(BirthEvent::life);
    rule.count = view.pair("count");
    rule.threshold_impulse = view.number("threshold_impulse");
    rule.share = view.has("share") ? view.boolean("share") : rule.on == BirthEvent::impact;
    rule.recursive = view.boolean("recursive");
    rule.inherit_velocity = view.number("inherit_velocity");
    rule.inherit_color = view.number("inherit_color");
    for (const char* const key : {"burst", "start", "stop", "rate_per_frame", "rate_per_area"}) {
        if (view.has(key)) context.error(view, key, "is not for emitters of type \"child\", leave it out");
    }
    if (rule.share && rule.on == BirthEvent::life) {
        context.error(view, "share",
                      "a parent that lives on cannot be shared out; expected \"on\": \"death\" or \"impact\"");
    }
    if (rule.share && view.has("particle_radius")) {
        context.error(view, "particle_radius", "radii follow from the parent's when it is shared out, leave it out");
    }
    if (rule.on != BirthEvent::life && view.has("rate")) {
        context.error(view, "rate", "only goes together with \"on\": \"life\"; expected \"count\"");
    }
    if (rule.on == BirthEvent::life && most_of(emitter.rate) == 0.0) {
        context.diagnostics().warning(view.place(), view.path(), "emits nothing: it has no rate");
    }
    return rule;
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
            context.error(views[k], "parent", unknown_name("emitter", name, names));
        } else {
            setup.emitters[k].parent->emitter = static_cast<std::uint32_t>(found - names.begin());
        }
    }
}

// Two emitters cannot have the same parents to share out.
void check_shares(const SceneContext& context, const SimulationSetup& setup) {
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

void build_emitters(SceneContext& context, SimulationSetup& setup) {
    const std::shared_ptr<const FrameTree> frames = frames_of(context);
    std::set<std::string> taken;
    double births = 0.0;
    for (const ObjectView& view : context.objects("emitters")) {
        EmitterDescription emitter = emitter_of(view);
        emitter.name = context.unique_name(view, setup.emitters.size(), "emitter", taken);
        emitter.shape = shape_of(context, setup, view);
        attach(context, view, frames, emitter);
        check_volume(context, view, emitter.shape);
        read_looks(context, setup, view, emitter);
        if (view.type() == "child") {
            emitter.parent = rule_of(context, view, emitter);
        } else {
            births += checked_births(context, setup, view, emitter);
        }
        if (births > kMostParticles) {
            context.diagnostics().error(
                view.place(), view.path(),
                fmt::format("with this emitter the scene gives birth to {:.3g} particles, expected at most {}", births,
                            kMostParticles));
        }
        setup.emitters.push_back(std::move(emitter));
    }
    find_parents(context, setup);
    check_shares(context, setup);
}

}  // namespace ricochet::detail
