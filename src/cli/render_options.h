// Options of `ricochet render`: raw values and their meaning.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/run_pictures.h"

namespace ricochet::cli {

/// Raw arguments of the command line.
struct RenderArguments {
    std::string folder;
    std::string output;
    std::string frame;  // empty: the frame at the scene's picture time, or the last frame; all frames for a film
    std::string size = "1280x720";
    std::string camera;
    std::string up;
    std::string lens;
    std::string color_by;
    std::string drawing = "auto";
    std::string sprite;
    std::string mesh;
    double black_body = 0.0;  // 0: the scene's value
    std::string color_map = "plasma";
    std::string range;
    std::string collider_color = "plain";
    std::string collider_range;
    bool color_bar = false;
    std::vector<std::string> hidden;
    std::vector<std::string> glass;
    std::optional<double> particle_radius;  // default: the scene's value
    std::optional<int> samples;             // default: 16
    bool preview = false;
    std::optional<int> frames_per_second;  // default: 30
    double exposure = 1.0;
    std::optional<double> speed;                             // default: 1
    double shutter = std::numeric_limits<double>::lowest();  // lowest value: the scene's shutter
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

/// Returns the style of the pictures. Throws InputError on invalid arguments, as do the functions below.
[[nodiscard]] PictureStyle picture_style(const RenderArguments& arguments);
void check_numbers(const RenderArguments& arguments);
/// Throws InputError if options of films are given for a picture.
void check_film_options(const RenderArguments& arguments, bool film);
[[nodiscard]] int rays_a_pixel(const RenderArguments& arguments);
[[nodiscard]] int film_rate(const RenderArguments& arguments);
[[nodiscard]] double film_speed(const RenderArguments& arguments);

}  // namespace ricochet::cli
