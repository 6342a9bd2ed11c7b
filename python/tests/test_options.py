"""Options are stated once: what a method shows, takes and refuses agrees."""

import inspect

import numpy as np
import pytest

import rollfix
from rollfix import Disk, InputError
from rollfix._options import DEFAULTS, LogOptions, RollOptions, names_of

METHODS = [
    rollfix.Part.locate, rollfix.Part.advise, rollfix.Part.locate_many, rollfix.Part.locate_logs, rollfix.Part.watch,
    rollfix.Catalog.identify, rollfix.Watch.__init__,
]  # fmt: skip
TOUCHES = [(1.0, 2.0), (2.0, 3.0)]
ONE_LOG = {"u": [0.0, 0.1, 0.2], "psi": [0.0, 0.3, 0.6]}


@pytest.mark.parametrize("method", METHODS)
def test_a_method_shows_every_option_with_its_default(method):
    shown = inspect.signature(method).parameters
    assert "finger" in shown and "mirrored" in shown
    assert not any(one.kind is one.VAR_KEYWORD for one in shown.values())
    assert all(shown[name].default == DEFAULTS[name] for name in DEFAULTS if name in shown and name not in ("noise", "facing"))


def test_options_of_a_roll_hold_those_of_logs():
    assert set(names_of(LogOptions)) < set(names_of(RollOptions)) < set(DEFAULTS)


@pytest.mark.parametrize("ask", ["locate", "advise"])
def test_an_unknown_option_is_a_type_error_that_names_it(ellipse, ask):
    with pytest.raises(TypeError, match=rf"{ask}\(\) got an unexpected keyword argument 'fingers'"):
        getattr(ellipse, ask)(1.0, 0.5, fingers=Disk(0.1))


@pytest.mark.parametrize("option, value", [("facing", 1.0), ("prior", (1, 0.1)), ("robust", True), ("roll", 1), ("degrees", True)])
def test_touches_refuse_what_only_rolls_have(ellipse, option, value):
    with pytest.raises(InputError, match=f"{option}: touches do not roll and have no use for it"):
        ellipse.locate(touches=TOUCHES, noise={"position": 0.1}, **{option: value})


@pytest.mark.parametrize("option, value", [("clear", [(0, 0, 1, 1)]), ("squeezed", 0.1), ("direction", "cw"), ("facing", 0.0)])
def test_rolls_at_rest_ignore_nothing(ellipse, option, value):
    with pytest.raises(InputError, match=f"{option}: is"):
        ellipse.locate(log=ONE_LOG, roll="all", finger=Disk(0.1), **{option: value})


def test_three_fingers_refuse_what_they_do_not_take(ellipse):
    for option, value in {"clear": [(0, 0, 1, 1)], "rounding": (0.1, 0.1)}.items():
        with pytest.raises(InputError, match=f"{option}: is not taken with three and more fingers"):
            ellipse.locate(log=[ONE_LOG] * 3, finger=Disk(0.1), **{option: value})


def test_an_option_at_its_default_says_nothing(ellipse):
    said = ellipse.locate(touches=TOUCHES, noise={"position": 0.1}, robust=False, direction="ccw", prior=None)
    assert said == ellipse.locate(touches=TOUCHES, noise={"position": 0.1})
    assert np.isfinite(said.poses).all()
