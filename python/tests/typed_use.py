"""Code as users write it, for mypy --strict: what the types promise."""

from typing import List, Optional, Union

import numpy as np

import rollfix


def whole_session(path: str) -> None:
    part: rollfix.Part = rollfix.Part(path, unit="mm")
    answer: rollfix.Answer = part.locate(1.0, 0.5)
    first: rollfix.Placement = answer[0]
    some: int = len(answer[1:])
    start: float = float(first.start[0])
    probability: Optional[float] = first.probability
    verdict: str = answer.verdict
    noise = rollfix.Noise(contact=0.05, angle=0.01)
    weighed = part.locate(log="roll.csv", finger=rollfix.Disk(10), noise=noise, degrees=True, columns={"u": ("joint_4", "deg")})
    density: np.ndarray = weighed.density(np.linspace(0, 1, 5))
    many: rollfix.ManyAnswers = part.locate_many(np.ones((5, 2)), threads=2)
    rows: np.ndarray = many.start[many.rows(0)]
    logs: rollfix.LogAnswers = part.locate_logs(["a.csv"], finger=rollfix.Jaw())
    for event in part.watch(noise=noise).follow(["1,2"]):
        name: str = event["event"]
    some_answers: List[Union[rollfix.Answer, rollfix.InputError]] = [*many[:2], *many]
    reach: rollfix.Reach = part.reach(rollfix.Disk(1.0))
    catalog: rollfix.Catalog = rollfix.Catalog.build("parts.db", ["gallery:cam", ("wing.csv", 3)], unit="mm")
    found: rollfix.Identified = catalog.identify(log="roll.csv", finger=rollfix.Disk(10), noise=noise, threads=2)
    several: rollfix.ManyIdentified = catalog.identify_many([[1.0, 0.5]], client=None)
    likeliest: rollfix.PartFound = found[0]
    its_answer: rollfix.Answer = likeliest.answer
    print(several.answers, its_answer, likeliest.congruent_with, [entry.count for entry in catalog.entries])
    print(some_answers, some, start, probability, verdict, density, rows, logs, name, reach.share, part.advise(1.0, 0.5).length)


def mistakes(part: rollfix.Part) -> None:
    part.locate(1.0, 0.5, finger=3)  # type: ignore[call-overload]
    part.locate(1.0, 0.5, fingers=None)  # type: ignore[call-overload]
    part.perimeter = 3.0  # type: ignore[misc]
    part.locate(1.0, 0.5).verdict = "unique"  # type: ignore[misc]
    part.watch(nois=rollfix.Noise(angle=0.1))  # type: ignore[call-arg]
    rollfix.Catalog("parts.db").identify(1.0, 0.5, prior=(1, 2))  # type: ignore[call-arg]
    part.advise(1.0, 0.5, travell=3)  # type: ignore[call-arg]
    part.locate_logs([], nois=None)  # type: ignore[call-arg]
