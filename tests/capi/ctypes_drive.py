#!/usr/bin/env python3
"""Drives a wheel on a course through rollfix.h with nothing but ctypes: it must be found where it is.

Usage: ctypes_drive.py LIBRARY
"""

import ctypes
import math
import sys


class Options(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_size_t)] + [
        (name, ctypes.c_double) for name in "distance turn slip gyro_scale gyro_bias gyro_walk".split()
    ] + [("points", ctypes.c_size_t)]


class Answer(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_size_t),
        ("verdict", ctypes.c_int32),
        ("contradicts", ctypes.c_int32),
        ("rows", ctypes.c_size_t),
        ("places", ctypes.c_size_t),
    ] + [
        (name, ctypes.c_double)
        for name in "rest excess distance_scale distance_scale_sd turn_scale turn_scale_sd gyro_bias gyro_bias_sd".split()
    ]


class Place(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_size_t)] + [
        (name, ctypes.c_double)
        for name in "probability start start_sd start_lo start_hi now now_sd x y heading".split()
    ]


library = ctypes.CDLL(sys.argv[1])
library.rollfix_default_options.restype = Options
library.rollfix_part_length.restype = ctypes.c_double
library.rollfix_part_length.argtypes = [ctypes.c_void_p]
library.rollfix_push.argtypes = [ctypes.c_void_p] + 3 * [ctypes.c_double]


def check(code, message=b""):
    if code != 0:
        sys.exit(f"code {code}: {message.decode()}")


def ellipse(t):
    return 2 * math.cos(t), math.sin(t)


message = ctypes.create_string_buffer(512)
course, locator = ctypes.c_void_p(), ctypes.c_void_p()
xy = [value for k in range(400) for value in ellipse(2 * math.pi * k / 400)]
check(
    library.rollfix_part_from_points(
        (ctypes.c_double * len(xy))(*xy), ctypes.c_size_t(400), None, ctypes.byref(course), message, ctypes.c_size_t(512)
    ),
    message.value,
)
options = library.rollfix_default_options()
assert options.struct_size == ctypes.sizeof(Options), "the library's options are larger: it is a later one"
options.distance, options.turn, options.slip = 0.001, 0.002, 0.001
check(library.rollfix_start(course, ctypes.byref(options), ctypes.byref(locator), message, ctypes.c_size_t(512)), message.value)

# A quarter of the ellipse and a half, by chords: an ellipse looks the same from both ends.
steps, t, angle = 2000, 0.4, None
for k in range(steps):
    (x0, y0), (x1, y1) = ellipse(t), ellipse(t + 1.5 * math.pi / steps)
    ahead = math.atan2(y1 - y0, x1 - x0)
    turn = 0.0 if angle is None else math.remainder(ahead - angle, 2 * math.pi)
    check(library.rollfix_push(locator, float(k), math.hypot(x1 - x0, y1 - y0), turn))
    t, angle = t + 1.5 * math.pi / steps, ahead

answer, places = Answer(struct_size=ctypes.sizeof(Answer)), []
check(library.rollfix_locate(locator, ctypes.byref(answer)))
for k in range(answer.places):
    places.append(Place(struct_size=ctypes.sizeof(Place)))
    check(library.rollfix_place_at(locator, ctypes.c_size_t(k), ctypes.byref(places[-1])))
library.rollfix_stop(locator)
library.rollfix_part_free(course)

print(f"{answer.rows} rows, {answer.places} places: " + ", ".join(f"({p.x:.3f}, {p.y:.3f})" for p in places))
x, y = ellipse(t)
assert answer.places == 2 and all(abs(p.probability - 0.5) < 1e-6 for p in places), "expected two places, alike"
assert any(math.hypot(p.x - x, p.y - y) < 0.02 for p in places), f"expected one of them at ({x:.3f}, {y:.3f})"
