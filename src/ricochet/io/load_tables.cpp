#include "ricochet/io/load_tables.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "ricochet/core/atomic_file.h"
#include "ricochet/io/frames.h"
#include "ricochet/io/run_folder.h"

namespace ricochet {
namespace {

void append(std::string& text, const Vec3& v) {
    fmt::format_to(std::back_inserter(text), ",{:.17g},{:.17g},{:.17g}", v.x, v.y, v.z);
}

/// A name as a field of a table (RFC 4180).
std::string field(const std::string& name) {
    if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
    std::string quoted = "\"";
    for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

/// s from the begin of an interval, which may be empty, as a factor of rates.
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
        fmt::format_to(std::back_inserter(rows_.colliders), "{:.17g},{}", now, field(simulation.colliders()[i].name));
        append(rows_.colliders, after.impulse - before.impulse);
        append(rows_.colliders, rate * (after.moment - before.moment));
        fmt::format_to(std::back_inserter(rows_.colliders), ",{:.17g},{}\n", rate * (after.work - before.work),
                       after.hits - before.hits);
    }
    for (const BodyState& body : simulation.bodies()) {
        fmt::format_to(std::back_inserter(rows_.bodies), "{:.17g},{}", now, field(body.frame));
        for (const Vec3& v : {body.center, body.velocity, body.angular_velocity}) append(rows_.bodies, v);
        fmt::format_to(std::back_inserter(rows_.bodies), ",{:.17g},{:.17g},{:.17g}\n", body.coordinate, body.rate,
                       body.kinetic_energy);
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
                   "angular_velocity_z,coordinate,rate,kinetic_energy\n" +
                       rows_.bodies);
    }
}

}  // namespace ricochet
