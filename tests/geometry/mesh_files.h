/// \file Small mesh files for tests.
#pragma once

#include <bit>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace ricochet::test {

/// Text to which values are appended in little-endian byte order.
class BinaryText {
public:
    explicit BinaryText(std::string_view start = {}) : bytes_(start) {}

    template <typename Value>
    BinaryText& add(std::initializer_list<Value> values) {
        for (const Value& value : values) {
            char raw[sizeof(Value)];
            std::memcpy(raw, &value, sizeof raw);
            if (big_endian_) {
                for (std::size_t i = sizeof raw; i-- > 0;) bytes_ += raw[i];
            } else {
                bytes_.append(raw, sizeof raw);
            }
        }
        return *this;
    }
    BinaryText& big_endian() {
        big_endian_ = true;
        return *this;
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
    bool big_endian_ = false;
};

/// Returns a PLY header of vertices (double) and faces (uchar, int).
inline std::string ply_header(std::string_view format, int vertices, int faces) {
    return "ply\nformat " + std::string(format) + " 1.0\nelement vertex " + std::to_string(vertices) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " + std::to_string(faces) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

/// Returns a binary STL file whose title of 80 bytes starts with the given text. Every facet has 9 corner coordinates.
inline std::string binary_stl(std::string_view title, unsigned promised,
                              const std::vector<std::vector<float>>& facets) {
    std::string header(80, '\0');
    header.replace(0, title.size(), title);
    BinaryText file(header);
    file.add<unsigned>({promised});
    for (const auto& corners : facets) {
        file.add<float>({0, 0, 1});
        for (const float x : corners) file.add<float>({x});
        file.add<unsigned short>({0});
    }
    return file.bytes();
}

/// The same tetrahedron in each format.
inline const std::string kObjTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
inline const std::string kOffTetrahedron =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
inline const std::string kAsciiPlyTetrahedron =
    ply_header("ascii", 4, 4) + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

inline std::string binary_ply_tetrahedron(bool big_endian) {
    BinaryText file(ply_header(big_endian ? "binary_big_endian" : "binary_little_endian", 4, 4));
    if (big_endian) file.big_endian();
    file.add<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    for (const auto& face : {std::initializer_list<int>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
        file.add<unsigned char>({3}).add<int>(face);
    }
    return file.bytes();
}

inline std::string binary_stl_tetrahedron(std::string_view title = "tetrahedron") {
    return binary_stl(title, 4,
                      {{0, 0, 0, 0, 1, 0, 1, 0, 0},
                       {0, 0, 0, 1, 0, 0, 0, 0, 1},
                       {1, 0, 0, 0, 1, 0, 0, 0, 1},
                       {0, 0, 0, 0, 0, 1, 0, 1, 0}});
}

inline std::string ascii_facet(std::string_view a, std::string_view b, std::string_view c) {
    std::string text = "  facet normal 0 0 1\n    outer loop\n";
    for (const std::string_view corner : {a, b, c}) text.append("      vertex ").append(corner).append("\n");
    return text + "    endloop\n  endfacet\n";
}

inline const std::string kAsciiStlTetrahedron =
    "solid tetrahedron\n" + ascii_facet("0 0 0", "0 1 0", "1 0 0") + ascii_facet("0 0 0", "1 0 0", "0 0 1") +
    ascii_facet("1 0 0", "0 1 0", "0 0 1") + ascii_facet("0 0 0", "0 0 1", "0 1 0") + "endsolid tetrahedron\n";

}  // namespace ricochet::test
