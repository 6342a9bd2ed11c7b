#!/usr/bin/env python3
"""Writes the small DXF files in fuzz/corpus/dxf: every entity, ASCII and both kinds of binary.

Usage: write_dxf.py [FOLDER]
"""
import struct
import sys
from pathlib import Path

INT16 = [(60, 79), (170, 179), (270, 289), (370, 389), (400, 409), (1060, 1070)]
INT32 = [(90, 99), (420, 429), (440, 459), (1071, 1071)]
REAL = [(10, 59), (110, 149), (210, 239), (460, 469), (1010, 1059)]


def within(code, ranges):
    return any(first <= code <= last for first, last in ranges)


def ascii_file(groups):
    return "".join(f"{code:3}\n{value}\n" for code, value in groups).encode()


def binary_file(groups, short_codes):
    data = b"AutoCAD Binary DXF\r\n\x1a\x00"
    for code, value in groups:
        if short_codes:
            data += bytes([code]) if code < 255 else b"\xff" + struct.pack("<H", code)
        else:
            data += struct.pack("<H", code)
        if within(code, INT16):
            data += struct.pack("<h", int(value))
        elif within(code, INT32):
            data += struct.pack("<i", int(value))
        elif within(code, REAL):
            data += struct.pack("<d", float(value))
        else:
            data += str(value).encode() + b"\x00"
    return data


def section(name, groups):
    return [(0, "SECTION"), (2, name)] + groups + [(0, "ENDSEC")]


def entity(name, *groups, layer="0"):
    return [(0, name), (8, layer)] + list(groups)


def block(name, groups):
    return [(0, "BLOCK"), (8, "0"), (2, name), (70, 0), (10, 0.5), (20, 0.25)] + groups + [(0, "ENDBLK")]


def drawing(entities, blocks=(), header=()):
    groups = section("HEADER", list(header)) if header else []
    layers = [(0, "TABLE"), (2, "LAYER"), (0, "LAYER"), (2, "Cut"), (70, 0), (62, 7),
              (0, "LAYER"), (2, "Off"), (70, 0), (62, -7), (0, "ENDTAB")]
    groups += section("TABLES", layers)
    if blocks:
        groups += section("BLOCKS", list(blocks))
    return groups + section("ENTITIES", entities) + [(0, "EOF")]


def polyline(corners, flags):
    groups = entity("POLYLINE", (66, 1), (70, flags), (30, 0))
    for x, y, bulge in corners:
        groups += entity("VERTEX", (10, x), (20, y), (42, bulge))
    return groups + entity("SEQEND")


def files():
    corners = [(0, 0, 0), (3, 0, 0.5), (3, 2, 0), (0, 2, -0.25)]
    line = entity("LINE", (10, 0), (20, 0), (11, 1.5), (21, 2e-3), layer="Cut")
    arc = entity("ARC", (10, 1), (20, 2), (40, 0.5), (50, 350), (51, 80), (210, 0), (220, 0), (230, -1))
    circle = entity("CIRCLE", (10, 1), (20, 2), (40, 0.5))
    ellipse = entity("ELLIPSE", (10, 1), (20, 2), (11, 2), (21, 1), (40, 0.5), (41, 0), (42, 5))
    light = entity("LWPOLYLINE", (90, 4), (70, 1), (43, 0))
    for x, y, bulge in corners:
        light += [(10, x), (20, y), (42, bulge)]
    knots = [(40, k) for k in (0, 0, 0, 0.5, 1, 1, 1)]
    points = [g for p in ((0, 0), (1, 2), (2, 2), (3, 0)) for g in ((10, p[0]), (20, p[1]))]
    weights = [(41, w) for w in (1, 0.5, 2, 1)]
    spline = entity("SPLINE", (70, 12), (71, 2), (72, 7), (73, 4), *knots, *weights, *points)
    fits = entity("SPLINE", (70, 9), (71, 3), (74, 3), (11, 0), (21, 0), (11, 1), (21, 1), (11, 2), (21, -1))
    insert = entity("INSERT", (2, "B"), (10, 5), (20, 6), (41, -2), (42, 3), (50, 30), (70, 2), (71, 3), (44, 9), (45, 8))
    nested = block("A", line + circle) + block("B", arc + entity("INSERT", (2, "A"), (10, 1), (20, 0), (50, 90)))
    inches = [(9, "$ACADVER"), (1, "AC1015"), (9, "$INSUNITS"), (70, 1)]
    unknown = entity("TEXT", (10, 0), (20, 0), (40, 1), (1, "hi")) + line
    extended = line + [(1001, "ACAD"), (1070, 5), (1040, 1.5), (1000, "note")]
    return {
        "line": drawing(line), "arc": drawing(arc), "circle": drawing(circle, header=inches), "ellipse": drawing(ellipse),
        "light": drawing(light), "polyline": drawing(polyline(corners, 1)), "spline": drawing(spline),
        "fits": drawing(fits), "insert": drawing(insert + unknown, nested, inches), "extended": drawing(extended),
    }


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "dxf"
    folder.mkdir(parents=True, exist_ok=True)
    for name, groups in files().items():
        (folder / f"{name}.dxf").write_bytes(ascii_file(groups))
        if name in ("light", "spline", "insert", "extended"):
            (folder / f"{name}_r12_binary.dxf").write_bytes(binary_file(groups, True))
            (folder / f"{name}_binary.dxf").write_bytes(binary_file(groups, False))


if __name__ == "__main__":
    main()
