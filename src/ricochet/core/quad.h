/// \file
/// Vectors of four doubles (lanes), and three-component vectors of them. Each lane gets the same bits as a computation
/// with scalar doubles.
///
/// Uses the vector extensions of GCC and clang, which are fast in functions compiled for AVX2. Without AVX2, GCC
/// processes vectors element by element. Everything is inlined at any optimisation level, since the calling convention
/// for vectors of 32 bytes differs with and without AVX.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "ricochet/core/vec3.h"

/// Forces the inlining of a function into its callers. For parts of functions that are compiled for several kinds of
/// processors.
#define RICOCHET_INLINE [[gnu::always_inline]] inline

namespace ricochet {

/// Truth value for each of four lanes.
struct QuadMask {
    std::int64_t lanes __attribute__((vector_size(32)));  ///< all bits of a lane are equal
};

/// Four numbers.
struct Quad {
    using Lanes = double __attribute__((vector_size(32)));

    /// Lanes in memory, to load from and store to any doubles. It is a packed structure, because Clang ignores a lower
    /// alignment of a vector type, and would use instructions that fail on doubles beside multiples of 32 bytes.
    struct __attribute__((packed, may_alias)) Stored {
        Lanes lanes;
    };

    Lanes lanes;
};

/// Loads four consecutive doubles. Does not use memcpy(), because GCC splits the copy into two halves if AVX is not
/// enabled yet at that stage of compilation.
[[nodiscard]] RICOCHET_INLINE Quad load_quad(const double* from) {
    return {reinterpret_cast<const Quad::Stored*>(from)->lanes};
}
[[nodiscard]] RICOCHET_INLINE Quad load_quad(const std::array<float, 4>& from) {
    using Floats = float __attribute__((vector_size(16)));
    return {__builtin_convertvector(std::bit_cast<Floats>(from), Quad::Lanes)};
}
RICOCHET_INLINE void store(const Quad& a, double* to) { reinterpret_cast<Quad::Stored*>(to)->lanes = a.lanes; }

/// Returns four equal numbers. A list of them would be built in two halves by GCC.
[[nodiscard]] RICOCHET_INLINE Quad quad_of(double all) {
    const Quad::Lanes one{all};
    return {__builtin_shufflevector(one, one, 0, 0, 0, 0)};
}

[[nodiscard]] RICOCHET_INLINE Quad operator+(const Quad& a, const Quad& b) { return {a.lanes + b.lanes}; }
[[nodiscard]] RICOCHET_INLINE Quad operator-(const Quad& a, const Quad& b) { return {a.lanes - b.lanes}; }
[[nodiscard]] RICOCHET_INLINE Quad operator-(const Quad& a) { return {-a.lanes}; }
[[nodiscard]] RICOCHET_INLINE Quad operator*(const Quad& a, const Quad& b) { return {a.lanes * b.lanes}; }
[[nodiscard]] RICOCHET_INLINE Quad operator*(double a, const Quad& b) { return {a * b.lanes}; }
[[nodiscard]] RICOCHET_INLINE Quad operator/(const Quad& a, const Quad& b) { return {a.lanes / b.lanes}; }
[[nodiscard]] RICOCHET_INLINE Quad operator/(double a, const Quad& b) { return {a / b.lanes}; }

[[nodiscard]] RICOCHET_INLINE QuadMask operator==(const Quad& a, double b) { return {a.lanes == b}; }
[[nodiscard]] RICOCHET_INLINE QuadMask operator>(const Quad& a, double b) { return {a.lanes > b}; }
[[nodiscard]] RICOCHET_INLINE QuadMask operator>=(const Quad& a, double b) { return {a.lanes >= b}; }
[[nodiscard]] RICOCHET_INLINE QuadMask operator<(const Quad& a, const Quad& b) { return {a.lanes < b.lanes}; }
[[nodiscard]] RICOCHET_INLINE QuadMask operator>(const Quad& a, const Quad& b) { return {a.lanes > b.lanes}; }
[[nodiscard]] RICOCHET_INLINE QuadMask operator&(const QuadMask& a, const QuadMask& b) { return {a.lanes & b.lanes}; }
[[nodiscard]] RICOCHET_INLINE QuadMask operator|(const QuadMask& a, const QuadMask& b) { return {a.lanes | b.lanes}; }
/// Returns true if a lane is true.
[[nodiscard]] RICOCHET_INLINE bool any(const QuadMask& a) {
    return (a.lanes[0] | a.lanes[1] | a.lanes[2] | a.lanes[3]) != 0;
}

/// Returns one bit for each lane, set if the lane is true.
[[nodiscard]] RICOCHET_INLINE unsigned bits_of(const QuadMask& a) {
    const auto bits = QuadMask{a.lanes & decltype(a.lanes){1, 2, 4, 8}}.lanes;
    return static_cast<unsigned>(bits[0] | bits[1] | bits[2] | bits[3]);
}

/// Returns a if the mask is true, else b, per lane.
[[nodiscard]] RICOCHET_INLINE Quad select(const QuadMask& mask, const Quad& a, const Quad& b) {
    return {mask.lanes ? a.lanes : b.lanes};
}
/// Returns the larger number per lane, with the semantics of std::max().
[[nodiscard]] RICOCHET_INLINE Quad larger(const Quad& a, const Quad& b) { return select(a < b, b, a); }
/// Returns the smaller number per lane, with the semantics of std::min().
[[nodiscard]] RICOCHET_INLINE Quad smaller(const Quad& a, const Quad& b) { return select(b < a, b, a); }
/// Returns |a| per lane.
[[nodiscard]] RICOCHET_INLINE Quad magnitude(const Quad& a) {
    using Bits = std::int64_t __attribute__((vector_size(32)));
    constexpr std::int64_t kMagnitude = 0x7FFFFFFFFFFFFFFF;
    return {reinterpret_cast<Quad::Lanes>(reinterpret_cast<Bits>(a.lanes) &
                                          Bits{kMagnitude, kMagnitude, kMagnitude, kMagnitude})};
}
[[nodiscard]] RICOCHET_INLINE Quad root(const Quad& a) {
    // GCC turns four std::sqrt() into four calls, since they may set errno.
#if __has_builtin(__builtin_elementwise_sqrt)
    return {__builtin_elementwise_sqrt(a.lanes)};
#elif defined(__SSE2__)
    using Half = double __attribute__((vector_size(16)));
    const Half low = __builtin_ia32_sqrtpd(__builtin_shufflevector(a.lanes, a.lanes, 0, 1));
    const Half high = __builtin_ia32_sqrtpd(__builtin_shufflevector(a.lanes, a.lanes, 2, 3));
    return {__builtin_shufflevector(low, high, 0, 1, 2, 3)};
#else
    return {Quad::Lanes{std::sqrt(a.lanes[0]), std::sqrt(a.lanes[1]), std::sqrt(a.lanes[2]), std::sqrt(a.lanes[3])}};
#endif
}

/// Scalar versions, for templates that compute with one number or with four.
[[nodiscard]] RICOCHET_INLINE bool any(bool a) { return a; }
template <class T>
[[nodiscard]] RICOCHET_INLINE T select(bool mask, const T& a, const T& b) {
    return mask ? a : b;
}
[[nodiscard]] RICOCHET_INLINE double larger(double a, double b) { return std::max(a, b); }
[[nodiscard]] RICOCHET_INLINE double smaller(double a, double b) { return std::min(a, b); }
[[nodiscard]] RICOCHET_INLINE double magnitude(double a) { return std::fabs(a); }
[[nodiscard]] RICOCHET_INLINE double root(double a) { return std::sqrt(a); }

/// Four vectors.
struct QuadVec3 {
    Quad x, y, z;
};

[[nodiscard]] RICOCHET_INLINE QuadVec3 operator+(const QuadVec3& a, const QuadVec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] RICOCHET_INLINE QuadVec3 operator-(const QuadVec3& a, const QuadVec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] RICOCHET_INLINE QuadVec3 operator-(const QuadVec3& a) { return {-a.x, -a.y, -a.z}; }
[[nodiscard]] RICOCHET_INLINE QuadVec3 operator*(const Quad& s, const QuadVec3& a) {
    return {a.x * s, a.y * s, a.z * s};
}
[[nodiscard]] RICOCHET_INLINE QuadVec3 operator*(double s, const QuadVec3& a) { return {s * a.x, s * a.y, s * a.z}; }
RICOCHET_INLINE QuadVec3& operator+=(QuadVec3& a, const QuadVec3& b) { return a = a + b; }
[[nodiscard]] RICOCHET_INLINE Quad dot(const QuadVec3& a, const QuadVec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] RICOCHET_INLINE QuadVec3 cross(const QuadVec3& a, const QuadVec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] RICOCHET_INLINE Quad length_squared(const QuadVec3& a) { return dot(a, a); }
[[nodiscard]] RICOCHET_INLINE QuadVec3 select(const QuadMask& mask, const QuadVec3& a, const QuadVec3& b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// Transposes the 4 x 4 matrix of these rows.
RICOCHET_INLINE void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
    const Quad::Lanes low_ab = __builtin_shufflevector(a.lanes, b.lanes, 0, 4, 2, 6);
    const Quad::Lanes high_ab = __builtin_shufflevector(a.lanes, b.lanes, 1, 5, 3, 7);
    const Quad::Lanes low_cd = __builtin_shufflevector(c.lanes, d.lanes, 0, 4, 2, 6);
    const Quad::Lanes high_cd = __builtin_shufflevector(c.lanes, d.lanes, 1, 5, 3, 7);
    a.lanes = __builtin_shufflevector(low_ab, low_cd, 0, 1, 4, 5);
    b.lanes = __builtin_shufflevector(high_ab, high_cd, 0, 1, 4, 5);
    c.lanes = __builtin_shufflevector(low_ab, low_cd, 2, 3, 6, 7);
    d.lanes = __builtin_shufflevector(high_ab, high_cd, 2, 3, 6, 7);
}

}  // namespace ricochet
