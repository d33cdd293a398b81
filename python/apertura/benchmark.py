"""A benchmark for super-resolution of sparse arrays: `python -m apertura.benchmark --method live -o live.json`.

Frozen scenes, one scorer, and an entry as one JSON file. `docs/benchmark.md` has the rules. `--check ENTRY.json` scores the same method again, compares,
and draws scenes that the entry could not know.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import secrets
import statistics
import sys
import time
from pathlib import Path
from typing import Any, Sequence

import numpy as np

from . import _apertura
from ._entries import FIGURES, Row, changed_scenes, differences, digest_of, markdown, mean_and_error, paired_z, pooled_z
from ._entries import read_entry, second_seed, table, text_of
from ._suites import SCENES, SEED, SUITES, VERSION, Suite, check_scenes, samples_hash, scenes_hash, target_ideal
from .objects import ArgumentError

#: Methods of this package that docs/benchmark has entries of.
OWN = ("baseline", "capon", "iaa", "live", "nomp", "hybrid")

#: The pooled z of a third draw that one honest entry in a hundred exceeds.
LIMIT = 2.33


def score(method: _apertura.Method, suite: Suite, seed: int, count: int) -> Row:
    """Figures of a method for each scene of a suite, or why it refuses them."""
    figures: dict[str, list[float]] = {name: [] for name in FIGURES}
    times = []
    for scene in suite.scenes(seed, count):
        maps = scene.simulate(floor=suite.floor, normalisation=suite.normalisation)
        ends = maps.ends
        began = time.perf_counter()
        try:
            found = method.reconstruct(ends, scene.radar, floor=suite.floor, normalisation=suite.normalisation)
        except ValueError as error:
            return {"suite": suite.name, "scenes": count, "refused": str(error)}
        times.append(1e3 * (time.perf_counter() - began))
        target = target_ideal(scene, suite.normalisation) if suite.imperfect else maps.target
        metrics = _apertura.metrics(target, found.map, found.eta, has_echoes=suite.set != "noise")
        figures["squared_error"].append(metrics.squared_error)
        figures["false_alarm"].append(metrics.false_alarm)
        if metrics.detection is not None:
            figures["detection"].append(metrics.detection)
            figures["detection_at_rate"].append(_detection_at(suite.rate, target, found.map))
    kept = {name: [float(f"{value:.7g}") for value in values] or None for name, values in figures.items()}
    return {"suite": suite.name, "scenes": count, **kept, "median_milliseconds": round(statistics.median(times), 2)}


def _detection_at(rate: float, target: Any, output: Any) -> float:
    """P_D at the smallest threshold whose P_FA is at most `rate`."""
    _, detection, false_alarm = _apertura.roc(target, output)
    allowed = np.flatnonzero(false_alarm <= rate)
    return float(detection[allowed[0]]) if allowed.size else 0.0


def draw(method: _apertura.Method, seed: int, scenes: int = SCENES, suites: Sequence[Suite] = SUITES) -> dict[str, Any]:
    """Scores a method on every suite of one seed."""
    rows = []
    for suite in suites:
        row = score(method, suite, seed, scenes)
        rows.append(row)
        told = f"refused: {row['refused']}" if "refused" in row else f"SE {mean_and_error(row['squared_error'])[0]:.1f}"
        print(f"{method.name}, seed {seed}, {suite.name}: {told}", file=sys.stderr, flush=True)
    return {"seed": seed, "suites": rows}


def entry(method: _apertura.Method, *, weights: str = "", scenes: int = SCENES, suites: Sequence[Suite] = SUITES) -> dict[str, Any]:
    """Scores a method on both draws: a whole entry where `scenes` and `suites` are the usual ones."""
    if not isinstance(method, _apertura.Method):
        raise ArgumentError(f"method is {method!r}; expected a Method, as apertura.method gives it")
    if not 1 <= scenes <= SCENES:
        raise ValueError(f"scenes is {scenes}; expected 1 to {SCENES}")
    first = draw(method, SEED, scenes, suites)
    found = {
        "apertura_benchmark": VERSION,
        "is_whole": scenes == SCENES and tuple(suites) == SUITES,
        "method": {"name": method.name, "description": method.description, "told": method.told, "eta": round(method.eta, 6), "weights": weights},
        "machine": machine(),
        "first": first,
        "second": draw(method, second_seed(first["suites"]), scenes, suites),
    }
    return found | {"sha256": digest_of(found)}


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


def check(path: Path, method: _apertura.Method, weights: str, scenes: int = SCENES, seed: int | None = None) -> str:
    """Scores a method again, on the scenes of its entry and on a third draw.

    Args:
        path: The entry.
        method: The method that it is of.
        weights: Those of the method; "" where unknown.
        scenes: Scenes of each suite, at least 3. A third draw of fewer than all gives no verdict.
        seed: Seed of the third draw; a random one where none is given.

    Returns:
        What was found, as text.

    Raises:
        ValueError: The entry is not what the method scores here, or the third draw is worse than chance allows.
        OSError: The entry can't be read.
    """
    told = read_entry(path)
    here = {"name": method.name, "eta": round(method.eta, 6), "weights": weights or told["method"]["weights"]}
    for name, value in here.items():
        if told["method"][name] != value:
            raise ValueError(f"{path} is of a method whose {name} is {told['method'][name]}; here it is {value}")
    halves = ("first", "second")
    rows = {half: told[half]["suites"] for half in halves}
    found = {half: draw(method, told[half]["seed"], scenes, SUITES)["suites"] for half in halves}
    wrong = differences(rows, found)
    entered, here_again = rows["first"] + rows["second"], found["first"] + found["second"]
    better = paired_z(entered, here_again)
    if scenes == SCENES and better > LIMIT:
        wrong.append(f"squared errors are worse here on most suites: z = {better:.2f}, expected at most {LIMIT}")
    if wrong:
        raise ValueError(f"{path}: the figures are not those of the entry:\n  " + "\n  ".join(wrong))
    third = draw(method, secrets.randbits(48) if seed is None else seed, scenes, SUITES)
    z = pooled_z(third["suites"], *rows.values())
    drawn = f"The third draw, of seed {third['seed']}, is worse than both draws of the entry by z = {z:+.2f}; 99 of 100 honest entries are below {LIMIT}."
    if scenes == SCENES and z > LIMIT:
        raise ValueError(f"{path} was tuned on the scenes of its draws. {drawn}")
    changed = f"{changed_scenes(entered, here_again)} scenes differ by more than last bits."
    verdict = "" if scenes == SCENES else f" That is no verdict: it needs {SCENES} scenes of each suite."
    return f"{path}: the figures are those of the entry. {changed} {drawn}{verdict}"


def _freeze() -> str:
    if os.environ.get("APERTURA_SIMD") != "portable":
        raise ValueError("the hashes are of the samples with APERTURA_SIMD=portable: set it")
    suites = {suite.name: suite.conditions | {"scenes_sha256": scenes_hash(suite, SEED, SCENES)} for suite in SUITES}
    for suite in SUITES:
        suites[suite.name]["samples_sha256"] = samples_hash(suite, SEED, SCENES)
    return json.dumps({"apertura_benchmark": VERSION, "seed": SEED, "scenes": SCENES, "suites": suites}, indent=1)


def _write(path: Path, found: dict[str, Any]) -> None:
    part = path.with_name(path.name + ".part")
    part.write_text(text_of(found))
    os.replace(part, path)


def _run(given: argparse.Namespace) -> None:
    if given.freeze:
        print(_freeze())
        return
    if given.table:
        print(markdown([read_entry(path) for path in given.table]))
        return
    least = 3 if given.check else 1
    if given.scenes < least or given.scenes > SCENES:
        raise ValueError(f"--scenes is {given.scenes}; expected {least} to {SCENES}")
    if given.all and (given.check or not (given.output and given.output.is_dir())):
        raise ValueError("--all writes entries into a folder: expected -o FOLDER, and no --check")
    changed = check_scenes()
    if changed:
        raise ValueError(f"the scenes of {', '.join(changed)} are not the frozen ones; a benchmark of other scenes needs another version")
    for name in OWN if given.all else (given.method,):
        method = _apertura.Method.of_command(given.method_command, seconds=300) if name is None else _apertura.method(name)
        weights = given.weights or method.weights
        if given.check:
            print(check(given.check, method, weights, given.scenes, given.seed))
            return
        found = entry(method, weights=weights, scenes=given.scenes)
        print(table(found))
        if given.output:
            _write(given.output / f"{name}.json" if given.all else given.output, found)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m apertura.benchmark", description=(__doc__ or "").split("\n\n")[1])
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--method", help="name of a method")
    which.add_argument("--method-command", metavar="COMMAND", help="a program of your own (docs/own-network.md)")
    which.add_argument("--all", action="store_true", help=f"make the entries of {', '.join(OWN)}, into the folder of -o")
    which.add_argument("--table", type=Path, nargs="+", metavar="ENTRY", help="print these entries as a Markdown table, and stop")
    which.add_argument("--freeze", action="store_true", help="print the suites and the hashes of their scenes and samples, and stop")
    parser.add_argument("--weights", default="", help="digits that tell these weights from others, for the entry [default: those that the method says]")
    parser.add_argument("-o", "--output", type=Path, help="the entry to write; with --all, a folder")
    parser.add_argument("--check", type=Path, metavar="ENTRY", help="score again, compare with this entry, and score a third draw")
    parser.add_argument("--seed", type=int, help="seed of the third draw; random where none is given")
    parser.add_argument("--scenes", type=int, default=SCENES, help="scenes of a suite; fewer make no entry, and a check without a verdict")
    try:
        _run(parser.parse_args(arguments))
    except (ValueError, OSError) as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
