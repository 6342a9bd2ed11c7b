"""Parts: from files, points, functions and the gallery; their numbers as arrays of any shape."""

import numpy as np
import pytest

import rollfix
from rollfix import InputError, Part


def ellipse_curve(**options):
    return Part.from_curve(lambda u: (2 * np.cos(u), np.sin(u)), lambda u: (-2 * np.sin(u), np.cos(u)),
                           lambda u: (-2 * np.cos(u), -np.sin(u)), (0, 2 * np.pi), **options)


def test_a_curve_of_functions_is_the_gallery_s(ellipse):
    curve = ellipse_curve()
    s = np.linspace(0, ellipse.perimeter, 2000)
    assert curve.perimeter == pytest.approx(ellipse.perimeter, rel=1e-12)
    np.testing.assert_allclose(curve.point(s), ellipse.point(s), atol=1e-11)
    np.testing.assert_allclose(curve.turning(s), ellipse.turning(s), atol=1e-11)
    np.testing.assert_allclose(curve.curvature(s), ellipse.curvature(s), atol=1e-9)
    assert len(curve.vertices) == 4 and len(curve.inflections) == 0


def test_an_open_curve_keeps_its_ends():
    parabola = Part.from_curve(lambda u: (u, u * u), lambda u: (1, 2 * u), lambda u: (0, 2), (-1, 1), closed=False)
    assert not parabola.closed
    np.testing.assert_allclose(parabola.point([0, parabola.perimeter]), [[-1, 1], [1, 1]], atol=1e-14)
    assert parabola.curvature(parabola.perimeter / 2) == pytest.approx(2, abs=1e-9)


def square(u):
    k = min(int(u), 3)
    return [(u - k, 0), (1, u - k), (1 - u + k, 1), (0, 1 - u + k)][k]


def square_slope(u):
    return [(1, 0), (0, 1), (-1, 0), (0, -1)][min(int(u), 3)]


def test_inner_values_of_the_domain_are_corners():
    part = Part.from_curve(square, square_slope, lambda u: (0, 0), (0, 1, 2, 3, 4))
    assert part.perimeter == pytest.approx(4, rel=1e-12)
    np.testing.assert_allclose(part.corners, [[k, np.pi / 2] for k in range(4)], atol=1e-9)


def test_a_corner_that_is_not_told_is_found():
    with pytest.raises(InputError, match="^(f: is not smooth near|df: .* at) 0.31"):
        Part.from_curve(lambda u: (u, abs(u - 0.3137)), lambda u: (1, np.sign(u - 0.3137)), lambda u: (0, 0), (-1, 1), closed=False)


@pytest.mark.parametrize("change, name", [
    (dict(df=lambda u: (2 * np.sin(u), np.cos(u))), "df"),
    (dict(df=lambda u: (-2.02 * np.sin(u), np.cos(u))), "df: expected the derivative of f"),
    (dict(ddf=lambda u: (np.cos(u), np.sin(u))), "ddf"),
    (dict(f=lambda u: (np.cos(u),)), "f"),
    (dict(f=3), "f"),
    (dict(domain=(1, 0)), "domain"),
    (dict(domain=(0, 3)), "f"),
    (dict(df=lambda u: (np.nan, 0)), "df"),
])
def test_what_is_wrong_with_a_curve_names_the_argument(change, name):
    given = dict(f=lambda u: (2 * np.cos(u), np.sin(u)), df=lambda u: (-2 * np.sin(u), np.cos(u)),
                 ddf=lambda u: (-2 * np.cos(u), -np.sin(u)), domain=(0, 2 * np.pi))
    with pytest.raises(InputError, match=f"^{name}"):
        Part.from_curve(**{**given, **change})


def test_points_are_those_of_a_file(wing):
    xy = np.loadtxt(wing.name, delimiter=",", comments="#", skiprows=2)
    part = Part.from_points(xy[:, :2])
    assert part.perimeter == wing.perimeter
    assert part.turning(np.arange(400.0)).tobytes() == wing.turning(np.arange(400.0)).tobytes()


@pytest.mark.parametrize("xy", [[], [1, 2, 3], [[1, 2]], [[0, 0], [1, 0], [np.nan, 1]], [[0, 0], [1, 0], ["a", 1]],
                                [[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0], [1, 1], [2, 2]], [[0, 0], [1, 0], [1]],
                                [[0, 0], [1j, 0], [1, 1]]])
def test_bad_points_are_refused(xy):
    with pytest.raises(InputError):
        Part.from_points(xy)


@pytest.mark.parametrize("shape", [(), (3,), (2, 3), (0,), (2, 0, 3), (1, 1, 1)])
def test_functions_of_s_take_any_shape(part, shape):
    s = np.random.default_rng(1).uniform(0, part.perimeter, shape)
    assert part.point(s).shape == shape + (2,)
    for function in (part.turning, part.curvature, part.tangent):
        assert function(s).shape == shape


def test_functions_of_s_agree_with_differences(ellipse):
    s, step = np.linspace(0.01, 9, 100), 1e-6
    slope = (ellipse.point(s + step) - ellipse.point(s - step)) / (2 * step)
    np.testing.assert_allclose(np.arctan2(slope[:, 1], slope[:, 0]), ellipse.tangent(s), atol=1e-8)
    np.testing.assert_allclose((ellipse.turning(s + step) - ellipse.turning(s - step)) / (2 * step), ellipse.curvature(s),
                               atol=1e-7)


@pytest.mark.parametrize("bad", [np.nan, np.inf, [1, np.nan], "x", [1j]])
def test_places_that_are_none_are_refused(ellipse, bad):
    with pytest.raises(InputError, match="^s"):
        ellipse.point(bad)


def test_inspection_is_that_of_the_program(part, program):
    assert part.inspect().to_dict() == program("inspect", part.name, "--json")
    assert part.inspect().part["perimeter"] == part.perimeter


def test_reach_is_that_of_the_program(program):
    gear = Part.gallery("gear")
    expected = program("inspect", "gallery:gear", "--finger", "disk,r=0.1", "--json")
    assert gear.inspect(rollfix.Disk(0.1)).to_dict() == expected
    reach = gear.reach(rollfix.Disk(0.1))
    np.testing.assert_array_equal(reach.arcs, expected["reach"]["arcs"])
    middles = reach.gaps.mean(axis=1)
    assert not reach.contains(middles).any() and reach.contains(reach.arcs.mean(axis=1)).all()


def test_a_clockwise_outline_says_so():
    turn = np.linspace(0, -2 * np.pi, 50, endpoint=False)
    part = Part.from_points(np.stack([np.cos(turn), 2 * np.sin(turn)], axis=1))
    assert part.reversed and "clockwise" in repr(part)


def test_the_gallery_is_listed():
    shapes = rollfix.gallery_shapes()
    assert {"circle", "ellipse", "cam", "naca", "spline"} <= set(shapes)
    assert Part.gallery("gallery:cam") == Part.gallery("cam") == Part("gallery:cam")
    with pytest.raises(InputError, match="ellipse"):
        Part.gallery("elipse")


def test_outer_takes_what_is_around_the_outside(tmp_path):
    file = tmp_path / "part.svg"
    file.write_text('<svg xmlns="http://www.w3.org/2000/svg">'
                    '<path id="a" d="M0 0H6V4"/><path id="b" d="M6 4H0V0"/><path id="leader" d="M0 0L-2 -2"/></svg>')
    with pytest.raises(InputError, match="outer"):
        Part(file)
    assert Part(file, outer=True).perimeter == 20
