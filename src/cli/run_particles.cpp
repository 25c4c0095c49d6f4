// Drawing of a run's particles: springs, and groups of particles with the same drawing.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/run_pictures.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/io/scene.h"
#include "view/render/motion_path.h"
#include "view/render/streaks.h"

namespace ricochet::cli {
namespace {

constexpr Vec3 kRopeColor{0.55, 0.40, 0.20};
constexpr Vec3 kClothColor{0.42, 0.075, 0.06};
constexpr double kThreadRadius = 0.5;  // radius of a spring between points, relative to the radius of a point
constexpr double kBead = 1.5;          // a particle is drawn too if it is thicker than its threads by this factor

template <class Value>
void append(std::vector<Value>& all, std::vector<Value>&& more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

template <class Value>
std::vector<Value> chosen_of(const std::vector<Value>& all, const std::vector<std::size_t>& chosen) {
    std::vector<Value> some;
    some.reserve(chosen.size());
    for (const std::size_t i : chosen) some.push_back(all[i]);
    return some;
}

std::vector<double> radii_of(const VtkPolyData& frame) {
    const VtkArray* own = find_array(frame.point_arrays, "radius");
    return own == nullptr ? std::vector<double>(frame.points.size(), 0.0) : scalar_values(*own);
}

// Returns the number of positions along a drawn path. Paths that only gravity bends need few positions. With impacts,
// more positions are needed, because a straight piece between two positions cuts off the corner at an impact.
std::size_t path_steps(const ShutterPaths& paths) {
    const bool bends = std::any_of(paths.nodes.begin(), paths.nodes.end(), [](const auto& nodes) {
        return std::any_of(nodes.begin(), nodes.end(),
                           [](const PathNode& node) { return node.velocity_before != node.velocity_after; });
    });
    return bends ? kMostPathSteps : kFewPathSteps;
}

}  // namespace

/// Groups particles by their drawing. `left_out` marks particles that springs already show.
std::vector<RunPictures::Group> RunPictures::groups_of(const VtkPolyData& frame,
                                                       const std::vector<bool>& left_out) const {
    std::vector<Group> groups;
    for (const Drawing& drawing : drawings_) groups.push_back({&drawing, {}});
    const VtkArray* const column = drawings_.size() > 1 ? find_array(frame.point_arrays, kDrawingAttribute) : nullptr;
    const std::vector<double> numbers = column == nullptr ? std::vector<double>{} : scalar_values(*column);
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
        if (left_out[i]) continue;
        const double number = i < numbers.size() ? numbers[i] : 0.0;
        const bool is_known = number >= 0.0 && number < static_cast<double>(groups.size());
        groups[is_known ? static_cast<std::size_t>(number) : 0].shown.push_back(i);
    }
    return groups;
}

/// Adds the springs as threads and cloth. Marks the particles that need no drawing of their own. These particles are
/// corners of cloth, and ends of threads without a size or hardly thicker than the thread.
std::vector<bool> RunPictures::add_springs(const VtkPolyData& frame, const std::vector<double>& radii,
                                           PreviewMoving& moving) const {
    const std::vector<double> own_radii = radii_of(frame);
    std::vector<double> thread(frame.points.size(), 0.0);  // radius of the thickest thread at the particle
    moving.lines.points = frame.points;
    for (const auto& [a, b] : frame.lines) {
        const bool have_size = own_radii[a] > 0.0 && own_radii[b] > 0.0;
        const double radius = std::min(radii[a], radii[b]) * (have_size ? 1.0 : kThreadRadius);
        moving.lines.ends.push_back({a, b});
        moving.lines.radii.push_back(radius);
        moving.lines.colors.push_back(kRopeColor);
        if (!emissions_.empty()) {
            moving.lines.emissions.emplace_back();
            moving.lines.parts.push_back(1.0);
        }
        thread[a] = std::max(thread[a], radius);
        thread[b] = std::max(thread[b], radius);
    }
    std::vector<bool> is_shown(frame.points.size(), false);
    for (const Triangle& triangle : frame.triangles) {
        for (const std::uint32_t corner : triangle) is_shown[corner] = true;
    }
    moving.cloth.mesh = {frame.points, frame.triangles};
    moving.cloth.color = kClothColor;
    for (std::size_t i = 0; i < is_shown.size(); ++i) {
        if (thread[i] > 0.0 && (own_radii[i] == 0.0 || radii[i] <= kBead * thread[i])) is_shown[i] = true;
    }
    return is_shown;
}

PreviewSpheres RunPictures::spheres_of(const Group& group, const VtkPolyData& frame, const std::vector<Vec3>& colors,
                                       const std::vector<double>& radii) const {
    PreviewSpheres spheres;
    spheres.centers = chosen_of(frame.points, group.shown);
    spheres.radii = chosen_of(radii, group.shown);
    spheres.colors = chosen_of(colors, group.shown);
    if (!emissions_.empty()) spheres.emissions = chosen_of(emissions_, group.shown);
    return spheres;
}

/// Moves drawn balls off the walls if they are larger than their particles.
void RunPictures::keep_off_walls(const Moment& moment, const Group& group, PreviewSpheres& spheres) {
    const std::vector<double> own = chosen_of(radii_of(moment.frame), group.shown);
    const bool any_larger = !std::equal(own.begin(), own.end(), spheres.radii.begin(),
                                        [](double radius, double drawn) { return drawn <= radius; });
    if (!any_larger) return;
    if (!walls_) walls_ = walls_at_rest();
    WallClearance walls = *walls_;
    for (const auto& [number, mesh] : moment.moving) {
        const auto looks = moving_looks_.find(number);
        if (looks != moving_looks_.end() && !looks->second.hidden) walls.add(mesh);
    }
    walls.clear({spheres.centers, spheres.radii, own});
}

/// Sets the paths that spheres take while the shutter is open.
void RunPictures::set_shutter_paths(const Moment& moment, const std::vector<std::size_t>& shown,
                                    PreviewSpheres& spheres) const {
    const ShutterPaths& paths = moment.paths;
    const std::size_t steps = path_steps(paths);
    spheres.shutter_paths.resize(shown.size());
    for (std::size_t k = 0; k < shown.size(); ++k) {
        const Vec3 off_walls = spheres.centers[k] - moment.frame.points[shown[k]];
        for (std::size_t step = 0; step < steps; ++step) {
            const double part = static_cast<double>(step) / static_cast<double>(steps - 1);
            const double time = (1.0 - part) * paths.born[shown[k]] + part * paths.close;
            spheres.shutter_paths[k].push_back(position_on_path(paths.nodes[shown[k]], time) + off_walls);
        }
    }
}

/// Adds streaks, which are threads along the paths of spheres.
void RunPictures::add_streaks(const ShutterPaths& paths, const std::vector<std::size_t>& shown,
                              const PreviewSpheres& spheres, PreviewMoving& moving) {
    for (std::size_t k = 0; k < shown.size(); ++k) {
        Streak streak{paths.nodes[shown[k]], paths.born[shown[k]], paths.close, spheres.radii[k], spheres.colors[k]};
        if (!spheres.emissions.empty()) streak.emission = spheres.emissions[k];
        add_streak(streak, moving.lines);
    }
}

void RunPictures::add_solid(const Moment& moment, const Group& group, PreviewSpheres&& spheres, PreviewMoving& moving) {
    if (!moment.paths.empty() && group.drawing->kind == ParticleDrawing::streaks) {
        add_streaks(moment.paths, group.shown, spheres, moving);
        return;
    }
    keep_off_walls(moment, group, spheres);
    if (!moment.paths.empty()) set_shutter_paths(moment, group.shown, spheres);
    if (group.drawing->is_copy()) {
        add_copies(moment, group, std::move(spheres), moving.copies);
        return;
    }
    append(moving.spheres.centers, std::move(spheres.centers));
    append(moving.spheres.radii, std::move(spheres.radii));
    append(moving.spheres.colors, std::move(spheres.colors));
    append(moving.spheres.shutter_paths, std::move(spheres.shutter_paths));
    append(moving.spheres.emissions, std::move(spheres.emissions));
}

/// Adds sprites. Images have one layer per drawing. All soft discs share one layer. All glowing discs share the last
/// layer.
void RunPictures::add_flat(const VtkPolyData& frame, const Group& group, std::vector<Sprites>& layers) const {
    const ParticleDrawing kind = group.drawing->kind;
    const VtkArray* const own = find_array(frame.point_arrays, kOpacityAttribute);
    const std::vector<double> opacities =
        own == nullptr ? std::vector<double>(frame.points.size(), 1.0) : scalar_values(*own);
    std::vector<Vec3> colors = sprite_colors(frame, kind);
    // Images are not tinted if the particles have no colours of their own.
    if (kind == ParticleDrawing::sprites && !own_colors_ && !colors_are_told_) {
        std::fill(colors.begin(), colors.end(), Vec3{1, 1, 1});
    }
    Sprites sprites{chosen_of(frame.points, group.shown), chosen_of(shown_radii(frame), group.shown),
                    chosen_of(colors, group.shown), chosen_of(opacities, group.shown), kind == ParticleDrawing::glow};
    if (group.drawing->sprite) {
        sprites.image = group.drawing->sprite;
        sprites.angles = sprite_angles(frame, group);
        layers.insert(layers.begin(), std::move(sprites));
        return;
    }
    const auto same = std::find_if(layers.begin(), layers.end(),
                                   [&](const Sprites& layer) { return !layer.image && layer.glow == sprites.glow; });
    if (same == layers.end()) {
        const auto glowing = std::find_if(layers.begin(), layers.end(), [](const Sprites& l) { return l.glow; });
        layers.insert(glowing, std::move(sprites));
        return;
    }
    append(same->centers, std::move(sprites.centers));
    append(same->radii, std::move(sprites.radii));
    append(same->colors, std::move(sprites.colors));
    append(same->opacities, std::move(sprites.opacities));
}

/// Returns the rotations of all particles, or an empty list if no particle is a copy of a mesh.
std::vector<Turn> RunPictures::turns_in(const VtkPolyData& frame) {
    if (shapes_.empty()) return {};
    std::vector<const Drawing*> drawing_of(frame.points.size(), &drawings_[0]);
    for (const Group& group : groups_of(frame, std::vector<bool>(frame.points.size(), false))) {
        for (const std::size_t i : group.shown) drawing_of[i] = group.drawing;
    }
    return turning_.shown_turns(frame, [&](std::size_t i) { return drawing_of[i]->shape.turning; });
}

Image RunPictures::picture(double time, const PictureOptions& options) {
    Moment moment = timeline_.at(time, shutter());
    const VtkPolyData& frame = moment.frame;
    place_camera(frame);
    emissions_ = emissions(frame);
    turns_ = turns_in(frame);
    PreviewMoving moving;
    std::vector<Sprites> layers;
    const std::vector<double> radii = shown_radii(frame);
    const std::vector<Vec3> shown = colors(frame);
    const std::vector<bool> by_springs = add_springs(frame, radii, moving);
    for (const Group& group : groups_of(frame, by_springs)) {
        if (!group.drawing->is_flat()) add_solid(moment, group, spheres_of(group, frame, shown, radii), moving);
    }
    for (const Group& group : groups_of(frame, std::vector<bool>(frame.points.size(), false))) {
        if (group.drawing->is_flat()) add_flat(frame, group, layers);
    }
    add_moving(std::move(moment.moving), moving);
    preview_->set_moving(std::move(moving), options.quick ? SphereRays::skipped : SphereRays::traced);
    return render_picture(*preview_, camera_, options, layers);
}

}  // namespace ricochet::cli
