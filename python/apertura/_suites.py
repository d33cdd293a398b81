"""The scenes of the benchmark, frozen: `benchmark.json` has their hashes."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass
from importlib import resources
from typing import Any, Iterator, Literal, Sequence

import numpy as np
import numpy.typing as npt

from . import _apertura
from .objects import Elements

#: Version of the benchmark: other scenes or another score are another version.
VERSION = 2

#: Seed of the frozen draw.
SEED = 20_261

#: Scenes of a suite.
SCENES = 20

#: False-alarm rates of `detection_at_rate`: the thesis' for its sets.
_RATES = {"1": 0.0037, "2": 0.0056, "3": 0.0102}


@dataclass(frozen=True)
class Suite:
    """Scenes of one kind over one floor. Each array of imperfect elements is another one, and the target is that of ideal elements without noise."""

    name: str
    set: str
    floor: str = "thesis"
    normalisation: str = "min-max"
    convention: Literal["thesis", "physical"] = "thesis"
    imperfect: bool = False

    @property
    def rate(self) -> float:
        """False-alarm rate of `detection_at_rate`."""
        return _RATES.get(self.set, 0.01) if self.normalisation == "min-max" else 0.01

    @property
    def radar(self) -> _apertura.Radar:
        return _apertura.Radar(convention=self.convention, carrier_hz=77e9)

    @property
    def conditions(self) -> dict[str, Any]:
        """All but its name, as benchmark.json has it."""
        return {name: value for name, value in asdict(self).items() if name != "name"}

    def scenes(self, seed: int, count: int) -> Iterator[_apertura.Scene]:
        for index in range(count):
            scene = _apertura.Scene.random(self.set, seed, index, radar=self.radar)
            if self.imperfect:
                elements = Elements.built(gain_db=0.5, phase_degrees=5.0, position_millimetres=0.05, seed=(seed + index) % (1 << 63))
                scene = scene.replace(elements=elements)
            yield scene


SUITES = (
    *(Suite(f"set {set}", set) for set in ("1", "2", "3")),
    *(Suite(kind, kind) for kind in ("clusters", "walls", "spacings", "corner", "crowd", "dynamic", "near")),
    Suite("set 2 at 20 dB", "2", "snr=20"),
    Suite("set 3 at 40 dB", "3", "snr=40"),
    Suite("set 2, imperfect elements", "2", "snr=40", "db=60", imperfect=True),
    Suite("street, physical radar", "street", "thermal", "db=60", "physical"),
    Suite("noise alone", "noise", "dbm=-20"),
)


def target_ideal(scene: _apertura.Scene, normalisation: str) -> npt.NDArray[np.float32]:
    """Lambda of the whole array as it should be, `[samples, elements]`: of ideal elements, and without noise."""
    return scene.replace(elements=None).simulate(floor="exact", normalisation=normalisation).target


def scenes_hash(suite: Suite, seed: int, count: int) -> str:
    """SHA-256 of the scenes' files: the same on every machine."""
    digest = hashlib.sha256()
    for scene in suite.scenes(seed, count):
        digest.update(scene.to_toml().encode())
    return digest.hexdigest()


def samples_hash(suite: Suite, seed: int, count: int) -> str:
    """SHA-256 of the samples of both ends: the same bits with APERTURA_SIMD=portable."""
    digest = hashlib.sha256()
    for scene in suite.scenes(seed, count):
        digest.update(np.ascontiguousarray(scene.simulate(floor=suite.floor).ends).tobytes())
    return digest.hexdigest()


def frozen() -> dict[str, Any]:
    """The suites and hashes that came with the package."""
    found: dict[str, Any] = json.loads(resources.files(__package__).joinpath("benchmark.json").read_text())
    return found


def check_scenes(suites: Sequence[Suite] = SUITES) -> list[str]:
    """Names of the suites whose scenes or conditions are not the frozen ones."""
    kept = frozen()["suites"]
    now = {suite.name: suite.conditions | {"scenes_sha256": scenes_hash(suite, SEED, SCENES)} for suite in suites}
    return [name for name, conditions in now.items() if not conditions.items() <= kept.get(name, {}).items()]
