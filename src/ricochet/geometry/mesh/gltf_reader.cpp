#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "ricochet/core/memory_limit.h"
#include "ricochet/geometry/mesh/gltf_buffers.h"
#include "ricochet/geometry/mesh/gltf_json.h"
#include "ricochet/geometry/mesh/gltf_nodes.h"
#include "ricochet/geometry/mesh/mesh_source.h"
#include "ricochet/geometry/mesh/placed_mesh_builder.h"

namespace ricochet {
namespace {

constexpr std::string_view kGlbMagic = "glTF";

/// The JSON and the binary chunk of a file.
struct GltfParts {
    std::string_view json;
    std::optional<std::string_view> chunk;
    std::string format;
};

std::uint32_t number_at(const MeshSource& source, std::size_t byte) {
    return value_at<std::uint32_t>(source.bytes.data() + byte);
}

// A GLB file has a header of 12 bytes, then chunks. The length and the kind of a chunk precede its data.
GltfParts parts_of_glb(const MeshSource& source) {
    constexpr std::size_t kHeader = 12;
    constexpr std::size_t kChunkHeader = 8;
    constexpr std::uint32_t kJson = 0x4e4f534a;
    constexpr std::uint32_t kBinary = 0x004e4942;
    if (source.bytes.size() < kHeader + kChunkHeader) source.fail("GLB file that is cut off");
    if (const std::uint32_t version = number_at(source, 4); version != 2) {
        source.fail_at_byte(4, fmt::format("GLB file of version {}, expected 2: export as glTF 2.0", version));
    }
    if (const std::uint32_t length = number_at(source, 8); length != source.bytes.size()) {
        source.fail_at_byte(8,
                            fmt::format("GLB file that should have {} bytes, but has {}{}", length, source.bytes.size(),
                                        length > source.bytes.size() ? "; is it cut off?" : ""));
    }
    GltfParts parts{{}, std::nullopt, "glTF 2.0, binary"};
    for (std::size_t at = kHeader; at < source.bytes.size();) {
        if (source.bytes.size() - at < kChunkHeader) source.fail_at_byte(at, "bytes after the last chunk");
        const std::uint32_t length = number_at(source, at);
        const std::uint32_t kind = number_at(source, at + 4);
        if (length > source.bytes.size() - at - kChunkHeader) {
            source.fail_at_byte(
                at, fmt::format("chunk of {} bytes, but {} are left", length, source.bytes.size() - at - kChunkHeader));
        }
        const std::string_view bytes = source.bytes.substr(at + kChunkHeader, length);
        if (at == kHeader && kind != kJson) source.fail_at_byte(at + 4, "the first chunk of the GLB file is not JSON");
        if (at == kHeader) parts.json = bytes;
        if (kind == kBinary && !parts.chunk) parts.chunk = bytes;
        at += kChunkHeader + length;
    }
    return parts;
}

GltfParts parts_of(const MeshSource& source) {
    if (looks_like_glb(source)) return parts_of_glb(source);
    require_plain_text(source);
    return {source.bytes, std::nullopt, "glTF 2.0"};
}

/// Geometry that a primitive draws.
enum class Drawing : std::uint8_t { nothing, list, strip, fan };

Drawing drawing_of(const GltfLocation& primitive) {
    constexpr std::uint64_t kTriangles = 4;
    constexpr std::uint64_t kStrip = 5;
    constexpr std::uint64_t kFan = 6;
    const std::uint64_t mode = primitive.whole_number("mode", kTriangles);
    if (mode > kFan) primitive.fail(fmt::format("found the mode {}, expected 0 to {}", mode, kFan));
    if (mode < kTriangles) return Drawing::nothing;  // points and lines
    if (mode == kTriangles) return Drawing::list;
    return mode == kStrip ? Drawing::strip : Drawing::fan;
}

// Returns the elements of the primitive's triangle t.
std::array<std::size_t, 3> elements_of(Drawing drawing, std::size_t t) {
    if (drawing == Drawing::list) return {3 * t, 3 * t + 1, 3 * t + 2};
    if (drawing == Drawing::fan) return {t + 1, t + 2, 0};
    return {t, t + 1 + t % 2, t + 2 - t % 2};
}

class GltfReader {
public:
    GltfReader(const MeshSource& source, const GltfLocation& document, GltfSurroundings surroundings,
               std::size_t free_corners)
        : source_(source),
          document_(document),
          accessors_(document.items("accessors")),
          meshes_(document.items("meshes")),
          materials_(document.items("materials")),
          buffers_(document, std::move(surroundings)),
          free_corners_(free_corners),
          quantized_(uses_quantization(document)) {}

    ImportedMesh read(std::string format) {
        require_known_extensions(document_);
        const GltfScenery scenery = placed_gltf_meshes(document_);
        hidden_nodes_ = scenery.hidden_nodes;
        reserve(scenery.meshes);
        for (const PlacedGltfMesh& one : scenery.meshes) add(one);
        ImportedMesh result = builder_.finish(std::move(format));
        result.files = buffers_.files();
        result.notes = notes();
        return result;
    }

private:
    // Corners are counted first, so that memory is bounded by the file's size even if nodes show one mesh many times.
    void reserve(const std::vector<PlacedGltfMesh>& placed) {
        constexpr std::size_t kCornersPerByte = 16;
        std::map<std::uint32_t, std::uint64_t> counts;
        std::uint64_t corners = 0;
        for (const PlacedGltfMesh& one : placed) {
            const auto [entry, is_new] = counts.try_emplace(one.mesh);
            if (is_new) entry->second = corners_in(meshes_[one.mesh]);
            corners += entry->second;
            const std::uint64_t bytes = source_.bytes.size() + buffers_.bytes_of_files();
            const std::uint64_t most = std::max<std::uint64_t>(free_corners_, kCornersPerByte * bytes);
            if (corners > std::min(most, kLargestIndexCount)) {
                source_.fail(
                    fmt::format("its nodes show more than {} corners of triangles, far more than a file of {} "
                                "bytes should: make fewer copies of its meshes",
                                std::min(most, kLargestIndexCount), bytes));
            }
        }
        // Local: an estimate of memory.
        constexpr double kBytesPerCorner = 24.0;  // including its share of faces and vertices
        require_memory(kBytesPerCorner * static_cast<double>(corners), source_.name);
        builder_.reserve(corners);
    }

    // A primitive that draws nothing also counts as one corner, because it takes time.
    std::uint64_t corners_in(const GltfLocation& mesh) {
        std::uint64_t corners = 0;
        const GltfList primitives = mesh.items("primitives");
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            corners += 1 + 3 * triangles_in(primitives[p]);
        }
        return corners;
    }

    std::size_t triangles_in(const GltfLocation& primitive) {
        const Drawing drawing = drawing_of(primitive);
        if (drawing == Drawing::nothing) return 0;
        const GltfAccessor* const indices = indices_of(primitive);
        const std::size_t elements = indices != nullptr ? indices->size() : points_of(primitive).size();
        if (drawing != Drawing::list) return elements < 3 ? 0 : elements - 2;
        if (elements % 3 != 0) {
            primitive.fail(fmt::format("triangles of {} corners, expected a multiple of 3", elements));
        }
        return elements / 3;
    }

    const GltfAccessor& points_of(const GltfLocation& primitive) {
        const GltfLocation location = primitive.at("attributes").at("POSITION");
        const std::uint32_t number = location.index_below(accessors_.size(), "accessors");
        const auto found = points_.find(number);
        if (found != points_.end()) return found->second;
        return points_.emplace(number, GltfAccessor::of_points(accessors_[number], buffers_, quantized_)).first->second;
    }

    const GltfAccessor* indices_of(const GltfLocation& primitive) {
        const auto number = primitive.index_below("indices", accessors_.size(), "accessors");
        if (!number) return nullptr;
        const auto found = indices_.find(*number);
        if (found != indices_.end()) return &found->second;
        return &indices_.emplace(*number, GltfAccessor::of_indices(accessors_[*number], buffers_)).first->second;
    }

    void add(const PlacedGltfMesh& placed) {
        const GltfLocation mesh = meshes_[placed.mesh];
        builder_.begin(placed.world, placed.name, mesh.text("name"));
        const GltfList primitives = mesh.items("primitives");
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const GltfLocation primitive = primitives[p];
            if (drawing_of(primitive) == Drawing::nothing) {
                ++left_out_;
                continue;
            }
            const auto material = primitive.index_below("material", materials_.size(), "materials");
            builder_.set_material(material ? materials_[*material].text("name") : std::string());
            add_triangles(primitive);
        }
        builder_.end();
    }

    void add_triangles(const GltfLocation& primitive) {
        const Drawing drawing = drawing_of(primitive);
        const GltfAccessor& points = points_of(primitive);
        const GltfAccessor* const indices = indices_of(primitive);
        const std::size_t count = triangles_in(primitive);
        for (std::size_t t = 0; t < count; ++t) {
            std::array<std::size_t, 3> corners = elements_of(drawing, t);
            if (indices != nullptr) {
                for (std::size_t& corner : corners) corner = index_in(primitive, *indices, corner, points.size());
            }
            // In a strip, a triangle that repeats a point only changes the strip's direction.
            const bool repeats = corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
            if (repeats && drawing == Drawing::strip) continue;
            for (const std::size_t corner : corners) {
                if (const auto wrong = builder_.add_corner(points.point(corner))) {
                    primitive.fail(misplaced_point(corner, *wrong));
                }
            }
            builder_.end_face();
        }
    }

    static std::uint32_t index_in(const GltfLocation& primitive, const GltfAccessor& indices, std::size_t at,
                                  std::size_t points) {
        const std::uint32_t index = indices.index(at);
        if (index >= points || index == indices.no_index()) {
            primitive.fail(fmt::format("index {} at place {}, but there are {} points", index, at, points));
        }
        return index;
    }

    [[nodiscard]] std::vector<std::string> notes() const {
        std::vector<std::string> notes;
        if (left_out_ > 0) {
            notes.push_back(fmt::format("{} of points and lines left out: particles do not hit them",
                                        left_out_ == 1 ? "1 primitive" : fmt::format("{} primitives", left_out_)));
        }
        if (hidden_nodes_ > 0) {
            notes.push_back(fmt::format(
                "{} by {} left out, with all below: particles pass there",
                hidden_nodes_ == 1 ? "1 node that is hidden" : fmt::format("{} nodes that are hidden", hidden_nodes_),
                kGltfVisibility));
        }
        if (document_.has("animations")) {
            notes.emplace_back("animations are not played: everything stands as the nodes of the file say");
        }
        if (const std::size_t scenes = document_.items("scenes").size(); scenes > 1) {
            notes.push_back(fmt::format("one of {} scenes is read: the one that the file shows", scenes));
        }
        return notes;
    }

    const MeshSource& source_;
    const GltfLocation& document_;
    GltfList accessors_;
    GltfList meshes_;
    GltfList materials_;
    GltfBuffers buffers_;
    std::size_t free_corners_;
    bool quantized_;
    std::map<std::uint32_t, GltfAccessor> points_;
    std::map<std::uint32_t, GltfAccessor> indices_;
    PlacedMeshBuilder builder_;
    std::size_t left_out_ = 0;
    std::size_t hidden_nodes_ = 0;
};

}  // namespace

bool looks_like_glb(const MeshSource& source) { return source.bytes.starts_with(kGlbMagic); }

ImportedMesh read_gltf(const MeshSource& source, const std::optional<std::filesystem::path>& folder,
                       std::size_t free_corners) {
    GltfParts parts = parts_of(source);
    const JsonNode root = parse_gltf_json(source, parts.json);
    const GltfLocation document(source, root, "");
    const GltfLocation asset = document.at("asset");
    const std::string version = asset.at("version").text();
    if (!version.starts_with("2.")) {
        source.fail(fmt::format("found glTF {}, expected 2.0: export as glTF 2.0", in_quotes(version)));
    }
    if (asset.has("minVersion") && asset.at("minVersion").text() != "2.0") {
        source.fail(fmt::format("asks for a reader of glTF {}, this one is of 2.0: export as glTF 2.0",
                                in_quotes(asset.at("minVersion").text())));
    }
    return GltfReader(source, document, {parts.chunk, folder}, free_corners).read(std::move(parts.format));
}

}  // namespace ricochet
