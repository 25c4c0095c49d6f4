#include "cli/commands.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/chosen_frames.h"
#include "cli/film.h"
#include "cli/render_options.h"
#include "cli/run_pictures.h"
#include "cli/terminal.h"
#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

using namespace cli;

[[noreturn]] void refuse(const std::string& message) { throw InputError(message); }

// Progress of the pictures.
class Watch {
public:
    Watch(std::size_t pictures, const RenderArguments& arguments)
        : line_(arguments.quiet, parse_progress(arguments.progress)), pictures_(pictures) {}

    [[nodiscard]] std::function<void(double)> callback(std::size_t picture) {
        return [this, picture](double part) {
            if (!line_.due()) return;
            const double done = (static_cast<double>(picture) + part) / static_cast<double>(pictures_);
            const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
            line_.show(fmt::format("{:3.0f} %  picture {} of {}  {} left", 100.0 * done, picture + 1, pictures_,
                                   duration_text(spent / done - spent)));
        };
    }

private:
    ProgressLine line_;
    std::size_t pictures_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Image labelled(RunPictures& pictures, double time, const PictureOptions& options, const RenderArguments& arguments) {
    Image image = pictures.picture(time, options);
    if (arguments.color_bar) draw_color_bars(image, pictures.color_bars());
    return image;
}

// Returns the times of a film's pictures. Film time is simulation time divided by --speed.
std::vector<double> film_times(RunTimeline& timeline, const RenderArguments& arguments) {
    constexpr double kMostPictures = 1e6;
    const double step = film_speed(arguments) / film_rate(arguments);
    const double first = timeline.first_time();
    const double length = timeline.last_time() - first;
    if (length / step > kMostPictures) {
        refuse(fmt::format("--speed {}: a film of {:.4g} s would have more than {:.0f} pictures", film_speed(arguments),
                           length / film_speed(arguments), kMostPictures));
    }
    std::vector<double> times;
    for (double k = 0.0; k * step <= length * (1.0 + 1e-12); k += 1.0) times.push_back(first + k * step);
    times.back() = std::min(times.back(), timeline.last_time());
    return times;
}

void write_film(RunPictures& pictures, const std::vector<double>& times, PictureOptions options,
                const RenderArguments& arguments) {
    Film film(arguments.output, options.width, options.height, film_rate(arguments));
    Watch watch(times.size(), arguments);
    for (std::size_t i = 0; i < times.size(); ++i) {
        options.progress = watch.callback(i);
        film.add(labelled(pictures, times[i], options, arguments));
    }
    film.finish();
}

std::filesystem::path numbered(const std::filesystem::path& path, std::uint64_t step) {
    return path.parent_path() / fmt::format("{}_{:06}{}", path.stem().string(), step, path.extension().string());
}

void write_pictures(RunPictures& pictures, const std::vector<FrameFile>& frames, PictureOptions options,
                    const RenderArguments& arguments) {
    const std::filesystem::path output = arguments.output;
    Watch watch(frames.size(), arguments);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        options.progress = watch.callback(i);
        const Image image = labelled(pictures, pictures.timeline().go_to(frames[i].step), options, arguments);
        write_png(arguments.frame == "all" ? numbered(output, frames[i].step) : output, image);
    }
}

// Describes the interpolation between frames.
std::string film_report(RunPictures& pictures, const RenderArguments& arguments) {
    const double step = film_speed(arguments) / film_rate(arguments);
    const double spacing = pictures.timeline().spacing();
    const double ratio = spacing > 0.0 ? step / spacing : 1.0;
    const std::string text = fmt::format("{:.4g} s of the run a second", film_speed(arguments));
    if (ratio >= 0.999999 && std::fabs(ratio - std::round(ratio)) < 1e-6) return text;
    return fmt::format("{}, interpolated between frames {:.4g} s apart{}", text, spacing,
                       pictures.timeline().knows_impacts()
                           ? ""
                           : " (without the impacts in between, which output.contacts = true would log)");
}

void require_room(const PictureSize& size, bool has_sprites, bool film, const std::string& text) {
    const double pixels = static_cast<double>(size.width) * static_cast<double>(size.height);
    const double bytes =
        picture_bytes(size.width, size.height, has_sprites) + (film ? pixels * Film::kBytesPerPixel : 0.0);
    require_memory(bytes, fmt::format("--size {}", text));
}

void print_looks(const RunPictures& pictures) {
    if (pictures.shows_image_colors()) {
        cli::print("in the colours of the sprite\n");
    } else if (pictures.shows_heat_alone()) {
        cli::print("glowing by their temperature\n");
    } else if (pictures.shows_own_colors()) {
        cli::print("in the particles' own colours\n");
    } else {
        cli::print("{} from {:.4g} to {:.4g}\n", pictures.color_by(), pictures.range().low, pictures.range().high);
    }
    if (const std::string note = pictures.collider_note(); !note.empty()) {
        cli::print("note: the colliders' colours show {}; --collider-color impulse shows all\n", note);
    }
    if (const auto end = pictures.totals_end()) {
        cli::print(
            "note: the run was interrupted: the colliders' colours end at {:.6g} s; continue with run --resume if it "
            "has a checkpoint, otherwise run it again\n",
            *end);
    }
    if (pictures.lacks_shutter()) {
        cli::print(
            "note: streaks need an open shutter, so spheres are drawn; --shutter 0.02 shows the paths of 0.02 s\n");
    }
    if (const std::string& name = pictures.hiding_collider(); !name.empty()) {
        cli::print(
            "note: most particles are inside \"{0}\", which hides them from the camera; --glass {0}, or "
            "\"looks\": {{\"glass\": true}} in the scene, shows them\n",
            name);
    }
}

// Returns the frames to draw. Without --frame, a film shows all frames. A picture without --frame shows the frame
// nearest to the time in the scene's picture settings, or the last frame.
std::vector<FrameFile> frames_of(const RunFolder& folder, const std::string& asked, bool film) {
    if (film && (asked.empty() || asked == "last")) return folder.frames;
    const auto& own = folder.info.picture;
    const bool is_told = asked.empty() && own && own->time && folder.info.time_step > 0.0;
    return is_told ? std::vector{nearest_frame(folder, *own->time)}
                   : chosen_frames(folder, asked.empty() ? "last" : asked, true);
}

void render(const RenderArguments& arguments) {
    const std::string extension = std::filesystem::path(arguments.output).extension().string();
    if (extension != ".png" && extension != ".mp4") {
        refuse(fmt::format("--output {}: expected a name that ends in .png or .mp4", arguments.output));
    }
    check_numbers(arguments);
    (void)parse_progress(arguments.progress);  // reports an invalid word before the work starts
    const PictureSize size = parse_picture_size(arguments.size);
    const bool film = extension == ".mp4";
    check_film_options(arguments, film);
    if (film && (size.width % 2 != 0 || size.height % 2 != 0)) {
        refuse(fmt::format("--size {}: a film needs an even width and height", arguments.size));
    }
    const PictureStyle style = picture_style(arguments);
    const RunFolder folder = open_run_folder(arguments.folder);
    const std::vector<FrameFile> frames = frames_of(folder, arguments.frame, film);
    const ThreadLimit limit(parse_thread_count(arguments.threads));
    RunPictures pictures(folder, frames, style, static_cast<double>(size.width) / size.height);
    require_room(size, pictures.draws_sprites(), film, arguments.size);
    PictureOptions options;
    options.width = size.width;
    options.height = size.height;
    options.samples = rays_a_pixel(arguments);
    options.quick = arguments.preview;
    options.exposure = arguments.exposure;
    options.filter = !arguments.no_filter;
    pictures.set_scenery(options);
    if (film && options.transparent) {
        refuse("--background transparent: a film has no transparent background, expected --output with a .png name");
    }
    std::vector<double> times;
    if (film) {
        times = frames.size() == 1 ? std::vector<double>{pictures.timeline().go_to(frames[0].step)}
                                   : film_times(pictures.timeline(), arguments);
        write_film(pictures, times, options, arguments);
    } else {
        write_pictures(pictures, frames, options, arguments);
    }
    if (arguments.quiet) return;
    if (film) {
        cli::print("{}: {} pictures, {}; ", arguments.output, times.size(), film_report(pictures, arguments));
    } else {
        cli::print("{}: {} {}, ", arguments.output, frames.size(), frames.size() == 1 ? "frame" : "frames");
    }
    print_looks(pictures);
}

}  // namespace

void add_render_command(cli::Command program, int& exit_code) {
    cli::Command command = program.add_command("render", "Make a picture or a film of a run");
    const auto arguments = std::make_shared<RenderArguments>();
    add_render_options(command, *arguments);
    command.on_call([arguments, &exit_code] {
        render(*arguments);
        exit_code = 0;
    });
}

}  // namespace ricochet
