"""No text of a figure leaves the page or meets another, whatever the part, the finger, the noise and the unit."""

import re
import warnings

import numpy as np
import pytest

import rollfix
from rollfix import Disk, Noise, Part

matplotlib = pytest.importorskip("matplotlib")
from matplotlib import font_manager, ft2font  # noqa: E402

PIXEL = 1.0  # letters are rounded to it
SHAPES = ["cam", "ellipse", "limacon", "gear", "stadium", "spline,n=9,seed=7,wobble=0.2", "naca", "superellipse", "circle"]
FONTS = {
    (bold, italic): ft2font.FT2Font(
        font_manager.findfont(
            font_manager.FontProperties(family="DejaVu Sans", weight=["normal", "bold"][bold], style=["normal", "oblique"][italic])
        )
    )
    for bold in (False, True)
    for italic in (False, True)
}


def width_of(text, size, bold=False, italic=False):
    font = FONTS[bold, italic]
    font.set_size(1000, 72)
    font.set_text(text, 0, flags=ft2font.LOAD_NO_HINTING)
    return font.get_width_height()[0] / 64 * size / 1000


def attribute(tag, name, default=None):
    found = re.search(rf'(?<![\w-]){name}="([^"]*)"', tag)
    return default if found is None else found[1]


def plain(text):
    return text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", '"').replace("&amp;", "&")


def boxes_in(svg):
    """Left, top, right, bottom of each text, and the text."""
    for tag, content in re.findall(r"<text([^>]*)>(.*?)</text>", svg):
        if "aria-hidden" in tag:
            continue
        x, y, size = (float(attribute(tag, name)) for name in ("x", "y", "font-size"))
        width, words = 0.0, ""
        for span, inner in re.findall(r"<tspan([^>]*)>(.*?)</tspan>", content) or [("", content)]:
            own = float(attribute(span, "font-size", size))
            bold, italic = attribute(span, "font-weight") == "bold", attribute(span, "font-style") == "italic"
            width += width_of(plain(inner), own, bold, italic)
            words += plain(inner)
        before = {"start": 0.0, "middle": 0.5, "end": 1.0}[attribute(tag, "text-anchor", "start")] * width
        above, below = 0.73 * size, 0.1 * size
        if "rotate(-90" in tag:
            yield x - above, y - width + before, x + below, y + before, words
        else:
            yield x - before, y - above, x - before + width, y + below, words


def collisions(svg):
    wide, high = (float(attribute(re.search(r"<svg[^>]*>", svg)[0], name)) for name in ("width", "height"))
    boxes = [box for box in boxes_in(svg) if box[4].strip()]
    assert boxes
    for left, top, right, bottom, words in boxes:
        if left < -PIXEL or top < -PIXEL or right > wide + PIXEL or bottom > high + PIXEL:
            yield f"{words!r} leaves the page"
    for k, one in enumerate(boxes):
        for two in boxes[:k]:
            across = min(one[2], two[2]) - max(one[0], two[0])
            down = min(one[3], two[3]) - max(one[1], two[1])
            if across > PIXEL and down > PIXEL:
                yield f"{one[4]!r} meets {two[4]!r}"


def random_figure(seed):
    """Of one finger or two, with noise or without, of a log or of readings, with a unit or without."""
    dice = np.random.default_rng(seed)
    shape = SHAPES[seed % len(SHAPES)]
    scale = float(10 ** dice.uniform(-2, 3)) if seed % 3 == 0 else 1.0
    part = Part.gallery(shape)
    if scale != 1 or seed % 2:
        samples = part.samples()
        xy = scale * np.stack([samples["x"], samples["y"]], axis=1)
        keep = np.r_[True, np.hypot(*np.diff(xy, axis=0).T) > 1e-6 * part.perimeter * scale]
        part = Part.from_points(xy[keep][:-1], unit=["", "mm", "in"][seed % 3], allow_crossing=True, name=f"{shape} of a long name")
    P = part.perimeter
    finger = Disk(float(P * dice.uniform(0.02, 0.12)))
    noise = Noise(contact=1e-3 * P, angle=0.01, slip=0.002) if seed % 4 else None
    if seed % 7 == 3:
        starts = dice.uniform(0, P, 2)
        lengths = P * dice.uniform(0.1, 0.3, 2) * dice.choice([-1, 1], 2)
        roll = part.simulate(finger, start=starts, length=lengths, samples=25, noise=noise, seed=seed)
        return part.locate(log=roll, finger=finger, noise=noise, may_overlap=True)
    length = float(P * dice.uniform(0.1, 0.4))
    roll = part.simulate(finger, start=float(dice.uniform(0, P)), length=length, samples=40, noise=noise, seed=seed)
    return part.locate(log=roll, finger=finger, noise=noise)


@pytest.mark.parametrize("block", range(20))
def test_no_text_of_200_random_figures_leaves_the_page_or_meets_another(block):
    found, figures = [], 0
    for seed in range(10 * block, 10 * block + 10):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                answer = random_figure(seed)
        except rollfix.InputError:  # such a finger does not roll there
            continue
        figures += 1
        found += [f"figure {seed}: {each}" for each in collisions(answer.to_svg())]
    assert figures >= 5 and not found, "\n".join(found)


def test_a_finger_is_drawn_whole(recwarn):
    part = Part.gallery("cam")
    finger, noise = Disk(0.5), Noise(contact=0.01, angle=0.01)
    roll = part.simulate(finger, start=1.0, length=2.0, samples=60, noise=noise)
    svg = part.locate(log=roll, finger=finger, noise=noise).to_svg()
    clip = re.search(r'<svg x="([\d.-]+)" y="([\d.-]+)" width="([\d.]+)" height="([\d.]+)"', svg)
    x, y, w, h = (float(one) for one in clip.groups())
    disks = [
        tuple(float(attribute(tag, name)) for name in ("cx", "cy", "r"))
        for group in re.findall(r'<g class="finger">(.*?)</g>', svg, re.DOTALL)
        for tag in re.findall(r"<circle[^>]*>", group)
    ]
    assert len(disks) >= 2
    for cx, cy, r in disks:
        assert x <= cx - r and cx + r <= x + w and y <= cy - r and cy + r <= y + h


def test_twelve_equal_teeth_have_twelve_equal_peaks():
    part = Part.gallery("gear")
    answer = part.locate([0.3, 0.2], noise=Noise(contact=0.01, angle=0.02))
    svg = answer.to_svg()
    panel = svg[svg.index('<g class="density-over-s">'):]
    path = re.search(r'<g class="density">\s*<path d="([^"]*)"', panel)[1]
    points = np.array([[float(one) for one in pair.split()] for pair in re.findall(r"[-\d.]+[ ,][-\d.]+", path.replace(",", " "))])
    teeth = np.array_split(points, 1)[0]
    left, right = points[:, 0].min(), points[:, 0].max()
    tooth = np.clip(((teeth[:, 0] - left) / (right - left) * 12).astype(int), 0, 11)
    heights = [teeth[tooth == k, 1].min() for k in range(12)]
    assert np.ptp(heights) < 2.5  # pixels, of some 70


def hills_of(height):
    """How often it rises by a tenth of its peak and falls again."""
    hills, level, rising = 0, 0.0, True
    for one in np.r_[height / height.max(), 0.0]:
        level = max(level, one) if rising else min(level, one)
        if abs(one - level) > 0.1:
            hills, level, rising = hills + rising, one, not rising
    return hills


def densest(answer, k, s):
    """All pieces together: those of different pairs may lie over one another."""
    pieces, probability = answer.density(finger=k)
    P, height = answer.part.perimeter, np.zeros_like(s)
    for (lo, hi), each in zip(pieces, probability):
        height += np.where((s - lo) % P < hi - lo, each / (hi - lo), 0)
    return height


@pytest.mark.parametrize("starts", [(1.0, 4.0), (0.4, 3.1), (1.5, 5.0)])
def test_the_density_of_two_fingers_has_no_ripples(starts):
    part, finger, noise = Part.gallery("cam"), Disk(0.2), Noise(contact=0.01, angle=0.01)
    roll = part.simulate(finger, start=starts, length=[1.5, -0.8], samples=240, noise=noise)
    answer = part.locate(log=roll, finger=finger, noise=noise, may_overlap=True)
    for k in (0, 1):
        s = answer.best.mean[k] + answer.best.sd[k] * np.linspace(-2, 2, 400)
        assert hills_of(densest(answer, k, s)) == 1
