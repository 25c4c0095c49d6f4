/// \file
/// Curves through values that are keyed in time, as in animation, with their exact derivatives.
/// Sources: ease in and out as the cubic 3 s^2 - 2 s^3: J. Lasseter, "Principles of Traditional Animation Applied to 3D
/// Computer Animation", SIGGRAPH 1987 (slow in and out). Splines: E. Catmull, R. Rom, "A class of local interpolating
/// splines", 1974; on uneven keys with the tangents of C. de Boor, "A Practical Guide to Splines", 1978, chapter IV
/// (piecewise cubic Bessel interpolation; cubic splines, complete and periodic).
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Interpolation between two keys.
enum class Interpolation {
    linear,            ///< a straight line; the derivative jumps at keys
    slow_in_slow_out,  ///< the change times 3 s^2 - 2 s^3: slope 0 at every key, continuous derivative
    spline,            ///< a cubic; its slope at a key is that of the parabola through the key and both neighbours
                       ///< (Catmull-Rom if keys are evenly spaced): continuous derivative
    cubic_spline,      ///< the cubic spline: continuous second derivative; each key affects the whole curve
};

[[nodiscard]] std::string_view name_of(Interpolation interpolation);

/// Extrapolation before the first and after the last key.
enum class CurveEnds {
    hold,    ///< constant, with the value of that key; splines have slope 0 there for a continuous derivative
    repeat,  ///< the keys repeat, and each round begins with the value at the end of the one before; splines continue
             ///< smoothly
};

/// One key. Value: double or Vec3.
template <class Value>
struct CurveKey {
    double time = 0.0;  ///< s
    Value value{};
};

/// Upper bounds of the magnitudes of a function of time and of its first to fourth derivative, in the user's unit per
/// s^n.
using DerivativeBounds = std::array<double, 5>;

/// Returns the bounds of a product of two functions, by Leibniz' rule.
[[nodiscard]] DerivativeBounds product(const DerivativeBounds& f, const DerivativeBounds& g);

/// Curve through keys, for Value = double and Value = Vec3. Immutable, so any number of threads may use it. Time is in
/// s, values are in the user's unit.
template <class Value>
class KeyedCurve {
public:
    /// Makes a curve with one value at all times. Throws InputError unless the value is finite.
    explicit KeyedCurve(const Value& constant = Value{});
    /// Throws InputError unless there is a key, all keys are finite and times strictly increase. It also throws if two
    /// keys are so close in time that the derivative between them overflows.
    explicit KeyedCurve(std::vector<CurveKey<Value>> keys, Interpolation interpolation = Interpolation::linear,
                        CurveEnds ends = CurveEnds::hold);

    /// Returns the value at a time. At a key this is exactly the key's value.
    [[nodiscard]] Value value(double time) const;
    /// Returns the first derivative by time, per s. At a key it is the derivative after the key.
    [[nodiscard]] Value derivative(double time) const;
    /// Returns the second derivative by time, per s^2. At a key it is the derivative after the key.
    [[nodiscard]] Value second_derivative(double time) const;

    /// Returns bounds of the value and of its derivatives between keys, over [from, to].
    [[nodiscard]] DerivativeBounds bounds(double from, double to) const;
    /// Returns the time of the first key after a time, in s; infinity after the last key. Derivatives can jump at a
    /// key.
    [[nodiscard]] double next_key(double time) const;

    [[nodiscard]] const std::vector<CurveKey<Value>>& keys() const { return keys_; }
    [[nodiscard]] Interpolation interpolation() const { return interpolation_; }
    [[nodiscard]] CurveEnds ends() const { return ends_; }

private:
    // Time shifted into the range of the keys, and the number of rounds subtracted for that.
    struct Phase {
        double time;
        double rounds;
    };
    [[nodiscard]] Phase phase_of(double time) const;
    [[nodiscard]] bool is_held(double time) const;
    // Returns the segment that contains a time within the range of the keys.
    [[nodiscard]] std::size_t segment_at(double time) const;
    void set_slopes();
    [[nodiscard]] bool is_spline() const {
        return interpolation_ == Interpolation::spline || interpolation_ == Interpolation::cubic_spline;
    }
    void include_segment(std::size_t k, DerivativeBounds& bounds) const;

    std::vector<CurveKey<Value>> keys_;
    std::vector<Value> slopes_;  // of a spline, one per key
    Interpolation interpolation_ = Interpolation::linear;
    CurveEnds ends_ = CurveEnds::hold;
};

extern template class KeyedCurve<double>;
extern template class KeyedCurve<Vec3>;

}  // namespace ricochet
