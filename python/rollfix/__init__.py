"""Where a rolling finger touches a part of known outline: every place that fits, with its probability.

>>> import rollfix
>>> part = rollfix.Part.gallery("ellipse", a=2, b=1)
>>> part.locate(1.0, 0.625)
<Answer: ambiguous (4); start 0.3926, 3.4517, 5.2368, 8.2959>

Lengths are in the part's unit, angles in radians. s is arc length along the stored outline, counter-clockwise on a closed
one, the material on the left. The names are those of the JSON documents of the program `rollfix`.
"""

from ._answer import Answer, Placement
from ._catalog import Catalog, CatalogEntry, ManyIdentified, PartsAdvice
from ._core import InputError, InternalError, __version__
from ._documents import Advice, Inspection
from ._fingers import Disk, Finger, Jaw, OutlineFinger, Wheel
from ._holds import HoldAnswer, PinAdvice
from ._identified import Identified, PartFound
from ._log_answers import LogAnswers
from ._log_reading import read_log
from ._logs import Log, Roll
from ._making import gallery_shapes
from ._many import ManyAnswers
from ._messages import RollfixWarning
from ._noise import Noise
from ._part import Part
from ._plans import Plan
from ._reach import Reach
from ._resample import resample
from ._teach import Taught, teach
from ._touches import TouchAnswer
from ._watch import Watch

InputError.__module__ = InternalError.__module__ = __name__  # as they are imported, for tracebacks and pickles

__all__ = [
    "Advice",
    "Answer",
    "Catalog",
    "CatalogEntry",
    "Disk",
    "Finger",
    "HoldAnswer",
    "Identified",
    "InputError",
    "Inspection",
    "InternalError",
    "Jaw",
    "Log",
    "LogAnswers",
    "ManyAnswers",
    "ManyIdentified",
    "Noise",
    "OutlineFinger",
    "Part",
    "PartFound",
    "PartsAdvice",
    "PinAdvice",
    "Placement",
    "Plan",
    "Reach",
    "Roll",
    "RollfixWarning",
    "Taught",
    "TouchAnswer",
    "Watch",
    "__version__",
    "gallery_shapes",
    "read_log",
    "resample",
    "teach",
    "Wheel",
]
