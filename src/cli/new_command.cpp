#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/scene_templates.h"
#include "cli/terminal.h"
#include "inspect/mesh_report.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/plausible_size.h"
#include "ricochet/io/scene.h"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

struct NewArguments {
    std::string mesh;
    std::string output;
    std::string kind = "rain";
    std::string up;    ///< axis that points up; empty: default of the file format
    std::string unit;  ///< unit of the mesh file; empty: not stated, so metres are assumed
    bool force = false;
};

cli::SceneTemplate wanted_template(const NewArguments& arguments) {
    if (const auto kind = cli::template_named(arguments.kind)) return *kind;
    throw InputError(
        fmt::format("--template: found \"{}\", expected rain, debris, sparks, gas or fountain", arguments.kind));
}

// Returns the box after a quarter turn about x.
Box3 turned(const Box3& box, Vec3 (*turn)(const Vec3&)) {
    Box3 result;
    for (const Vec3& corner : {box.lower, box.upper}) result.include(turn(corner));
    return result;
}

struct Unit {
    std::string_view name;
    double metres;
};
constexpr std::array<Unit, 9> kUnits = {{{"um", 1e-6},
                                         {"mm", 1e-3},
                                         {"cm", 0.01},
                                         {"dm", 0.1},
                                         {"m", 1.0},
                                         {"km", 1e3},
                                         {"in", 0.0254},
                                         {"ft", 0.3048},
                                         {"yd", 0.9144}}};

// Returns the length of a unit in metres.
double metres_in(const std::string& unit) {
    std::vector<std::string_view> names;
    for (const auto& [name, metres] : kUnits) {
        if (name == unit) return metres;
        names.push_back(name);
    }
    throw InputError(fmt::format("--unit: found \"{}\", expected one of {}", unit, fmt::join(names, ", ")));
}

void warn_of_size(const NewArguments& arguments, const Box3& bounds, const std::string& format) {
    if (arguments.unit == "m") return;
    const bool is_stated = !arguments.unit.empty();
    const auto doubt = implausible_size(bounds, is_stated ? SizeOrigin::stated : size_origin(format));
    if (!doubt) return;
    cli::print(stderr, "ricochet: warning: {}: {}{}\n", arguments.mesh, *doubt,
               is_stated ? fmt::format(" by --unit {}: give the unit that its numbers have", arguments.unit)
                         : "; give --unit mm (or cm, in, ...), or --unit m to keep the size");
}

// Returns the mesh path relative to the scene's folder, so that the scene and the mesh can be moved together.
std::string file_from(const fs::path& scene, const fs::path& mesh) {
    const fs::path folder = fs::weakly_canonical(scene.parent_path().empty() ? fs::path(".") : scene.parent_path());
    return fs::proximate(fs::weakly_canonical(mesh), folder).generic_string();
}

cli::FittedMesh fitted_mesh(const NewArguments& arguments) {
    if (!arguments.up.empty() && arguments.up != "z" && arguments.up != "y")
        throw InputError(fmt::format("--up: found \"{}\", expected z or y", arguments.up));
    const MeshReport report = report_on(read_mesh(arguments.mesh));
    cli::FittedMesh mesh;
    mesh.up = arguments.up;
    mesh.bounds = report.bounds;
    if (mesh.up == "y" && !report.y_up) mesh.bounds = turned(report.bounds, y_up_as_z_up);
    if (mesh.up == "z" && report.y_up) mesh.bounds = turned(report.bounds, z_up_as_y_up);
    mesh.format_up = report.y_up ? "y" : "z";
    mesh.closed = report.topology.closed;
    mesh.file = file_from(arguments.output, arguments.mesh);
    if (!arguments.unit.empty()) mesh.scale = metres_in(arguments.unit);
    if (mesh.scale > 0.0) mesh.bounds = {mesh.scale * mesh.bounds.lower, mesh.scale * mesh.bounds.upper};
    if (!(mesh.bounds.diagonal() > 0.0) || !std::isfinite(mesh.bounds.diagonal()))
        throw InputError(fmt::format("{}: the mesh has no extent, a scene cannot be fitted to it", arguments.mesh));
    warn_of_size(arguments, mesh.bounds, report.format);
    return mesh;
}

// Checks that the written scene can run.
void check_scene(const NewArguments& arguments, const std::string& text) {
    try {
        const Simulation simulation(parse_scene(text, arguments.output).setup);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: no {} scene can be fitted to this mesh: {}", arguments.mesh, arguments.kind,
                                     error.what()));
    }
}

bool can_be_read(const std::string& text, const std::string& file) {
    try {
        const Simulation simulation(parse_scene(text, file).setup);
        return true;
    } catch (const InputError&) {
        return false;
    }
}

void make_scene(const NewArguments& arguments) {
    const cli::SceneTemplate kind = wanted_template(arguments);
    const fs::path target(arguments.output);
    std::error_code ignored;
    if (fs::equivalent(target, arguments.mesh, ignored))
        throw InputError(fmt::format("--output {}: is the mesh itself, expected another name", arguments.output));
    if (!arguments.force && fs::exists(fs::symlink_status(target, ignored)))
        throw InputError(
            fmt::format("--output {}: exists already; another name, or --force to replace it", arguments.output));
    cli::FittedMesh mesh = fitted_mesh(arguments);
    const bool is_to_be_filled = kind == cli::SceneTemplate::gas && mesh.closed;
    std::string text = cli::scene_text(kind, mesh);
    if (is_to_be_filled && !can_be_read(text, arguments.output)) {
        mesh.closed = false;
        text = cli::scene_text(kind, mesh);
    }
    check_scene(arguments, text);
    write_file(target, text);
    const std::string folder = (target.parent_path() / target.stem()).generic_string();
    const std::string up = mesh.up.empty() ? mesh.format_up : mesh.up;
    const Vec3 size = mesh.bounds.size();
    cli::print("{}: a {} scene for {} of {:.3g} x {:.3g} x {:.3g} m, {} up\n", arguments.output, arguments.kind,
               arguments.mesh, size.x, size.y, size.z, up);
    if (kind == cli::SceneTemplate::gas && !mesh.closed) {
        cli::print("  the gas is around the mesh, in a box, not in it: {}\n",
                   is_to_be_filled ? "the mesh has no interior to fill, because it encloses almost nothing or some "
                                     "edges have three faces or more"
                                   : "the mesh is not closed, `ricochet info` tells why");
    }
    cli::print("  if the mesh lies on its side: --up {} --force\n", up == "z" ? "y" : "z");
    cli::print("  next: ricochet run {} --output {}\n", arguments.output, folder == target ? folder + "_run" : folder);
}

}  // namespace

void add_new_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<NewArguments>();
    cli::Command command = program.add_command("new", "Write a first scene, fitted to a mesh");
    command.add_option("mesh", arguments->mesh, "OBJ, PLY, STL, OFF or glTF file").required();
    command.add_option("--output", arguments->output, "Scene file to write").type_name("FILE.json").required();
    command.add_option("--template", arguments->kind, "Kind of scene")
        .type_name("rain|debris|sparks|gas|fountain")
        .show_default();
    command.add_option("--up", arguments->up, "Axis of the mesh file that points up (default: y of glTF, else z)")
        .type_name("z|y");
    command.add_option("--unit", arguments->unit, "Unit of the mesh file's numbers; scenes are in metres (default: m)")
        .type_name("um|mm|cm|dm|m|km|in|ft|yd");
    command.add_flag("--force", arguments->force, "Replace a scene file of that name");
    command.on_call([arguments, &exit_code] {
        make_scene(*arguments);
        exit_code = 0;
    });
}

}  // namespace ricochet
