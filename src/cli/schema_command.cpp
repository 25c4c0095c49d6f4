#include "cli/commands.h"

#include <fmt/format.h>

#include <memory>

#include "ricochet/io/scene.h"

namespace ricochet {

void add_schema_command(cli::Command program, int& exit_code) {
    const auto markdown = std::make_shared<bool>(false);
    cli::Command command = program.add_command("schema", "Prints the JSON Schema of scene files");
    command.add_flag("--markdown", *markdown, "Print the reference page instead");
    command.on_call([markdown, &exit_code] {
        fmt::print("{}", *markdown ? scene_reference() : scene_schema());
        exit_code = 0;
    });
}

}  // namespace ricochet
