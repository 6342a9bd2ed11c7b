"""Options are stated once: what a method shows, takes and refuses agrees."""

import inspect

import numpy as np
import pytest

import rollfix
from rollfix import Disk, InputError, Noise
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


@pytest.mark.parametrize("option, value", [("facing", 1.0), ("prior", (1, 0.1)), ("roll", 1), ("degrees", True)])
def test_touches_refuse_what_only_rolls_have(ellipse, option, value):
    with pytest.raises(InputError, match=f"{option}: touches do not roll and have no use for it"):
        ellipse.locate(touches=TOUCHES, noise={"position": 0.1}, **{option: value})


@pytest.mark.parametrize("option, value", [("clear", [(0, 0, 1, 1)]), ("squeezed", 0.1), ("direction", "cw"), ("facing", 0.0)])
def test_rolls_at_rest_ignore_nothing(ellipse, option, value):
    with pytest.raises(InputError, match=f"^{option}: "):
        ellipse.locate(log=ONE_LOG, roll="all", finger=Disk(0.1), **{option: value})


def test_rounding_is_of_readings_alone(ellipse):
    for contacts in ({"touches": TOUCHES}, {"log": ONE_LOG, "finger": Disk(0.1)}, {"log": [ONE_LOG] * 3, "finger": Disk(0.1)}):
        with pytest.raises(InputError, match="^rounding: is of readings"):
            ellipse.locate(**contacts, rounding=(0.1, 0.1))


def test_three_fingers_refuse_what_they_do_not_take(ellipse):
    for option, value in {"clear": [(0, 0, 1, 1)], "facing": 1.0, "direction": "cw"}.items():
        with pytest.raises(InputError, match=f"^{option}: .*leave it out"):
            ellipse.locate(log=[ONE_LOG] * 3, finger=Disk(0.1), **{option: value})


def test_a_log_that_is_read_already_may_count_clockwise(ellipse):
    log = rollfix.read_log({"length": [0.0, 0.4, 1.0], "turn": [0.0, -0.3, -0.6]})
    found = ellipse.locate(log=log, direction="cw", tolerance=1e-9)
    assert len(found) == 4 and np.array_equal(found.starts, ellipse.locate(-1.0, -0.6, tolerance=1e-9).starts)


@pytest.mark.parametrize("options", [{"prior": (1, 0.1)}, {"robust": True}, {"noise": {"slip": 0.1}}])
def test_what_no_roll_can_be_asked_with_is_refused_before_any_log_is_read(ellipse, options):
    with pytest.raises(InputError, match="noise"):
        ellipse.locate_logs(["there is no such file.csv"], **options)


def test_noise_is_what_the_document_says(ellipse):
    answer = ellipse.locate(1.0, 0.6, noise={"contact": 0.1, "angle": 0.1})
    assert set(Noise.NAMES) == set(answer.to_dict()["noise"]) - {"part"}


def test_an_option_at_its_default_says_nothing(ellipse):
    said = ellipse.locate(touches=TOUCHES, noise={"position": 0.1}, robust=False, direction="ccw", prior=None)
    assert said == ellipse.locate(touches=TOUCHES, noise={"position": 0.1})
    assert np.isfinite(said.poses).all()
