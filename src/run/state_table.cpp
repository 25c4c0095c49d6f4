// Writes the final state as a table.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>

#include "ricochet/core/atomic_file.h"
#include "run/run_report.h"

namespace ricochet {
namespace {

std::string attribute_names(const AttributeTable& attributes) {
    std::string names;
    for (const AttributeDescription& column : attributes.columns()) {
        names += column.components == 3 ? fmt::format(",{0}_x,{0}_y,{0}_z", column.name) : "," + column.name;
    }
    return names;
}

/// Appends the spin and the remaining lifetime, in s, so that a new run can start from the table; inf means unlimited.
void append_spin_and_lifetime(const Particles& particles, std::size_t i, double time, std::string& text) {
    const Vec3& spin = particles.spin[i];
    const double left = std::max(0.0, particles.birth_time[i] + particles.lifetime[i] - time);
    fmt::format_to(std::back_inserter(text), ",{:.17g},{:.17g},{:.17g},{:.17g}", spin.x, spin.y, spin.z, left);
}

void append_attributes(const AttributeTable& attributes, std::size_t i, std::string& text) {
    for (std::size_t k = 0; k < attributes.columns().size(); ++k) {
        const Vec3 value = attributes.value(k, i);
        for (int c = 0; c < attributes.columns()[k].components; ++c) {
            fmt::format_to(std::back_inserter(text), ",{:.17g}", value[c]);
        }
    }
}

}  // namespace

void write_state_csv(const std::filesystem::path& path, const Particles& particles, double time) {
    write_state_csv(path, particles, particles.attributes, time);
}

void write_state_csv(const std::filesystem::path& path, const Particles& particles, const AttributeTable& attributes,
                     double time) {
    constexpr std::size_t kFlushBytes = 1 << 16;
    AtomicFile file(path);
    std::string text =
        "id,x,y,z,vx,vy,vz,radius,mass,age,contacts,resting,unsimulated_time,spin_x,spin_y,spin_z,lifetime" +
        attribute_names(attributes) + "\n";
    for (const std::uint32_t i : particles.order_by_id()) {
        const Vec3& x = particles.position[i];
        const Vec3& v = particles.velocity[i];
        fmt::format_to(std::back_inserter(text),
                       "{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{},{:.17g}",
                       particles.id[i], x.x, x.y, x.z, v.x, v.y, v.z, particles.radius[i], particles.mass[i],
                       time - particles.birth_time[i], particles.contacts[i], particles.resting[i],
                       particles.unsimulated_time[i]);
        append_spin_and_lifetime(particles, i, time, text);
        append_attributes(attributes, i, text);
        text += '\n';
        if (text.size() >= kFlushBytes) {
            file.write(text);
            text.clear();
        }
    }
    file.write(text);
    file.commit();
}

}  // namespace ricochet
