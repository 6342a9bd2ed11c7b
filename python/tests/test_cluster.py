"""The workers of a Dask cluster answer as this process does."""

import os
import signal
import threading

import numpy as np
import pytest

import rollfix

NOISE = rollfix.Noise(contact=0.005, angle=0.01)
FINGER = rollfix.Disk(0.05)
SHAPES = ["cam", "limacon", "gear", *(f"spline,n=9,seed={k},wobble=0.2" for k in range(6))]


@pytest.fixture(scope="module")
def client():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as found:
            yield found


@pytest.fixture(scope="module")
def part():
    return rollfix.Part.gallery("spline", n=9, seed=3)


@pytest.fixture(scope="module")
def catalog(tmp_path_factory):
    return rollfix.Catalog.build(tmp_path_factory.mktemp("catalog") / "parts.db", [f"gallery:{one}" for one in SHAPES])


def rolls(part, count, samples=60):
    return [part.simulate(FINGER, start=0.3 * k, length=1.5, samples=samples, noise=NOISE, seed=k) for k in range(count)]


def test_many_logs(part, client):
    logs = [*rolls(part, 9), "nowhere.csv"]
    found = part.locate_logs(logs, finger=FINGER, noise=NOISE, client=client)
    assert found == part.locate_logs(logs, finger=FINGER, noise=NOISE)
    assert found[0].log is not None and list(found.errors) == [9]


def test_many_readings(part, client):
    lengths = np.linspace(0.1, 1.5, 50)
    readings = np.column_stack([lengths, part.turning(0.4 + lengths) - part.turning(0.4)])
    readings[7] = np.nan
    found, expected = part.locate_many(readings, client=client), part.locate_many(readings)
    assert found.errors == expected.errors and list(found.errors) == [7]
    for name in ("offsets", "start", "extent", "kind", "verdict"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
    assert found[3] == expected[3]


def test_many_readings_of_two_fingers(part, client):
    readings, facing = [[0.3, -0.2, 0.1], [0.5, 0.4, 0.2], [0.7, 0.1, -0.3]], [0.1, 0.2, 0.3]
    found, expected = part.locate_many(readings, facing=facing, client=client), part.locate_many(readings, facing=facing)
    np.testing.assert_array_equal(found.start, expected.start)


def test_which_part_each_of_many_rolls_is_of(catalog, client):
    logs = [log for name in list(catalog)[:4] for log in rolls(catalog.part(name), 1)]
    found = catalog.identify_many(logs=[*logs, "nowhere.csv"], finger=FINGER, noise=NOISE, client=client)
    assert found == catalog.identify_many(logs=[*logs, "nowhere.csv"], finger=FINGER, noise=NOISE)
    assert found[0][0].answer.log is not None and list(found.errors) == [4]
    assert catalog.identify_many([[0.3, 0.2], [0.5, 0.1]], client=client) == catalog.identify_many([[0.3, 0.2], [0.5, 0.1]])


def test_none_at_all(part, catalog, client):
    assert len(part.locate_logs([], client=client)) == 0 == len(catalog.identify_many([], client=client))
    assert len(part.locate_many(np.zeros((0, 2)), client=client)) == len(part.locate_many(np.zeros((0, 2))))


def test_what_is_no_client_is_refused(part, catalog):
    pytest.importorskip("distributed")
    for ask in (lambda: part.locate_logs(["a.csv"], client=3), lambda: part.locate_many([[1, 0.5]], client=3),
                lambda: catalog.identify_many([[1.0, 0.5]], client=3)):
        with pytest.raises(rollfix.InputError, match="client: expected a distributed.Client"):
            ask()


def test_a_worker_that_is_killed_loses_nothing(part, client):
    logs = rolls(part, 24, samples=3000)
    found = []
    asking = threading.Thread(
        target=lambda: found.append(part.locate_logs(logs, finger=FINGER, noise=NOISE, client=client, progress=False))
    )
    pids = client.run(os.getpid)
    asking.start()
    busy = []
    while not busy and asking.is_alive():
        busy = [worker for worker, tasks in client.processing().items() if tasks and worker in pids]
    assert busy
    os.kill(pids[busy[0]], signal.SIGKILL)
    assert asking.is_alive()
    asking.join(300)
    assert found == [part.locate_logs(logs, finger=FINGER, noise=NOISE, progress=False)]
