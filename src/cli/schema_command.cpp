#include "cli/schema_command.h"

#include <fmt/format.h>

#include <memory>

#include "ricochet/io/scene.h"

namespace ricochet {

void add_schema_command(CLI::App& app, int& exit_code) {
    const auto markdown = std::make_shared<bool>(false);
    CLI::App* const command = app.add_subcommand("schema", "Prints the JSON Schema of scene files");
    command->add_flag("--markdown", *markdown, "Print the reference page instead");
    command->callback([markdown, &exit_code] {
        fmt::print("{}", *markdown ? scene_reference() : scene_schema());
        exit_code = 0;
    });
}

}  // namespace ricochet
