"""A benchmark for super-resolution of sparse arrays: `python -m apertura.benchmark --method live -o live.json`.

Frozen scenes, one scorer, and an entry as one JSON file. `docs/benchmark.md` has the rules. `--check ENTRY.json` scores the same method again and compares.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import os
import platform
import statistics
import sys
import time
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any, Iterator, Sequence

import numpy as np

from . import _apertura
from .objects import Elements

#: Version of the benchmark: other scenes or another score are another version.
VERSION = 1

#: Seed of the frozen draw.
SEED = 20_260

#: Scenes of a suite.
SCENES = 20

#: False-alarm rates of "P_D at": the thesis' for its sets.
_RATES = {"1": 0.0037, "2": 0.0056, "3": 0.0102}


@dataclass(frozen=True)
class Suite:
    """Scenes of one kind over one floor. Of imperfect elements each array is another one."""

    name: str
    set: str
    floor: str = "thesis"
    imperfect: bool = False

    @property
    def rate(self) -> float:
        return _RATES.get(self.set, 0.01)

    def scenes(self, seed: int, count: int) -> Iterator[_apertura.Scene]:
        for index in range(count):
            scene = _apertura.Scene.random(self.set, seed, index)
            if self.imperfect:
                elements = Elements.built(gain_db=0.5, phase_degrees=5.0, position_millimetres=0.05, seed=(seed + index) % (1 << 63))
                scene = scene.replace(elements=elements)
            yield scene


SUITES = (
    *(Suite(f"set {set}", set) for set in ("1", "2", "3")),
    *(Suite(kind, kind) for kind in ("clusters", "walls", "spacings", "corner", "crowd", "dynamic", "near")),
    Suite("set 2 at 20 dB", "2", "snr=20"),
    Suite("set 3 at 40 dB", "3", "snr=40"),
    Suite("set 2, imperfect elements", "2", "snr=40", imperfect=True),
    Suite("noise alone", "noise", "dbm=-20"),
)


def scenes_hash(suite: Suite, seed: int, count: int) -> str:
    """SHA-256 of the scenes' files: the same on every machine."""
    digest = hashlib.sha256()
    for scene in suite.scenes(seed, count):
        digest.update(scene.to_toml().encode())
    return digest.hexdigest()


def samples_hash(suite: Suite, seed: int, count: int) -> str:
    """SHA-256 of the samples of both ends: the same bits on the same instruction set alone."""
    digest = hashlib.sha256()
    for scene in suite.scenes(seed, count):
        digest.update(np.ascontiguousarray(scene.simulate(floor=suite.floor).ends).tobytes())
    return digest.hexdigest()


def frozen() -> dict[str, Any]:
    """The hashes that came with the package."""
    found: dict[str, Any] = json.loads(resources.files(__package__).joinpath("benchmark.json").read_text())
    return found


def check_scenes(suites: Sequence[Suite] = SUITES) -> list[str]:
    """Names of the suites whose scenes are not the frozen ones."""
    hashes = frozen()["suites"]
    return [suite.name for suite in suites if hashes.get(suite.name, {}).get("scenes_sha256") != scenes_hash(suite, SEED, SCENES)]


def score(method: _apertura.Method, suite: Suite, seed: int, count: int) -> dict[str, Any]:
    """Mean figures of a method on a suite, with standard errors."""
    squares, detections, alarms, at_rate, times = [], [], [], [], []
    for scene in suite.scenes(seed, count):
        maps = scene.simulate(floor=suite.floor)
        target, ends = maps.target, maps.ends
        began = time.perf_counter()
        found = method.reconstruct(ends, floor=suite.floor)
        times.append(1e3 * (time.perf_counter() - began))
        metrics = _apertura.metrics(target, found.map, found.eta, has_echoes=suite.set != "noise")
        squares.append(metrics.squared_error)
        alarms.append(metrics.false_alarm)
        if metrics.detection is not None:
            detections.append(metrics.detection)
            at_rate.append(_detection_at(suite.rate, target, found.map))
    return {
        "suite": suite.name,
        "scenes": count,
        "squared_error": _mean(squares),
        "detection": _mean(detections),
        "false_alarm": _mean(alarms),
        "detection_at": {"false_alarm": suite.rate, **(_mean(at_rate) or {})} if at_rate else None,
        "median_milliseconds": statistics.median(times),
    }


def _detection_at(rate: float, target: Any, output: Any) -> float:
    """P_D at the smallest threshold whose P_FA is at most `rate`."""
    _, detection, false_alarm = _apertura.roc(target, output)
    allowed = np.flatnonzero(false_alarm <= rate)
    return float(detection[allowed[0]]) if allowed.size else 0.0


def _mean(values: Sequence[float]) -> dict[str, float] | None:
    if not values:
        return None
    spread = statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else 0.0
    return {"mean": statistics.fmean(values), "standard_error": spread}


def figures(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows without their times, which no two runs have in common."""
    return [{name: value for name, value in row.items() if name != "median_milliseconds"} for row in rows]


def second_seed(method: dict[str, Any], rows: Sequence[dict[str, Any]]) -> int:
    """The seed of the second draw: whoever enters can't choose it, as it depends on the whole first half of the entry."""
    text = json.dumps({"version": VERSION, "method": method, "first": figures(rows)}, sort_keys=True)
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:6], "big")


def entry(method: _apertura.Method, *, weights: str = "", scenes: int = SCENES, suites: Sequence[Suite] = SUITES) -> dict[str, Any]:
    """Scores a method on both draws: a whole entry where `scenes` and `suites` are the usual ones."""
    about = {"name": method.name, "description": method.description, "told": method.told, "eta": round(method.eta, 6), "weights": weights}
    first = [_scored(method, suite, SEED, scenes) for suite in suites]
    seed = second_seed(about, first)
    second = [_scored(method, suite, seed, scenes) for suite in suites]
    return {
        "apertura_benchmark": VERSION,
        "is_whole": scenes == SCENES and tuple(suites) == SUITES,
        "method": about,
        "machine": machine(),
        "first": {"seed": SEED, "suites": first},
        "second": {"seed": seed, "suites": second},
    }


def weights_of(method: str | None) -> str:
    """Digits that tell the weights of a method of this package from others, as rows of an evaluation hold them; none without weights."""
    return str(_apertura.evaluate([method], ["1"], count=1)[0]["weights"] or "") if method else ""


def _scored(method: _apertura.Method, suite: Suite, seed: int, scenes: int) -> dict[str, Any]:
    print(f"{suite.name}, seed {seed}", file=sys.stderr, flush=True)
    return score(method, suite, seed, scenes)


def machine() -> dict[str, Any]:
    """What the times were measured on."""
    processor = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        names = [line.split(":", 1)[1].strip() for line in cpuinfo.read_text().splitlines() if line.startswith("model name")]
        processor = names[0] if names else processor
    return {
        "processor": processor,
        "processors": os.cpu_count(),
        "threads": _apertura.threads(),
        "system": platform.system(),
        "instructions": os.environ.get("APERTURA_SIMD", "the best that the processor has"),
        "package": _apertura.__version__,
    }


def read_entry(path: Path) -> dict[str, Any]:
    """An entry, whose second seed follows from the rest.

    Raises:
        ValueError: It is no entry, of another version, or was changed.
        OSError: It can't be read.
    """
    try:
        found = json.loads(path.read_text())
        version, method, first, second = found["apertura_benchmark"], found["method"], found["first"], found["second"]
        rows, seed = first["suites"], second["seed"]
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{path} is no entry of the benchmark: {error!r}") from None
    if version != VERSION:
        raise ValueError(f"{path} is of version {version} of the benchmark; this package has version {VERSION}")
    if first["seed"] != SEED or seed != second_seed(method, rows):
        raise ValueError(f"{path} was changed: the seed of its second draw does not follow from the rest")
    return dict(found)


def differences(told: dict[str, Any], found: dict[str, Any], tolerance: float = 1e-3) -> list[str]:
    """Where an entry's mean figures differ by more than `tolerance`, relative; machines differ in last bits."""
    wrong = []
    for half in ("first", "second"):
        for a, b in zip(told[half]["suites"], found[half]["suites"], strict=True):
            for name in ("squared_error", "detection", "false_alarm", "detection_at"):
                x, y = (side[name]["mean"] if side[name] else None for side in (a, b))
                same = x == y if x is None or y is None else math.isclose(x, y, rel_tol=tolerance, abs_tol=tolerance)
                if not same:
                    wrong.append(f"{half} draw, {a['suite']}: {name} is {x} in the entry and {y} here")
    return wrong


def table(found: dict[str, Any]) -> str:
    """An entry as text: mean SE, P_D and P_FA of both draws."""
    lines = [f"{found['method']['name']}{'' if found['is_whole'] else ' (a part of the benchmark: no entry)'}"]
    lines.append(f"{'suite':28} {'SE':>9} {'SE 2':>9} {'P_D %':>7} {'P_FA %':>7} {'P_D % at P_FA':>15} {'ms':>8}")
    for a, b in zip(found["first"]["suites"], found["second"]["suites"], strict=True):
        percent = lambda part: "-" if part is None else f"{100 * part['mean']:.2f}"
        at = f"{percent(a['detection_at'])} at {100 * a['detection_at']['false_alarm']:.2f}" if a["detection_at"] else "-"
        lines.append(
            f"{a['suite']:28} {a['squared_error']['mean']:9.1f} {b['squared_error']['mean']:9.1f} {percent(a['detection']):>7} "
            f"{percent(a['false_alarm']):>7} {at:>15} {a['median_milliseconds']:8.1f}"
        )
    return "\n".join(lines)


def _check(path: Path, method: _apertura.Method) -> None:
    told = read_entry(path)
    if told["method"]["name"] != method.name:
        raise ValueError(f"{path} is of {told['method']['name']}; the method here is {method.name}")
    rows = told["first"]["suites"]
    known = {suite.name: suite for suite in SUITES}
    suites = [known[row["suite"]] for row in rows if row["suite"] in known]
    # The second draw is that of the entry, whatever the last bits of the first are here.
    scenes = rows[0]["scenes"]
    found = {
        "first": {"suites": [_scored(method, suite, SEED, scenes) for suite in suites]},
        "second": {"suites": [_scored(method, suite, told["second"]["seed"], scenes) for suite in suites]},
    }
    wrong = differences(told, found)
    if wrong:
        raise ValueError("the figures are not those of the entry:\n  " + "\n  ".join(wrong))
    print(f"{path}: the figures are those of the entry")


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m apertura.benchmark", description=(__doc__ or "").split("\n\n")[1])
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--method", help="name of a method")
    which.add_argument("--method-command", metavar="COMMAND", help="a program of your own (docs/own-network.md)")
    which.add_argument("--freeze", action="store_true", help="print the hashes of the frozen scenes, and stop")
    parser.add_argument("--weights", default="", help="digits that tell these weights from others, for the entry; those of a method of this package are known")
    parser.add_argument("-o", "--output", type=Path, help="the entry to write")
    parser.add_argument("--check", type=Path, metavar="ENTRY", help="score again and compare with this entry")
    parser.add_argument("--scenes", type=int, default=SCENES, help="scenes of a suite; fewer make no entry")
    given = parser.parse_args(arguments)
    if given.freeze:
        hashes = {s.name: {"scenes_sha256": scenes_hash(s, SEED, SCENES), "samples_sha256": samples_hash(s, SEED, SCENES)} for s in SUITES}
        print(json.dumps({"apertura_benchmark": VERSION, "seed": SEED, "scenes": SCENES, "suites": hashes}, indent=1))
        return
    try:
        if given.scenes < 1:
            raise ValueError(f"--scenes is {given.scenes}; expected at least 1")
        changed = check_scenes()
        if changed:
            raise ValueError(f"the scenes of {', '.join(changed)} are not the frozen ones; a benchmark of other scenes needs another version")
        method = _apertura.Method.of_command(given.method_command, seconds=300) if given.method_command else _apertura.method(given.method)
        if given.check:
            _check(given.check, method)
            return
        found = entry(method, weights=given.weights or weights_of(given.method), scenes=given.scenes)
        print(table(found))
        if given.output:
            part = given.output.with_name(given.output.name + ".part")
            part.write_text(json.dumps(found, indent=1) + "\n")
            os.replace(part, given.output)
    except (ValueError, OSError) as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
