#include "ricochet/geometry/mesh/text_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_break(char c) { return c == '\n' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// from_chars knows no leading plus; the formats allow it.
const char* skip_plus(const char* at, const char* end) {
    return end - at > 1 && *at == '+' && (is_digit(at[1]) || at[1] == '.') ? at + 1 : at;
}

// Decides for a number that is out of the range of doubles whether it is too small: by the decimal place of its first
// non-zero digit.
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
        // Beyond this no count of digits makes a difference, and the sum below cannot overflow.
        exponent = std::clamp(exponent, -kLargestExponent, kLargestExponent);
    }
    const auto point = static_cast<long long>(std::min(mantissa.find('.'), mantissa.size()));
    const auto first_digit = static_cast<long long>(mantissa.find_first_of("123456789"));
    return exponent + (point - first_digit) < 0;
}

}  // namespace

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

std::string_view TextCursor::rest_of_line() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    const char* start = at_;
    while (at_ != end_ && !is_line_break(*at_)) ++at_;
    const char* last = at_;
    while (last != start && is_blank(last[-1])) --last;
    return {start, static_cast<std::size_t>(last - start)};
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

// Digits without a sign, too few to overflow: what nearly every index is.
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
