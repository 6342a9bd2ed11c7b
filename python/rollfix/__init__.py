"""Where a rolling finger touches a part of known outline: every place that fits, with its probability.

>>> import rollfix
>>> part = rollfix.Part.gallery("ellipse", a=2, b=1)
>>> part.locate(1.0, 0.625)
<Answer: ambiguous (4); start 0.3926, 3.4517, 5.2368, 8.2959>

Lengths are in the part's unit, angles in radians. s is arc length along the stored outline, counter-clockwise on a closed
one, the material on the left. The names are those of the JSON documents of the program `rollfix`.
"""

from ._answer import Answer, ManyAnswers, Placement
from ._core import InputError, InternalError, Reach, __version__
from ._documents import Advice, Inspection
from ._inputs import Disk, Finger, Jaw, Noise, OutlineFinger, RollfixWarning
from ._logs import Log, Roll, read_log
from ._part import Part, gallery_shapes
from ._teach import Taught, teach
from ._watch import Watch

for _named in (InputError, InternalError, Reach):  # as they are imported, for tracebacks and pickles
    _named.__module__ = __name__

__all__ = [
    "Advice",
    "Answer",
    "Disk",
    "Finger",
    "InputError",
    "Inspection",
    "InternalError",
    "Jaw",
    "Log",
    "ManyAnswers",
    "Noise",
    "OutlineFinger",
    "Part",
    "Placement",
    "Reach",
    "Roll",
    "RollfixWarning",
    "Taught",
    "Watch",
    "__version__",
    "gallery_shapes",
    "read_log",
    "teach",
]
