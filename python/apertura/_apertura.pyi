"""What the compiled module holds; the docstrings at run time say shapes, units and errors."""

import os
from typing import Any, Callable, Iterable, Literal, Sequence, SupportsIndex, final

import numpy as np
import numpy.typing as npt

from .objects import (
    Box,
    Cluster,
    Elements,
    Interferer,
    Line,
    Metrics,
    Mirror,
    Paired,
    Point,
    Polygon,
    PositionBound,
    Post,
    Threshold,
    Wall,
)

_Path = str | os.PathLike[str]
_Progress = Callable[[float], object]
_Carrier = Literal["one-way", "two-way"]
_Convention = Literal["thesis", "physical"]
_Window = Literal["hann", "hamming", "blackman", "rectangular"]
_Purpose = Literal["training", "validation", "test"]
_Reading = Literal["program", "text"]
_Target = str
#: A name, a method, a file of weights, or a function.
_Method = str | os.PathLike[str] | Method | Callable[..., Any]

__all__ = [
    "ROW_COLUMNS",
    "Examples",
    "LinkBudget",
    "Maps",
    "Method",
    "Radar",
    "Reconstruction",
    "Recording",
    "Scene",
    "__version__",
    "_maps",
    "_reconstruction",
    "_recording",
    "ambiguity",
    "built_elements",
    "cfar",
    "chirp_samples",
    "cramer_rao",
    "dataset",
    "evaluate",
    "kinds",
    "layout",
    "live_input",
    "maps",
    "method",
    "methods",
    "metrics",
    "paired",
    "range_doppler",
    "read_rows",
    "robustness",
    "roc",
    "set_threads",
    "threads",
    "threshold",
    "write_rows",
]
__version__: str
#: The columns of rows, in the file's order: name, type (str, int or float), and whether it says what made a row.
ROW_COLUMNS: list[tuple[str, type, bool]]

@final
class LinkBudget:
    def __new__(
        cls,
        transmit_power_dbm: float | None = None,
        antenna_gain_dbi: float | None = None,
        noise_figure_db: float | None = None,
        half_power_width_degrees: float | None = None,
    ) -> LinkBudget: ...
    @staticmethod
    def reflectivity_of(cross_section_dbsm: float) -> float: ...
    @property
    def transmit_power_dbm(self) -> float: ...
    @property
    def antenna_gain_dbi(self) -> float: ...
    @property
    def noise_figure_db(self) -> float: ...
    @property
    def half_power_width_degrees(self) -> float | None: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Radar:
    def __new__(
        cls,
        *,
        transmit_power_watts: float | None = None,
        bandwidth_hz: float | None = None,
        carrier_hz: float | None = None,
        element_spacing_metres: float | None = None,
        elements: int | None = None,
        end_elements: int | None = None,
        samples: int | None = None,
        carrier: _Carrier | None = None,
        window: _Window | None = None,
        convention: _Convention | None = None,
        transmitter_x_metres: Sequence[float] | None = None,
        receiver_x_metres: Sequence[float] | None = None,
        transmitter_y_metres: Sequence[float] | None = None,
        receiver_y_metres: Sequence[float] | None = None,
        focus_off_line: bool | None = None,
        chirp_seconds: float | None = None,
        chirps: int | None = None,
        chirp_interval_seconds: float | None = None,
        budget: LinkBudget | dict[str, float] | None = None,
    ) -> Radar: ...
    @staticmethod
    def preset(name: str) -> Radar: ...
    @staticmethod
    def presets() -> list[str]: ...
    @staticmethod
    def load(path: _Path) -> Radar: ...
    def save(self, path: _Path) -> None: ...
    def replace(self, **fields: Any) -> Radar: ...
    @property
    def transmit_power_watts(self) -> float: ...
    @property
    def bandwidth_hz(self) -> float: ...
    @property
    def carrier_hz(self) -> float: ...
    @property
    def element_spacing_metres(self) -> float: ...
    @property
    def elements(self) -> int: ...
    @property
    def end_elements(self) -> int: ...
    @property
    def samples(self) -> int: ...
    @property
    def chirp_seconds(self) -> float: ...
    @property
    def budget(self) -> LinkBudget | None: ...
    def link(self, range_metres: float, cross_section_dbsm: float = 0.0, angle_degrees: float = 0.0) -> dict[str, float]: ...
    @property
    def carrier(self) -> _Carrier: ...
    @property
    def convention(self) -> _Convention: ...
    @property
    def transmitter_x_metres(self) -> npt.NDArray[np.float64] | None: ...
    @property
    def receiver_x_metres(self) -> npt.NDArray[np.float64] | None: ...
    @property
    def transmitter_y_metres(self) -> npt.NDArray[np.float64] | None: ...
    @property
    def receiver_y_metres(self) -> npt.NDArray[np.float64] | None: ...
    @property
    def focus_off_line(self) -> bool: ...
    @property
    def window(self) -> _Window: ...
    @property
    def chirps(self) -> int: ...
    @property
    def chirp_interval_seconds(self) -> float: ...
    @property
    def unambiguous_velocity_metres_per_second(self) -> float: ...
    @property
    def velocity_metres_per_second(self) -> npt.NDArray[np.float64]: ...
    @property
    def wavelength_metres(self) -> float: ...
    @property
    def range_resolution_metres(self) -> float: ...
    @property
    def max_range_metres(self) -> float: ...
    @property
    def aperture_metres(self) -> float: ...
    @property
    def element_x_metres(self) -> npt.NDArray[np.float64]: ...
    @property
    def range_metres(self) -> npt.NDArray[np.float64]: ...
    @property
    def cos_theta(self) -> npt.NDArray[np.float64]: ...
    @property
    def rising_columns(self) -> npt.NDArray[np.int64]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class Scene:
    def __new__(
        cls,
        objects: Iterable[Point | Line | Cluster | Wall | Box | Post | Polygon] | None = None,
        *,
        name: str = "",
        notes: str = "",
        noise_seed: int = 0,
        radar: Radar | None = None,
        elements: Elements | None = None,
        interferer: Interferer | None = None,
        mirror: Mirror | None = None,
        shadows: bool = True,
    ) -> Scene: ...
    @staticmethod
    def of_points(points: npt.ArrayLike, radar: Radar | None = None) -> Scene: ...
    @staticmethod
    def random(
        set: str | int,
        seed: int = 0,
        index: int = 0,
        *,
        purpose: _Purpose = "test",
        reading: _Reading = "program",
        radar: Radar | None = None,
    ) -> Scene: ...
    @staticmethod
    def preset(name: str) -> Scene: ...
    @staticmethod
    def presets() -> list[str]: ...
    @staticmethod
    def load(path: _Path) -> Scene: ...
    def save(self, path: _Path) -> None: ...
    @staticmethod
    def from_toml(text: str) -> Scene: ...
    def to_toml(self) -> str: ...
    def to_text(self, *, floor: str = "thesis", normalisation: str = "min-max", method: str = "live") -> str: ...
    def replace(self, **fields: Any) -> Scene: ...
    @property
    def shadows(self) -> bool: ...
    @property
    def objects(self) -> list[Point | Line | Cluster | Wall | Box | Post | Polygon]: ...
    @property
    def name(self) -> str: ...
    @property
    def notes(self) -> str: ...
    @property
    def noise_seed(self) -> int: ...
    @property
    def radar(self) -> Radar: ...
    @property
    def elements(self) -> Elements | None: ...
    @property
    def interferer(self) -> Interferer | None: ...
    @property
    def mirror(self) -> Mirror | None: ...
    @property
    def reflectors(self) -> npt.NDArray[np.float64]: ...
    def simulate(
        self,
        radar: Radar | None = None,
        *,
        floor: str = "thesis",
        seed: int | None = None,
        normalisation: str = "min-max",
        progress: _Progress | None = None,
    ) -> Maps: ...
    def __len__(self, /) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class Maps:
    @property
    def radar(self) -> Radar: ...
    @property
    def normalisation(self) -> str: ...
    @property
    def samples(self) -> npt.NDArray[np.complex128]: ...
    @property
    def ends(self) -> npt.NDArray[np.complex128]: ...
    @property
    def decades(self) -> npt.NDArray[np.float64]: ...
    @property
    def target(self) -> npt.NDArray[np.float32]: ...
    @property
    def complex(self) -> npt.NDArray[np.complex128]: ...
    @property
    def inputs(self) -> npt.NDArray[np.float32]: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Method:
    @staticmethod
    def of_command(command: str, *, seconds: float = 120.0) -> Method: ...
    @staticmethod
    def of_function(
        function: Callable[..., Any],
        *,
        name: str | None = None,
        description: str = "",
        told: str = "",
        eta: float = 0.9,
        answers: Literal["lambda", "decades"] = "lambda",
        weights: str = "",
    ) -> Method: ...
    @property
    def name(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def told(self) -> str: ...
    @property
    def weights(self) -> str: ...
    @property
    def eta(self) -> float: ...
    def refusal(self, radar: Radar | None = None, *, layout: str | Sequence[int] | None = None) -> str | None: ...
    def __reduce__(self) -> tuple[Any, ...]: ...
    def reconstruct(
        self,
        ends: npt.ArrayLike,
        radar: Radar | None = None,
        *,
        layout: str | Sequence[int] | None = None,
        floor: str = "thesis",
        normalisation: str = "min-max",
        snapshot_range_metres: float | None = None,
        progress: _Progress | None = None,
    ) -> Reconstruction: ...

def _maps(samples: npt.ArrayLike, radar: Radar, normalisation: str, elements: Elements | None = None) -> Maps: ...
def _recording(
    name: str,
    notes: str,
    radar: Radar,
    samples: npt.ArrayLike | None,
    ends: npt.ArrayLike,
    missing: Sequence[int],
    range_metres: float | None,
    doubts: Sequence[str],
) -> Recording: ...
def _reconstruction(fields: dict[str, Any]) -> Reconstruction: ...

@final
class Reconstruction:
    @property
    def map(self) -> npt.NDArray[np.float32]: ...
    @property
    def eta(self) -> float: ...
    @property
    def doubt(self) -> npt.NDArray[np.float32] | None: ...
    @property
    def reflectors(self) -> npt.NDArray[np.float64]: ...
    @property
    def confidences(self) -> npt.NDArray[np.float64]: ...
    @property
    def detections(self) -> npt.NDArray[np.float64]: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Recording:
    @staticmethod
    def load(path: _Path) -> Recording: ...
    @staticmethod
    def open(path: _Path, config: _Path | None = None) -> Recording: ...
    @staticmethod
    def preset(name: str) -> Recording: ...
    @staticmethod
    def presets() -> list[str]: ...
    @property
    def name(self) -> str: ...
    @property
    def notes(self) -> str: ...
    @property
    def radar(self) -> Radar: ...
    @property
    def samples(self) -> npt.NDArray[np.complex128] | None: ...
    @property
    def ends(self) -> npt.NDArray[np.complex128]: ...
    @property
    def missing(self) -> list[int]: ...
    @property
    def range_metres(self) -> float | None: ...
    @property
    def doubts(self) -> list[str]: ...
    @property
    def floor(self) -> str: ...
    def maps(self, *, normalisation: str = "db=60") -> Maps: ...

@final
class Examples:
    def __new__(
        cls,
        mixture: str,
        seed: int = 0,
        *,
        purpose: _Purpose = "training",
        floor: str = "thesis",
        thermal: tuple[float, float, float] | None = None,
        elements: tuple[float, float, float, float] | None = None,
        radar: Radar | Literal["random"] | None = None,
        targets: Sequence[str] | None = None,
        features: bool | None = None,
        layout: str | Sequence[int] | None = None,
    ) -> Examples: ...
    @property
    def domain(self) -> str: ...
    @property
    def has_features(self) -> bool: ...
    def radar(self, index: SupportsIndex) -> Radar: ...
    def batch(
        self, indices: Sequence[SupportsIndex], *, mag_phase: bool = False, scenes: Sequence[Scene] | None = None
    ) -> list[dict[str, Any]]: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

def dataset(
    folder: _Path,
    sets: Iterable[str | int],
    *,
    count: int,
    validation: int | None = None,
    test: int | None = None,
    seed: int = 0,
    floor: str = "thesis",
    thermal: tuple[float, float, float] | None = None,
    elements: tuple[float, float, float, float] | None = None,
    radar: Radar | Literal["random"] | None = None,
    layout: str | Sequence[int] | None = None,
    dtype: Literal["f16", "f32"] = "f16",
    arrays: Sequence[Literal["ends", "features", "target_ideal", "target_measured", "target_calibrated"]] | None = None,
    shard: int = 64,
    progress: _Progress | None = None,
) -> None: ...
def live_input(ends: npt.ArrayLike, radar: Radar | None = None) -> dict[str, Any]: ...
def maps(samples: npt.ArrayLike, radar: Radar | None = None, *, normalisation: str = "min-max") -> Maps: ...
def range_doppler(
    scene: Scene,
    radar: Radar | None = None,
    *,
    floor: str = "thesis",
    seed: int | None = None,
    seconds: float = 0.0,
    progress: _Progress | None = None,
) -> npt.NDArray[np.float64]: ...
def chirp_samples(
    scene: Scene,
    radar: Radar | None = None,
    *,
    floor: str = "thesis",
    seed: int | None = None,
    seconds: float = 0.0,
    progress: _Progress | None = None,
) -> npt.NDArray[np.complex128]: ...
def kinds(*, training: bool = False) -> list[str]: ...
def method(name: str, *, weights: _Path | None = None, called: str | None = None) -> Method: ...
def methods() -> list[str]: ...
def metrics(target: npt.ArrayLike, output: npt.ArrayLike, eta: float, *, has_echoes: bool = True) -> Metrics: ...
def roc(
    target: npt.ArrayLike, output: npt.ArrayLike
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64]]: ...
def cfar(power: npt.ArrayLike, detector: str = "ca") -> npt.NDArray[np.bool_]: ...
def evaluate(
    methods: Sequence[_Method],
    scenes: Sequence[str | int | Scene],
    *,
    count: int = 100,
    seed: int = 0,
    floor: str = "thesis",
    normalisation: str = "min-max",
    purpose: _Purpose = "test",
    reading: _Reading = "program",
    radar: Radar | None = None,
    elements: Elements | tuple[float, float, float] | None = None,
    target: _Target = "measured",
    layout: str | Sequence[int] | None = None,
    on_row: Callable[[dict[str, Any]], object] | None = None,
    progress: _Progress | None = None,
    path: _Path | None = None,
    overwrite: bool = False,
    only: Sequence[tuple[str, int, str]] | None = None,
    cfar: str | None = None,
) -> list[dict[str, Any]]: ...
def robustness(
    methods: Sequence[_Method],
    set: str | int,
    *,
    gain_db: float = 0.5,
    phase_degrees: float = 10.0,
    position_millimetres: float = 0.0,
    scales: Sequence[float] | None = None,
    count: int = 5,
    seed: int = 0,
    floor: str = "thesis",
    radar: Radar | None = None,
    layout: str | Sequence[int] | None = None,
    calibrate: bool = False,
    progress: _Progress | None = None,
) -> list[dict[str, Any]]: ...
def threshold(
    method: _Method | None = None,
    *,
    false_alarm_percent: float = 1.0,
    sets: Sequence[str | int] | None = None,
    count: int = 100,
    seed: int = 0,
    floor: str = "thesis",
    normalisation: str = "min-max",
    radar: Radar | None = None,
    layout: str | Sequence[int] | None = None,
    progress: _Progress | None = None,
) -> Threshold: ...
def read_rows(path: _Path) -> list[dict[str, Any]]: ...
def paired(rows: Sequence[dict[str, Any]], first: str, second: str) -> Paired: ...
def write_rows(path: _Path, rows: Sequence[dict[str, Any]]) -> None: ...
def layout(name: str, radar: Radar | None = None) -> list[int]: ...
def cramer_rao(
    reflectors: npt.ArrayLike,
    snr_db: float,
    radar: Radar | None = None,
    *,
    layout: str = "two-ends",
    gains: Literal["one", "per-end"] = "one",
) -> list[PositionBound]: ...
def ambiguity(
    x_metres: float,
    y_metres: float,
    range_metres: npt.ArrayLike,
    cos_theta: npt.ArrayLike,
    radar: Radar | None = None,
    *,
    layout: str = "two-ends",
) -> npt.NDArray[np.float64]: ...
def built_elements(
    gain_db: float, phase_degrees: float, position_millimetres: float, seed: int, radar: Radar | None = None
) -> Elements: ...
def set_threads(count: int) -> None: ...
def threads() -> int: ...
