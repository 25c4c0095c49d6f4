/// \file
/// Hash of the state in reports, and checksum of saved files. Data with equal bits have equal hashes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// FNV-1a hash with 64 bits over the little-endian bytes of the added values.
/// Source: G. Fowler, L. C. Noll, K.-P. Vo, the FNV non-cryptographic hash (offset basis and prime as published).
class StateHash {
public:
    static constexpr const char* kName = "fnv1a64";

    void add(std::uint64_t word) {
        for (int byte = 0; byte < 8; ++byte) {
            value_ ^= (word >> (8 * byte)) & 0xffU;
            value_ *= 0x100000001b3ULL;
        }
    }
    /// Adds bytes in their order.
    void add(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) value_ = (value_ ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3ULL;
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(const Vec3& v) {
        add(v.x);
        add(v.y);
        add(v.z);
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace ricochet
