"""Rolls that are still to come: watched, simulated, planned."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, Tuple, Union

from ._asked import Asked
from ._fingers import FingerLike
from ._logs import Roll
from ._noise import Noise, NoiseLike
from ._options import LiveOptions, keywords
from ._plans import Plan, planned
from ._simulate import simulated, simulated_rig, tell_of_dropped
from ._watch import Watch

if TYPE_CHECKING:
    from typing_extensions import Unpack


class RolledOn(Asked):
    """A part on which rolls are watched, simulated and planned."""

    __slots__ = ()

    @keywords(LiveOptions)
    def watch(
        self,
        *,
        noise: Union[Noise, Mapping[str, float]],
        every: int = 0,
        live: bool = False,
        name: Union[str, Tuple[str, str]] = "log",
        **options: Unpack[LiveOptions],
    ) -> Watch:
        """A `Watch` on this part."""
        return Watch(self, noise=noise, every=every, live=live, name=name, **options)

    def simulate(
        self,
        finger: Optional[FingerLike] = None,
        *,
        start: Any,
        length: Any = None,
        rotation: Optional[float] = None,
        samples: int = 101,
        contact: Any = 0.0,
        part_rotation: float = 0.0,
        pin: Any = None,
        jaw_rotation: float = 0.0,
        squeeze: bool = False,
        wheel: str = "skin",
        noise: NoiseLike = None,
        seed: int = 0,
        seconds: Optional[float] = None,
    ) -> Roll:
        """What the sensors of a roll say, and how it really was.

        Parameters
        ----------
        finger : Disk, Jaw, OutlineFinger; two of them; None: a wheel with a gyroscope
            Two roll on a part that is free to move. A wheel with a gyroscope logs `distance` and `dturn`. With `pin` they
            are `(Jaw(), Disk(radius))`, a jaw and a wheel that turns freely on a pin.
        start : float, of two fingers (s, t)
            The first contacts. With `squeeze` s alone does where the wheel can be squeezed at one place only.
        length : float, of two fingers (La, Lb)
            Until the contact has travelled this far; below 0: backwards. Or
        rotation : float
            of one finger: until it has turned by this, radians.
        samples : int
            Rows of the log.
        contact : float, of two fingers a pair
            Of a disk its angle u at the first contact, radians; of another finger the place on it.
        part_rotation : float
            Of two fingers: by how much the part turns meanwhile, radians.
        pin : (float, float), with `squeeze` a float
            Of a jaw and a wheel, in place of `length`: how far the pin moves in the jaw's frame, along the jaw and towards
            its body.
        jaw_rotation : float
            Of a jaw and a wheel: by how much the jaw turns meanwhile, and the pin with it, radians.
        squeeze : bool
            A spring presses the pin on the part, across the jaw: the wheel's normal passes through the jaw's contact.
        wheel : 'skin', 'encoder' or 'pin'
            What the wheel's log has: u, psi, x, y; psi, x, y; or x, y.
        noise : Noise or dict, optional
            `position` is of a wheel's pin; of other fingers x and y have no errors.
        seed : int
            Everything that is drawn follows from it, the same on all platforms.
        seconds : float, optional
            Of a wheel: how long it takes, at an even speed. None: its log has no times.

        Returns
        -------
        Roll
        """
        is_rig = pin is not None or squeeze or wheel != "skin" or jaw_rotation != 0
        if is_rig:
            is_told = length is not None or rotation is not None or part_rotation != 0
            roll = simulated_rig(
                self._core, finger, start, pin, squeeze, jaw_rotation, samples, contact, wheel, noise, seed, is_told
            )
        else:
            roll = simulated(
                self._core, finger, start, length, rotation, samples, contact, part_rotation, noise, seed, seconds
            )
        tell_of_dropped(self._core, roll, finger)
        return Roll(roll)

    def plan(
        self,
        finger: FingerLike,
        *,
        start: Any,
        length: Any,
        friction: Any = None,
        wheel: bool = False,
        pose: Optional[Sequence[float]] = None,
        part_rotation: Optional[float] = None,
        stays: str = "middle",
        duration: Optional[float] = None,
        limits: Optional[Mapping[str, float]] = None,
        margin: float = 0.0,
        clearance: float = 0.0,
        samples: int = 101,
        contact: Any = None,
        may_overlap: bool = False,
        mirrored: bool = False,
    ) -> Plan:
        """What the fingers have to do so that they roll as far as is asked, or which condition fails.

        Parameters
        ----------
        finger : Disk, Jaw, OutlineFinger; two of them, for a part that is free to move
        start : float, of two fingers (s, t)
            The first contacts; the second one of a wheel may be None.
        length : float, of two fingers (La, Lb) or La alone
            How far each contact is to travel; below 0: backwards. Of La alone the best Lb is found.
        friction : float, of two fingers also a pair, optional
            Coefficients between fingers and part. Default: what the roll needs is in `friction_needed`.
        wheel : bool
            The second finger is a disk on a free pin: nothing turns it, and its length follows.
        pose : (x, y, heading)
            Where the part lies in the world at the start.
        part_rotation : float, optional
            By how much the part turns meanwhile, radians. Default: so that the force keeps its direction, beside a wheel so
            that the first finger does not turn.
        stays : 'middle', 'a', 'b' or 'part'
            What stays in place.
        duration : float, optional
            Seconds. Default: the shortest within the limits.
        limits : mapping
            Any of speed and turn (radians), both per second, travel and rotation (radians) from the start.
        margin : float
            How far the force must stay inside the friction cones, radians.
        clearance : float
            How far the fingers must stay apart.
        samples : int
            Rows of the plan.
        contact : float, of two fingers also a pair, optional
            Of a disk its angle u at the first contact, radians; of another finger the place on it.
        may_overlap : bool
            Two fingers at different heights: they may pass one another.
        mirrored : bool
            The part lies face down. `start` and `length` are along the outline as drawn.

        Returns
        -------
        Plan
        """
        return planned(
            self,
            finger,
            start,
            length,
            friction,
            wheel,
            pose,
            part_rotation,
            stays,
            duration,
            limits,
            margin,
            clearance,
            samples,
            contact,
            may_overlap,
            mirrored,
        )
