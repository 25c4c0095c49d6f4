/// \file
/// The header of a PLY file. Private to mesh_reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Returns the bytes of a value in a binary file.
[[nodiscard]] std::size_t ply_size(PlyType type);
[[nodiscard]] inline bool is_integer(PlyType type) { return type < PlyType::kFloat32; }

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::kFloat32;  ///< of the value, or of a list's items
    bool is_list = false;
    PlyType count_type = PlyType::kUint8;  ///< of a list's length
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    std::size_t line = 0;  ///< of the declaration in the header

    /// Returns the bytes of one element in a binary file if all its lists are empty.
    [[nodiscard]] std::size_t smallest_size() const;
    /// Returns the index of a property, or nullopt if no property has that name.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::kAscii;
    std::vector<PlyElement> elements;
    std::size_t body_byte = 0;       ///< first byte after the header
    std::size_t body_line = 0;       ///< line number of body_byte
    std::vector<std::string> notes;  ///< lines that were left out

    [[nodiscard]] const PlyElement* find(std::string_view element) const;
};

/// Returns true if the first line is "ply".
[[nodiscard]] bool looks_like_ply(const MeshSource& source);

/// Reads the header and checks that the rest of the file is long enough for the counts in the header.
[[nodiscard]] PlyHeader read_ply_header(const MeshSource& source);

}  // namespace ricochet
