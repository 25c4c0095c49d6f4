// ricochet render DIR --output FILE.png|.mp4
#pragma once

namespace CLI {
class App;
}

namespace ricochet {

/// Adds `render` to the parser.
void add_render_command(CLI::App& app, int& exit_code);

}  // namespace ricochet
