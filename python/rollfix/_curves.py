"""A curve that is given by functions becomes polynomials once, so that nothing calls Python afterwards."""

from __future__ import annotations

from typing import Any, Callable, List, Sequence, Tuple

import numpy as np

from ._checks import number, numbers
from ._core import InputError
from ._messages import shown

Function = Callable[[float], Any]
DEGREE = 9  # of the pieces' derivative: high enough for few pieces, low enough to lose no digits to its basis
SMALLEST = 2.0**-20  # of the domain: what is rougher is a corner or no curve
# Relative to the largest first derivative: to this a piece meets the function's derivatives.
FIRST, SECOND, GIVEN = 1e-13, 1e-9, 1e-6


def pieces_of(f: Function, df: Function, ddf: Function, domain: Sequence[float]) -> List[np.ndarray]:
    """Control points of Bezier pieces, (DEGREE + 2, 2) each, whose slope meets `df` at Chebyshev's places."""
    try:
        knots = [number(knot, "domain") for knot in domain]
    except TypeError:
        raise InputError(f"domain: expected (first, last), found {shown(domain)}") from None
    if len(knots) < 2 or not all(a < b for a, b in zip(knots, knots[1:])):
        expected = "(first, last), or growing values with corners at the inner ones"
        raise InputError(f"domain: expected {expected}, found {shown(domain)}")
    functions = [_named(f, "f"), _named(df, "df"), _named(ddf, "ddf")]
    whole = knots[-1] - knots[0]
    size = 0.0
    for lo, hi in zip(knots, knots[1:]):  # never at a corner, where derivatives jump
        probes = lo + (hi - lo) * np.linspace(0.02, 0.98, 33)
        size = max(size, max(float(np.hypot(*functions[1](u))) for u in probes))
        if not size > 0:
            raise InputError(f"df: is 0 all the way from {lo!r} to {hi!r}, expected a curve that moves")
        _check_given(functions, probes, size)
    result: List[np.ndarray] = []
    for lo, hi in zip(knots, knots[1:]):
        _add_pieces(functions, lo, hi, size, SMALLEST * whole, result)
    _join(result, functions[0](knots[0]))
    return result


def _named(function: Function, name: str) -> Callable[[float], np.ndarray]:
    if not callable(function):
        raise InputError(f"{name}: expected a function of the parameter, found {shown(function)}")

    def call(u: float) -> np.ndarray:
        return np.array(numbers(np.ravel(function(u)), 2, f"{name}({u:.6g})", "two numbers, x and y"))

    return call


def _check_given(functions: List[Callable[[float], np.ndarray]], probes: np.ndarray, size: float) -> None:
    """Each derivative against differences of what it is the derivative of, between neighbouring corners."""
    step = 1e-5 * (probes[-1] - probes[0])
    for low, high, names in ((0, 1, ("f", "df")), (1, 2, ("df", "ddf"))):
        scale = size * (1 if low == 0 else 1 / (probes[-1] - probes[0]))
        for u in probes[1:-1:4]:
            difference = (functions[low](u + step) - functions[low](u - step)) / (2 * step)
            off = float(np.abs(difference - functions[high](u)).max())
            if off > 1e3 * GIVEN * max(scale, float(np.abs(difference).max())):
                raise InputError(
                    f"{names[1]}: expected the derivative of {names[0]}, which at {u:.6g} is about {difference}, "
                    f"found {functions[high](u)}"
                )


def _basis() -> Tuple[np.ndarray, np.ndarray]:
    """Chebyshev's places in [0, 1], and the matrix from values there to Bernstein coefficients."""
    places = 0.5 - 0.5 * np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
    return places, np.linalg.inv(_bernstein(DEGREE, places))


def _bernstein(degree: int, places: np.ndarray) -> np.ndarray:
    from math import comb

    return np.stack([comb(degree, k) * places**k * (1 - places) ** (degree - k) for k in range(degree + 1)], axis=1)


_PLACES, _TO_BERNSTEIN = _basis()
_CHECKS = np.array([0.003, 0.21, 0.5, 0.83, 0.997])  # not the ends, which may be corners


def _add_pieces(functions: Any, lo: float, hi: float, size: float, least: float, result: List[np.ndarray]) -> None:
    stack = [(lo, hi)]
    while stack:
        a, b = stack.pop()
        width = b - a
        slopes = _TO_BERNSTEIN @ np.array([functions[1](a + width * x) for x in _PLACES])
        if _is_met(functions, slopes, a, width, size):
            # The integral of Bernstein polynomials: sums of their coefficients.
            steps = width * slopes / (DEGREE + 1)
            result.append(functions[0](a) + np.vstack([np.zeros(2), np.cumsum(steps, axis=0)]))
        elif width < least:
            raise InputError(
                f"f: is not smooth near {a:.9g}; give the corners as inner values of `domain`: (first, corner, last)"
            )
        else:
            middle = a + 0.5 * width
            stack += [(middle, b), (a, middle)]


def _is_met(functions: Any, slopes: np.ndarray, a: float, width: float, size: float) -> bool:
    values = _bernstein(DEGREE, _CHECKS) @ slopes
    rates = _bernstein(DEGREE - 1, _CHECKS) @ (DEGREE * np.diff(slopes, axis=0) / width)
    for x, value, rate in zip(_CHECKS, values, rates):
        u = a + width * x
        second = functions[2](u)
        if np.abs(value - functions[1](u)).max() > FIRST * size:
            return False
        if np.abs(rate - second).max() > SECOND * max(size / width, float(np.abs(second).max())):
            return False
    return True


def _join(pieces: List[np.ndarray], start: np.ndarray) -> None:
    """Each piece starts, to the bit, where the one before ends."""
    for before, after in zip(pieces, pieces[1:]):
        after[0] = before[-1]
