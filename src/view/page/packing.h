/// \file
/// Serialization, compression and encoding as text of the bytes of a page.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace ricochet {

/// Little-endian serializer of numbers.
class ByteWriter {
public:
    void byte(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }
    /// Appends seven bits per byte, lowest first. All bytes except the last have their top bit set.
    void varint(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7) byte(static_cast<std::uint8_t>(value | 0x80U));
        byte(static_cast<std::uint8_t>(value));
    }
    /// Appends a signed number as a varint: 0, -1, 1, -2, ... are coded as 0, 1, 2, 3, ...
    void signed_varint(std::int64_t value) {
        varint((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
    }
    void float32(double value) {
        const auto narrow = static_cast<float>(value);
        std::array<char, sizeof narrow> bytes{};
        std::memcpy(bytes.data(), &narrow, sizeof narrow);
        bytes_.append(bytes.data(), bytes.size());
    }
    void append(std::string_view bytes) { bytes_ += bytes; }

    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

/// Returns the bytes in zlib's format (RFC 1950). Browsers call this format `deflate`. Throws std::bad_alloc if memory
/// is short, and RunError for more than 4 GB.
[[nodiscard]] std::string deflated(std::string_view bytes);

/// Returns the bytes as base64 text (RFC 4648, with padding).
[[nodiscard]] std::string base64(std::string_view bytes);

/// Returns the text escaped for HTML: &, <, > and quotes become entities.
[[nodiscard]] std::string html_text(std::string_view text);

}  // namespace ricochet
