/// \file Choices from a fuzzer's bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ricochet/core/vec3.h"

namespace ricochet::fuzz {

/// Reader of choices from consecutive bytes. After the end every byte is 0. C++ does not define the order of two
/// choices within one expression. Each choice is therefore a separate statement, or the scene would depend on the
/// compiler.
class ByteChoices {
public:
    explicit ByteChoices(std::string_view bytes) : rest_(bytes) {}

    [[nodiscard]] bool at_end() const { return rest_.empty(); }
    std::uint8_t byte() {
        if (rest_.empty()) return 0;
        const auto value = static_cast<std::uint8_t>(rest_.front());
        rest_.remove_prefix(1);
        return value;
    }
    /// Returns an index below `count`, which is at most 256.
    std::size_t index(std::size_t count) { return byte() % count; }
    template <class T, std::size_t n>
    T one_of(const T (&values)[n]) {
        return values[index(n)];
    }
    bool yes() { return (byte() & 1U) != 0; }
    std::uint16_t two_bytes() {
        const unsigned high = byte();
        return static_cast<std::uint16_t>(high << 8U | byte());
    }
    /// Returns a number in [0, 1], in steps of 2^-16.
    double part() { return static_cast<double>(two_bytes()) / 65535.0; }
    /// Returns a fraction of one of the values.
    template <std::size_t n>
    double part_of(const double (&values)[n]) {
        const double value = one_of(values);
        return value * part();
    }
    double between(double low, double high) { return low + (high - low) * part(); }

    /// Returns a coordinate in [-2, 2]: on a coarse grid, near the grid, or anywhere. On the grid, objects touch at
    /// edges and corners and lie in planes.
    double coordinate() {
        const std::uint8_t kind = byte();
        const double on_grid = static_cast<double>(static_cast<int>(kind >> 2U) - 32) / 16.0;
        switch (kind & 3U) {
            case 0:
            case 1:
                return on_grid;
            case 2: {
                const double unit = one_of<double>({1e-16, 1e-13, 1e-9, 1e-5});
                return on_grid + unit * (static_cast<double>(byte()) - 128.0);
            }
            default:
                return between(-2.0, 2.0);
        }
    }
    Vec3 point() {
        const double x = coordinate();
        const double y = coordinate();
        const double z = coordinate();
        return {x, y, z};
    }
    /// Returns a direction that is not zero.
    Vec3 direction() {
        const Vec3 v = point();
        return v == Vec3{} ? Vec3{0, 0, 1} : v;
    }

private:
    std::string_view rest_;
};

}  // namespace ricochet::fuzz
