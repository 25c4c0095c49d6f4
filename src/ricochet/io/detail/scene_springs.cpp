// Springs of a scene: one by one, and as ropes, chains and cloth.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/detail/scene_context.h"

namespace ricochet::detail {
namespace {

constexpr double kMostVertices = 1e8;  // of a sheet

// Direction in which things fall at first.
Vec3 fall_of(const SimulationSetup& setup) {
    Vec3 fall;
    for (const auto& force : setup.forces) {
        if (force->is_uniform()) fall += force->acceleration({Vec3{}, Vec3{}, 1.0, 0.0, 0.0});
    }
    return fall == Vec3{} ? Vec3{0, 0, -1} : fall;
}

class SpringBuilder {
public:
    SpringBuilder(SceneContext& context, const SimulationSetup& setup)
        : context_(context), all_{setup.particles, {}, {}}, fall_(fall_of(setup)) {
        for (std::size_t i = 0; i < all_.particles.size(); ++i) all_.particles[i].id = i;
    }

    // Single springs come last: they may join any two particles.
    SpringBody build() {
        const std::vector<ObjectView> views = context_.objects("springs");
        for (const ObjectView& view : views) {
            if (view.type() == "list" || view.type().empty()) continue;
            try {
                const SpringBody body = body_of(view);
                is_complete_ = is_complete_ && !body.particles.empty();
                all_.append(body);
            } catch (const InputError& problem) {
                context_.diagnostics().error(view.place(), view.path(), problem.what());
                is_complete_ = false;
            }
        }
        for (const ObjectView& view : views) {
            if (view.type() != "list") continue;
            for (const ObjectView& spring : view.objects("springs")) add_spring(spring);
        }
        return std::move(all_);
    }

private:
    SpringBody body_of(const ObjectView& view) {
        if (view.type() == "rope" || view.type() == "chain") return rope_of(view);
        return view.type() == "sheet" ? sheet_of(view) : cloth_of(view);
    }

    static double breaking_stretch_of(const ObjectView& view) {
        return view.has("breaking_stretch") ? view.number("breaking_stretch") : std::numeric_limits<double>::infinity();
    }

    // What is refused already must not be refused again by the maker.
    static bool is_complete(const ObjectView& view, std::initializer_list<std::string_view> keys,
                            std::string_view either, std::string_view other) {
        return std::all_of(keys.begin(), keys.end(), [&](std::string_view key) { return view.has(key); }) &&
               view.has(either) != view.has(other);
    }

    SpringBody rope_of(const ObjectView& view) {
        const bool is_chain = view.type() == "chain";
        const std::string_view count = is_chain ? "links" : "nodes";
        if (!is_complete(view, {"from", "to", "mass", count}, "stiffness", "axial_stiffness")) return {};
        RopeSettings rope;
        rope.from = view.vector("from");
        rope.to = view.vector("to");
        rope.nodes = static_cast<std::size_t>(view.whole_number(count)) + (is_chain ? 1 : 0);
        if (is_chain && !view.has("link_length")) return {};
        if (is_chain) rope.length = view.number("link_length") * static_cast<double>(rope.nodes - 1);
        if (!is_chain && view.has("length")) rope.length = view.number("length");
        rope.sag = view.has("sag") ? view.vector("sag") : fall_;
        rope.mass = view.number("mass");
        rope.radius = view.number("radius");
        if (view.has("stiffness")) rope.stiffness = view.number("stiffness");
        if (view.has("axial_stiffness")) rope.axial_stiffness = view.number("axial_stiffness");
        rope.damping = view.number("damping");
        rope.breaking_stretch = breaking_stretch_of(view);
        const std::string pinned = view.text("pinned");
        rope.pin_from = pinned == "from" || pinned == "both";
        rope.pin_to = pinned == "to" || pinned == "both";
        return make_rope(rope);
    }

    SpringBody sheet_of(const ObjectView& view) {
        if (!is_complete(view, {"corner", "side_u", "side_v", "cells_u", "cells_v", "stiffness"}, "mass",
                         "mass_per_area")) {
            return {};
        }
        const double vertices = (static_cast<double>(view.whole_number("cells_u")) + 1.0) *
                                (static_cast<double>(view.whole_number("cells_v")) + 1.0);
        if (vertices > kMostVertices) {
            throw InputError(fmt::format("{:.3g} vertices, expected at most {:.3g}", vertices, kMostVertices));
        }
        return cloth_of(view, sheet_mesh(view.vector("corner"), view.vector("side_u"), view.vector("side_v"),
                                         static_cast<std::size_t>(view.whole_number("cells_u")),
                                         static_cast<std::size_t>(view.whole_number("cells_v"))));
    }

    SpringBody cloth_of(const ObjectView& view) {
        const auto mesh = context_.load_mesh(view);
        if (!mesh || !is_complete(view, {"stiffness"}, "mass", "mass_per_area")) return {};
        const TriangleMesh world = transformed(*mesh, SceneContext::placement_of(view));
        const bool is_placed_well = std::all_of(world.vertices.begin(), world.vertices.end(), [](const Vec3& v) {
            return is_finite(v) && max_abs(v) <= kLargestCoordinate;
        });
        if (!is_placed_well) {
            context_.error(view, "file",
                           fmt::format("a placed vertex is not finite or beyond {} m", kLargestCoordinate));
            return {};
        }
        return cloth_of(view, world);
    }

    SpringBody cloth_of(const ObjectView& view, const TriangleMesh& mesh) {
        const double area = surface_area(mesh);
        if (!(area > 0.0)) throw InputError("the mesh has no area to make cloth of");
        ClothSettings cloth;
        cloth.mass_per_area = view.has("mass") ? view.number("mass") / area : view.number("mass_per_area");
        cloth.radius = view.number("radius");
        cloth.stiffness = view.number("stiffness");
        cloth.damping = view.number("damping");
        cloth.bending_stiffness = view.number("bending_stiffness");
        cloth.breaking_stretch = breaking_stretch_of(view);
        for (const std::uint64_t vertex : view.whole_numbers("pinned")) {
            if (vertex < mesh.vertices.size()) {
                cloth.pinned.push_back(static_cast<std::uint32_t>(vertex));
            } else {
                context_.error(view, "pinned",
                               fmt::format("found vertex {}, expected a number below {}, the number of vertices",
                                           vertex, mesh.vertices.size()));
            }
        }
        for (const ObjectView& box : view.objects("pin_boxes")) pin_in_box(box, mesh, cloth);
        return make_cloth(mesh, cloth);
    }

    void pin_in_box(const ObjectView& view, const TriangleMesh& mesh, ClothSettings& cloth) const {
        if (!view.has("lower") || !view.has("upper")) return;
        Box3 box;
        box.lower = view.vector("lower");
        box.upper = view.vector("upper");
        const std::size_t before = cloth.pinned.size();
        for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
            if (box.contains(mesh.vertices[i])) cloth.pinned.push_back(i);
        }
        if (cloth.pinned.size() > before) return;
        context_.diagnostics().error(view.place(), view.path(),
                                     "no vertex of the cloth lies in this box, expected at least one");
    }

    void add_spring(const ObjectView& view) {
        const bool has_ends = is_particle(view, "first") && is_particle(view, "second");
        if (!has_ends || !view.has("stiffness")) return;
        Spring spring;
        spring.first = view.whole_number("first");
        spring.second = view.whole_number("second");
        if (spring.first == spring.second) {
            context_.error(view, "second",
                           fmt::format("both ends are particle {}, expected two particles", spring.first));
            return;
        }
        spring.rest_length =
            view.has("rest_length")
                ? view.number("rest_length")
                : length(all_.particles[spring.second].position - all_.particles[spring.first].position);
        spring.stiffness = view.number("stiffness");
        spring.damping = view.number("damping");
        spring.breaking_stretch = breaking_stretch_of(view);
        if (spring.rest_length == 0.0 && view.has("breaking_stretch")) {
            context_.error(view, "breaking_stretch",
                           "a spring without a rest length has no relative stretch, leave this key out");
        }
        all_.springs.push_back(spring);
    }

    // Reports a number that no particle has.
    [[nodiscard]] bool is_particle(const ObjectView& view, std::string_view key) const {
        if (!view.has(key)) return false;
        const std::uint64_t number = view.whole_number(key);
        if (number < all_.particles.size()) return true;
        if (!is_complete_) return false;  // it may be one of a body that was refused
        context_.error(view, key,
                       fmt::format("there is no particle {}, the scene has {} from the start (numbered from 0)", number,
                                   all_.particles.size()));
        return false;
    }

    SceneContext& context_;
    SpringBody all_;
    Vec3 fall_;
    bool is_complete_ = true;  // no body has been refused
};

}  // namespace

void build_springs(SceneContext& context, SimulationSetup& setup) {
    SpringBody body = SpringBuilder(context, setup).build();
    setup.particles = std::move(body.particles);
    setup.springs = std::move(body.springs);
    setup.spring_faces = std::move(body.faces);
}

}  // namespace ricochet::detail
