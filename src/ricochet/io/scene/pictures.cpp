// How a scene is shown: the camera of its pictures, their light and surroundings.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/io/picture_files.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

constexpr double kSmallestSine = 1e-6;  // of the angle between the view and up

// True for a frame that a body moves, or that stands on one: where it is cannot be told before the run.
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

// A camera needs exactly one of a point and a path.
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

}  // namespace

void refuse_camera_on_target(const SceneContext& context, const ObjectView& view) {
    context.error(view, view.has("target_path") ? "target_path" : "target",
                  "the camera stands on its target, expected another point");
}

const ObjectSpec& camera_spec() {
    using C = CameraDescription;
    static const ObjectSpec spec = object<C>(
        "camera", "Where `ricochet render` looks from, unless it is told otherwise.",
        {{"position", &C::position, kCoordinate, "m", "Where it stands.", Without{"`path` says it"}},
         {"target", &C::target, kCoordinate, "m", "The point in the middle of the picture.",
          Without{"`target_path` says it"}},
         {"path", ValueType::object, "Instead of `position`: where it goes, a curve of [x, y, z].", Unit{"m"},
          Without{"it stands at `position`"}, &vector_curve_spec()},
         {"target_path", ValueType::object, "Instead of `target`: a curve of [x, y, z].", Unit{"m"},
          Without{"it looks at `target`"}, &vector_curve_spec()},
         {"frame", &C::frame, "One of the names in `frames`, in whose coordinates the camera stands, looks and is up.",
          Without{"the world"}},
         {"up", &C::up, kCoordinate, "", "What is up in the picture.", kNotZero, Without{"against gravity"}},
         {"field_of_view", &C::field_of_view_degrees, kFieldOfView, "degrees", kFieldOfViewMeaning},
         {"focal_length", &C::focal_length, between(1.0, 1400.0), "mm",
          "Instead of `field_of_view`: of a lens before a film 24 mm high.", Without{"`field_of_view` says it"}},
         {"aperture", &C::aperture, kLengthOrZero, "m",
          "Diameter of the lens: what is nearer or farther than `focus_distance` blurs. 0: everything is sharp."},
         {"focus_distance", &C::focus_distance, kLengthOrZero, "m",
          "Along the view to what is sharp; 0: as far as the target."}});
    return spec;
}

namespace {

const ObjectSpec& stretch_spec() {
    using S = StretchDescription;
    static const ObjectSpec spec = object<S>(
        "stretch", "How drawn particles change their shape as they move; collisions know nothing of it.",
        {{"speed", &S::speed, kNotNegative, "s/m",
          "Along their velocity they are longer by the factor 1 + `speed` times the speed."},
         {"impact", &S::impact, kNotNegative, "s/m",
          "At an impact they are flatter along its normal by the factor 1 + `impact` times the speed along it; this "
          "needs `output.contacts`."},
         {"time", &S::time, kPositive, "s", "How long an impact shows, half of it before."},
         {"most", &S::most, between(1.0, 100.0), "", "Neither longer nor flatter than by this factor."}});
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

// The file that a key names, as a path; empty where there is none, or after reporting.
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

// What particles are drawn as, and the key without which they cannot be.
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
                      "pictures know impacts from the contact log only, expected \"output\": {\"contacts\": true}");
    }
}

// Something must say how hot they are.
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

/// What particles are drawn as; the first line says which of the others go with it.
template <class P, class... Options>
Fields<P> drawing_fields(const Options&... options) {
    return {
        {"particles", &P::particles, "What particles are drawn as.",
         Choices{{"spheres", "solid spheres"},
                 {"streaks", "threads along the way that they went while the shutter was open, bent where they hit"},
                 {"soft", "soft discs that cover what is behind by their opacity"},
                 {"glow", "discs of light that adds up"},
                 {"sprites", "the picture of `sprite`, which faces the camera"},
                 {"meshes", "copies of `mesh`, turned by their spin"}},
         options...},
        {"sprite", &P::sprite,
         "A PNG file, with alpha or without: its longer edge is as long as the particle is thick.", ValueType::file,
         Without{"none"}},
        {"mesh", &P::mesh, "A mesh file: the middle of its box is the particle's, its farthest vertex the radius away.",
         ValueType::file, Without{"none"}},
        {"turn", &P::turn, "How sprites are turned.",
         Choices{{"upright", "as the camera is"},
                 {"random", "each by an angle of its own"},
                 {"velocity", "their upper edge the way that the particle goes"}},
         Without{"`upright`"}},
        {"turning", &P::turning, kCoordinate, "rad/s",
         "How fast sprites, and meshes of particles without a spin, turn on as they age.", Without{"not at all"}}};
}

}  // namespace

const ObjectSpec& drawing_spec() {
    static const ObjectSpec spec = object<ParticleDrawingDescription>(
        "drawing", "What the particles of an emitter are drawn as, where that is not what all are.",
        drawing_fields<ParticleDrawingDescription>(kRequired));
    return spec;
}

const ObjectSpec& picture_spec() {
    using P = PictureDescription;
    static const ObjectSpec spec = object<P>(
        "picture", "Light and surroundings of `ricochet render`, unless it is told otherwise.",
        joined<P>({{{"light", &P::light, "What lights it.",
                     Choices{{"day", "a sun at middling height behind the camera's left shoulder"},
                             {"noon", "a high, white, hard sun"},
                             {"overcast", "a bright grey sky without a sun"},
                             {"night", "a little moonlight"},
                             {"studio", "one large lamp, and a grey backdrop"}},
                     Without{"`day`"}},
                    {"background", &P::background, kFraction, "",
                     "Red, green and blue behind everything, linear light.", Without{"the light's sky"}},
                    {"transparent", &P::transparent, "Nothing behind everything: an alpha channel in PNG files."}},
                   drawing_fields<P>(Without{"soft discs where they have an opacity, spheres otherwise"}),
                   {{"shutter", &P::shutter, kNotNegative, "s",
                     "How long it is open, up to the picture's time: moving particles blur. 0: not at all."},
                    {"black_body", &P::black_body, between(500.0, 20000.0), "K",
                     "Particles shine as black bodies of their attribute `temperature` (K): at this one as brightly as "
                     "a white "
                     "surface in the sun.",
                     Without{"no light of their own"}},
                    {"stretch", &P::stretch, "Squash and stretch of spheres and meshes, at the same volume.",
                     Without{"they keep their shape"}, &stretch_spec()},
                    {"ground", &P::ground, kCoordinate, "m", "A level ground at this height along the upward axis.",
                     Without{"none"}},
                    {"particle_radius", &P::particle_radius, kLength, "m",
                     "Radius by which all particles are drawn. Collisions do not know it.", Without{"their own"}},
                    {"time", &P::time, kNotNegative, "s",
                     "The moment that a single picture shows: the nearest frame. Films show all.",
                     Without{"the last frame"}}}}));
    return spec;
}

const ObjectSpec& collider_looks_spec() {
    using L = ColliderLooks;
    static const ObjectSpec spec = object<L>(
        "collider looks", "How pictures show a collider; it does nothing to the run.",
        {{"color", &L::color, kFraction, "", "Red, green and blue, linear light.", Without{"one for each material"}},
         {"roughness", &L::roughness, kFraction, "", "From 0, which mirrors what is around, to 1, which is matt."},
         {"glass", &L::glass, "It is seen through."},
         {"hidden", &L::hidden, "It is not shown."},
         {"pattern", &L::pattern, "Of a plane: a faint chequer (lines on pages) gives the eye a scale."}});
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
        // What does not go together has been reported.
        drawing.sprite = drawing.particles == "sprites" ? picture_file(context, view, "sprite") : "";
        drawing.mesh = drawing.particles == "meshes" ? picture_file(context, view, "mesh") : "";
        if (drawing.particles == "streaks" && !(scene.picture && scene.picture->shutter > 0.0)) {
            context.warn(
                view, "particles",
                "streaks are as long as the shutter is open, and \"picture\": {\"shutter\": ...} does not open "
                "it: they are spheres, unless `ricochet render --shutter` says otherwise");
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
