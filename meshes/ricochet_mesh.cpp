/// \file
/// ricochet-mesh: makes colliders of any size.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command_line.h"
#include "kinds.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "run/mesh_writer.h"

namespace {

using namespace ricochet;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongInput = 2;

/// Arguments of the command line.
struct Request {
    std::size_t triangles = 10'000;
    std::filesystem::path output;
    int decimals = -1;  // all digits if below 0
    std::function<TriangleMesh(std::size_t)> build;
};

void print_kinds() {
    for (const meshes::Kind& kind : meshes::kinds()) fmt::print("{:<14}{}\n", kind.name, kind.summary);
}

/// Rounds coordinates to a number of decimals, which keeps text files small.
void round_coordinates(TriangleMesh& mesh, int decimals) {
    double unit = 1.0;
    for (int i = 0; i < decimals; ++i) unit *= 10.0;
    for (Vec3& p : mesh.vertices) {
        p = {std::nearbyint(p.x * unit) / unit, std::nearbyint(p.y * unit) / unit, std::nearbyint(p.z * unit) / unit};
    }
}

void require_sound(const TriangleMesh& mesh) {
    for (const Triangle& t : mesh.triangles) {
        if (!are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) continue;
        throw InputError("rounding left a triangle without area: use fewer --triangles or more --decimals");
    }
}

void make_mesh(const Request& request) {
    TriangleMesh mesh = request.build(request.triangles);
    if (request.decimals >= 0) {
        round_coordinates(mesh, request.decimals);
        require_sound(mesh);
    }
    write_mesh(mesh, request.output);
    fmt::print("{}: {} triangles, {} vertices\n", request.output.string(), mesh.triangles.size(), mesh.vertices.size());
}

void add_kind(cli::Command program, const meshes::Kind& kind, Request& request) {
    cli::Command command = program.add_command(kind.name, kind.summary);
    command.add_option("--triangles", request.triangles, "approximate number of triangles, 2 to 100 million")
        .show_default();
    command.add_option("--output", request.output, "file to write: .obj, .ply, .stl or .off").required();
    command.add_option("--decimals", request.decimals, "round coordinates to this many decimals (default: all digits)")
        .range(0, 15);
    auto build = kind.add_options(command);
    command.on_call([&request, build] { request.build = build; });
}

void require_known_shape(const std::string& name) {
    const auto& all = meshes::kinds();
    const auto same = [&](const meshes::Kind& kind) { return kind.name == name; };
    if (name == "list" || std::any_of(all.begin(), all.end(), same)) return;
    throw InputError(fmt::format("there is no shape '{}': ricochet-mesh list shows all", name));
}

int run(int argc, char** argv) {
    if (argc > 1 && argv[1][0] != '-') require_known_shape(argv[1]);
    cli::CommandLine line("Makes triangle meshes for colliders. Metres, z up; the same bits on every machine.",
                          "ricochet-mesh");
    Request request;
    const cli::Command list = line.program().add_command("list", "list all shapes");
    for (const meshes::Kind& kind : meshes::kinds()) add_kind(line.program(), kind, request);
    const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    if (const auto printed = line.parse(words, "try ricochet-mesh --help")) return *printed;
    if (list.is_called()) {
        print_kinds();
    } else {
        make_mesh(request);
    }
    return kDone;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const InputError& error) {
        fmt::print(stderr, "ricochet-mesh: {}\n", error.what());
        return kWrongInput;
    } catch (const std::exception& error) {
        fmt::print(stderr, "ricochet-mesh: {}\n", error.what());
        return kFailed;
    }
}
