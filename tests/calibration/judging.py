"""Whether an answer is true, and whether a cell's answers are as often as they say."""

import math
import re
from dataclasses import dataclass, field

import numpy as np

SURE = 0.95
TWO_SIGMA, FOUR_SIGMA = 0.023, 3.2e-5
FAR = 5.0  # standard deviations from a place's mean: nearer counts as listed
Z95 = 1.959964
FLAT = 1.8  # half of an interval with 95 %, in standard deviations: 1.65 of a flat density, 1.96 of a normal one
ALIKE = 0.2  # logarithms of densities that differ by less are alike


@dataclass
class Count:
    """What is counted of a cell's logs."""

    logs: int = 0
    inside: int = 0
    own: int = 0
    listed: int = 0
    first: int = 0
    claimed: float = 0.0
    sure_wrong: int = 0
    doubt: float = 0.0  # what was claimed with SURE and more: how often that says it is wrong
    misfit: int = 0
    errors: int = 0
    sd: list = field(default_factory=list)
    seconds: float = 0.0
    wrong: list = field(default_factory=list)
    message: str = ""

    def add(self, other):
        for name, value in vars(other).items():
            setattr(self, name, getattr(self, name) + value if name != "message" else self.message or value)


def nearest(x, target, period):
    return x + period * np.round((target - x) / period)


def judge(answer, truth, outline, count):
    """Counts one log's answer against the true starts, one for each finger."""
    count.logs += 1
    if "error" in answer and "placements" not in answer:
        count.errors += 1
        count.message = count.message or answer["error"]
        return
    verdict = answer["verdict"]
    misfit = bool(re.search("fits? badly|inconsistent", verdict) or answer.get("diagnosis"))
    count.misfit += misfit
    found = [p for p in answer["placements"] if p.get("probability")]
    known = [p for p in found if not any(v is None for v in (*p["mean"], *p["sd"], *sum(p["interval"], [])))]
    if len(known) < len(found):
        count.errors += 1
        count.message = count.message or f"{answer['id']}: a place whose mean, sd or interval is not a number"
    found = known
    if not found:
        return
    found.sort(key=lambda p: -p["probability"])
    period, slack = outline.perimeter, 1e-7 * outline.perimeter
    p = np.array([f["probability"] for f in found])
    mean = np.array([f["mean"] for f in found])
    sd = np.array([f["sd"] for f in found])
    interval = np.array([f["interval"] for f in found])  # places x fingers x 2
    middle = interval.mean(axis=2)
    mean = nearest(mean, middle, period)  # a mean just before the seam may be of an interval just behind it
    # On a part that looks the same m times one place stands for m, both fingers' together.
    share = period / outline.symmetry
    turns = [share * k for k in range(outline.symmetry)]
    standing = np.array([[nearest(t + turn, middle, period)[:, k] for k, t in enumerate(truth)] for turn in turns])
    standing = np.moveaxis(standing, 1, 2)  # turns x places x fingers: the truth beside each place
    outside = np.maximum(0, np.maximum(interval[:, :, 0] - standing, standing - interval[:, :, 1]))
    wide = np.maximum(sd, 1e-9 * period)
    far = (np.abs(standing - mean) / wide).max(axis=2)
    within = outside.max(axis=2) <= slack  # turns x places
    near = within | (far <= FAR)
    # Which of them it is: the one that is densest there.
    density = np.log(p) - np.log(wide).sum(axis=1) - np.where(within, np.minimum(far, 2), far) ** 2 / 2
    mine = np.where(near, density, -np.inf).argmax(axis=1)

    count.listed += bool(near[0].any())
    if len(truth) == 1:
        count.own += bool(within[0].any())
        count.inside += bool(within[0].any() and outline.is_corner(truth[0])) or in_smallest(
            p, interval[:, 0], sd[:, 0], standing[0, :, 0], within[0], slack)
    elif near[0].any():
        sides = outside[0, mine[0]] <= slack
        count.inside += bool(sides[0])
        count.own += bool(sides[1])
    # The first place with those that look like it, and whether the truth is one of them.
    is_first = any(near[k][0] and mine[k] == 0 for k in range(len(turns)))
    alike = np.zeros(len(p), dtype=bool)
    for turn in turns:
        apart = np.abs(nearest(mean[0] + turn, mean, period) - mean)
        alike |= (apart <= 0.5 * (sd + sd[0]) + 10 * slack).all(axis=1)
    alike[0] = True
    claim = min(1.0, float(p[alike].sum()))
    count.first += is_first
    count.claimed += claim
    if claim >= SURE:
        count.doubt += 1 - claim
    if (claim >= SURE or (verdict.startswith("unique") and not misfit)) and not is_first:
        count.sure_wrong += 1
        count.wrong.append(f"{answer.get('id')}: true {np.round(truth, 4).tolist()}, said {mean[0].round(4).tolist()} "
                           f"sd {sd[0].round(4).tolist()} p {p[0]:.4f}")
    count.sd.append(float(sd[0].max()) / period)


def in_smallest(p, interval, sd, standing, within, slack):
    """Whether the smallest set with 95 % holds the truth: each place is a normal density with its own interval, or a flat
    one where that is as short beside the standard deviation as only a flat one's is. (A corner, which has no size, is in
    that set wherever a place's interval holds it.)"""
    if len(p) == 1:
        return bool(within[0])
    half = np.maximum((interval[:, 1] - interval[:, 0]) / 2, slack)
    flat = half < FLAT * sd
    reach = np.where(flat, half / 0.95, half / Z95)  # to the end of a flat one, else a standard deviation
    height = p / np.where(flat, 2 * reach, math.sqrt(2 * math.pi) * reach)
    z = np.abs(standing - interval.mean(axis=1)) / reach
    log_density = np.log(height) + np.where(flat, np.where(z <= 1, 0, -np.inf), -z * z / 2)
    if not np.isfinite(log_density).any():
        return False
    mine = np.argmax(log_density)
    above = np.log(height) - log_density[mine]
    held = np.array([math.erf(math.sqrt(max(0, a))) for a in above])
    # Flat ones that are about as high are filled from their middles, all of them at once.
    held = np.where(flat, np.where(np.abs(above) < ALIKE, min(1, z[mine]) if flat[mine] else 0, above > 0), held)
    return bool((p * held).sum() / p.sum() <= 0.95)


def share(hits, n):
    """Per cent with a standard error: of hits + 1/2 among n + 1, so that it is never 0."""
    q = (hits + 0.5) / (n + 1)
    return 100 * hits / n, 100 * math.sqrt(q * (1 - q) / n)


def tail(hits, n, rate):
    """How likely it is that chance alone is as far on this side of the rate: of hits among n, whichever side they are."""
    rate = min(max(rate, 1e-12), 1 - 1e-12)
    counts = range(hits + 1) if hits <= rate * n else range(hits, n + 1)
    log = lambda k: (math.lgamma(n + 1) - math.lgamma(k + 1) - math.lgamma(n - k + 1) + k * math.log(rate)
                     + (n - k) * math.log1p(-rate))
    return sum(math.exp(log(k)) for k in counts)


def verdicts(cell, count):
    """What lies outside of what is promised. `?`: chance alone does that once in 40 times at the limit itself; `!`: not
    once in 30,000, as 4 standard errors."""
    n = count.logs
    marks, clear = [], []

    def hold(name, hits, least=0.0, most=1.0):
        if least * n <= hits <= most * n:
            return
        chance = tail(hits, n, least if hits < least * n else most)
        marks.append(name + ("!" if chance < FOUR_SIGMA else "?" if chance > TWO_SIGMA else ""))
        if chance < FOUR_SIGMA:
            clear.append(name)

    claim = count.claimed / n
    hold("in95", count.inside, 0.93, 1.0 if cell.overstated() else 0.97)
    hold("claim", count.first, claim - 0.03, 1.0 if cell.overstated() else claim + 0.03)
    hold("listed", count.listed, 0.995)
    if count.sure_wrong:
        # What is claimed with 0.95 to 1 may be wrong as often as that says.
        chance = tail(count.sure_wrong, n, count.doubt / n + 1e-3)
        marks.append("sure" + ("!" if chance < FOUR_SIGMA else "?" if chance > TWO_SIGMA else ""))
        clear += ["sure"] if chance < FOUR_SIGMA else []
    hold("misfit", count.misfit, 0, 0.005)
    if count.errors:
        marks.append("no answer!")
        clear.append("no answer")
    return marks, clear
