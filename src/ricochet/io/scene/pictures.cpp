// Appearance of a scene: the camera, light and background of its pictures.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

/// Local: a limit of input values.
// Sine of the smallest allowed angle between the view direction and the upward direction.
constexpr double kSmallestSine = 1e-6;

// Returns true if a dynamic body moves the frame or one of its parents. The position of such a frame is unknown before
// the run.
bool stands_on_body(const FrameTree& frames, std::size_t frame) {
    std::optional<std::size_t> k = frame;
    while (k) {
        if (frames.description(*k).is_driven) return true;
        const std::string& parent = frames.description(*k).parent;
        k = parent.empty() ? std::nullopt : frames.find(parent);
    }
    return false;
}

void check_frame(const SceneContext& context, const ObjectView& view, const FrameTree& frames) {
    if (!view.has("frame") || !is_frame_named(context, view, frames)) return;
    const std::size_t frame = frames.find(view.text("frame")).value_or(0);
    if (stands_on_body(frames, frame) && !frames.description(frame).is_driven) {
        context.error(view, "frame", "the frame stands on a body, expected the body's own frame or one without bodies");
    }
}

// Returns true if the camera has the key `point` or the key `path`. Reports an error unless exactly one of them is
// present.
bool has_one_of(const SceneContext& context, const ObjectView& view, const char* point, const char* path) {
    if (view.has(point) && view.has(path)) {
        context.error(view, path, fmt::format("\"{}\" says the same, expected one of the two", point));
    } else if (!view.has(point) && !view.has(path)) {
        context.error(view, point, fmt::format("missing, expected this key or \"{}\"", path));
    }
    return view.has(point) != view.has(path);
}

void read_paths(const SceneContext& context, const ObjectView& view, CameraDescription& camera) {
    if (view.has("path")) {
        camera.path = vector_curve_of(view.object("path"), context.diagnostics());
        camera.position = camera.path->value(0.0);
    }
    if (view.has("target_path")) {
        camera.target_path = vector_curve_of(view.object("target_path"), context.diagnostics());
        camera.target = camera.target_path->value(0.0);
    }
}

CameraDescription camera_of(const SceneContext& context, const ObjectView& view, const SimulationSetup& setup) {
    auto camera = view.read<CameraDescription>();
    const bool has_place = has_one_of(context, view, "position", "path");
    const bool has_target = has_one_of(context, view, "target", "target_path");
    if (setup.frames) check_frame(context, view, *setup.frames);
    if (!camera.frame.empty()) camera.frames = setup.frames;
    if (view.has("focal_length") && view.has("field_of_view")) {
        context.error(view, "focal_length", "\"field_of_view\" says the same, expected one of the two");
    }
    // Height of a picture on 35 mm film. A constant of photography.
    constexpr double kFilmHeight = 24.0;  // mm
    if (camera.focal_length) {
        camera.field_of_view_degrees = std::atan(0.5 * kFilmHeight / *camera.focal_length) * 360.0 / std::numbers::pi;
    }
    if (!has_place || !has_target) return camera;
    read_paths(context, view, camera);
    const Vec3 ahead = camera.target - camera.position;
    if (ahead == Vec3{}) {
        refuse_camera_on_target(context, view);
    } else if (camera.up && length(cross(normalized(*camera.up), normalized(ahead))) < kSmallestSine) {
        context.error(view, "up", "the camera looks along its up direction, expected another one");
    }
    return camera;
}

const ObjectSpec& stretch_spec() {
    using S = StretchDescription;
    static const ObjectSpec spec =
        object<S>("stretch", "Change of the drawn shape of moving particles. Collisions ignore it.",
                  {{"speed", &S::speed, kNotNegative, "s/m",
                    "Stretch along the velocity: particles are longer by the factor 1 + `speed` times their speed."},
                   {"impact", &S::impact, kNotNegative, "s/m",
                    "Squash along the normal of an impact: particles are flatter by the factor 1 + `impact` times the "
                    "normal speed. This needs `output.contacts`."},
                   {"time", &S::time, kPositive, "s", "Duration of the squash. Half of it is before the impact."},
                   {"most", &S::most, between(1.0, 100.0), "", "Largest factor of stretch and squash."}});
    return spec;
}

std::optional<std::string> mesh_problem(const std::filesystem::path& path) {
    try {
        (void)read_mesh(path, MeshContent::triangles);
    } catch (const InputError& error) {
        return error.what();
    }
    return std::nullopt;
}

// Returns the reason why a file does not start with the header of a PNG image. Returns nothing if it does. Source: W3C,
// "Portable Network Graphics (PNG) Specification", 5.2 and 11.2.2.
std::optional<std::string> png_problem(const std::filesystem::path& path) {
    constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
    std::array<char, 24> head{};
    std::ifstream file(path, std::ios::binary);
    file.read(head.data(), head.size());
    const std::string_view bytes(head.data(), static_cast<std::size_t>(file.gcount()));
    if (bytes.size() == head.size() && bytes.starts_with(kSignature) && bytes.substr(12, 4) == "IHDR") {
        return std::nullopt;
    }
    return fmt::format("{} is not a PNG file, expected one", path.string());
}

// Returns the path of the file that a key contains. Empty if the key is absent, or after reporting an error.
std::string picture_file(const SceneContext& context, const ObjectView& view, std::string_view key) {
    if (!view.has(key)) return "";
    const std::filesystem::path path = context.path_of_file(view.text(key));
    std::optional<std::string> problem = file_problem(path);
    if (!problem && key == "sprite") problem = png_problem(path);
    if (!problem && key == "mesh") problem = mesh_problem(path);
    if (!problem) return path.string();
    context.error(view, key, *problem);
    return "";
}

// Reports a drawing without its required file, or with keys of other drawings.
void check_drawing(const SceneContext& context, const ObjectView& view, const ParticleDrawingDescription& picture) {
    for (const auto& [drawing, key] : {std::pair{"sprites", "sprite"}, std::pair{"meshes", "mesh"}}) {
        const bool is_drawn = picture.particles == drawing;
        if (is_drawn && !view.has(key)) {
            context.error(view, key, fmt::format("missing, \"particles\": \"{}\" needs its file", drawing));
        } else if (!is_drawn && view.has(key)) {
            context.error(view, key, fmt::format("only goes together with \"particles\": \"{}\"", drawing));
        }
    }
    const bool turns = picture.particles == "sprites" || picture.particles == "meshes";
    if (view.has("turn") && picture.particles != "sprites") {
        context.error(view, "turn", R"(only goes together with "particles": "sprites")");
    }
    if (view.has("turning") && !turns) {
        context.error(view, "turning", R"(only goes together with "particles": "sprites" or "meshes")");
    }
}

void check_stretch(const SceneContext& context, const ObjectView& view, const PictureDescription& picture,
                   bool has_contact_log) {
    if (!picture.stretch) return;
    const std::string& drawing = picture.particles;
    if (!drawing.empty() && drawing != "spheres" && drawing != "meshes") {
        context.error(
            view, "stretch",
            fmt::format("\"particles\": \"{}\" keep their shape, expected \"spheres\" or \"meshes\"", drawing));
    }
    if (picture.stretch->impact > 0.0 && !has_contact_log) {
        context.error(view.object("stretch"), "impact",
                      "pictures read impacts from the contact log, expected \"output\": {\"contacts\": true}");
    }
}

// Reports the key "black_body" if particles have no attribute "temperature".
void check_black_body(const SceneContext& context, const ObjectView& view, const SimulationSetup& setup) {
    if (!view.has("black_body")) return;
    for (const AttributeDescription& attribute : setup.attributes) {
        if (attribute.name == "temperature" && attribute.components == 1) return;
    }
    context.error(view, "black_body",
                  "particles have no temperature, expected \"attributes\": {\"temperature\": {\"default\": 1500}}");
}

PictureDescription picture_of(const SceneContext& context, const ObjectView& view, const SimulationSetup& setup) {
    auto picture = view.read<PictureDescription>();
    check_black_body(context, view, setup);
    check_drawing(context, view, picture);
    check_stretch(context, view, picture, setup.options.record_contacts);
    picture.sprite = picture_file(context, view, "sprite");
    picture.mesh = picture_file(context, view, "mesh");
    return picture;
}

/// Returns the keys for the drawing of particles. The options apply to the first key.
template <class P, class... Options>
Fields<P> drawing_fields(const Options&... options) {
    return {{"particles", &P::particles, "Shape of drawn particles.",
             Choices{{"spheres", "solid spheres"},
                     {"streaks", "lines along the path of a particle while the shutter is open, with bends at impacts"},
                     {"soft", "soft discs that cover the background by their opacity"},
                     {"glow", "discs of light, which are added"},
                     {"sprites", "the image of `sprite`, which faces the camera"},
                     {"meshes", "copies of `mesh`, rotated by the spin of the particles"}},
             options...},
            {"sprite", &P::sprite,
             "PNG file, with or without alpha. Its longer edge has the length of the particle's diameter.",
             ValueType::file, Without{"none"}},
            {"mesh", &P::mesh,
             "Mesh file. The middle of its bounding box is at the particle's centre. Its farthest vertex is one radius "
             "away.",
             ValueType::file, Without{"none"}},
            {"turn", &P::turn, "Orientation of sprites.",
             Choices{{"upright", "like the camera"},
                     {"random", "each at its own random angle"},
                     {"velocity", "with the upper edge in the direction of motion"}},
             Without{"`upright`"}},
            {"turning", &P::turning, kCoordinate, "rad/s",
             "Rotation rate of sprites, and of meshes of particles without a spin, over their age.",
             Without{"no rotation"}}};
}

}  // namespace

void refuse_camera_on_target(const SceneContext& context, const ObjectView& view) {
    context.error(view, view.has("target_path") ? "target_path" : "target",
                  "the camera stands on its target, expected another point");
}

const ObjectSpec& camera_spec() {
    using C = CameraDescription;
    static const ObjectSpec spec = object<C>(
        "camera", "Camera of `ricochet render`, unless its options say otherwise.",
        {{"position", &C::position, kCoordinate, "m", "Position of the camera.", Without{"given by `path`"}},
         {"target", &C::target, kCoordinate, "m", "Point in the middle of the picture.",
          Without{"given by `target_path`"}},
         {"path", ValueType::object, "Instead of `position`: path of the camera, a curve of [x, y, z].", Unit{"m"},
          Without{"fixed at `position`"}, &vector_curve_spec()},
         {"target_path", ValueType::object, "Instead of `target`: path of the target, a curve of [x, y, z].", Unit{"m"},
          Without{"fixed at `target`"}, &vector_curve_spec()},
         {"frame", &C::frame, "Name of a frame in `frames`. Position, target and `up` are in its coordinates.",
          Without{"the world"}},
         {"up", &C::up, kCoordinate, "", "Upward direction in the picture.", kNotZero, Without{"against gravity"}},
         {"field_of_view", &C::field_of_view_degrees, kFieldOfView, "degrees", kFieldOfViewMeaning},
         {"focal_length", &C::focal_length, between(1.0, 1400.0), "mm",
          "Instead of `field_of_view`: focal length of a lens in front of film 24 mm high.",
          Without{"given by `field_of_view`"}},
         {"aperture", &C::aperture, kLengthOrZero, "m",
          "Diameter of the lens. Objects nearer or farther than `focus_distance` blur. With 0 everything is sharp."},
         {"focus_distance", &C::focus_distance, kLengthOrZero, "m",
          "Distance along the view at which objects are sharp. 0 means the distance of the target."}});
    return spec;
}

const ObjectSpec& drawing_spec() {
    static const ObjectSpec spec = object<ParticleDrawingDescription>(
        "drawing", "How the particles of an emitter are drawn, if they differ from other particles.",
        drawing_fields<ParticleDrawingDescription>(kRequired));
    return spec;
}

const ObjectSpec& picture_spec() {
    using P = PictureDescription;
    static const ObjectSpec spec = object<P>(
        "picture", "Light and surroundings of `ricochet render`, unless its options say otherwise.",
        joined<P>(
            {{{"light", &P::light, "Light of the picture.",
               Choices{{"day", "a sun at medium height behind the camera's left shoulder"},
                       {"noon", "a high, white, hard sun"},
                       {"overcast", "a bright grey sky without a sun"},
                       {"night", "a little moonlight"},
                       {"studio", "one large lamp, and a grey backdrop"}},
               Without{"`day`"}},
              {"background", &P::background, kFraction, "", "Red, green and blue of the background, linear light.",
               Without{"the sky of the light"}},
              {"transparent", &P::transparent,
               "true: the background is transparent, as an alpha channel in PNG files."}},
             drawing_fields<P>(Without{"soft discs if particles have an opacity, spheres otherwise"}),
             {{"shutter", &P::shutter, kNotNegative, "s",
               "Time for which the shutter is open, up to the picture's time. Moving particles blur. 0 means no blur."},
              {"black_body", &P::black_body, between(500.0, 20000.0), "K",
               "Temperature at which a particle shines as brightly as a white surface in the sun. Particles shine as "
               "black bodies of their attribute `temperature` (K).",
               Without{"no light of their own"}},
              {"stretch", &P::stretch, "Squash and stretch of spheres and meshes, at the same volume.",
               Without{"they keep their shape"}, &stretch_spec()},
              {"ground", &P::ground, kCoordinate, "m", "Height of a level ground along the upward axis.",
               Without{"none"}},
              {"particle_radius", &P::particle_radius, kLength, "m",
               "Drawn radius of all particles. Collisions ignore it.", Without{"their own radius"}},
              {"time", &P::time, kNotNegative, "s",
               "Time of a single picture, which shows the nearest frame. Films show all frames.",
               Without{"the last frame"}}}}));
    return spec;
}

const ObjectSpec& collider_looks_spec() {
    using L = ColliderLooks;
    static const ObjectSpec spec = object<L>(
        "collider looks", "Appearance of a collider in pictures. It does not affect the run.",
        {{"color", &L::color, kFraction, "", "Red, green and blue, linear light.", Without{"one for each material"}},
         {"roughness", &L::roughness, kFraction, "", "Roughness from 0 (mirror) to 1 (matt)."},
         {"glass", &L::glass, "true: the collider is transparent."},
         {"hidden", &L::hidden, "true: the collider is not shown."},
         {"pattern", &L::pattern, "true: a plane has a faint chequer pattern (lines on pages) that shows the scale."}});
    return spec;
}

std::size_t drawing_number(const SceneContext& context, const ObjectView& emitter) {
    std::size_t number = 0;
    for (const ObjectView& view : context.objects("emitters")) {
        number += view.has("drawing") ? 1 : 0;
        if (view.path() == emitter.path()) break;
    }
    return number;
}

static void build_drawings(const SceneContext& context, SceneDescription& scene) {
    for (const ObjectView& emitter : context.objects("emitters")) {
        if (!emitter.has("drawing")) continue;
        const ObjectView view = emitter.object("drawing");
        auto drawing = view.read<ParticleDrawingDescription>();
        check_drawing(context, view, drawing);
        // Keys of other kinds of drawing have already been reported, so they are ignored here.
        drawing.sprite = drawing.particles == "sprites" ? picture_file(context, view, "sprite") : "";
        drawing.mesh = drawing.particles == "meshes" ? picture_file(context, view, "mesh") : "";
        if (drawing.particles == "streaks" && !(scene.picture && scene.picture->shutter > 0.0)) {
            context.warn(
                view, "particles",
                "streaks are drawn while the shutter is open, but \"picture\": {\"shutter\": ...} does not open it: "
                "particles are drawn as spheres, unless `ricochet render --shutter` opens it");
        }
        scene.drawings.push_back(std::move(drawing));
    }
}

void build_pictures(const SceneContext& context, SceneDescription& scene) {
    for (const ObjectView& view : context.root().objects("colliders")) {
        const ObjectView looks = view.object("looks");
        if (looks.has("pattern") && view.type() != "plane") {
            context.error(looks, "pattern",
                          "only planes have one, expected the collider to be a \"plane\" or no such key");
        }
        scene.looks.push_back(looks.read<ColliderLooks>());
    }
    if (context.root().has("camera")) scene.camera = camera_of(context, context.root().object("camera"), scene.setup);
    if (context.root().has("picture")) {
        scene.picture = picture_of(context, context.root().object("picture"), scene.setup);
    }
    build_drawings(context, scene);
}

}  // namespace ricochet::detail
