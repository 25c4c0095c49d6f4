#include "ricochet/geometry/mesh/mesh_source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"

namespace ricochet {
namespace {

[[noreturn]] void fail_to_open(const std::filesystem::path& path) {
    if (errno == ENOENT || errno == ENOTDIR) {
        throw InputError(fmt::format("{}: no such file, check the name", path.string()));
    }
    throw InputError(fmt::format("{}: cannot be read ({})", path.string(), std::strerror(errno)));
}

void require_regular(const std::filesystem::path& path, const struct stat& status) {
    if (S_ISREG(status.st_mode)) return;
    throw InputError(fmt::format("{}: {}, expected a regular file that holds a mesh", path.string(),
                                 S_ISDIR(status.st_mode) ? "is a folder" : "is a device, pipe or socket"));
}

class FileDescriptor {
public:
    // Opens the file without blocking. If a FIFO replaces the file after the check, the call must not wait for a
    // writer.
    explicit FileDescriptor(const std::filesystem::path& path)
        : value_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
    ~FileDescriptor() {
        if (value_ >= 0) ::close(value_);
    }
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;
    [[nodiscard]] int value() const { return value_; }

private:
    int value_;
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_break(char c) { return c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Skips a leading plus, which the formats allow, but from_chars refuses.
const char* skip_plus(const char* at, const char* end) {
    return end - at > 1 && *at == '+' && (is_digit(at[1]) || at[1] == '.') ? at + 1 : at;
}

// Returns true if a number outside the range of doubles is too small, and false if it is too large. The decimal
// position of its first nonzero digit decides.
bool is_too_small(std::string_view text) {
    const std::size_t exponent_mark = text.find_first_of("eE");
    const std::string_view mantissa = text.substr(0, exponent_mark);
    constexpr long long kLargestExponent = 1'000'000'000'000'000;
    long long exponent = 0;
    if (exponent_mark != std::string_view::npos) {
        std::string_view digits = text.substr(exponent_mark + 1);
        if (digits.starts_with('+')) digits.remove_prefix(1);
        const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
        if (result.ec == std::errc::result_out_of_range) return digits.starts_with('-');
        // A larger exponent gives the same result for any number of digits. The clamp prevents overflow of the sum
        // below.
        exponent = std::clamp(exponent, -kLargestExponent, kLargestExponent);
    }
    const auto point = static_cast<long long>(std::min(mantissa.find('.'), mantissa.size()));
    const auto first_digit = static_cast<long long>(mantissa.find_first_of("123456789"));
    return exponent + (point - first_digit) < 0;
}

}  // namespace

void MeshSource::fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", name, what)); }

void MeshSource::fail_at_line(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name, line, what));
}

void MeshSource::fail_at_byte(std::size_t byte, const std::string& what) const {
    throw InputError(fmt::format("{}: byte {}: {}", name, byte, what));
}

FileBytes read_regular_file(const std::filesystem::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) fail_to_open(path);
    require_regular(path, status);
    const FileDescriptor file(path);
    if (file.value() < 0 || ::fstat(file.value(), &status) != 0) fail_to_open(path);
    require_regular(path, status);

    FileBytes bytes;
    bytes.size = static_cast<std::size_t>(status.st_size);
    require_memory(static_cast<double>(bytes.size), path.string());
    bytes.data = std::make_unique_for_overwrite<char[]>(bytes.size);
    std::size_t done = 0;
    while (done < bytes.size) {
        const ssize_t count = ::read(file.value(), bytes.data.get() + done, bytes.size - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail_to_open(path);
        if (count == 0) throw InputError(fmt::format("{}: became shorter while it was being read", path.string()));
        done += static_cast<std::size_t>(count);
    }
    return bytes;
}

ImportedMesh imported(PolygonMesh polygons, std::string format, std::optional<WeldReport> weld) {
    ImportedMesh result;
    result.polygons = std::move(polygons);
    result.format = std::move(format);
    result.weld = weld;
    return result;
}

std::string ascii_lower(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return lower;
}

std::string in_quotes(std::string_view word) {
    constexpr std::size_t kLongest = 40;
    std::string text = "'";
    for (const char c : word.substr(0, kLongest)) text += (c >= ' ' && c <= '~') ? c : '?';
    return text + (word.size() > kLongest ? "...'" : "'");
}

void require_plain_text(const MeshSource& source) {
    if (source.bytes.starts_with("\xff\xfe") || source.bytes.starts_with("\xfe\xff")) {
        source.fail("UTF-16 text, save the file as UTF-8 or ASCII");
    }
    const std::size_t nul = source.bytes.find('\0');
    if (nul != std::string_view::npos) {
        source.fail_at_byte(nul, "NUL byte in a text file, expected text only (is this a binary or UTF-16 file?)");
    }
}

bool TextCursor::skip_continuation() {
    if (!syntax_.backslash_continues_line || *at_ != '\\' || end_ - at_ < 2 || !is_line_break(at_[1])) return false;
    ++at_;
    next_line();
    return true;
}

void TextCursor::skip_blanks() {
    while (at_ != end_) {
        if (is_blank(*at_)) {
            ++at_;
        } else if (!skip_continuation()) {
            break;
        }
    }
    if (syntax_.hash_comments && at_ != end_ && *at_ == '#') {
        while (at_ != end_ && !is_line_break(*at_)) ++at_;
    }
}

bool TextCursor::at_word_end_slowly() const {
    if (at_ == end_ || is_blank(*at_) || is_line_break(*at_)) return true;
    return syntax_.backslash_continues_line && *at_ == '\\' && end_ - at_ > 1 && is_line_break(at_[1]);
}

bool TextCursor::at_line_end_slowly() {
    skip_blanks();
    return at_ == end_ || is_line_break(*at_);
}

std::string_view TextCursor::word_here() const {
    TextCursor probe = *this;
    while (!probe.at_word_end()) ++probe.at_;
    return {at_, static_cast<std::size_t>(probe.at_ - at_)};
}

std::string_view TextCursor::word() {
    if (at_line_end()) return {};
    const char* start = at_;
    while (!at_word_end()) ++at_;
    return {start, static_cast<std::size_t>(at_ - start)};
}

std::string TextCursor::rest_of_line() {
    std::string rest;
    while (!at_line_end()) {
        const char* const start = at_;
        const char* last = at_;  // end of the last word of this line
        while (at_ != end_ && !is_line_break(*at_)) {
            if (is_blank(*at_)) {
                ++at_;
                continue;
            }
            if (at_word_end() || (syntax_.hash_comments && *at_ == '#')) break;  // a continuation or a comment
            (void)word();
            last = at_;
        }
        if (!rest.empty()) rest += ' ';
        rest.append(start, last);
    }
    return rest;
}

void TextCursor::skip_statement() {
    const char* line_end = at_;
    while (line_end != end_ && !is_line_break(*line_end)) ++line_end;
    if (syntax_.backslash_continues_line && line_end != at_ && line_end[-1] == '\\') {
        while (!at_line_end()) (void)word();
    }
    next_line();
}

void TextCursor::next_line_slowly() {
    while (at_ != end_ && !is_line_break(*at_)) ++at_;
    if (at_ == end_) return;
    const bool carriage_return = *at_++ == '\r';
    if (carriage_return && at_ != end_ && *at_ == '\n') ++at_;
    ++line_;
}

bool TextCursor::next_filled_line() {
    while (at_line_end()) {
        if (at_ == end_) return false;
        next_line();
    }
    return true;
}

double TextCursor::number(const char* what) {
    if (at_line_end()) fail(fmt::format("the line ends before {}, expected a number", what));
    double value = 0.0;
    const char* start = skip_plus(at_, end_);
    const auto [stop, error] = std::from_chars(start, end_, value);
    if (error == std::errc::result_out_of_range) {
        value = limit_value(start, what);
    } else if (error != std::errc{}) {
        fail(fmt::format("{} is {}, expected a number such as -1.5e3", what, in_quotes(word_here())));
    }
    const char* word_start = at_;
    at_ = stop;
    if (!at_word_end() || !std::isfinite(value)) {
        at_ = word_start;
        fail(fmt::format("{} is {}, expected a finite number such as -1.5e3 (decimal point, no comma)", what,
                         in_quotes(word_here())));
    }
    return value;
}

bool TextCursor::skip_number(const char* what) {
    if (at_line_end()) fail(fmt::format("the line ends before {}, expected a number", what));
    const std::string_view found = word_here();
    const std::string_view digits = found.substr(found.starts_with('-') || found.starts_with('+') ? 1 : 0);
    for (const std::string_view start : {"nan", "NaN", "NAN", "inf", "Inf", "INF", "1.#"}) {
        if (!digits.starts_with(start)) continue;
        (void)word();
        return false;
    }
    (void)number(what);
    return true;
}

double TextCursor::limit_value(const char* word_start, const char* what) const {
    const std::string_view word = word_here();
    if (is_too_small({word_start, static_cast<std::size_t>(word.data() + word.size() - word_start)})) return 0.0;
    fail(fmt::format("{} is {}, larger than any double, expected at most {}; choose another unit", what,
                     in_quotes(word), kLargestCoordinate));
}

double TextCursor::coordinate(const char* what) {
    const double value = number(what);
    const std::optional<double> accepted = accepted_coordinate(value);
    if (!accepted)
        fail(
            fmt::format("{} is {}, expected at most {} in size; choose another unit", what, value, kLargestCoordinate));
    return *accepted;
}

Vec3 TextCursor::point(const char* what) {
    const double x = coordinate(what);
    const double y = coordinate(what);
    const double z = coordinate(what);
    return {x, y, z};
}

// Reads a number without a sign that has too few digits to overflow. Nearly every index has this form.
std::optional<std::int64_t> TextCursor::small_number() {
    constexpr std::ptrdiff_t kSafeDigits = 18;
    const char* const most = end_ - at_ > kSafeDigits ? at_ + kSafeDigits : end_;
    std::int64_t value = 0;
    const char* at = at_;
    for (; at != most && is_digit(*at); ++at) value = 10 * value + (*at - '0');
    if (at == at_ || (at == most && at != end_)) return std::nullopt;
    at_ = at;
    return value;
}

std::int64_t TextCursor::integer_part(const char* what) {
    if (const std::optional<std::int64_t> number = small_number()) return *number;
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(skip_plus(at_, end_), end_, value);
    if (error != std::errc{}) fail(fmt::format("{} is {}, expected an integer", what, in_quotes(word_here())));
    at_ = stop;
    return value;
}

std::int64_t TextCursor::integer(const char* what) {
    if (at_line_end()) fail(fmt::format("the line ends before {}, expected an integer", what));
    const char* word_start = at_;
    const std::int64_t value = integer_part(what);
    if (!at_word_end()) {
        at_ = word_start;
        fail(fmt::format("{} is {}, expected an integer", what, in_quotes(word_here())));
    }
    return value;
}

bool TextCursor::take(char c) {
    if (!comes_next(c)) return false;
    ++at_;
    return true;
}

}  // namespace ricochet
