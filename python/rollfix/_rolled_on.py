"""Rolls that are still to come: watched, simulated."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Tuple, Union

from ._asked import Asked
from ._columns import Columns, Units
from ._fingers import Finger, FingerLike
from ._logs import Roll
from ._noise import Noise, NoiseLike
from ._rig import simulated_rig
from ._simulate import simulated, tell_of_dropped
from ._watch import Watch


class RolledOn(Asked):
    """A part on which rolls are watched and simulated."""

    __slots__ = ()

    def watch(
        self,
        *,
        noise: Union[Noise, Mapping[str, float]],
        finger: Optional[Finger] = None,
        prior: Optional[Tuple[float, float]] = None,
        heading: Optional[Tuple[float, float]] = None,
        pose: Optional[Sequence[float]] = None,
        robust: bool = False,
        every: int = 0,
        columns: Columns = None,
        units: Units = None,
        degrees: bool = False,
        wrapped: Optional[bool] = None,
        direction: str = "ccw",
        mirrored: bool = False,
        live: bool = False,
        name: str = "log",
    ) -> Watch:
        """A `Watch` on this part."""
        return Watch(
            self,
            noise=noise,
            finger=finger,
            prior=prior,
            heading=heading,
            pose=pose,
            robust=robust,
            every=every,
            columns=columns,
            units=units,
            degrees=degrees,
            wrapped=wrapped,
            direction=direction,
            mirrored=mirrored,
            live=live,
            name=name,
        )

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
                self._core, finger, start, length, rotation, samples, contact, part_rotation, noise, seed
            )
        tell_of_dropped(self._core, roll, finger)
        return Roll(roll)
