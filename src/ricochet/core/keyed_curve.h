/// \file
/// Values keyed in time, as animators set them: a curve through keys, with its exact derivatives.
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

/// What holds between two keys.
enum class Interpolation {
    linear,            ///< a straight line; the derivative jumps at keys
    slow_in_slow_out,  ///< 3 s^2 - 2 s^3 of the change: at rest at every key, continuous derivative
    spline,            ///< a cubic whose slope at a key is that of the parabola through it and both its neighbours
                       ///< (Catmull-Rom where keys are evenly spaced): continuous derivative
    cubic_spline,      ///< the cubic spline: the second derivative is continuous too, and each key moves all of it
};

[[nodiscard]] std::string_view name_of(Interpolation interpolation);

/// What holds before the first and after the last key.
enum class CurveEnds {
    hold,    ///< the value of that key; splines are at rest there, so that the derivative stays continuous
    repeat,  ///< the keys again and again, each round beginning with the value that the one before ended with; a spline
             ///< goes on smoothly
};

/// One key. Value: double or Vec3.
template <class Value>
struct CurveKey {
    double time = 0.0;  ///< s
    Value value{};
};

/// Upper bounds of the sizes of a function of time and of its first to fourth derivative; in the user's unit, per s^n.
using DerivativeBounds = std::array<double, 5>;

/// Those of a product of two functions, by Leibniz' rule.
[[nodiscard]] DerivativeBounds product(const DerivativeBounds& f, const DerivativeBounds& g);

/// A curve through keys, for Value = double and Value = Vec3. Immutable: safe from any number of threads. Time is in s,
/// values are in the user's unit.
template <class Value>
class KeyedCurve {
public:
    /// The same value at all times; throws InputError unless it is finite.
    explicit KeyedCurve(const Value& constant = Value{});
    /// Throws InputError unless there is a key, all are finite, times strictly increase, and no two keys are so near to
    /// each other in time that the derivative between them overflows.
    explicit KeyedCurve(std::vector<CurveKey<Value>> keys, Interpolation interpolation = Interpolation::linear,
                        CurveEnds ends = CurveEnds::hold);

    /// The value at a time; a key's own value exactly at that key.
    [[nodiscard]] Value value(double time) const;
    /// Derivative by time, per s; at a key the one of what follows it.
    [[nodiscard]] Value derivative(double time) const;
    /// Second derivative by time, per s^2; at a key the one of what follows it.
    [[nodiscard]] Value second_derivative(double time) const;

    /// Bounds of the value and its derivatives between keys, over [from, to].
    [[nodiscard]] DerivativeBounds bounds(double from, double to) const;
    /// The first key after a time, s, where derivatives may jump; infinite after the last.
    [[nodiscard]] double next_key(double time) const;

    [[nodiscard]] const std::vector<CurveKey<Value>>& keys() const { return keys_; }
    [[nodiscard]] Interpolation interpolation() const { return interpolation_; }
    [[nodiscard]] CurveEnds ends() const { return ends_; }

private:
    // A time within the keys, and how many rounds were taken off.
    struct Phase {
        double time;
        double rounds;
    };
    [[nodiscard]] Phase phase_of(double time) const;
    [[nodiscard]] bool is_held(double time) const;
    // The segment that begins at or before a time within the keys.
    [[nodiscard]] std::size_t segment_at(double time) const;
    void set_slopes();
    [[nodiscard]] bool is_spline() const {
        return interpolation_ == Interpolation::spline || interpolation_ == Interpolation::cubic_spline;
    }
    void include_segment(std::size_t k, DerivativeBounds& bounds) const;

    std::vector<CurveKey<Value>> keys_;
    std::vector<Value> slopes_;  // of a spline, one a key
    Interpolation interpolation_ = Interpolation::linear;
    CurveEnds ends_ = CurveEnds::hold;
};

extern template class KeyedCurve<double>;
extern template class KeyedCurve<Vec3>;

}  // namespace ricochet
