"""A jaw beside a wheel without skin, and a fingertip with corners, watched while they roll."""

import pytest

from rollfix import Disk, InputError, Jaw, Noise, OutlineFinger, Part, Wheel

pytest.importorskip("pandas")

CAM = Part.gallery("cam")
NOISE = Noise(contact=0.01, angle=0.005, position=0.01)
RIG = CAM.simulate(
    [Jaw(), Disk(0.4)], start=(3.9, 2), pin=(0.25, -0.1), jaw_rotation=0.5, samples=31, wheel="encoder", noise=NOISE, seed=3
).log


def jaw_rows():
    return {"time": RIG["time"], "u": RIG["u_a"], "psi": RIG["psi_a"], "x": RIG["x_a"], "y": RIG["y_a"]}


def pin_rows(*columns):
    return {"time": RIG["time"], **{column: RIG[f"{column}_b"] for column in columns}}


def watched(columns, **options):
    watch = CAM.watch(finger=[Jaw(), Wheel(0.4)], name=("jaw", "pin"), noise=NOISE, every=10, **options)
    watch.add(jaw_rows(), log=0)
    watch.add(pin_rows(*columns), log=1)
    watch.finish()
    return watch


@pytest.mark.parametrize("columns", [("x", "y"), ("psi", "x", "y")])
def test_a_jaw_beside_a_wheel_ends_as_locate(columns):
    watch = watched(columns)
    located = CAM.locate(log=[jaw_rows(), pin_rows(*columns)], finger=[Jaw(), Wheel(0.4)], noise=NOISE)
    assert watch.verdict == located.verdict
    assert watch.placements == [{key: one[key] for key in one} for one in located.placements]


def test_a_fingertip_with_corners_ends_as_locate():
    tip = OutlineFinger(Part.from_points([[0, 0], [0.2, 0], [0.2, 0.4], [-0.2, 0.4], [-0.2, 0]], corner_angle=0))
    noise = Noise(contact=0.003, angle=0.002)
    log = CAM.simulate(tip, start=2, length=1.2, samples=61, noise=noise, seed=1).log
    watch = CAM.watch(finger=tip, noise=noise, every=20)
    watch.add(log.to_frame())
    watch.finish()
    located = CAM.locate(log=log, finger=tip, noise=noise)
    assert [place["start"][0] for place in watch.placements] == [place.start[0] for place in located]


def test_an_outline_finger_on_a_part_face_down_ends_as_locate():
    tip = OutlineFinger(Part.gallery("spline", n=7, seed=2, wobble=0.3))
    noise = Noise(contact=0.003, angle=0.004)
    seen = [CAM.point(k * CAM.perimeter / 400) for k in range(400)]
    face_down = Part.from_points([[-x, y] for x, y in seen])
    log = face_down.simulate(tip, start=face_down.perimeter - 2, length=-2, samples=61, noise=noise, seed=1).log
    watch = CAM.watch(finger=tip, noise=noise, every=20, mirrored=True)
    watch.add(log.to_frame())
    watch.finish()
    located = CAM.locate(log=log, finger=tip, noise=noise, mirrored=True)
    assert [place["start"][0] for place in watch.placements] == [place.start[0] for place in located]
    assert located.placements[0].start[0] == pytest.approx(2, abs=0.1)


def test_what_goes_with_a_wheel_is_said():
    with pytest.raises(InputError, match="^finger: expected one finger with skin and behind it one Wheel"):
        CAM.watch(finger=[Jaw(), Wheel(0.4)], noise=NOISE)
    with pytest.raises(InputError, match="^squeezed: is about a finger with skin and a Wheel"):
        CAM.watch(finger=Jaw(), squeezed=0.1, noise=NOISE)
    with pytest.raises(InputError, match="prior.* is not taken beside a wheel"):
        watched(("x", "y"), prior=(1, 0.1))


def test_the_first_roll_is_advised_before_any_contact():
    first = CAM.advise(finger=Disk(0.2), noise=NOISE)
    assert first.helps and len(first.contenders) > 50
    assert len(CAM.advise(finger=[Disk(0.2), Disk(0.3)]).length) == 2
    with pytest.raises(InputError, match="^prior: is about a roll that was"):
        CAM.advise(finger=Disk(0.2), prior=(1, 0.1))
    with pytest.raises(InputError, match="expected one finger or two"):
        CAM.advise()


def test_the_pin_of_a_wheel_is_told_how_to_move():
    few = {key: column[:4] for key, column in jaw_rows().items()}, {key: column[:4] for key, column in pin_rows("x", "y").items()}
    advice = CAM.advise(log=list(few), finger=[Jaw(), Wheel(0.4)], noise=NOISE, travel=0.3)
    assert advice.helps and max(abs(one) for one in advice.pin) <= 0.3
    assert "move the pin by" in repr(advice)
