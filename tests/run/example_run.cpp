// Writes a small series for third-party readers, in the same way as a run: example_run FOLDER.
#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/core/atomic_file.h"
#include "ricochet/io/frames.h"
#include "run/example_frames.h"
#include "run/frame_writer.h"
#include "run/run_folder.h"

int main(int argc, char** argv) {
    using namespace ricochet;
    if (argc != 2) return 2;
    const OutputDirectory folder(argv[1]);
    Box3 region;
    region.include({-1, -1, -1});
    region.include({1, 1, 1});
    const std::string mesh = collider_file_name(0, "tetrahedron");
    const std::string plane = collider_file_name(1, "floor");
    VtkPolyData tetrahedron = mesh_collider_frame(test::example_mesh(), test::example_totals(), 0.0);
    tetrahedron.cell_arrays.push_back({"group", std::vector<std::uint32_t>{0, 2, 1, 1}});
    tetrahedron.texts = {{"group_names", {"", "a \"b\" <&>", std::string(3000, 'x')}}, {"none", {}}};
    write_vtp(folder.path() / mesh, tetrahedron);
    write_vtp(folder.path() / plane, plane_collider_frame({}, region, {{12}, {{0, 0, -3}}}, 0.0));
    write_file(folder.path() / kColliderSeriesFile, pvd_text({{0.0, 0, mesh}, {0.0, 1, plane}}));
    FrameWriter contacts(folder.path(), kContactSeries);
    for (const std::uint64_t step : {0U, 2U, 7U}) {
        contacts.submit(step, contact_frame(test::example_contacts(step), static_cast<double>(step) / 30.0));
    }
    contacts.finish();
    FrameWriter writer(folder.path());
    // The number of particles changes, and the first and the last frame have none.
    for (const std::uint64_t step : {0U, 2U, 4U, 6U, 7U}) {
        const std::uint64_t count = step == 0 || step == 7 ? 0 : 10 * step;
        writer.submit(step, particle_frame(test::example_particles(count), static_cast<double>(step) / 30.0, true));
    }
    writer.finish();
    return 0;
}
