/// \file
/// Decoder of base64, digit by digit.
#pragma once

#include <cstdint>
#include <string>

namespace ricochet {

/// State between two digits.
class Base64Decoder {
public:
    /// Adds a digit of either alphabet of RFC 4648, and appends a byte that it completes. Returns false for all other
    /// characters.
    bool add(char c, std::string& bytes) {
        const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 26
                          : c >= '0' && c <= '9' ? c - '0' + 52
                          : c == '+' || c == '-' ? 62
                          : c == '/' || c == '_' ? 63
                                                 : -1;
        if (digit < 0) return false;
        bits_ = bits_ << 6U | static_cast<std::uint32_t>(digit);
        held_ += 6;
        if (held_ >= 8) bytes += static_cast<char>(bits_ >> (held_ -= 8) & 0xFFU);
        return true;
    }

private:
    std::uint32_t bits_ = 0;
    unsigned held_ = 0;
};

}  // namespace ricochet
