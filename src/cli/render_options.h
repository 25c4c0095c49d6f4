// The options of `ricochet render`: as they stand on the command line, and what they mean.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/run_pictures.h"

namespace ricochet::cli {

/// The arguments as they stand on the command line.
struct RenderArguments {
    std::string folder;
    std::string output;
    std::string frame;  // empty: the scene's, or the last; of a film all
    std::string size = "1280x720";
    std::string camera;
    std::string up;
    std::string lens;
    std::string color_by;
    std::string drawing = "auto";
    std::string sprite;
    std::string mesh;
    double black_body = 0.0;  // 0: the scene's
    std::string color_map = "plasma";
    std::string range;
    std::string collider_color = "plain";
    std::string collider_range;
    bool color_bar = false;
    std::vector<std::string> hidden;
    std::vector<std::string> glass;
    std::optional<double> particle_radius;  // the scene's
    std::optional<int> samples;             // 16
    bool preview = false;
    std::optional<int> frames_per_second;  // 30
    double exposure = 1.0;
    std::optional<double> speed;                             // 1
    double shutter = std::numeric_limits<double>::lowest();  // that: the scene's
    std::string light;
    bool night = false;
    std::string background;
    std::string ground;
    bool no_filter = false;
    std::string threads;
    std::string progress = "auto";
    bool quiet = false;
};

void add_render_options(cli::Command command, RenderArguments& arguments);

/// How the run is shown. Throws InputError on arguments that make no sense, as the others do.
[[nodiscard]] PictureStyle picture_style(const RenderArguments& arguments);
void check_numbers(const RenderArguments& arguments);
/// What has a meaning for films alone is refused for pictures.
void check_film_options(const RenderArguments& arguments, bool film);
[[nodiscard]] int rays_a_pixel(const RenderArguments& arguments);
[[nodiscard]] int film_rate(const RenderArguments& arguments);
[[nodiscard]] double film_speed(const RenderArguments& arguments);

}  // namespace ricochet::cli
