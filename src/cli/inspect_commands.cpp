// Commands without a simulation: info, check and schema.
#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "inspect/face_names.h"
#include "inspect/mesh_report.h"
#include "inspect/scene_schema.h"
#include "inspect/scene_warnings.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/core/printable.h"
#include "ricochet/geometry/mesh/plausible_size.h"
#include "ricochet/io/scene.h"

namespace ricochet {

namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    std::string mesh;
    bool json = false;
};

Json json_of(const Vec3& p) { return Json::array({p.x, p.y, p.z}); }

std::string_view key_of(FaceNameKind kind) {
    return kind == FaceNameKind::material ? "material" : kind == FaceNameKind::group ? "group" : "object";
}

Json json_of(const MeshReport& report, const std::string& file) {
    const TopologyReport& topology = report.topology;
    Json out;
    out["file"] = file;
    out["format"] = report.format;
    out["vertices"] = report.vertices;
    out["faces"] = report.faces;
    out["triangles"] = report.triangles;
    out["bounds"] = Json::array({json_of(report.bounds.lower), json_of(report.bounds.upper)});
    out["area"] = report.area;
    out["volume"] = report.volume ? Json(*report.volume) : Json(nullptr);
    out["closed"] = topology.closed;
    out["shells"] = topology.shells;
    out["boundary_edges"] = topology.boundary_edges;
    out["boundary_loops"] = topology.boundary_loops;
    out["nonmanifold_edges"] = topology.nonmanifold_edges;
    out["nonmanifold_vertices"] = topology.nonmanifold_vertices;
    out["degenerate_triangles"] = report.degenerate_triangles;
    out["duplicate_faces"] = report.duplicate_faces;
    out["self_intersections"] = report.self_intersections;
    out["self_intersections_are_all"] = report.self_intersections_are_all;
    out["unused_vertices"] = topology.unused_vertices;
    out["consistently_oriented"] = topology.consistently_oriented;
    out["inconsistent_edges"] = topology.inconsistent_edges;
    out["wound_inward"] = report.wound_inward;
    out["y_up"] = report.y_up;
    out["names"] = Json::array();
    for (const NamedTriangles& named : report.names) {
        out["names"].push_back({{"kind", key_of(named.kind)}, {"name", named.name}, {"triangles", named.triangles}});
    }
    out["notes"] = report.notes;
    out["welded_corners"] = report.weld ? Json(report.weld->corners) : Json(nullptr);
    out["joined_vertices"] = report.joined_vertices;
    out["warnings"] = report.warnings;
    return out;
}

void print_line(std::string_view name, std::string_view value) { cli::print("{:<22}{}\n", name, value); }

template <typename Value>
void print_line(std::string_view name, const Value& value) {
    print_line(name, std::string_view(fmt::format("{}", value)));
}

std::string text_of(const Vec3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z); }

std::string yes_or_no(bool answer) { return answer ? "yes" : "no"; }

void print_sizes(const MeshReport& report) {
    print_line("format", report.format);
    print_line("vertices", report.vertices);
    print_line("faces", report.faces);
    print_line("triangles", report.triangles);
    if (report.y_up) print_line("up", "y, as glTF says; read as (x, -z, y), so that z points up");
    print_line("bounds", fmt::format("{} to {}", text_of(report.bounds.lower), text_of(report.bounds.upper)));
    print_line("area", fmt::format("{:.6g} m^2", report.area));
    print_line("volume", report.volume ? fmt::format("{:.6g} m^3", *report.volume) : "none (not closed)");
    if (report.weld) {
        print_line("weld", fmt::format("{} corners joined to {} vertices (equal coordinates)", report.weld->corners,
                                       report.weld->vertices));
    }
}

void print_topology(const MeshReport& report) {
    const TopologyReport& topology = report.topology;
    if (report.joined_vertices > 0) {
        print_line("joined", fmt::format("{} that another vertex has, so that they count as one below",
                                         report.joined_vertices == 1
                                             ? std::string("1 vertex has a position")
                                             : fmt::format("{} vertices have positions", report.joined_vertices)));
    }
    print_line("closed", yes_or_no(topology.closed));
    print_line("shells", topology.shells);
    print_line("boundary edges", topology.boundary_edges);
    print_line("boundary loops", topology.boundary_loops);
    print_line("non-manifold edges", topology.nonmanifold_edges);
    print_line("non-manifold vertices", topology.nonmanifold_vertices);
    print_line("degenerate triangles", report.degenerate_triangles);
    print_line("duplicate faces", report.duplicate_faces);
    print_line("self-intersections",
               fmt::format("{}{}", report.self_intersections_are_all ? "" : "at least ", report.self_intersections));
    print_line("consistently oriented", yes_or_no(topology.consistently_oriented));
}

std::string counted(std::size_t count, std::string_view singular) {
    return fmt::format("{} {}{}", count, singular, count == 1 ? "" : "s");
}

// Returns a name as written in a scene file, in characters that a terminal displays unchanged.
std::string as_in_scene(const std::string& name) {
    constexpr std::size_t kLongest = 200;
    try {
        const std::string text = Json(name).dump();
        return printable(printable(text) == text ? text : Json(name).dump(-1, ' ', true), kLongest);
    } catch (const Json::type_error&) {
        return printable(name, kLongest) + " (not UTF-8, so that no scene can name it)";
    }
}

void print_names(const MeshReport& report, FaceNameKind kind) {
    constexpr std::size_t kMostNames = 20;
    std::size_t count = 0;
    for (const NamedTriangles& named : report.names) count += named.kind == kind ? 1 : 0;
    if (count == 0) return;
    print_line(fmt::format("{} names", key_of(kind)), count);
    std::size_t shown = 0;
    for (const NamedTriangles& named : report.names) {
        if (named.kind != kind || shown == kMostNames) continue;
        ++shown;
        print_line("", fmt::format("{}: {}", as_in_scene(named.name), counted(named.triangles, "triangle")));
    }
    if (count > shown) print_line("", fmt::format("and {} more (--json has all)", count - shown));
}

void run_info(const InfoOptions& options) {
    MeshReport report = report_on(read_mesh(options.mesh));
    if (const auto doubt = implausible_size(report.bounds, size_origin(report.format))) {
        report.warnings.push_back(*doubt +
                                  ": give the unit to `ricochet new` (--unit mm), or a \"scale\" to the collider in a "
                                  "scene (0.001 for millimetres)");
    }
    if (options.json) {
        // Invalid UTF-8 is replaced, because a file name can contain any bytes and JSON needs UTF-8.
        fmt::print("{}\n", json_of(report, options.mesh).dump(2, ' ', false, Json::error_handler_t::replace));
        return;
    }
    print_line("file", options.mesh);
    print_sizes(report);
    print_topology(report);
    for (const auto kind : {FaceNameKind::material, FaceNameKind::group, FaceNameKind::object}) {
        print_names(report, kind);
    }
    for (const std::string& note : report.notes) cli::print("note: {}\n", note);
    for (const std::string& warning : report.warnings) cli::print("warning: {}\n", warning);
}

}  // namespace

void add_info_command(cli::Command program, int& exit_code) {
    const auto options = std::make_shared<InfoOptions>();
    cli::Command command = program.add_command("info", "Counts, names of parts, topology and defects of a mesh file");
    command.add_option("mesh", options->mesh, "OBJ, PLY, STL, OFF or glTF file").required();
    command.add_flag("--json", options->json, "Print one JSON object");
    command.on_call([options, &exit_code] {
        run_info(*options);
        exit_code = 0;
    });
}

namespace {

std::size_t triangle_count(const SimulationSetup& setup) {
    std::size_t triangles = 0;
    for (const ColliderDescription& collider : setup.colliders) {
        if (const auto* mesh = std::get_if<MeshShape>(&collider.shape)) triangles += mesh->mesh->triangles.size();
    }
    return triangles;
}

void print_warnings(const std::string& file, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) cli::print(stderr, "ricochet: warning: {}: {}\n", file, warning);
}

void run_check(const cli::SceneArguments& arguments) {
    SceneDescription scene = cli::load_scene(arguments);
    for (const std::string& note : scene.notes) cli::print("{}\n", note);
    const std::string memory = memory_text(scene.memory_bytes);
    const std::string counts = fmt::format(
        "{} ({}), {}, {}, {}", counted(scene.setup.colliders.size(), "collider"),
        counted(triangle_count(scene.setup), "triangle"), counted(scene.setup.emitters.size(), "emitter"),
        counted(scene.setup.particles.size(), "explicit particle"), counted(scene.setup.forces.size(), "force"));
    try {
        const std::vector<EmitterDescription> emitters = scene.setup.emitters;
        const Vec3 fall = uniform_acceleration(scene.setup);
        const std::vector<std::string> outside = bounds_warnings(scene.setup);
        const Simulation simulation(std::move(scene.setup));
        print_warnings(arguments.file, simulation.warnings());
        print_warnings(arguments.file, outside);
        print_warnings(arguments.file, scene_warnings(simulation, emitters, fall));
        cli::print("{}: ok: {}, {} of {:.6g} s, about {} of memory\n", arguments.file, counts,
                   counted(simulation.step_count(), "step"), simulation.options().time_step, memory);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", arguments.file, error.what()));
    }
}

}  // namespace

void add_check_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<cli::SceneArguments>();
    cli::Command command = program.add_command("check", "Check a scene for errors without running it");
    cli::add_scene_arguments(command, *arguments);
    command.on_call([arguments, &exit_code] {
        run_check(*arguments);
        exit_code = 0;
    });
}

void add_schema_command(cli::Command program, int& exit_code) {
    const auto markdown = std::make_shared<bool>(false);
    cli::Command command = program.add_command("schema", "Print the JSON Schema of scene files");
    command.add_flag("--markdown", *markdown, "Print the reference page instead");
    command.on_call([markdown, &exit_code] {
        fmt::print("{}", *markdown ? scene_reference() : scene_schema());
        exit_code = 0;
    });
}

}  // namespace ricochet
