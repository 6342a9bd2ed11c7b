"""Many problems at once: the answers of one after the other, in order, errors in place."""

import json
import os
import pickle
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import rollfix
from conftest import random_rolls


def test_many_are_one_after_the_other(part):
    start, readings = random_rolls(part, 300, 1)
    slack = 1e-4 * part.perimeter  # a double root moves by the root of rounding
    many = part.locate_many(readings)
    assert len(many) == 300 and many.offsets[-1] == len(many.start) and (many.status == "complete").all()
    for k, reading in enumerate(readings):
        one = part.locate(*map(float, reading))
        assert many.start[many.rows(k)].tobytes() == one.starts.tobytes()
        assert [*many.kind[many.rows(k)]] == [place.kind for place in one]
        assert one.verdict.startswith(str(many.verdict[k]))
        assert many.tolerance[k] == one.tolerance
    assert (many.counts > 0).all()
    for k, s in enumerate(start):
        ahead = np.remainder(s + slack - many.extent[many.rows(k), 0, 0], part.perimeter)
        assert (ahead <= np.diff(many.extent[many.rows(k), 0])[:, 0] + 2 * slack).any()


def test_a_whole_answer_comes_by_its_number(ellipse):
    _, readings = random_rolls(ellipse, 10, 2)
    many = ellipse.locate_many(readings)
    assert many[3] == ellipse.locate(*map(float, readings[3])) and many[-1] == list(many)[9]
    with pytest.raises(IndexError):
        many[10]


def test_any_number_of_threads_gives_the_same_bits(part):
    _, readings = random_rolls(part, 500, 3)
    assert part.locate_many(readings, threads=1) == part.locate_many(readings, threads=5) == part.locate_many(readings)


def test_several_readings_of_a_problem(ellipse):
    s = np.array([0.3, 1.0, 4.0])
    lengths = np.array([0.5, 1.1])
    readings = np.stack([np.stack([np.full(3, L), ellipse.turning(s + L) - ellipse.turning(s)], axis=-1) for L in lengths], axis=1)
    many = ellipse.locate_many(readings, tolerance=1e-9)
    for k in range(3):
        assert many[k] == ellipse.locate(readings[k], tolerance=1e-9)


def test_two_fingers_with_their_facing():
    cam = rollfix.Part.gallery("cam")
    roll = cam.simulate((rollfix.Disk(0.2), rollfix.Disk(0.2)), start=(1, 4), length=(1.5, -0.8))
    answer = cam.locate(log=roll, finger=rollfix.Disk(0.2))
    rows = np.repeat(answer.readings[:1], 4, axis=0)
    many = cam.locate_many(rows, facing=answer.facing, tolerance=1e-6)
    assert many.fingers == 2 and many.start.shape[1:] == (2,) and many.extent.shape[1:] == (2, 2)
    assert many[2] == cam.locate(rows[2], facing=answer.facing, tolerance=1e-6)


def test_an_error_stays_with_its_problem(ellipse):
    spiral = rollfix.Part.gallery("log-spiral")
    readings = np.array([[1, 0.1], [np.nan, 1], [1000, 1], [2, 0.2]])
    many = spiral.locate_many(readings)
    assert set(many.errors) == {1, 2} and list(many.status) == ["complete", "error", "error", "complete"]
    assert "nan" in many.errors[1] and many.counts[1] == 0 and np.isnan(many.tolerance[1])
    assert many.start[many.rows(3)].tobytes() == spiral.locate(2.0, 0.2).starts.tobytes()
    with pytest.raises(rollfix.InputError):
        many[1]
    assert "2 errors" in repr(many)


def test_going_through_them_meets_errors_in_their_place(ellipse):
    many = ellipse.locate_many(np.array([[1, 0.625], [np.nan, 1], [1.9, 0.8796]]))
    assert [type(one).__name__ for one in many] == ["Answer", "InputError", "Answer"]
    assert many[:2][0] == many[0] and "nan" in str(many[1:][0]) and many[::2] == [many[0], many[2]] and many[5:] == []
    for wrong in ("a", 1.5):
        with pytest.raises(TypeError, match="expected the number of a problem"):
            many[wrong]


def test_they_can_be_pickled(ellipse):
    cam = rollfix.Part.gallery("cam")
    pairs = np.array([[1.0, -0.4, 0.3], [0.5, 0.4, 0.2]])
    for many in (ellipse.locate_many([[1, 0.625], [np.nan, 1]], finger=rollfix.Disk(0.1), direction="cw", rounding=(0.001, 0)),
                 cam.locate_many(pairs, facing=[0.3, 0.4], tolerance=1e-6)):
        back = pickle.loads(pickle.dumps(many))
        assert back == many and back[0] == many[0] and not back.start.flags.writeable


def test_an_array_that_is_asked_with_stays_the_user_s(ellipse):
    readings = np.array([[[1.0, 0.625]]])
    ellipse.locate_many(readings)
    readings[0, 0, 0] = 2.0


def test_nothing_asked_is_nothing_answered(ellipse):
    many = ellipse.locate_many(np.empty((0, 2)))
    assert len(many) == 0 and many.start.shape == (0, 1) and len(list(many)) == 0


def test_logs_are_answered_in_order_with_their_errors(wing, roll_csv, noise):
    finger = rollfix.Disk(10)
    answers = wing.locate_logs([roll_csv, "nowhere.csv", rollfix.read_log(roll_csv)], finger=finger, noise=noise)
    assert answers[0] == answers[2] == wing.locate(log=roll_csv, finger=finger, noise=noise)
    assert isinstance(answers[1], rollfix.InputError) and "nowhere.csv" in str(answers[1])
    with pytest.raises(TypeError):
        wing.locate_logs([], fingers=finger)


def test_noise_and_fingers_are_for_all(ellipse, noise):
    _, readings = random_rolls(ellipse, 5, 4)
    options = dict(noise=rollfix.Noise(contact=0.01, angle=0.01), finger=rollfix.Disk(0.1))
    many = ellipse.locate_many(readings, **options)
    for k in range(5):
        one = ellipse.locate(readings[k], **options)
        np.testing.assert_array_equal(many.probability[many.rows(k)], [place.probability for place in one])


def test_a_table_has_the_problem_of_each_row(ellipse):
    pytest.importorskip("pandas")
    _, readings = random_rolls(ellipse, 7, 5)
    many = ellipse.locate_many(readings)
    frame = many.to_frame()
    assert list(frame.groupby("problem").size()) == list(many.counts)


def test_a_batch_of_the_program_says_the_same(program, tmp_path):
    part = rollfix.Part.gallery("spline,n=9,seed=7,wobble=0.2")
    _, readings = random_rolls(part, 40, 6)
    lines = [json.dumps({"id": k, "readings": [row], "tolerance": 1e-9}) for k, row in enumerate(readings.tolist())]
    lines[5] = "nonsense"
    (tmp_path / "problems.jsonl").write_text("\n".join(lines))
    answers = program("locate", part.name, "--batch", tmp_path / "problems.jsonl", lines=True)
    many = part.locate_many(readings, tolerance=1e-9)
    assert len(answers) == 40 and "problems.jsonl:6" in answers[5]["error"]
    for k, answer in enumerate(answers):
        if k != 5:
            assert answer.pop("id") == k and answer == many[k].to_dict()


def test_ctrl_c_stops_it():
    code = ("import numpy as np, rollfix, sys; p = rollfix.Part.gallery('spline')\n"
            "rolls = np.tile([2.0, 1.0], (20_000_000, 1)); print('ready', flush=True)\n"
            "try: p.locate_many(rolls)\n"
            "except KeyboardInterrupt: print('stopped'); sys.exit(3)")
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "ready\n"
    time.sleep(1.0)
    began = time.monotonic()
    os.kill(child.pid, signal.SIGINT)
    out, _ = child.communicate(timeout=60)
    assert child.returncode == 3 and "stopped" in out and time.monotonic() - began < 10


def test_progress_is_shown_where_it_is_wanted(ellipse, capsys):
    pytest.importorskip("tqdm")
    ellipse.locate_many(np.tile([1.0, 0.625], (60000, 1)), progress=True, threads=1)
    assert "problems" in capsys.readouterr().err
    ellipse.locate_many(np.tile([1.0, 0.625], (1000, 1)), progress=False)
    assert capsys.readouterr().err == ""
