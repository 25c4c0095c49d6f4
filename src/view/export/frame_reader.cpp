#include "view/export/frame_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ricochet/io/vtk_xml.h"
#include "run/regular_file.h"
#include "run/run_folder.h"
#include "run/vtp_reader.h"

namespace ricochet {
namespace {

/// Largest index file, in bytes; sufficient for about 100000 pieces.
constexpr std::size_t kLargestIndex = std::size_t{1} << 24;

detail::VtkSource source_of(const std::filesystem::path& path) {
    return {path, "expected a .pvtp file as ricochet writes it"};
}

std::vector<std::filesystem::path> pieces_of(const std::filesystem::path& path) {
    const std::string text = read_regular_file(path, kLargestIndex, "a .pvtp file as ricochet writes it");
    const detail::VtkSource source = source_of(path);
    detail::XmlTags tags(source, text);
    std::vector<std::filesystem::path> pieces;
    std::unordered_set<std::string> names;
    bool is_index = false;
    bool is_closed = false;
    while (const std::optional<detail::XmlTag> tag = tags.next()) {
        is_index |= tag->name == "VTKFile" && detail::attribute_of(source, *tag, "type") == "PPolyData";
        is_closed |= tag->name == "/VTKFile";
        if (tag->name != "Piece") continue;
        const std::string& name = detail::attribute_of(source, *tag, "Source");
        // Only pieces of this run's frames are opened, so that an index file cannot name other files.
        if (!step_of_piece_file(name)) source.refuse(fmt::format("the piece {} is not a file of a frame", name));
        if (!names.insert(name).second) source.refuse(fmt::format("the piece {} is named twice", name));
        pieces.push_back(path.parent_path() / name);
        require_own_file(pieces.back());
    }
    if (!is_index || !is_closed || pieces.empty()) source.refuse("the index of the pieces is incomplete");
    return pieces;
}

const std::vector<std::int64_t>& ids_of(const VtkPolyData& frame, const std::filesystem::path& path) {
    const VtkArray* array = find_array(frame.point_arrays, "id");
    const auto* ids = array == nullptr ? nullptr : std::get_if<std::vector<std::int64_t>>(&array->values);
    if (ids == nullptr) source_of(path).refuse("a piece has no array id");
    return *ids;
}

void append(VtkPolyData& all, VtkPolyData&& piece, const std::filesystem::path& file) {
    if (!piece.lines.empty() || !piece.triangles.empty() || !all.lines.empty() || !all.triangles.empty()) {
        source_of(file).refuse("lines or triangles in one of several pieces");
    }
    const bool fits = piece.time == all.time &&
                      std::equal(all.point_arrays.begin(), all.point_arrays.end(), piece.point_arrays.begin(),
                                 piece.point_arrays.end(), [](const VtkArray& a, const VtkArray& b) {
                                     return a.name == b.name && a.values.index() == b.values.index();
                                 });
    if (!fits) source_of(file).refuse("another time, or other arrays, than the pieces before");
    all.points.insert(all.points.end(), piece.points.begin(), piece.points.end());
    for (std::size_t k = 0; k < all.point_arrays.size(); ++k) {
        std::visit(
            [&](auto& values) {
                const auto& more = std::get<std::decay_t<decltype(values)>>(piece.point_arrays[k].values);
                values.insert(values.end(), more.begin(), more.end());
            },
            all.point_arrays[k].values);
    }
}

template <class T>
void put_in_order(std::vector<T>& values, const std::vector<std::size_t>& order) {
    std::vector<T> sorted;
    sorted.reserve(values.size());
    for (const std::size_t k : order) sorted.push_back(values[k]);
    values = std::move(sorted);
}

void put_in_order(VtkPolyData& frame, const std::filesystem::path& path) {
    const std::vector<std::int64_t>& ids = ids_of(frame, path);
    std::vector<std::size_t> order(ids.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    for (std::size_t k = 1; k < order.size(); ++k) {
        if (ids[order[k - 1]] == ids[order[k]]) {
            source_of(path).refuse(fmt::format("particle {} is in two pieces", ids[order[k]]));
        }
    }
    put_in_order(frame.points, order);
    for (VtkArray& array : frame.point_arrays) {
        std::visit([&](auto& values) { put_in_order(values, order); }, array.values);
    }
}

}  // namespace

VtkPolyData read_frame(const std::filesystem::path& path) {
    if (path.extension() != ".pvtp") return read_vtp(path);
    const std::vector<std::filesystem::path> pieces = pieces_of(path);
    VtkPolyData all = read_vtp(pieces.front());
    for (std::size_t k = 1; k < pieces.size(); ++k) append(all, read_vtp(pieces[k]), pieces[k]);
    if (pieces.size() > 1) put_in_order(all, path);
    return all;
}

}  // namespace ricochet
