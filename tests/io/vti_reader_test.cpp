#include "ricochet/io/vti_reader.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::TemporaryFolder;

// Returns 2 x 1 x 3 points with the values (n, n + 1/2, -n).
std::vector<Vec3> expected_values() {
    std::vector<Vec3> values;
    for (int n = 0; n < 6; ++n) values.emplace_back(n, n + 0.5, -n);
    return values;
}

template <typename T>
std::string raw_values() {
    std::string bytes;
    for (const Vec3& value : expected_values()) {
        for (int axis = 0; axis < 3; ++axis) {
            const T component = static_cast<T>(value[axis]);
            char text[sizeof(T)];
            std::memcpy(text, &component, sizeof(T));
            bytes.append(text, sizeof(T));
        }
    }
    return bytes;
}

template <typename T>
std::string raw_size(std::size_t size) {
    const T value = static_cast<T>(size);
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    return bytes;
}

std::string base64(const std::string& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = (bits << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : kDigits[(bits >> (18 - 6 * k)) & 63U];
        }
    }
    return text;
}

struct Parts {
    std::string file = R"(type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64")";
    std::string image = R"(WholeExtent="2 3 0 0 -1 1" Origin="1 2 3" Spacing="0.5 1 2")";
    std::string piece = R"(Extent="2 3 0 0 -1 1")";
    std::string type = "Float64";
    std::string format = R"(format="ascii")";
    std::string data = "0 0.5 0  1 1.5 -1\n2 2.5 -2 3 3.5 -3 4 4.5 -4 5 5.5 -5\n";
    std::string appended;
};

std::string text_of(const Parts& parts) {
    return "<?xml version=\"1.0\"?>\n<VTKFile " + parts.file + ">\n<!-- <Piece> -->\n<ImageData " + parts.image +
           ">\n<Piece " + parts.piece + ">\n<PointData Vectors='velocity'>\n<DataArray type=\"Float32\" Name=\"p\" " +
           "format=\"ascii\">1 2 3 4 5 6</DataArray>\n<DataArray type=\"" + parts.type +
           "\" Name=\"velocity\"\n  NumberOfComponents=\"3\" " + parts.format + ">" + parts.data +
           "</DataArray>\n</PointData>\n<CellData>\n<DataArray type=\"Float64\" Name=\"cells\" " +
           "NumberOfComponents=\"3\" format=\"ascii\">1 2 3</DataArray>\n</CellData>\n</Piece>\n</ImageData>\n" +
           parts.appended + "</VTKFile>\n";
}

void expect_grid(const VectorGrid& grid) {
    EXPECT_EQ(grid.origin, (Vec3{2, 2, 1}));
    EXPECT_EQ(grid.spacing, (Vec3{0.5, 1, 2}));
    EXPECT_EQ(grid.counts, (std::array<std::uint32_t, 3>{2, 1, 3}));
    EXPECT_EQ(grid.values, expected_values());
}

VectorGrid read(const Parts& parts, std::string_view array = {}) {
    const TemporaryFolder folder;
    return read_vti(folder.write("wind.vti", text_of(parts)), array);
}

// Returns the message without the folder; empty if the file is read.
std::string refusal(const Parts& parts, std::string_view array = {}) {
    try {
        (void)read(parts, array);
        return "";
    } catch (const InputError& error) {
        const std::string text = error.what();
        return text.substr(text.find("wind.vti"));
    }
}

TEST(VtiReader, NumbersAreReadAsText) {
    expect_grid(read({}));
    expect_grid(read({}, "velocity"));
}

TEST(VtiReader, InlineBase64IsReadWithEitherSizeAndType) {
    Parts parts;
    parts.format = R"(format="binary")";
    parts.data = "\n  " + base64(raw_size<std::uint64_t>(144) + raw_values<double>()) + "\n";
    expect_grid(read(parts));
    // Some writers encode the size separately.
    parts.data = base64(raw_size<std::uint64_t>(144)) + base64(raw_values<double>());
    expect_grid(read(parts));
    parts.type = "Float32";
    parts.data = base64(raw_size<std::uint64_t>(72) + raw_values<float>());
    expect_grid(read(parts));
    parts.file = R"(type="ImageData")";  // sizes have 32 bits by default
    parts.data = base64(raw_size<std::uint32_t>(72) + raw_values<float>());
    expect_grid(read(parts));
}

TEST(VtiReader, AppendedDataIsRead) {
    Parts parts;
    parts.format = R"(format="appended" offset="3")";
    parts.data = "";
    parts.appended = "<AppendedData encoding=\"raw\">\n _<<>" + raw_size<std::uint64_t>(144) + raw_values<double>() +
                     "\n</AppendedData>\n";
    expect_grid(read(parts));
    parts.format = R"(format="appended" offset="4")";
    parts.appended = "<AppendedData encoding=\"base64\">_AAAA" +
                     base64(raw_size<std::uint64_t>(144) + raw_values<double>()) + "</AppendedData>\n";
    expect_grid(read(parts));
}

TEST(VtiReader, ErrorsNameTheFaultAndItsLine) {
    const auto with = [](auto change) {
        Parts parts;
        change(parts);
        return refusal(parts);
    };
    const std::string expected = "; expected a VTK image (.vti) of one piece, not compressed";
    EXPECT_EQ(with([](Parts& p) { p.file = R"(type="PolyData")"; }),
              "wind.vti: line 2: found type=\"PolyData\", expected \"ImageData\"" + expected);
    EXPECT_EQ(with([](Parts& p) { p.file += R"( compressor="vtkZLibDataCompressor")"; }),
              "wind.vti: line 2: the data are compressed (vtkZLibDataCompressor), write them without" + expected);
    EXPECT_EQ(with([](Parts& p) { p.file = R"(type="ImageData" byte_order="BigEndian")"; }),
              "wind.vti: line 2: found byte_order=\"BigEndian\", expected \"LittleEndian\"" + expected);
    EXPECT_EQ(with([](Parts& p) { p.piece = R"(Extent="2 3 0 0 0 1")"; }),
              "wind.vti: line 5: the piece is not the whole image" + expected);
    EXPECT_EQ(with([](Parts& p) { p.image += R"( Direction="0 1 0 1 0 0 0 0 1")"; }),
              "wind.vti: line 4: the axes are turned (Direction)" + expected);
    EXPECT_EQ(with([](Parts& p) { p.image = R"(WholeExtent="2 3 0 0 -1 1" Spacing="0.5 0 2")"; }),
              "wind.vti: line 4: Spacing is not three numbers > 0" + expected);
    EXPECT_EQ(with([](Parts& p) { p.data = "1 2 3"; }),
              "wind.vti: line 8: number 4 of 18 in the array is missing or no number" + expected);
    EXPECT_EQ(with([](Parts& p) { p.data += " 7"; }),
              "wind.vti: line 8: the array goes on after its 18 numbers" + expected);
    EXPECT_EQ(with([](Parts& p) { p.data.replace(p.data.find("4.5"), 3, "nan"); }),
              "wind.vti: line 8: the value of point 4 is not finite" + expected);
    EXPECT_EQ(with([](Parts& p) { p.type = "Int32"; }),
              "wind.vti: line 8: found type=\"Int32\", expected \"Float32\", \"Float64\"" + expected);
}

TEST(VtiReader, DataThatDoNotFitAreRefused) {
    Parts parts;
    parts.format = R"(format="binary")";
    parts.data = base64(raw_size<std::uint64_t>(143) + raw_values<double>());
    EXPECT_NE(refusal(parts).find("line 8: the array has 143 bytes instead of 144"), std::string::npos);
    parts.data = base64(raw_size<std::uint64_t>(144) + raw_values<double>().substr(0, 100));
    EXPECT_NE(refusal(parts).find("line 8: the array ends after 100 of 144 bytes"), std::string::npos);
    parts.data = "";
    EXPECT_NE(refusal(parts).find("line 8: the array has no data"), std::string::npos);
    parts.format = R"(format="appended" offset="9999")";
    EXPECT_NE(refusal(parts).find("line 8: the array starts past the end of the file"), std::string::npos);
    Parts huge;
    huge.image = R"(WholeExtent="0 2000000000 0 2000000000 0 2000000000")";
    huge.piece = R"(Extent="0 2000000000 0 2000000000 0 2000000000")";
    EXPECT_NE(refusal(huge).find("line 5: more points than the file has bytes"), std::string::npos);
}

TEST(VtiReader, ArraysAreChosenByName) {
    EXPECT_NE(refusal({}, "p").find("the array \"p\" has 1 components instead of 3"), std::string::npos);
    EXPECT_NE(refusal({}, "cells").find("the array \"cells\" stands in <CellData> instead of <PointData>"),
              std::string::npos);
    EXPECT_NE(refusal({}, "wind").find("no array \"wind\" in <PointData>, which has \"velocity\""), std::string::npos);
}

TEST(VtiReader, RefusesEverythingButVtiFiles) {
    const TemporaryFolder folder;
    EXPECT_THROW((void)read_vti(folder.path("none.vti")), InputError);
    EXPECT_THROW((void)read_vti(folder.path("")), InputError);
    EXPECT_THROW((void)read_vti(folder.write("empty.vti", "")), InputError);
    EXPECT_THROW((void)read_vti(folder.write("text.vti", "hello")), InputError);
    EXPECT_THROW((void)read_vti(folder.write("tag.vti", "<VTKFile type=\"ImageData\"")), InputError);
}

TEST(VtiReader, EveryTruncatedFileIsRefused) {
    const TemporaryFolder folder;
    Parts parts;
    parts.format = R"(format="appended" offset="0")";
    parts.data = "";
    parts.appended = "<AppendedData encoding=\"raw\">_" + raw_size<std::uint64_t>(144) + raw_values<double>();
    const std::string whole = text_of(parts);
    const std::size_t needed = whole.size() - std::string("</VTKFile>\n").size();
    for (std::size_t size = 0; size < needed; ++size) {
        EXPECT_THROW((void)read_vti(folder.write("cut.vti", whole.substr(0, size))), InputError) << size;
    }
    EXPECT_NO_THROW((void)read_vti(folder.write("whole.vti", whole.substr(0, needed))));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
