/// \file
/// Bytes of glTF buffers, and the points and indices that accessors read from them. Private to the glTF reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/gltf_json.h"
#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {

/// Sources of buffers outside the JSON.
struct GltfSurroundings {
    std::optional<std::string_view> chunk;        ///< the binary chunk of a GLB file
    std::optional<std::filesystem::path> folder;  ///< of files that buffers name; nullopt: refuses such files
};

/// Bytes of buffers. Each buffer is fetched once, at its first use.
class GltfBuffers {
public:
    GltfBuffers(const GltfLocation& document, GltfSurroundings surroundings);

    /// A buffer view: its bytes and the stride from one element to the next (0: no gaps).
    struct View {
        std::string_view bytes;
        std::size_t stride = 0;
    };
    /// Returns the buffer view with the index stored under `key`. Throws InputError if the buffer or the view is
    /// shorter than declared.
    [[nodiscard]] View view(const GltfLocation& owner, std::string_view key);

    /// Returns the files that were read, sorted by name.
    [[nodiscard]] std::vector<std::filesystem::path> files() const;
    /// Returns the total size of files(), in bytes.
    [[nodiscard]] std::size_t bytes_of_files() const;

private:
    [[nodiscard]] std::string_view buffer(std::size_t number);
    [[nodiscard]] std::string_view bytes_of(std::size_t number, const GltfLocation& buffer);
    [[nodiscard]] std::string_view file_bytes(const GltfLocation& uri);

    GltfList buffers_;
    GltfList views_;
    GltfSurroundings surroundings_;
    std::map<std::size_t, std::string_view> known_;  ///< bytes of buffers, by index
    std::map<std::size_t, std::string> decoded_;     ///< bytes of data URIs, by index of the buffer
    std::map<std::filesystem::path, FileBytes> read_;
};

/// The elements of an accessor, checked against the available bytes.
class GltfAccessor {
public:
    /// Makes an accessor of points: three floats each, or small integers with KHR_mesh_quantization.
    [[nodiscard]] static GltfAccessor of_points(const GltfLocation& accessor, GltfBuffers& buffers, bool quantized);
    /// Makes an accessor of indices: one unsigned integer each.
    [[nodiscard]] static GltfAccessor of_indices(const GltfLocation& accessor, GltfBuffers& buffers);

    [[nodiscard]] std::size_t size() const { return count_; }
    /// Returns the point with the values in the file, which may not be finite.
    [[nodiscard]] Vec3 point(std::size_t i) const;
    [[nodiscard]] std::uint32_t index(std::size_t i) const;
    /// Returns the largest value of the index type, which stands for "no vertex".
    [[nodiscard]] std::uint32_t no_index() const;

private:
    GltfAccessor(const GltfLocation& accessor, GltfBuffers& buffers, std::size_t components);

    void read_sparse(const GltfLocation& accessor, GltfBuffers& buffers);
    [[nodiscard]] const char* element(std::size_t i) const;
    [[nodiscard]] double component(const char* at) const;

    std::size_t components_;
    std::uint64_t type_ = 0;
    std::size_t component_bytes_ = 0;
    bool is_normalized_ = false;
    std::size_t count_ = 0;
    std::size_t stride_ = 0;
    std::string_view bytes_;                     ///< from the first element; empty: all elements are zero
    std::vector<std::uint32_t> sparse_indices_;  ///< elements whose values are in sparse_values_, ascending
    std::string_view sparse_values_;
};

}  // namespace ricochet
