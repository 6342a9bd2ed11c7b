"""Threads, forks, other processes, parts that are closed meanwhile, and memory."""

import concurrent.futures
import gc
import multiprocessing
import os
import pickle
import threading

import numpy as np
import pytest

import rollfix
from conftest import random_rolls


def ask(part, readings):
    return [part.locate(*map(float, reading)) for reading in readings]


def test_sixteen_threads_on_one_part(part):
    _, readings = random_rolls(part, 60, 1)
    expected = ask(part, readings)
    with concurrent.futures.ThreadPoolExecutor(16) as pool:
        for found in pool.map(lambda _: ask(part, readings), range(32)):
            assert found == expected


def test_sixteen_threads_with_noise_and_logs(wing, roll_csv, noise):
    def once(_):
        return wing.locate(log=roll_csv, finger=rollfix.Disk(10), noise=noise)

    expected = once(0)
    with concurrent.futures.ThreadPoolExecutor(16) as pool:
        assert all(found == expected for found in pool.map(once, range(32)))


def test_other_processes_get_parts_and_give_answers(wing):
    _, readings = random_rolls(wing, 8, 2)
    expected = ask(wing, readings)
    for method in ("spawn", "fork"):
        context = multiprocessing.get_context(method)
        with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
            assert list(pool.map(ask, [wing] * 8, readings[:, np.newaxis])) == [[one] for one in expected]


def test_a_fork_can_go_on(ellipse):
    answer = ellipse.locate(1.0, 0.625)
    ellipse.locate_many(np.tile([1.0, 0.625], (2000, 1)))  # threads were there before
    read, write = os.pipe()
    child = os.fork()
    if child == 0:  # pragma: no cover
        try:
            same = ellipse.locate(1.0, 0.625) == answer and len(ellipse.locate_many([[1.0, 0.625]] * 300)) == 300
            os.write(write, b"y" if same else b"n")
        finally:
            os._exit(0)
    os.close(write)
    assert os.read(read, 1) == b"y"
    os.close(read)
    os.waitpid(child, 0)


def test_a_part_that_is_closed_while_threads_use_it():
    part = rollfix.Part.gallery("spline,n=16,seed=7,wobble=0.2")
    _, readings = random_rolls(part, 4000, 3)
    done, errors = [], []
    begun = threading.Barrier(9)

    def work():
        begun.wait()
        try:
            done.append(len(part.locate_many(readings, threads=2)))
            for _ in range(1000):
                part.locate(1.0, 1.0)
        except rollfix.InputError as error:
            errors.append(str(error))

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    begun.wait()
    part.close()
    for thread in threads:
        thread.join()
    assert len(errors) == 8 and all("part: was closed" in error for error in errors)
    assert all(count == 4000 for count in done)


@pytest.mark.parametrize("use", [lambda p: p.perimeter, lambda p: p.locate(1.0, 1.0), lambda p: p.point(1), lambda p: pickle.dumps(p),
                                 lambda p: p.locate_many([[1.0, 1.0]]), lambda p: p.inspect(), lambda p: p.to_svg(),
                                 lambda p: p.simulate(rollfix.Disk(0.1), start=0, length=1), lambda p: p.reach(rollfix.Disk(1)),
                                 lambda p: p.watch(noise=rollfix.Noise(angle=0.1))])
def test_a_closed_part_says_so(use):
    with rollfix.Part.gallery("ellipse") as part:
        answer = part.locate(1.0, 0.5)
    with pytest.raises(rollfix.InputError, match="closed"):
        use(part)
    assert "closed" in repr(part)
    assert answer.part.perimeter > 0 and answer.to_svg() and pickle.loads(pickle.dumps(answer)) == answer


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def grows(calls, call):
    """Bytes per call, after the first tenth of them."""
    for _ in range(calls // 10):
        call()
    gc.collect()
    before = resident()
    for _ in range(calls):
        call()
    gc.collect()
    return (resident() - before) / calls


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="Linux tells its memory there")
@pytest.mark.parametrize("name", ["locate", "refused", "fields", "document", "pickle", "many"])
def test_memory_does_not_grow(ellipse, name, request):
    calls = 1_000_000 if request.config.getoption("--slow") and name in ("locate", "refused") else 20_000

    def refused():
        try:
            ellipse.locate(np.nan, 1.0)
        except rollfix.InputError:
            pass

    def fields():
        place = ellipse.locate(1.0, 0.625)[0]
        return place.start, place.extent, place.point, place.roots, place.per_turn, place.per_length

    job = {"locate": lambda: ellipse.locate(1.0, 0.625), "refused": refused, "fields": fields,
           "document": lambda: ellipse.locate(1.0, 0.625).to_dict(),
           "pickle": lambda: pickle.loads(pickle.dumps(ellipse.locate(1.0, 0.625)[1].start)),
           "many": lambda: ellipse.locate_many([[1.0, 0.625]] * 3, threads=1)}[name]
    calls = calls if name != "document" else calls // 10
    assert grows(calls, job) < 2e6 / calls + 50  # bytes a call; a leak of one answer is 2,000


def test_threads_that_feed_one_watch_lose_no_row(ellipse):
    noise = rollfix.Noise(contact=0.01, angle=0.01)
    roll = ellipse.simulate(rollfix.Disk(0.1), start=1, length=2, samples=300, noise=noise, seed=1)
    rows = roll.log.to_frame()[["u", "psi"]].to_dict("records")
    for _ in range(5):  # most often the first one crashed
        watch, waiting, begun = ellipse.watch(finger=rollfix.Disk(0.1), noise=noise), iter(rows), threading.Barrier(4)

        def feed():
            begun.wait()
            for row in iter(lambda: next(waiting, None), None):
                watch.add(row)

        threads = [threading.Thread(target=feed) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        counts = watch.finish()[-1]["counts"]
        assert counts["samples"] + counts["malformed"] == len(rows)
