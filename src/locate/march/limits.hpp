#pragma once

namespace rollfix::march {

// What the searches for one finger and for two have in common.

/// The smallest limit that rounding errors of s leave room for.
inline constexpr double kLeastLimit = 1e-14;
/// Rounding errors of an advance of s or t, as a part of P: some sums of lengths of up to two loops.
inline constexpr double kLengthRounding = 4e-15;
/// Equations that hold to rounding over more than this part of P: a continuum.
inline constexpr double kContinuum = 1e-3;
/// A limit is good enough, where rounding prevents better, when the reset surely passes what was found.
inline constexpr double kPartOfReset = 0.25;
/// A Newton step shorter than this part of the parameter step is taken without another quadrature: what it leaves is
/// its square, a rounding error.
inline constexpr double kLastCorrection = 1e-8;

}  // namespace rollfix::march
