"""Nothing is taken for what it was not meant as: one sentence names the argument, what was expected, and the cure."""

import numpy as np
import pytest

import rollfix
from rollfix import Disk, InputError, Noise, Part, Watch

pandas = pytest.importorskip("pandas")
CIRCLE = (lambda u: (np.cos(u), np.sin(u)), lambda u: (-np.sin(u), np.cos(u)), lambda u: (-np.cos(u), -np.sin(u)))
SQUARE = [[0, 0], [4, 0], [4, 3]]
WEIGHED = dict(noise=Noise(contact=0.01, angle=0.01))
LOG = pandas.DataFrame({"u": [0.0, 1.0], "psi": [0.0, 0.1]})


def simulated(part, **options):
    return part.simulate(**{"finger": Disk(0.1), "start": 0, "length": 1, **options})


@pytest.mark.parametrize("call, name", [
    (lambda p: p.locate(1, 1, mirrored="no"), "mirrored"),
    (lambda p: p.locate(1, 1, robust=1, **WEIGHED), "robust"),
    (lambda p: p.locate(log=LOG, degrees="yes"), "degrees"),
    (lambda p: p.locate(log=LOG, degrees=None), "degrees"),
    (lambda p: p.locate_many([[1, 1]], mirrored="no"), "mirrored"),
    (lambda p: p.watch(live="yes", **WEIGHED), "live"),
    (lambda p: p.watch(robust=0, **WEIGHED), "robust"),
    (lambda p: Part.from_points(SQUARE, closed="no"), "closed"),
    (lambda p: Part.from_points(SQUARE, allow_crossing=1), "allow_crossing"),
    (lambda p: Part.from_curve(*CIRCLE, (0, 2 * np.pi), closed=0), "closed"),
    (lambda p: Part("gallery:circle", open="no"), "open"),
    (lambda p: rollfix.teach(LOG, Disk(1), bridge="yes"), "bridge"),
])
def test_switches_are_true_or_false(ellipse, call, name):
    with pytest.raises(InputError, match=f"^{name}: expected True or False, found "):
        call(ellipse)


def test_numpy_s_booleans_are_booleans(ellipse):
    assert ellipse.locate(1.0, 0.625, mirrored=np.bool_(False)) == ellipse.locate(1.0, 0.625)


@pytest.mark.parametrize("call", [
    lambda u: Part("gallery:circle", unit=u), lambda u: Part.from_points(SQUARE, unit=u),
    lambda u: Part.from_curve(*CIRCLE, (0, 2 * np.pi), unit=u), lambda u: rollfix.read_log(LOG, unit=u),
    lambda u: rollfix.teach(LOG, Disk(1), unit=u),
])
def test_units_are_of_length_and_known(call):
    for wrong, message in (("furlong", "expected a unit of length: mm, .*, found 'furlong'"), ("deg", "a unit of length"),
                           (3, "expected a text, found 3")):
        with pytest.raises(InputError, match=f"^unit: .*{message}"):
            call(wrong)


def test_a_unit_has_its_usual_name():
    assert Part.from_points(SQUARE, unit="inches").unit == "in" == Part("gallery:circle", unit="inch").unit


@pytest.mark.parametrize("call, message", [
    (lambda p: p.locate(1, 1, noise=Noise(angle=3)), r"^noise: an angle's standard deviation of 3 rad .*np.radians\(3\)$"),
    (lambda p: p.locate(1, 1, noise=Noise(angle=0.6)), "^noise: .* of 0.6 rad is 34.4 deg, expected at most 0.5 rad"),
    (lambda p: p.locate(1, 1, noise=Noise(slip=0.1)), "^noise: expected a standard deviation of the contact or"),
    (lambda p: p.locate(1, 1, heading=(90, 5), **WEIGHED), r"^heading: .*at most pi radians, found 5.0; .*radians\(5\)$"),
    (lambda p: p.locate(1, 1, pose=(0, 0, 90, 1, 5), **WEIGHED), "^pose: .*at most pi radians"),
    (lambda p: Part.from_points(SQUARE, corner_angle=45), r"^corner_angle: .* from 0 to pi.*np.radians\(45\)$"),
    (lambda p: Part("gallery:circle", corner_angle=45), "^corner_angle"),
    (lambda p: rollfix.teach(LOG, Disk(1), corner_angle=45), "^corner_angle"),
])
def test_degrees_for_radians_are_seen(ellipse, call, message):
    with pytest.raises(InputError, match=message):
        call(ellipse)


@pytest.mark.parametrize("call, message", [
    (lambda p: p.locate(1, 1, rounding=(-1, 0)), "^rounding: expected half units of at least 0"),
    (lambda p: p.locate(1, 1, direction="left"), "^direction: expected 'ccw', 'cw' or 'either', found 'left'"),
    (lambda p: p.locate_many([[1, 1]], direction="either"), "^direction: expected 'ccw' or 'cw', found 'either'; "),
    (lambda p: p.locate(1, 1, prior=(1, 1)), "^prior: .*give `noise` as well"),
    (lambda p: p.locate(1, 1, robust=True), "^robust: .*give `noise` as well"),
    (lambda p: p.locate(1, 1, tolerance="1"), "^tolerance: expected a number, found '1'"),
    (lambda p: p.locate(LOG, finger=Disk(1)), "^readings: .*found a data frame: give a log by name, as log="),
    (lambda p: p.locate("roll.csv"), "^readings: .*log="),
    (lambda p: p.locate({"u": [0, 1], "psi": [0, 1]}), "^readings: .*found a dict: .*log="),
    (lambda p: p.locate((LOG, LOG)), "^readings: .*log="),
    (lambda p: p.locate(log=LOG), r"^log: u says where on the finger .*finger=Disk\(RADIUS\)"),
    (lambda p: p.locate(log=[LOG] * 9, finger=Disk(1)), "^fingers on a free part: expected logs of 2 to 8 fingers, found 9$"),
    (lambda p: p.locate(log=LOG.to_dict("records") * 2, finger=Disk(1)), r"^log: .*pandas.DataFrame\(rows\)"),
    (lambda p: p.locate(log="u,psi\n0,0\n1,1\n", finger=Disk(1)), "^log: expected the path of a file, found 3 lines"),
    (lambda p: rollfix.teach(LOG), "^finger"),
])
def test_questions_that_can_not_be_meant(ellipse, call, message):
    with pytest.raises(InputError, match=message):
        call(ellipse)


@pytest.mark.parametrize("options, message", [
    (dict(length=None), "^length: .*or else `rotation`.*found neither"),
    (dict(rotation=1), "^length: .*found both"),
    (dict(part_rotation=0.3), "^part_rotation: is of two fingers"),
    (dict(finger=None, part_rotation=0.3), "^part_rotation: is of two fingers"),
    (dict(finger=None, contact=1), "^contact: is of a finger"),
    (dict(seed=2**70), "^seed: expected a whole number of at most"),
    (dict(seed=-1), "^seed"),
    (dict(finger=(Disk(0.1), Disk(0.1)), start=(0, 1), length=(1, 1), contact=(1, 2, 3)), "^contact: expected one or two"),
])
def test_rolls_that_can_not_be_simulated(ellipse, options, message):
    with pytest.raises(InputError, match=message):
        simulated(ellipse, **options)


@pytest.mark.parametrize("call, message", [
    (lambda p: Part("gallery:circle", layer=0), "^layer: expected a text"),
    (lambda p: Part("gallery:circle", loop="1"), "^loop"),
    (lambda p: Part.from_points(SQUARE, name=3), "^name: expected a text, found 3"),
    (lambda p: Part.from_curve(*CIRCLE, 6.28), r"^domain: expected \(first, last\), found 6.28"),
    (lambda p: Watch(p, name=3, **WEIGHED), "^name"),
    (lambda p: Watch(p, name="", **WEIGHED), "^name"),
    (lambda p: p.to_svg(title=3), "^title: expected a text"),
    (lambda p: p.to_svg(width=-3), "^width"),
    (lambda p: p.locate(1.0, 0.625).to_svg(title=3), "^title: expected a text"),
    (lambda p: p.locate(1.0, 0.625).to_svg(highlight=-1), "^highlight: expected the number of one of 4 placements"),
    (lambda p: p.locate(1.0, 0.625).to_svg(highlight=4), "^highlight"),
    (lambda p: p.locate(1.0, 0.625).to_svg(width=np.nan), "^width"),
    (lambda p: p.locate(1.0, 0.625).density([1.0]), "^density: needs `noise`"),
    (lambda p: p.locate(1.0, 0.625, **WEIGHED).density(1, finger=1), "^finger: expected 0, as there is one finger"),
    (lambda p: p.reach(Disk(0.1)).contains("a"), "^s: expected an array of numbers"),
    (lambda p: p.reach(Disk(0.1)).contains(np.nan), "^s: expected finite numbers, found nan$"),
    (lambda p: p.locate_logs(LOG), "^logs: expected a list of logs, found a data frame: give .log."),
    (lambda p: p.locate_logs("roll.csv"), "^logs: expected a list of logs, found a str"),
    (lambda p: p.locate_logs({"a": LOG}), "^logs: expected a list of logs, found a dict"),
    (lambda p: p.locate_logs(np.ones((3, 2))), "^logs: expected a list"),
    (lambda p: p.locate_logs(None), "^logs: expected a list of logs, found None"),
])
def test_everything_else_is_a_sentence_too(ellipse, call, message):
    with pytest.raises(InputError, match=message):
        call(ellipse)


@pytest.mark.parametrize("ax", [3, "figure.png", np.array([1, 2])])
def test_plots_need_axes(ellipse, ax):
    with pytest.raises(InputError, match="^ax: expected matplotlib axes, found "):
        ellipse.locate(1.0, 0.625).plot(ax)


@pytest.mark.parametrize("options, name", [
    (dict(noise=0.1), "noise"), (dict(finger=3), "finger"), (dict(prior=5), "prior"), (dict(columns=5), "columns"),
    (dict(units="deg"), "units"), (dict(tolerance=-1), "tolerance"), (dict(heading=(1, 9), **WEIGHED), "heading"),
])
def test_what_all_logs_share_is_refused_at_once(ellipse, options, name):
    with pytest.raises(InputError, match=f"^{name}"):
        ellipse.locate_logs([LOG, LOG], **options)


@pytest.mark.parametrize("call", [
    lambda p: p.locate(1.0, 0.6, nois=3), lambda p: p.advise(1.0, 0.6, travell=3), lambda p: p.watch(nois=3, **WEIGHED),
    lambda p: p.locate_logs([], nois=3), lambda p: p.locate_logs([], facing=3), lambda p: p.locate_many([[1, 1]], prior=3),
])
def test_arguments_that_are_none_are_refused(ellipse, call):
    with pytest.raises(TypeError, match="unexpected keyword argument"):
        call(ellipse)


def test_a_message_is_one_line_whatever_it_shows(tmp_path):
    for call in (lambda: Part(str(tmp_path / "a\nb.csv")), lambda: Part(np.zeros((3, 2))), lambda: Noise(contact="a\nb")):
        with pytest.raises(InputError) as caught:
            call()
        assert str(caught.value) and "\n" not in str(caught.value)


def test_a_log_is_no_part(roll_csv):
    with pytest.raises(InputError, match=r"a log goes to `locate`: part.locate\(log=...\)$"):
        Part(roll_csv)


def test_a_unit_is_stated_where_the_part_is_made(ellipse):
    with pytest.raises(InputError, match="make the part with unit='mm'"):
        ellipse.locate(log={"length": [1.0], "turn": [0.6]}, units={"length": "mm"})
    assert "state it with unit='mm'" in str(pytest.raises(InputError, rollfix.read_log, {"length": [1.0], "turn": [0.6]},
                                                          units={"length": "mm"}).value)
