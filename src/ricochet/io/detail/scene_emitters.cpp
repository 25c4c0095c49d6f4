// Emitters of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/placed_mesh.h"
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
    auto world = std::make_shared<const TriangleMesh>(placed(*mesh, placement));
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
    if (view.type() == "mesh") return MeshSurfaceShape{surface_of(context, setup, view)};
    return PointShape{view.type() == "point" ? view.vector("center") : Vec3{}};
}

EmitterDescription emitter_of(const ObjectView& view) {
    EmitterDescription emitter;
    emitter.burst = view.whole_number("burst");
    emitter.rate = view.pair("rate");
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

// Reports contradictions; returns the most births there can be.
double checked_births(const SceneContext& context, const ObjectView& view, const EmitterDescription& emitter,
                      double duration) {
    if (emitter.stop < emitter.start) {
        context.error(view, "stop",
                      fmt::format("found {} s, expected a time after start ({} s)", emitter.stop, emitter.start));
    }
    const double most_rate = emitter.rate.mean + emitter.rate.spread;
    const double time = std::max(0.0, std::min(duration, emitter.stop) - emitter.start);
    const double births = static_cast<double>(emitter.burst) + most_rate * time;
    if ((emitter.burst == 0 && most_rate == 0.0) || emitter.limit == 0) {
        context.diagnostics().warning(view.place(), view.path(), "emits nothing: it has neither a burst nor a rate");
    } else if (emitter.start >= duration) {
        context.warn(view, "start",
                     fmt::format("emits nothing: it begins at {} s, the scene ends at {} s", emitter.start, duration));
    }
    return std::min(births, static_cast<double>(emitter.limit));
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
        births += checked_births(context, view, emitter, setup.options.duration);
        if (births > kMostParticles) {
            context.diagnostics().error(
                view.place(), view.path(),
                fmt::format("with this emitter the scene gives birth to {:.3g} particles, expected at most {}", births,
                            kMostParticles));
        }
        setup.emitters.push_back(std::move(emitter));
    }
}

}  // namespace ricochet::detail
