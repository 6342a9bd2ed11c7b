"""Catalogs: which part it is, as the program says it, in shares, by other processes and by a cluster that loses a worker."""

import os
import pickle
import time

import pytest

import rollfix

SHAPES = ["cam", "limacon", "gear", "naca", "ellipse,a=2,b=1", *(f"spline,n=9,seed={k},wobble=0.2" for k in range(12))]
NOISE = rollfix.Noise(contact=0.005, angle=0.01)
FINGER = rollfix.Disk(0.05)


@pytest.fixture(scope="module")
def catalog(tmp_path_factory):
    return rollfix.Catalog.build(tmp_path_factory.mktemp("catalog") / "parts.db", [f"gallery:{one}" for one in SHAPES])


@pytest.fixture(scope="module")
def roll(catalog):
    part = catalog.part("gallery:spline,n=9,seed=7,wobble=0.2")
    return part.simulate(FINGER, start=0.8, length=1.6, samples=30, noise=NOISE, seed=5)


@pytest.fixture(scope="module")
def noisy(roll):
    return dict(log=roll, finger=FINGER, noise=NOISE)


@pytest.fixture(scope="module")
def reading(catalog):
    cam = catalog.part("gallery:cam")
    return [[length, float(cam.turning(1 + length) - cam.turning(1))] for length in (0.3, 0.7, 1.1)]


def test_a_catalog_is_its_names(catalog):
    assert list(catalog) == list(catalog.names) == [f"gallery:{one}" for one in SHAPES] and len(catalog) == len(SHAPES)
    assert "gallery:cam" in catalog and "cam" not in catalog and catalog.left_out == {} and catalog.unit == ""
    assert catalog.part("gallery:cam") == catalog.part(0) == rollfix.Part.gallery("cam") and catalog.part(-1).closed
    assert catalog.entries[4].symmetry == 2 and catalog.entries[4].perimeter == catalog.part(4).perimeter
    assert "17 parts" in repr(catalog)


def test_the_program_says_the_same(catalog, reading, noisy, program, tmp_path):
    typed = [word for row in reading for word in ("--reading", ",".join(map(repr, row)))]
    told = program("identify", catalog.path, *typed, "--tolerance", "1e-9", "--json")
    assert catalog.identify(reading, tolerance=1e-9).to_dict() == told
    noisy["log"].log.save(tmp_path / "roll.csv")
    told = program("identify", catalog.path, "--log", tmp_path / "roll.csv", "--finger", "disk,r=0.05",
                   "--noise", "contact=0.005,angle=0.01", "--json")
    found = catalog.identify(log=tmp_path / "roll.csv", finger=FINGER, noise=NOISE)
    assert found.to_dict() == told and found.verdict == told["verdict"] and found.rest == told["rest"]


def test_each_part_has_its_own_answer(catalog, reading, noisy):
    found = catalog.identify(reading)
    assert found.names == ("gallery:cam",) and found.verdict.startswith("unique part") and found.rest is None
    assert found[0].answer == catalog.part("gallery:cam").locate(reading) and found[0].probability is None
    found = catalog.identify(**noisy)
    assert found[0].name.endswith("seed=7,wobble=0.2") and found.status == "complete" and found[0].source == found[0].name
    assert sum(one.probability for one in found) + found.rest == pytest.approx(1)
    assert [place.to_dict() for place in found[0].answer] == found.to_dict()["parts"][0]["placements"]
    assert found.verdict in repr(found) and found[0].verdict in repr(found[0]) and found.searched >= len(found)


def test_parts_that_can_t_be_told_apart_are_said_to_be(tmp_path, ellipse):
    two = rollfix.Catalog.build(tmp_path / "two.db", [("gallery:ellipse,a=2,b=1", 3), "gallery:ellipse,b=1,a=2"])
    found = two.identify(1.0, 0.625, noise=NOISE)
    assert found.verdict == "2 congruent parts" and found[0].congruent_with == (found[1].name,)
    assert [one.probability for one in found] == pytest.approx([0.75, 0.25]) and two.entries[0].count == 3


def test_answers_of_other_fingers_are_others(catalog, reading):
    small, large = (catalog.identify(reading, finger=rollfix.Disk(radius)) for radius in (0.01, 0.02))
    assert small.to_dict() == large.to_dict()  # which does not tell what the finger was
    assert small != large and small == catalog.identify(reading, finger=rollfix.Disk(0.01))


def test_it_can_be_pickled(catalog, noisy):
    found = catalog.identify(**noisy)
    back = pickle.loads(pickle.dumps(found))
    assert back == found and hash(back) == hash(found) and back[0] == found[0] and back != catalog.identify(1.0, 0.6)
    assert pickle.loads(pickle.dumps(catalog)).identify(**noisy) == found
    with pytest.raises(AttributeError):
        found.verdict = "none"


def test_any_number_of_threads_gives_the_same_bits(catalog, noisy):
    assert catalog.identify(**noisy, threads=1) == catalog.identify(**noisy, threads=5)


def test_a_table_has_a_row_for_each_place(catalog, noisy):
    pytest.importorskip("pandas")
    found = catalog.identify(**noisy)
    frame = found.to_frame()
    assert list(frame.part) == [one.name for one in found for _ in one.answer]
    assert list(frame.columns[:3]) == ["part", "part_probability", "kind"] and len(catalog.identify(1.0, 30.0).to_frame()) == 0
    several = catalog.identify(1.0, 0.6, noise={"contact": 0.05, "angle": 0.05})
    assert len(several) > 1
    assert list(several.to_frame().part_probability) == [one.probability for one in several for _ in one.answer]
    assert list(several.to_frame().probability) == [place.probability for one in several for place in one.answer]


def test_a_folder_and_a_list_are_taken_as_they_stand(tmp_path, wing):
    folder = tmp_path / "outlines"
    folder.mkdir()
    wing.save(folder / "wing.json")
    (folder / "broken.csv").write_text("1 2\n")
    with pytest.warns(rollfix.RollfixWarning, match="1 source was left out.*broken.csv"):
        built = rollfix.Catalog.build(tmp_path / "parts.db", folder)
    assert built.names == ("wing.json",) and [*built.left_out][0].endswith("broken.csv")
    (tmp_path / "list.txt").write_text("outlines/wing.json\t2\ngallery:cam\n")
    listed = rollfix.Catalog.build(tmp_path / "listed.db", tmp_path / "list.txt", threads=1, progress=False)
    assert len(listed) == 2 and listed.entries[0].count == 2
    assert listed.remove("gallery:cam") == 1 and len(listed) == 1 and len(rollfix.Catalog(listed.path)) == 1


def test_all_is_in_the_catalog_s_unit(tmp_path):
    built = rollfix.Catalog.build(tmp_path / "parts.db", ["gallery:cam", "gallery:gear"], unit="mm")
    assert built.unit == "mm" == built.part(0).unit
    roll = built.part(0).simulate(FINGER, start=1, length=1.5)
    assert built.identify(log=roll, finger=FINGER)[0].answer.part == built.part(0)


@pytest.mark.parametrize("wrong, why", [
    (dict(), "expected readings, a log or touches, found none"),
    (dict(readings=[1, 2, 3, 4]), "readings:"),
    (dict(readings=[1, 0.5], noise=3), "noise:"),
    (dict(readings=[1, 0.5], finger=-1), "finger:"),
    (dict(readings=[1, 0.5], direction="up"), "direction:"),
    (dict(readings=[1, 0.5], threads=-1), "threads:"),
    (dict(log="nowhere.csv"), "nowhere.csv"),
])  # fmt: skip
def test_what_can_t_be_meant_is_refused_by_its_name(catalog, wrong, why):
    with pytest.raises(rollfix.InputError, match=why):
        catalog.identify(**wrong)


def test_catalogs_and_parts_that_are_not_there(catalog, tmp_path):
    for ask, why in ((lambda: rollfix.Catalog(tmp_path / "none.db"), "none.db"), (lambda: rollfix.Catalog(3), "path:"),
                     (lambda: catalog.part("gallery:cax"), "did you mean 'gallery:cam'"), (lambda: catalog.part(99), "which:"),
                     (lambda: catalog.remove("cam"), "names:"), (lambda: catalog.remove([3]), "names:"),
                     (lambda: rollfix.Catalog.build(tmp_path / "a.db", 3), "sources:"),
                     (lambda: rollfix.Catalog.build(tmp_path / "a.db", []), "sources:"),
                     (lambda: rollfix.Catalog.build(tmp_path / "a.db", [("gallery:cam", 0)]), "sources:"),
                     (lambda: rollfix.Catalog.build(tmp_path / "a.db", [tmp_path / "none.csv"]), "none.csv"),
                     (lambda: rollfix.Catalog.build(tmp_path / "a.db", ["gallery:cam"], unit="miles"), "unit:"),
                     (lambda: catalog.identify_many([[1.0, 0.5]], client=3), "client:")):
        with pytest.raises(rollfix.InputError, match=why):
            ask()
    assert not (tmp_path / "a.db").exists() and len(catalog) == len(SHAPES)


TOUCHES = [(12.792, 5.984), (11.486, 5.811), (10.981, 4.883), (12.067, 3.784)]


def test_touches_tell_the_part_as_the_program_says_it(catalog, program):
    asked = dict(touches=TOUCHES, finger=rollfix.Disk(0.1), noise={"position": 0.005})
    found = catalog.identify(**asked)
    words = [word for x, y in TOUCHES for word in ("--touch", f"{x},{y}")]
    told = program("identify", catalog.path, *words, "--finger", "disk,r=0.1", "--noise", "position=0.005", "--json")
    assert found.to_dict() == told and found.names[0] == "gallery:spline,n=9,seed=7,wobble=0.2"
    assert found[0].answer == catalog.part(found.names[0]).locate(**asked)
    assert pickle.loads(pickle.dumps(found)) == found
    rows = found.to_frame()
    assert list(rows["part"])[0] == found.names[0] and len(rows) == sum(max(len(one.answer), 1) for one in found)


def test_a_part_without_a_placement_has_a_row_of_the_frame(catalog):
    found = catalog.identify(touches=TOUCHES[:1], finger=rollfix.Disk(0.1), noise={"position": 0.005})
    rows = found.to_frame()
    assert tuple(rows["part"]) == found.names and rows["x"].isna().all()


def test_several_rolls_say_which_part_it_is(catalog):
    part = catalog.part(catalog.names[0])
    sensors = {"contact": 0.002, "angle": 0.005}
    rolls = [part.simulate(rollfix.Disk(0.05), start=s, length=0.5, samples=30, noise=sensors, seed=1) for s in (1, 3)]
    given = {"finger": rollfix.Disk(0.05), "noise": {**sensors, "position": 0.005}}
    found = catalog.identify(log=[roll.log for roll in rolls], roll="all", **given)
    assert found.names[0] == catalog.names[0]
    alone = part.locate(log=[roll.log for roll in rolls], roll="all", **given)
    assert found[0].answer.poses.tolist() == alone.poses.tolist()
    with pytest.raises(rollfix.InputError, match="facing: rolls with u and psi have it themselves"):
        catalog.identify(log=[roll.log for roll in rolls], roll="all", facing=1.0, **given)


def test_touches_and_a_roll_are_two_questions(catalog, roll):
    with pytest.raises(rollfix.InputError, match="share a pose with roll='all': add it"):
        catalog.identify(touches=TOUCHES, log=roll, noise={"position": 0.005})
    with pytest.raises(rollfix.InputError, match="facing: touches do not roll"):
        catalog.identify(touches=TOUCHES, facing=1.0, noise={"position": 0.005})
    with pytest.raises(rollfix.InputError, match="clear: is about touches and several rolls"):
        catalog.identify(1.0, 0.5, clear=[(0, 0, 1, 1)])
