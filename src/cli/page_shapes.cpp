#include "cli/page_shapes.h"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "cli/run_pictures.h"
#include "cli/run_turning.h"
#include "ricochet/io/scene.h"

namespace ricochet::cli {
namespace {

/// Largest number of triangles of a mesh that a page draws for each particle. Larger meshes would make the page slow.
constexpr std::size_t kMostPageTriangles = 20'000;

}  // namespace

PageShapes page_shapes(const RunFolder& folder) {
    std::vector<ParticleDrawingDescription> drawings{{}};
    if (folder.info.picture) drawings[0] = *folder.info.picture;
    drawings.insert(drawings.end(), folder.info.drawings.begin(), folder.info.drawings.end());
    PageShapes shapes;
    std::vector<MeanSpread> turnings;
    for (const ParticleDrawingDescription& drawing : drawings) {
        turnings.push_back(drawing.turning.value_or(MeanSpread{}));
        shapes.of.push_back(-1);
        if (drawing.particles != "meshes" || folder.frames.empty()) continue;
        TriangleMesh mesh = shape_from(folder.frames.front().path.parent_path() / drawing.mesh);
        if (mesh.triangles.size() > kMostPageTriangles) {
            shapes.notes.push_back(fmt::format("particles that are copies of a mesh of {} triangles are spheres here",
                                               mesh.triangles.size()));
            continue;
        }
        shapes.of.back() = static_cast<int>(shapes.meshes.size());
        shapes.meshes.push_back(std::move(mesh));
    }
    const auto turning = std::make_shared<RunTurning>(folder.frames);
    shapes.turns = [turning, turnings](const VtkPolyData& frame) {
        const VtkArray* const column = find_array(frame.point_arrays, kDrawingAttribute);
        const std::vector<double> numbers = column == nullptr ? std::vector<double>{} : scalar_values(*column);
        const auto turning_of = [&](std::size_t i) {
            const double number = i < numbers.size() ? numbers[i] : 0.0;
            const bool is_known = number >= 0.0 && number < static_cast<double>(turnings.size());
            return turnings[is_known ? static_cast<std::size_t>(number) : 0];
        };
        return turning->shown_turns(frame, turning_of);
    };
    return shapes;
}

}  // namespace ricochet::cli
