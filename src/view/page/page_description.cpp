#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "ricochet/core/printable.h"
#include "view/page/page_data.h"
#include "view/page/part_encoder.h"

namespace ricochet {
namespace {

using nlohmann::ordered_json;

constexpr int kMapSamples = 65;

ordered_json triple(const Vec3& v) { return {v.x, v.y, v.z}; }

ordered_json grid_json(const PositionGrid& grid, const Vec3& origin) {
    return {{"lower", triple(grid.lower - origin)}, {"step", grid.step}};
}

ordered_json attribute_json(const PageAttribute& attribute, int value_bits) {
    const int bits = attribute_bits(attribute, value_bits);
    const LevelScale scale = level_scale(attribute, bits);
    return {{"name", printable(attribute.name)},
            {"bits", bits},
            {"low", scale.low},
            {"step", scale.step},
            {"largest", scale.largest},
            {"gaps", attribute.has_gaps},
            {"cut", attribute.is_cut},
            {"whole", attribute.is_whole},
            {"constant", is_constant(attribute)},
            {"shown", {attribute.shown.low, attribute.shown.high}}};
}

ordered_json part_json(const ColliderPart& part, const Vec3& origin, int bits) {
    static constexpr std::array kMotions = {"still", "rigid", "deforming"};
    ordered_json json = {{"name", printable(part.name)},
                         {"material", part.material},
                         {"motion", kMotions.at(static_cast<std::size_t>(part.motion))},
                         {"glass", part.is_glass},
                         {"hidden", part.is_hidden},
                         {"roughness", part.roughness},
                         {"vertices", part.mesh.vertices.size()},
                         {"triangles", part.mesh.triangles.size()},
                         {"grid", grid_json(part_grid(part, 16), origin)},
                         {"frameGrid", grid_json(part_grid(part, bits), origin)},
                         {"error", vertex_rounding_error(part, bits)}};
    if (part.color) json["color"] = triple(*part.color);
    if (part.plane_normal) {
        json["planeNormal"] = triple(*part.plane_normal);
        json["pattern"] = part.has_pattern;
    }
    if (!part.hits.levels.empty()) json["hits"] = part.hits.largest;
    if (!part.impulse.levels.empty()) json["impulse"] = part.impulse.largest;
    return json;
}

// Returns the radius of a ball around the page's origin that contains everything except planes, in m.
double reach_of(const PageSource& source) {
    Box3 box = source.survey.box;
    const Box3 colliders = source.colliders.box();
    if (!colliders.empty()) box.include(colliders);
    if (box.empty()) return 0.0;
    const Vec3& origin = source.survey.origin;
    return length(max(box.upper - origin, origin - box.lower));
}

// Returns the particle shapes as JSON, or null if particles are spheres.
ordered_json shapes_json(const PageShapes& shapes, int bits) {
    if (shapes.meshes.empty()) return nullptr;
    ordered_json meshes = ordered_json::array();
    for (const TriangleMesh& mesh : shapes.meshes) {
        ordered_json vertices = ordered_json::array();
        ordered_json triangles = ordered_json::array();
        for (const Vec3& v : mesh.vertices) {
            for (int axis = 0; axis < 3; ++axis) vertices.push_back(std::round(1e5 * v[axis]) / 1e5);
        }
        for (const Triangle& triangle : mesh.triangles) {
            for (const std::uint32_t corner : triangle) triangles.push_back(corner);
        }
        meshes.push_back({{"vertices", std::move(vertices)}, {"triangles", std::move(triangles)}});
    }
    const LevelScale scale = turn_scale(bits);
    return {{"of", shapes.of}, {"turnLow", scale.low}, {"turnStep", scale.step}, {"meshes", std::move(meshes)}};
}

// Returns samples of a colour map as sRGB bytes in hexadecimal digits.
std::string map_text(ColorMap map) {
    static constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (int i = 0; i < kMapSamples; ++i) {
        const Vec3 color = map_color(map, static_cast<double>(i) / (kMapSamples - 1));
        for (int channel = 0; channel < 3; ++channel) {
            const auto byte = static_cast<unsigned>(std::lround(255.0 * srgb_from_linear(color[channel])));
            text += kDigits[byte >> 4U];
            text += kDigits[byte & 15U];
        }
    }
    return text;
}

ordered_json frames_json(const PageSource& source, const PageFrames& frames) {
    ordered_json steps = ordered_json::array();
    ordered_json times = ordered_json::array();
    for (const std::size_t frame : frames.chosen) {
        steps.push_back(source.frames[frame].step);
        times.push_back(source.survey.times[frame]);
    }
    return {{"step", steps}, {"time", times}, {"count", frames.counts}};
}

// Returns the JSON text with <, > and & escaped, so that no text from the run can close the script element.
std::string script_text(const ordered_json& json) {
    std::string text;
    for (const char c : json.dump(-1, ' ', true, ordered_json::error_handler_t::replace)) {
        if (c == '<' || c == '>' || c == '&') {
            text += c == '<' ? "\\u003c" : (c == '>' ? "\\u003e" : "\\u0026");
        } else {
            text += c;
        }
    }
    return text;
}

}  // namespace

std::string page_description(const PageSource& source, const PageFrames& frames, const PageOptions& options,
                             const std::vector<std::string>& notes) {
    const RunSurvey& survey = source.survey;
    const PageDetail& detail = frames.detail;
    ordered_json attributes = ordered_json::array();
    for (const PageAttribute& attribute : survey.attributes) {
        attributes.push_back(attribute_json(attribute, detail.value_bits));
    }
    ordered_json parts = ordered_json::array();
    for (const ColliderPart& part : source.colliders.parts()) {
        parts.push_back(part_json(part, survey.origin, detail.position_bits));
    }
    ordered_json maps;
    for (const std::string_view name : color_map_names())
        maps[std::string(name)] = map_text(*color_map_from_name(name));
    ordered_json json = {{"version", options.version},
                         {"scene", printable(std::filesystem::path(source.folder.info.scene).filename().string())},
                         {"origin", triple(survey.origin)},
                         {"up", triple(source.folder.info.up)},
                         {"camera",
                          {{"position", triple(source.camera.position - survey.origin)},
                           {"target", triple(source.camera.target - survey.origin)},
                           {"fov", source.camera.fov_degrees}}},
                         {"grid", grid_json(position_grid(survey.box, detail.position_bits), survey.origin)},
                         {"size", survey.box.empty() ? triple({}) : triple(survey.box.size())},
                         {"reach", reach_of(source)},
                         {"positionBits", detail.position_bits},
                         {"valueBits", detail.value_bits},
                         {"largestId", survey.largest_id},
                         {"attributes", attributes},
                         {"colors", survey.has_colors},
                         {"springs", survey.has_springs},
                         {"shapes", shapes_json(options.shapes, detail.value_bits)},
                         {"frames", frames_json(source, frames)},
                         {"parts", parts},
                         {"maps", maps},
                         {"colorBy", printable(options.color_by)},
                         {"map", std::string(color_map_names().at(static_cast<std::size_t>(options.map)))},
                         {"notes", notes}};
    return script_text(json);
}

}  // namespace ricochet
