"""Answers are small immutable values."""

import copy
import json
import pickle

import numpy as np
import pytest

import rollfix
from rollfix import Disk, Noise


@pytest.fixture
def answer(ellipse):
    return ellipse.locate(1.0, 0.625)


@pytest.fixture(scope="module")
def weighed(wing, roll_csv, noise):
    return wing.locate(log=roll_csv, finger=Disk(10), noise=noise)


def pair_answer(**options):
    cam = rollfix.Part.gallery("cam")
    return cam.locate([[0.7446832, -0.3983439, 1.0032473], [1.5, -0.8, 1.9367925]], **(options or {"tolerance": 1e-6}))


def test_an_answer_is_a_sequence(answer):
    assert len(answer) == 4 == len(list(answer)) == len(answer[:])
    assert answer[0] == answer.placements[0] and answer[-1] == answer[3]
    assert answer[1] in answer
    with pytest.raises(IndexError):
        answer[4]


def test_repr_tells_the_verdict(answer):
    assert repr(answer) == "<Answer: ambiguous (4); start 0.3926, 3.4517, 5.2368, 8.2959>"
    assert repr(answer[0]) == "<Placement crossing: start 0.3926, end 1.3926>"


@pytest.mark.parametrize("name", ["verdict", "status", "placements", "tolerance", "anything"])
def test_an_answer_can_not_be_changed(answer, name):
    with pytest.raises(AttributeError):
        setattr(answer, name, 1)


@pytest.mark.parametrize("name", ["start", "extent", "point", "roots", "tangent"])
def test_arrays_can_not_be_written_to(answer, name):
    with pytest.raises(ValueError):
        getattr(answer[0], name)[...] = 0
    with pytest.raises(AttributeError):
        setattr(answer[0], name, 1)


def test_the_document_is_that_of_the_program(answer, program):
    expected = program("locate", "gallery:ellipse,a=2,b=1", "--reading", "1.0,0.625", "--tolerance", "1e-9", "--json")
    assert answer.to_dict() == expected
    assert [one.to_dict() for one in answer] == expected["placements"]


def test_the_fields_are_those_of_the_document(weighed):
    document = weighed.to_dict()
    for placement, fields in zip(weighed, document["placements"]):
        for name in ("start", "end", "extent", "point", "tangent", "mean", "sd", "interval", "end_mean", "end_sd", "roots",
                     "pose", "pose_mean", "pose_covariance"):
            np.testing.assert_array_equal(getattr(placement, name), np.array(fields[name]).reshape(
                getattr(placement, name).shape), err_msg=name)
        for name in ("kind", "probability", "residual", "error", "whole_loop"):
            assert getattr(placement, name) == fields[name], name
        np.testing.assert_array_equal(placement.per_turn, fields["sensitivity"]["per_turn"])
        np.testing.assert_array_equal(placement.per_length, fields["sensitivity"]["per_length"])
    assert weighed.verdict == document["verdict"] and weighed.status == document["status"]
    assert weighed.fit == document["fit"] and weighed.diagnosis == document["diagnosis"]


@pytest.mark.parametrize("make", [lambda w: w, lambda w: pair_answer(), lambda w: w[0], lambda w: w.part, lambda w: w.log,
                                  lambda w: Disk(3), lambda w: rollfix.Jaw(), lambda w: Noise(angle=0.1),
                                  lambda w: w.part.inspect(), lambda w: w.advise(), lambda w: w.part.locate(60.1, 0.0894),
                                  lambda w: w.part.reach(Disk(3)), lambda w: w.part.reach(rollfix.Jaw()),
                                  lambda w: w.part.simulate(Disk(3), start=1, length=20, noise=Noise(angle=0.1))])
def test_results_survive_pickle_and_copy(weighed, make):
    value = make(weighed)
    for copied in (pickle.loads(pickle.dumps(value)), copy.deepcopy(value)):
        assert copied == value and hash(copied) == hash(value) and repr(copied) == repr(value)


def test_other_bits_are_another_answer(ellipse, answer):
    assert answer == ellipse.locate([[1.0, 0.625]])
    assert answer != ellipse.locate(1.0, np.nextafter(0.625, 1))
    assert answer != rollfix.Part.gallery("ellipse", a=2, b=1.0000001).locate(1.0, 0.625)
    assert answer != 3


def test_rolls_and_reaches_are_values(ellipse):
    roll = ellipse.simulate(Disk(0.2), start=1, length=2)
    assert roll == ellipse.simulate(Disk(0.2), start=1, length=2) != ellipse.simulate(Disk(0.2), start=1, length=2, seed=1,
                                                                                     noise=Noise(angle=0.1))
    assert ellipse.reach(Disk(0.2)) == ellipse.reach(Disk(0.2)) != ellipse.reach(Disk(0.3))
    assert repr(ellipse.reach(Disk(0.2))) == "<Reach of Disk(0.2) along the boundary: all>"


def test_answers_on_another_part_or_with_another_finger_are_others(ellipse):
    assert ellipse.locate(1.0, 0.625, finger=Disk(0.1)) == ellipse.locate(1.0, 0.625, finger=Disk(0.1))
    assert ellipse.locate(1.0, 0.625, finger=Disk(0.1)) != ellipse.locate(1.0, 0.625, finger=Disk(0.2))
    nowhere, nowhere_else = (part.locate(1.0, 50.0) for part in (ellipse, rollfix.Part.gallery("cam")))
    assert len(nowhere) == len(nowhere_else) == 0 and nowhere != nowhere_else


def test_the_density_is_of_a_finger_that_there_is(weighed):
    with pytest.raises(rollfix.InputError, match="^finger: expected 0, as there is one finger, found 1$"):
        weighed.density(finger=1)


def test_a_table_has_a_row_for_each_placement(answer, weighed):
    pandas = pytest.importorskip("pandas")
    frame = answer.to_frame()
    assert list(frame.start) == [one.start[0] for one in answer]
    assert list(weighed.to_frame().probability) == [one.probability for one in weighed]
    assert {"start_a", "start_b"} <= set(pair_answer().to_frame().columns)
    assert isinstance(frame, pandas.DataFrame)


def test_each_column_is_the_placements_own_field_of_its_finger(weighed):
    pytest.importorskip("pandas")
    pair = pair_answer()
    for answer, ends in ((weighed, [""]), (pair, ["_a", "_b"])):
        frame = answer.to_frame()
        expected = {"kind": [one.kind for one in answer], "residual": [one.residual for one in answer]}
        expected["error"] = [one.error for one in answer]
        for finger, end in enumerate(ends):
            expected.update({
                "start" + end: [one.start[finger] for one in answer],
                "end" + end: [one.end[finger] for one in answer],
                "extent_lo" + end: [one.extent[finger][0] for one in answer],
                "extent_hi" + end: [one.extent[finger][1] for one in answer],
                "x" + end: [one.point[finger][0] for one in answer],
                "y" + end: [one.point[finger][1] for one in answer],
                "tangent" + end: [one.tangent[finger] for one in answer],
            })
        for name, values in expected.items():
            # What is not known is None here, and no number in a column of numbers.
            assert [None if value != value else value for value in frame[name]] == values, name


def test_each_column_is_the_posterior_s_own_of_its_finger(weighed):
    pytest.importorskip("pandas")
    for answer, ends in ((weighed, [""]), (pair_answer(noise=Noise(contact=0.002, angle=0.005)), ["_a", "_b"])):
        frame = answer.to_frame()
        for finger, end in enumerate(ends):
            assert list(frame["mean" + end]) == [one.mean[finger] for one in answer]
            assert list(frame["sd" + end]) == [one.sd[finger] for one in answer]
            assert list(frame["interval_lo" + end]) == [one.interval[finger, 0] for one in answer]
            assert list(frame["interval_hi" + end]) == [one.interval[finger, 1] for one in answer]
            assert list(frame["end_sd" + end]) == [one.end_sd[finger] for one in answer]


def test_columns_hold_poses_and_what_is_contradicted(wing, roll_csv, weighed):
    pytest.importorskip("pandas")
    poses = weighed.to_frame()[["pose_x", "pose_y", "pose_heading"]].to_numpy()
    np.testing.assert_array_equal(poses, [one.pose[0] for one in weighed])
    exact = wing.locate(log=roll_csv, finger=Disk(10))
    assert list(exact.to_frame()["contradicted"]) == [one.contradicted for one in exact]


def test_the_best_placement_is_the_first_and_contradicted_ones_are_counted(ellipse, weighed):
    assert weighed.best == weighed[0] and ellipse.locate(1.0, 9.0).best is None
    spline = rollfix.Part.gallery("spline,n=9,seed=7,wobble=0.2")
    s = np.array([0.0, 0.4, 0.9977])
    turn = spline.turning(1.0 + s) - spline.turning(1.0)
    log = spline.locate(log={"length": s[1:], "turn": turn[1:]})
    against = sum(one.contradicted for one in log)
    assert against > 0 and repr(log).endswith(f"; {against} of {len(log)} contradicted>")


@pytest.mark.parametrize("source, hint", [
    (np.zeros((4, 2)), "points: Part.from_points"), ([[0, 0], [1, 0], [0, 1]], "points: Part.from_points"),
    ({"x": [0], "y": [0]}, "points: Part.from_points")])
def test_what_is_no_path_names_what_makes_a_part_of_it(source, hint):
    with pytest.raises(rollfix.InputError, match="^source: expected a path, found " + hint):
        rollfix.Part(source)


@pytest.mark.parametrize("radius, why", [(0.2, "the fingers would overlap; of fingers at different heights say may_overlap=True"), (1, "the finger can't touch there")])
def test_an_empty_answer_says_what_took_its_placements_out(radius, why):
    part = rollfix.Part.gallery("spline,n=9,seed=7,wobble=0.2")
    s, travelled = np.array([1.0, 1.3]), np.array([[0.5, 0.4], [1.0, 0.8]])
    turned = part.turning(s + travelled) - part.turning(s)
    readings = np.column_stack([travelled, turned[:, 0] - turned[:, 1]])
    options = dict(facing=float(part.turning(1.0) - part.turning(1.3)), tolerance=1e-7)
    assert len(part.locate(readings, **options)) == 1 and part.locate(readings, **options).notes == ()
    assert part.locate(readings, finger=Disk(radius), **options).notes == (f"1 place that fits was dropped: {why}",)


def test_notebooks_show_the_figure_and_the_table(answer, weighed):
    for one in (answer, weighed, pair_answer()):
        assert one._repr_svg_().startswith("<svg")  # a declaration in a page stops nbconvert
        assert "<table>" in one._repr_html_() and one.verdict in one._repr_html_()


def test_the_figure_is_that_of_the_program(wing, roll_csv, noise, program, tmp_path):
    import subprocess

    file = tmp_path / "figure.svg"
    subprocess.run([program.path, "locate", wing.name, "--log", str(roll_csv), "--finger", "disk,r=10", "--noise",
                    "contact=0.05,angle=0.006,slip=0.004", "-o", str(file)], check=True, capture_output=True)
    assert wing.locate(log=roll_csv, finger=Disk(10), noise=noise).to_svg() == file.read_text()


def test_figures_are_written_by_their_ending(answer, ellipse, tmp_path):
    answer.save(tmp_path / "a.png")
    ellipse.save(tmp_path / "a.pdf")
    ellipse.save(tmp_path / "a.json")
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG" and (tmp_path / "a.pdf").read_bytes()[:4] == b"%PDF"
    saved = rollfix.Part(tmp_path / "a.json")
    assert saved.locate(1.0, 0.625).starts.tobytes() == answer.starts.tobytes()
    with pytest.raises(rollfix.InputError):
        answer.save(tmp_path / "a.bmp")


def test_plot_draws_on_axes_that_are_given(answer):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots()
    assert answer.plot(axes) is axes and len(axes.lines) == 1 + 2 * len(answer)
    plt.close(figure)


def test_the_density_integrates_to_the_probabilities(weighed):
    pieces, probability = weighed.density()
    assert probability.sum() == pytest.approx(1, abs=1e-6)
    s = np.linspace(0, weighed.part.perimeter, 400001)
    density = weighed.density(s)
    assert density.shape == s.shape and np.trapz(density, s) == pytest.approx(1, abs=1e-3)
    assert weighed.density(s.reshape(1, -1)).shape == (1, len(s))
    assert len(pieces) == len(probability)


def test_without_noise_there_is_no_density(answer):
    with pytest.raises(rollfix.InputError, match="noise"):
        answer.density([1.0])


def test_the_document_is_json(weighed):
    json.dumps(weighed.to_dict(), allow_nan=False)
