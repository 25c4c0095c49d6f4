#include "view/page/packing.h"

#include <zlib.h>

#include <new>

#include "ricochet/core/error.h"

namespace ricochet {

std::string deflated(std::string_view bytes) {
    z_stream stream{};
    if (deflateInit(&stream, 6) != Z_OK) throw std::bad_alloc();
    std::string packed(deflateBound(&stream, bytes.size()), '\0');
    // zlib does not write to its input, but its type is not const.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    const int status = bytes.size() > 0xffffffffU ? Z_BUF_ERROR : deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    if (status != Z_STREAM_END) throw RunError("more than 4 GB at a time cannot be packed into a page");
    return packed;
}

std::string base64(std::string_view bytes) {
    static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63U];
        }
    }
    return text;
}

std::string html_text(std::string_view text) {
    std::string shown;
    for (const char c : text) {
        switch (c) {
            case '&':
                shown += "&amp;";
                break;
            case '<':
                shown += "&lt;";
                break;
            case '>':
                shown += "&gt;";
                break;
            case '"':
                shown += "&quot;";
                break;
            case '\'':
                shown += "&#39;";
                break;
            default:
                shown += c;
        }
    }
    return shown;
}

}  // namespace ricochet
