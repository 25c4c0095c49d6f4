/// \file
/// Hashes of all bits that a run leaves behind.
#pragma once

#include <cstdint>
#include <cstring>

#include "ricochet/core/vec3.h"
#include "ricochet/simulation.h"

namespace ricochet::golden {

/// FNV-1a over the bits of numbers.
class Hash {
public:
    void add(std::uint64_t bits) {
        for (int k = 0; k < 8; ++k, bits >>= 8) value_ = (value_ ^ (bits & 0xFFU)) * 0x100000001B3U;
    }
    void add(double number) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &number, sizeof bits);
        add(bits);
    }
    void add(const Vec3& v) {
        add(v.x);
        add(v.y);
        add(v.z);
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xCBF29CE484222325U;
};

/// Adds the contact records of the last step.
inline void add_records(const Simulation& simulation, Hash& hash) {
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
