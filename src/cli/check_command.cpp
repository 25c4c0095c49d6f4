#include "cli/commands.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "cli/scene_arguments.h"

namespace ricochet {
namespace {

std::string counted(std::size_t count, std::string_view singular) {
    return fmt::format("{} {}{}", count, singular, count == 1 ? "" : "s");
}

std::size_t triangle_count(const SimulationSetup& setup) {
    std::size_t triangles = 0;
    for (const ColliderDescription& collider : setup.colliders) {
        if (const auto* mesh = std::get_if<MeshShape>(&collider.shape)) triangles += mesh->mesh->triangles.size();
    }
    return triangles;
}

void run_check(const SceneArguments& arguments) {
    SceneDescription scene = load_scene(arguments);
    const std::string counts = fmt::format(
        "{} ({}), {}, {}, {}", counted(scene.setup.colliders.size(), "collider"),
        counted(triangle_count(scene.setup), "triangle"), counted(scene.setup.emitters.size(), "emitter"),
        counted(scene.setup.particles.size(), "explicit particle"), counted(scene.setup.forces.size(), "force"));
    try {
        const Simulation simulation(std::move(scene.setup));
        fmt::print("{}: ok: {}, {} of {:.6g} s\n", arguments.file, counts, counted(simulation.step_count(), "step"),
                   simulation.options().time_step);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", arguments.file, error.what()));
    }
}

}  // namespace

void add_check_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<SceneArguments>();
    cli::Command command = program.add_command("check", "Everything that is wrong with a scene, without running it");
    add_scene_arguments(command, *arguments);
    command.on_call([arguments, &exit_code] {
        run_check(*arguments);
        exit_code = 0;
    });
}

}  // namespace ricochet
