"""What `__new__` alone made has no value: it says so, and the interpreter goes on."""

import pickle
import subprocess
import sys

import pytest

import rollfix
from rollfix import _core, _draw

CLASSES = [one for module in (_core, _draw) for one in vars(module).values()
           if isinstance(one, type) and one.__module__ == module.__name__ and not issubclass(one, Exception)]
USE_ALL = """
import importlib, sys
cls = getattr(importlib.import_module(sys.argv[1]), sys.argv[2])
uses = [repr, hash, len, lambda one: one == one] + [
    (lambda one, name=name: getattr(one, name)() if callable(getattr(one, name)) else getattr(one, name))
    for name in dir(cls) if name not in ('__init__', '__class__', '__new__', '__init_subclass__', '__subclasshook__')]
refused = 0
for use in uses:
    try:
        use(cls.__new__(cls))
    except TypeError as error:
        refused += 'has no value' in str(error)
    except Exception:
        pass
print(refused)
"""


def test_there_are_classes_to_look_at():
    assert {one.__name__ for one in CLASSES} >= {"Placement", "Answer", "Part", "Log", "Watch", "Catalog", "Figure", "Reach"}


@pytest.mark.parametrize("cls", CLASSES, ids=lambda one: one.__name__)
def test_an_object_without_its_value_refuses_whatever_it_is_asked(cls):
    done = subprocess.run([sys.executable, "-c", USE_ALL, cls.__module__, cls.__name__], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 0


def test_a_placement_without_its_value_has_no_text():
    with pytest.raises(TypeError, match="^Placement: has no value"):
        repr(rollfix.Placement.__new__(rollfix.Placement))


PYTHON_CLASSES = [one for one in vars(rollfix).values() if isinstance(one, type) and one.__module__.startswith("rollfix._")
                  and one not in CLASSES and not issubclass(one, (Exception, tuple))]


@pytest.mark.parametrize("cls", PYTHON_CLASSES, ids=lambda one: one.__name__)
def test_a_text_of_what_was_never_made_is_a_sentence(cls):
    try:
        assert repr(cls.__new__(cls))
    except (AttributeError, TypeError) as error:
        assert str(error).startswith(f"{cls.__name__}: has no value"), error


def test_a_name_that_is_wrong_is_told_as_python_tells_it(ellipse):
    with pytest.raises(AttributeError, match="'Part' object has no attribute 'perimetre'"):
        ellipse.perimetre


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_every_protocol_of_pickle_gives_the_same_back_or_refuses(ellipse, protocol):
    answer = ellipse.locate(1.0, 0.625)
    for one in (answer, answer[0], ellipse, ellipse.reach(rollfix.Disk(0.1))):
        assert pickle.loads(pickle.dumps(one, protocol)) == one
    with pytest.raises(TypeError, match="cannot pickle a Watch, which is at work"):
        pickle.dumps(ellipse.watch(noise=rollfix.Noise(angle=0.01)), protocol)
    with pytest.raises(TypeError, match="cannot pickle"):
        pickle.dumps(ellipse.watch(noise=rollfix.Noise(angle=0.1))._core, protocol)
