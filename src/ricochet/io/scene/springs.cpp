// Springs of a scene: single springs, ropes, chains and cloth.
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/dynamics/settings_table.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/scene/context.h"
#include "ricochet/simulation/memory_estimate.h"

namespace ricochet::detail {
namespace {

/// Local: a limit of input values.
constexpr double kMostVertices = 1e8;  // largest number of vertices of a sheet

enum class PinnedEnds { none, from, to, both };

// Keys of a rope or a chain.
struct RopeKeys : RopeSettings {
    std::size_t links = 1;
    double link_length = 1.0;
    PinnedEnds pinned = PinnedEnds::none;
};

// Keys of cloth and sheets.
struct ClothKeys : ClothSettings {
    std::optional<double> total_mass;
    std::optional<double> area_mass;
    std::vector<std::uint64_t> pinned_vertices;
    Placement placement;
    Vec3 corner;
    Vec3 side_u;
    Vec3 side_v;
    std::size_t cells_u = 1;
    std::size_t cells_v = 1;
};

constexpr Range kElements = between(1.0, 1e8);

const ObjectSpec& spring_spec() {
    using S = Spring;
    static const ObjectSpec spec = object<S>(
        "spring", "A spring between two particles.",
        joined<S>({{{"first", &S::first, kCount, "", "Number of the particle at one end.", kRequired},
                    {"second", &S::second, kCount, "", "Number of the particle at the other end.", kRequired}},
                   fields_of<S>(kSpringTable),
                   fields_of<S>(kDampingTable<S>)}));
    return spec;
}

const ObjectSpec& pin_box_spec() {
    static const ObjectSpec spec =
        object("pin box", "A box along the axes. Vertices in it or on its surface are pinned.",
               box_fields("Corner with the largest coordinates."));
    return spec;
}

Variant list_variant() {
    return variant<Unbound>("list",
                            "Single springs between particles. The numbers of particles start at 0: first the list "
                            "`particles`, then the particles of ropes, chains, cloths and sheets, each in its order.",
                            {{"springs", ValueType::list, "The springs.", &spring_spec(), kRequired}});
}

// Returns the keys that ropes and chains share.
Fields<RopeKeys> rope_fields() {
    using R = RopeKeys;
    return joined<R>({fields_of<R>(kRopeTable),
                      fields_of<R>(kDampingTable<RopeSettings>),
                      {{"sag", &R::sag, kCoordinate, "",
                        "Direction in which it hangs at first, if it is longer than the distance of its ends.",
                        kNotZero, Without{"along the uniform forces, or -z"}},
                       {"pinned", &R::pinned, "Ends that never move.",
                        Choices{choice(PinnedEnds::none, "none", "both are free"),
                                choice(PinnedEnds::from, "from", "the first particle"),
                                choice(PinnedEnds::to, "to", "the last particle"),
                                choice(PinnedEnds::both, "both", "the first and the last particle")}}}});
}

Variant rope_variant() {
    using R = RopeKeys;
    return variant("rope", "Particles at equal distances along a line, with springs between neighbours.",
                   joined<R>({fields_of<R>(kRopeEndsTable),
                              {{"nodes", &R::nodes, between(2.0, 1e8), "", "Number of its particles.", kRequired}},
                              fields_of<R>(kRopeLengthTable),
                              rope_fields()}),
                   {"stiffness", "axial_stiffness"});
}

Variant chain_variant() {
    using R = RopeKeys;
    return variant(
        "chain",
        "A rope described by its links. It starts as a catenary if it is longer than the distance of its ends.",
        joined<R>({fields_of<R>(kRopeEndsTable),
                   {{"links", &R::links, kElements, "", "Number of springs in a row. The chain has one particle more.",
                     kRequired},
                    {"link_length", &R::link_length, kLength, "m", "Rest length of a link.", kRequired}},
                   rope_fields()}),
        {"stiffness", "axial_stiffness"});
}

// Returns the keys that cloth and sheets share.
Fields<ClothKeys> cloth_fields() {
    using C = ClothKeys;
    return joined<C>(
        {{{"mass", &C::total_mass, kMass, "kg", "Total mass."},
          {"mass_per_area", &C::area_mass, kPositive, "kg/m^2", "Mass per area."}},
         fields_of<C>(kClothTable),
         fields_of<C>(kDampingTable<ClothSettings>),
         {{"pinned", &C::pinned_vertices, "Numbers, from 0, of vertices that never move.", Without{"none"}},
          {"pin_boxes", ValueType::list, "Boxes in which vertices never move.", &pin_box_spec()}}});
}

Variant cloth_variant() {
    return variant("cloth",
                   "A particle at every vertex of a mesh, and a spring along every edge. The mesh is the rest shape. A "
                   "particle has a third of the mass of every triangle around it.",
                   joined<ClothKeys>({{{"file", ValueType::file, kMeshFileMeaning, kRequired}, up_field<ClothKeys>()},
                                      placement_fields(&ClothKeys::placement),
                                      cloth_fields()}),
                   {"mass", "mass_per_area"});
}

Variant sheet_variant() {
    using C = ClothKeys;
    return variant("sheet",
                   "A flat cloth without a file, made of cells with two triangles each. Vertex (i, j) has the number j "
                   "(cells_u + 1) + i.",
                   joined<C>({{{"corner", &C::corner, kCoordinate, "m", "A corner of the sheet.", kRequired},
                               {"side_u", &C::side_u, kCoordinate, "m",
                                "Vector from the corner along one side to its end.", kRequired},
                               {"side_v", &C::side_v, kCoordinate, "m",
                                "Vector from the corner along the other side to its end.", kRequired},
                               {"cells_u", &C::cells_u, kElements, "", "Number of cells along `side_u`.", kRequired},
                               {"cells_v", &C::cells_v, kElements, "", "Number of cells along `side_v`.", kRequired}},
                              cloth_fields()}),
                   {"mass", "mass_per_area"});
}

// Returns the direction in which slack ropes hang at the start.
Vec3 fall_of(const SimulationSetup& setup) {
    const Vec3 fall = uniform_acceleration(setup);
    return fall == Vec3{} ? Vec3{0, 0, -1} : fall;
}

class SpringBuilder {
public:
    SpringBuilder(SceneContext& context, const SimulationSetup& setup)
        : context_(context),
          integrator_(setup.options.integrator.kind),
          all_{setup.particles, {}, {}},
          fall_(fall_of(setup)) {
        for (std::size_t i = 0; i < all_.particles.size(); ++i) all_.particles[i].id = i;
    }

    // Builds all springs. Single springs come last, because they can join any two particles.
    SpringBody build() {
        const std::vector<ObjectView> views = context_.objects("springs");
        for (const ObjectView& view : views) {
            if (view.type() == "list" || view.type().empty()) continue;
            try {
                const SpringBody body = body_of(view);
                is_complete_ = is_complete_ && !body.particles.empty();
                all_.append(body);
            } catch (const InputError& problem) {
                context_.error(view, problem.what());
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

    SpringBody rope_of(const ObjectView& view) {
        const bool is_chain = view.type() == "chain";
        const std::string_view count = is_chain ? "links" : "nodes";
        if (!view.is_complete()) return {};
        RopeKeys rope = view.read<RopeKeys>();
        if (is_chain) {
            rope.nodes = rope.links + 1;
            rope.length = rope.link_length * static_cast<double>(rope.links);
        }
        if (!view.has("sag")) rope.sag = fall_;
        rope.pin_from = rope.pinned == PinnedEnds::from || rope.pinned == PinnedEnds::both;
        rope.pin_to = rope.pinned == PinnedEnds::to || rope.pinned == PinnedEnds::both;
        const auto nodes = static_cast<double>(rope.nodes);
        if (!is_room(view, count, nodes, nodes - 1.0)) return {};
        return make_rope(rope);
    }

    SpringBody sheet_of(const ObjectView& view) {
        if (!view.is_complete()) return {};
        const auto sheet = view.read<ClothKeys>();
        const double vertices = (static_cast<double>(sheet.cells_u) + 1.0) * (static_cast<double>(sheet.cells_v) + 1.0);
        if (vertices > kMostVertices) {
            throw InputError(fmt::format("{:.3g} vertices, expected at most {:.3g}", vertices, kMostVertices));
        }
        if (!is_room(view, "cells_u", vertices, springs_of(3.0 * vertices, sheet))) return {};
        return cloth_of(view, sheet_mesh(sheet.corner, sheet.side_u, sheet.side_v, sheet.cells_u, sheet.cells_v));
    }

    SpringBody cloth_of(const ObjectView& view) {
        const auto mesh = context_.load_mesh(view);
        if (!mesh || !view.is_complete()) return {};
        const auto keys = view.read<ClothKeys>();
        const double edges = 1.5 * static_cast<double>(mesh->triangles.size());
        if (!is_room(view, "file", static_cast<double>(mesh->vertices.size()), springs_of(edges, keys))) return {};
        const auto world = context_.placed_mesh(view, "file", *mesh, keys.placement);
        return world ? cloth_of(view, *world) : SpringBody{};
    }

    SpringBody cloth_of(const ObjectView& view, const TriangleMesh& mesh) {
        const double area = surface_area(mesh);
        if (!(area > 0.0)) throw InputError("the mesh has no area to make cloth of");
        auto cloth = view.read<ClothKeys>();
        cloth.mass_per_area = cloth.total_mass ? *cloth.total_mass / area : cloth.area_mass.value_or(0.0);
        for (const std::uint64_t vertex : cloth.pinned_vertices) {
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

    static double springs_of(double edges, const ClothKeys& cloth) {
        return cloth.bending_stiffness > 0.0 ? 2.0 * edges : edges;
    }

    // Returns true if a body with the given numbers of particles and springs fits into memory, together with all
    // previous bodies. Otherwise reports it at this key.
    [[nodiscard]] bool is_room(const ObjectView& view, std::string_view key, double particles, double springs) const {
        const double bytes = bytes_of_springs(particles + static_cast<double>(all_.particles.size()),
                                              springs + static_cast<double>(all_.springs.size()), integrator_);
        if (bytes <= limit_.bytes) return true;
        context_.error(
            view, key,
            fmt::format("with its {:.0f} particles the scene {}", particles, too_much_memory(bytes, limit_)));
        return false;
    }

    void pin_in_box(const ObjectView& view, const TriangleMesh& mesh, ClothSettings& cloth) const {
        if (!view.is_complete()) return;
        const auto box = view.read<Box3>();
        const std::size_t before = cloth.pinned.size();
        for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
            if (box.contains(mesh.vertices[i])) cloth.pinned.push_back(i);
        }
        if (cloth.pinned.size() > before) return;
        context_.error(view, "no vertex of the cloth lies in this box, expected at least one");
    }

    void add_spring(const ObjectView& view) {
        auto spring = view.read<Spring>();
        const bool has_ends = is_particle(view, "first", spring.first) && is_particle(view, "second", spring.second);
        if (!has_ends || !view.has("stiffness")) return;
        if (spring.first == spring.second) {
            context_.error(view, "second",
                           fmt::format("both ends are particle {}, expected two particles", spring.first));
            return;
        }
        if (!view.has("rest_length")) {
            spring.rest_length = length(all_.particles[spring.second].position - all_.particles[spring.first].position);
        }
        if (spring.rest_length == 0.0 && view.has("breaking_stretch")) {
            context_.error(view, "breaking_stretch",
                           "a spring without a rest length has no relative stretch, leave this key out");
        }
        all_.springs.push_back(spring);
    }

    // Returns true if there is a particle with this number. Otherwise reports the number.
    [[nodiscard]] bool is_particle(const ObjectView& view, std::string_view key, std::uint64_t number) const {
        if (!view.has(key)) return false;
        if (number < all_.particles.size()) return true;
        if (!is_complete_) return false;  // the number may belong to a body that was refused
        context_.error(view, key,
                       fmt::format("there is no particle {}, the scene has {} from the start (numbered from 0)", number,
                                   all_.particles.size()));
        return false;
    }

    SceneContext& context_;
    IntegratorKind integrator_;
    MemoryLimit limit_ = memory_limit();
    SpringBody all_;
    Vec3 fall_;
    bool is_complete_ = true;  // false after a body was refused
};

}  // namespace

const ObjectSpec& springs_spec() {
    static const ObjectSpec spec =
        object<Unbound>("springs",
                        "Springs between particles, and ropes, chains and cloth with particles of their own. "
                        "docs/springs.md describes their forces and the integrators that they need.",
                        {}, {list_variant(), rope_variant(), chain_variant(), cloth_variant(), sheet_variant()});
    return spec;
}

void build_springs(SceneContext& context, SimulationSetup& setup) {
    SpringBody body = SpringBuilder(context, setup).build();
    setup.particles = std::move(body.particles);
    setup.springs = std::move(body.springs);
    setup.spring_faces = std::move(body.faces);
}

}  // namespace ricochet::detail
