#include "ricochet/io/state_csv.h"

#include <fmt/format.h>

#include <iterator>
#include <string>

#include "ricochet/core/atomic_file.h"

namespace ricochet {

void write_state_csv(const std::filesystem::path& path, const Particles& particles, double time) {
    constexpr std::size_t kFlushBytes = 1 << 16;
    AtomicFile file(path);
    std::string text = "id,x,y,z,vx,vy,vz,radius,mass,age,contacts,resting,unsimulated_time\n";
    for (const std::uint32_t i : particles.order_by_id()) {
        const Vec3& x = particles.position[i];
        const Vec3& v = particles.velocity[i];
        fmt::format_to(std::back_inserter(text),
                       "{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{},{:.17g}\n",
                       particles.id[i], x.x, x.y, x.z, v.x, v.y, v.z, particles.radius[i], particles.mass[i],
                       time - particles.birth_time[i], particles.contacts[i], particles.resting[i],
                       particles.unsimulated_time[i]);
        if (text.size() >= kFlushBytes) {
            file.write(text);
            text.clear();
        }
    }
    file.write(text);
    file.commit();
}

}  // namespace ricochet
