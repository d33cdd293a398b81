"""What scenes hold, and what figures come as: plain data."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import ClassVar, NamedTuple, Sequence, SupportsFloat, SupportsIndex

import numpy as np
import numpy.typing as npt

from ._apertura import Radar, built_elements


class ArgumentError(TypeError, ValueError):
    """An argument of the wrong type. It is a ValueError too, as all errors of the library are."""


#: What is expected in a field of a type, and the types that have it: numbers of NumPy are among them.
_EXPECTED: dict[str, tuple[str, tuple[type, ...]]] = {
    "float": ("a number", (SupportsFloat, SupportsIndex)),
    "int": ("a whole number", (SupportsIndex,)),
    "str": ("a text", (str,)),
}


@dataclass(frozen=True)
class _Checked:
    """A data class whose numbers and texts are checked when it is made."""

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            expected, types = _EXPECTED.get(str(one.type), ("", (object,)))
            if not isinstance(value, types):
                raise ArgumentError(f"{type(self).__name__}: {one.name} is {value!r}; expected {expected}")


@dataclass(frozen=True)
class Point(_Checked):
    """One reflector. x lies along the array, y ahead of it, both in metres. Every object may have a name, and a velocity, which only
    `range_doppler` sees."""

    kind: ClassVar[str] = "point"
    x_metres: float
    y_metres: float
    reflectivity: float = 1.0
    velocity_x_metres_per_second: float = 0.0
    velocity_y_metres_per_second: float = 0.0
    name: str = ""


@dataclass(frozen=True)
class Line(_Checked):
    """Reflectors at equal spacing on a straight line. `direction_degrees` is 0 along +x and 90 straight ahead."""

    kind: ClassVar[str] = "line"
    x_metres: float
    y_start_metres: float
    spacing_metres: float
    count: int
    direction_degrees: float = 90.0
    reflectivity: float = 1.0
    velocity_x_metres_per_second: float = 0.0
    velocity_y_metres_per_second: float = 0.0
    name: str = ""


@dataclass(frozen=True)
class Cluster(_Checked):
    """Reflectors drawn from a normal distribution around a centre; the same seed gives the same cluster."""

    kind: ClassVar[str] = "gaussian"
    x_metres: float
    y_metres: float
    x_std_metres: float
    y_std_metres: float
    count: int
    seed: int = 0
    reflectivity: float = 1.0
    velocity_x_metres_per_second: float = 0.0
    velocity_y_metres_per_second: float = 0.0
    name: str = ""


@dataclass(frozen=True)
class Wall(_Checked):
    """A straight wall around (x, y). `angle_degrees` is that of its length from +x, counter-clockwise. `reflectivity` is the reflection
    coefficient, `roughness_millimetres` the standard deviation of the surface's height, `seed` picks the rough surface."""

    kind: ClassVar[str] = "wall"
    x_metres: float
    y_metres: float
    length_metres: float
    angle_degrees: float = 0.0
    reflectivity: float = 1.0
    roughness_millimetres: float = 0.0
    seed: int = 0
    velocity_x_metres_per_second: float = 0.0
    velocity_y_metres_per_second: float = 0.0
    name: str = ""


@dataclass(frozen=True)
class Box(_Checked):
    """A rectangle around (x, y), such as a car of 4.5 m by 1.8 m; the other fields as those of a `Wall`."""

    kind: ClassVar[str] = "box"
    x_metres: float
    y_metres: float
    length_metres: float
    width_metres: float
    angle_degrees: float = 0.0
    reflectivity: float = 1.0
    roughness_millimetres: float = 0.0
    seed: int = 0
    velocity_x_metres_per_second: float = 0.0
    velocity_y_metres_per_second: float = 0.0
    name: str = ""


@dataclass(frozen=True)
class Post(_Checked):
    """A round post around (x, y); the other fields as those of a `Wall`."""

    kind: ClassVar[str] = "post"
    x_metres: float
    y_metres: float
    radius_metres: float
    reflectivity: float = 1.0
    roughness_millimetres: float = 0.0
    seed: int = 0
    velocity_x_metres_per_second: float = 0.0
    velocity_y_metres_per_second: float = 0.0
    name: str = ""


@dataclass(frozen=True)
class Polygon(_Checked):
    """A closed outline of straight faces with these corners (x, y) in order, either way round; the other fields as those of a `Wall`."""

    kind: ClassVar[str] = "polygon"
    corners_metres: Sequence[tuple[float, float]]
    reflectivity: float = 1.0
    roughness_millimetres: float = 0.0
    seed: int = 0
    velocity_x_metres_per_second: float = 0.0
    velocity_y_metres_per_second: float = 0.0
    name: str = ""


@dataclass(frozen=True)
class Interferer(_Checked):
    """Another radar that sends at the same time: heard while its frequency crosses ours.

    `strength` is its amplitude at 1 m over the radar's power, `crossing` when its frequency crosses ours and `duration` for how long it is
    heard, both as parts of a chirp.
    """

    x_metres: float = 6.0
    y_metres: float = 25.0
    strength: float = 0.1
    crossing: float = 0.6
    duration: float = 0.1


@dataclass(frozen=True)
class Mirror(_Checked):
    """A straight wall that mirrors: a point of it in metres, where it leads (0 along the array, 90 ahead), and the part of an amplitude
    that it reflects."""

    x_metres: float = -5.0
    y_metres: float = 0.0
    direction_degrees: float = 90.0
    reflection: float = 0.5


@dataclass(frozen=True, eq=False)
class Elements:
    """Elements as they are built: arrays, float64 `[elements]`, and the numbers of those that hear nothing. `forward_millimetres` is how far
    each stands off the array's line, towards the scene; no number at all is a straight line."""

    gain_db: npt.NDArray[np.float64]
    phase_degrees: npt.NDArray[np.float64]
    position_millimetres: npt.NDArray[np.float64]
    dead: Sequence[int] = field(default_factory=tuple)
    forward_millimetres: npt.NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))

    @staticmethod
    def built(
        *,
        gain_db: float = 0.0,
        phase_degrees: float = 0.0,
        position_millimetres: float = 0.0,
        seed: int = 0,
        radar: Radar | None = None,
    ) -> Elements:
        """Elements drawn with these standard deviations; the same seed builds the same. Pairs of antennas share what their common antenna is off by.

        Raises:
            ValueError: A number can't be used.
        """
        return built_elements(gain_db, phase_degrees, position_millimetres, seed, radar)


class Metrics(NamedTuple):
    """SE, P_D and P_FA of one scene; P_D is None where there is nothing to detect."""

    squared_error: float
    detection: float | None
    false_alarm: float


class Paired(NamedTuple):
    """Two methods on the same scenes; the interval is one of 95 %."""

    scenes: int
    difference: float
    interval: tuple[float, float]
    first_alone: int
    second_alone: int
    p_value: float


class Threshold(NamedTuple):
    """A threshold that keeps a rate of false alarms, and means over the scenes that chose it; rates are fractions.

    `left_to_scenes` is the most that `false_alarm` may be with so many scenes: the rest of the rate is the price of few scenes. It is a tenth or
    less from `scenes_within_a_tenth` scenes on.
    """

    eta: float
    scenes: int
    false_alarm: float
    detection: float
    left_to_scenes: float
    scenes_within_a_tenth: int


class PositionBound(NamedTuple):
    """Standard deviations that no unbiased estimate of one reflector can stay below.

    `y_metres` is infinite on the array's axis, `xy_covariance_metres2` then 0. `amplitude` is a part of the reflector's own, and
    `position_metres` the root of the mean squared distance.
    """

    range_metres: float
    cos_theta: float
    x_metres: float
    y_metres: float
    xy_covariance_metres2: float
    amplitude: float
    position_metres: float
