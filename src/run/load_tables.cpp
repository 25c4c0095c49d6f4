#include "run/load_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "ricochet/core/atomic_file.h"
#include "ricochet/io/frames.h"
#include "run/csv_file.h"
#include "run/run_folder.h"

namespace ricochet {
namespace {

void append(std::string& text, const Vec3& v) {
    fmt::format_to(std::back_inserter(text), ",{:.17g},{:.17g},{:.17g}", v.x, v.y, v.z);
}

/// Returns the rotation as a unit quaternion (w, x, y, z) with w >= 0.
/// The computation starts from the largest component, which avoids cancellation. Source: S. W. Shepperd, "Quaternion
/// from Rotation Matrix", J. Guidance and Control 1, 1978.
std::array<double, 4> quaternion_of(const AffineMap& map) {
    const double xx = map.row_x.x;
    const double yy = map.row_y.y;
    const double zz = map.row_z.z;
    // Four times the squares of w, x, y and z.
    const std::array<double, 4> squares{1.0 + xx + yy + zz, 1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz};
    const Vec3 turn{map.row_z.y - map.row_y.z, map.row_x.z - map.row_z.x, map.row_y.x - map.row_x.y};
    const Vec3 mixed{map.row_z.y + map.row_y.z, map.row_x.z + map.row_z.x, map.row_y.x + map.row_x.y};
    // Rows of the matrix 4 q q^T.
    const std::array<std::array<double, 4>, 4> rows{{{squares[0], turn.x, turn.y, turn.z},
                                                     {turn.x, squares[1], mixed.z, mixed.y},
                                                     {turn.y, mixed.z, squares[2], mixed.x},
                                                     {turn.z, mixed.y, mixed.x, squares[3]}}};
    const auto largest = static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
    std::array<double, 4> q = rows[largest];
    double norm = 0.0;
    for (const double component : q) norm += component * component;
    const double factor = (q[0] < 0.0 ? -1.0 : 1.0) / std::sqrt(norm);
    for (double& component : q) component *= factor;
    return q;
}

/// Returns the reciprocal of a duration in s, or 0 for an empty interval.
double per_second(double duration) { return duration > 0.0 ? 1.0 / duration : 0.0; }

}  // namespace

bool has_loads(const Simulation& simulation, std::size_t i) {
    const ColliderDescription& collider = simulation.colliders()[i];
    bool has = is_moving(collider);
    visit_materials(collider, [&](std::uint32_t k) { has = has || simulation.materials()[k].drives(); });
    return has;
}

void LoadTables::add(const Simulation& simulation) {
    const std::vector<ColliderTotals>& totals = simulation.collider_totals();
    const double now = simulation.time();
    const double rate = per_second(now - rows_.since);
    rows_.totals.resize(totals.size());
    for (std::size_t i = 0; i < totals.size(); ++i) {
        if (!has_loads(simulation, i)) continue;
        const ColliderTotals& before = rows_.totals[i];
        const ColliderTotals& after = totals[i];
        fmt::format_to(std::back_inserter(rows_.colliders), "{:.17g},{}", now,
                       csv_field(simulation.colliders()[i].name));
        append(rows_.colliders, after.impulse - before.impulse);
        append(rows_.colliders, rate * (after.moment - before.moment));
        fmt::format_to(std::back_inserter(rows_.colliders), ",{:.17g},{}\n", rate * (after.work - before.work),
                       after.hits - before.hits);
    }
    for (const BodyState& body : simulation.bodies()) {
        fmt::format_to(std::back_inserter(rows_.bodies), "{:.17g},{}", now, csv_field(body.frame));
        for (const Vec3& v : {body.center, body.velocity, body.angular_velocity}) append(rows_.bodies, v);
        const auto [w, x, y, z] = quaternion_of(body.world_from_frame);
        fmt::format_to(std::back_inserter(rows_.bodies), ",{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n",
                       body.coordinate, body.rate, body.kinetic_energy, w, x, y, z);
    }
    rows_.since = now;
    rows_.totals = totals;
}

void LoadTables::write(const Simulation& simulation) const {
    if (!simulation.collider_totals().empty()) {
        write_file(folder_ / kColliderTableFile,
                   "time,name,impulse_x,impulse_y,impulse_z,torque_x,torque_y,torque_z,power,hits\n" + rows_.colliders);
    }
    if (!simulation.bodies().empty()) {
        write_file(folder_ / kBodyTableFile,
                   "time,name,x,y,z,velocity_x,velocity_y,velocity_z,angular_velocity_x,angular_velocity_y,"
                   "angular_velocity_z,coordinate,rate,kinetic_energy,orientation_w,orientation_x,orientation_y,"
                   "orientation_z\n" +
                       rows_.bodies);
    }
}

}  // namespace ricochet
