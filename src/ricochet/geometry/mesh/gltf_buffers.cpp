#include "ricochet/geometry/mesh/gltf_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include "ricochet/core/base64.h"
#include "ricochet/core/memory_limit.h"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

std::string decode_base64(const GltfLocation& uri, std::string_view text) {
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    if (text.size() % 4 == 1) uri.fail("its base64 data is cut off");
    require_memory(static_cast<double>(text.size()), "a buffer of a glTF file");
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    Base64Decoder decoder;
    for (const char c : text) {
        if (!decoder.add(c, bytes)) uri.fail("its data is not base64");
    }
    return bytes;
}

// Decodes percent-encoded bytes, such as "%20" for a blank.
std::string without_percents(const GltfLocation& uri, std::string_view text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            plain += text[i];
            continue;
        }
        const std::string_view digits = text.substr(i + 1, 2);
        unsigned code = 0;
        const char* const end = digits.data() + digits.size();
        if (digits.size() != 2 || std::from_chars(digits.data(), end, code, 16).ptr != end)
            uri.fail(fmt::format("{} ends within a %", in_quotes(text)));
        plain += static_cast<char>(code);
        i += 2;
    }
    return plain;
}

bool is_within(const fs::path& path, const fs::path& folder) {
    const auto [rest, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return rest == folder.end();
}

// Returns the path of the file that a buffer names. The file must be beside the glTF file or in a subfolder, also after
// links have been resolved.
fs::path file_below(const GltfLocation& uri, const fs::path& folder) {
    const std::string name = without_percents(uri, uri.text());
    const fs::path path(name);
    const bool climbs = std::find(path.begin(), path.end(), "..") != path.end();
    if (name.empty() || name.find('\0') != std::string::npos || name.find_first_of(":\\") != std::string::npos ||
        path.is_absolute() || climbs) {
        uri.fail(fmt::format("found {}, expected a file beside the glTF file or in a folder below", in_quotes(name)));
    }
    std::error_code error;
    const fs::path home = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    const fs::path target = fs::weakly_canonical(home / path, error);
    if (error || !is_within(target, home)) {
        uri.fail(fmt::format("{} is a link that leads out of the glTF file's folder", in_quotes(name)));
    }
    return (folder / path).lexically_normal();
}

}  // namespace

GltfBuffers::GltfBuffers(const GltfLocation& document, GltfSurroundings surroundings)
    : buffers_(document.items("buffers")),
      views_(document.items("bufferViews")),
      surroundings_(std::move(surroundings)) {}

std::vector<fs::path> GltfBuffers::files() const {
    std::vector<fs::path> files;
    for (const auto& [path, bytes] : read_) files.push_back(path);
    return files;
}

std::size_t GltfBuffers::bytes_of_files() const {
    std::size_t sum = 0;
    for (const auto& [path, bytes] : read_) sum += bytes.size;
    return sum;
}

GltfBuffers::View GltfBuffers::view(const GltfLocation& owner, std::string_view key) {
    const GltfLocation view = views_[owner.at(key).index_below(views_.size(), "bufferViews")];
    const std::string_view bytes = buffer(view.at("buffer").index_below(buffers_.size(), "buffers"));
    const std::uint64_t offset = view.whole_number("byteOffset", 0);
    const std::uint64_t length = view.at("byteLength").whole_number();
    if (offset > bytes.size() || length > bytes.size() - offset) {
        view.fail(fmt::format("bytes {} to {}, but its buffer has {}", offset, offset + length, bytes.size()));
    }
    const std::uint64_t stride = view.whole_number("byteStride", 0);
    constexpr std::uint64_t kLargestStride = 252;
    // A stride of 0 is accepted, because several exporters write it for elements without gaps.
    if (stride != 0 && (stride < 4 || stride > kLargestStride)) {
        view.fail(fmt::format("found the byteStride {}, expected 4 to {}, or 0 for none", stride, kLargestStride));
    }
    return {bytes.substr(offset, length), static_cast<std::size_t>(stride)};
}

std::string_view GltfBuffers::buffer(std::size_t number) {
    const auto [entry, is_new] = known_.try_emplace(number);
    if (is_new) {
        const GltfLocation buffer = buffers_[number];
        const std::uint64_t length = buffer.at("byteLength").whole_number();
        const std::string_view bytes = bytes_of(number, buffer);
        if (length > bytes.size()) {
            buffer.fail(fmt::format("{} bytes, but there are {}; is it cut off?", length, bytes.size()));
        }
        entry->second = bytes.substr(0, length);
    }
    return entry->second;
}

std::string_view GltfBuffers::bytes_of(std::size_t number, const GltfLocation& buffer) {
    if (!buffer.has("uri")) {
        if (number != 0 || !surroundings_.chunk) {
            buffer.fail(
                "no \"uri\", and no binary chunk of a GLB file; compressed files have such buffers: "
                "export without compression");
        }
        return *surroundings_.chunk;
    }
    const GltfLocation uri = buffer.at("uri");
    const std::string_view text = uri.text();
    if (!text.starts_with("data:")) return file_bytes(uri);
    const std::size_t comma = text.find(',');
    constexpr std::string_view kBase64 = ";base64";
    if (comma == std::string_view::npos || !text.substr(0, comma).ends_with(kBase64)) {
        uri.fail(fmt::format("found {}, expected data in base64", in_quotes(text)));
    }
    return decoded_[number] = decode_base64(uri, text.substr(comma + 1));
}

std::string_view GltfBuffers::file_bytes(const GltfLocation& uri) {
    if (!surroundings_.folder) uri.fail("names a file, expected its data in the glTF file itself");
    const fs::path path = file_below(uri, *surroundings_.folder);
    const auto found = read_.find(path);
    if (found != read_.end()) return found->second.view();
    return read_.emplace(path, read_regular_file(path)).first->second.view();
}

}  // namespace ricochet
