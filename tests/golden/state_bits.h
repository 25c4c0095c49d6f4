/// \file Function that adds the contact records of a run to a hash.
#pragma once

#include <cstdint>

#include "ricochet/core/hash.h"
#include "ricochet/core/vec3.h"
#include "ricochet/simulation.h"

namespace ricochet::golden {

/// Adds the contact records of the last step.
inline void add_records(const Simulation& simulation, StateHash& hash) {
    for (const ContactRecord& record : simulation.contact_records()) {
        hash.add(record.time);
        hash.add(record.particle);
        hash.add(std::uint64_t{record.surface});
        for (const Vec3& v : {record.position, record.normal, record.velocity_before, record.velocity_after}) {
            hash.add(v);
        }
    }
}

}  // namespace ricochet::golden
