"""Entries of the benchmark: read, held against each other, and as tables."""

from __future__ import annotations

import hashlib
import json
import math
import re
import statistics
from pathlib import Path
from typing import Any, Mapping, Sequence

from ._suites import SCENES, SEED, SUITES, VERSION

#: Figures of a scene, in the order of tables.
FIGURES = ("squared_error", "detection", "false_alarm", "detection_at_rate")

#: Relative differences of figures below this one are the last bits of another machine.
LAST_BITS = 1e-3

#: How often a mean lies farther than two standard errors from the true one by chance, where it is that of many numbers.
BEYOND_TWO_ERRORS = 0.0455

#: Scores of one suite: its name, its number of scenes, and a list of numbers for each figure, or why the method refuses.
Row = dict[str, Any]

#: Rows of the draws "first" and "second".
Draws = Mapping[str, Sequence[Row]]


def mean_and_error(values: Sequence[float]) -> tuple[float, float]:
    """Mean, and its standard error, which is 0 for a single value."""
    spread = statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else 0.0
    return statistics.fmean(values), spread


def second_seed(first: Sequence[Row]) -> int:
    """The seed of the second draw: of the mean squared errors of the first, to two digits.

    Names, weights and last bits change nothing: only a method that scores otherwise has another second draw.
    """
    coarse = [[row["suite"], f"{statistics.fmean(row['squared_error']):.1e}" if "squared_error" in row else "refused"] for row in first]
    text = json.dumps({"version": VERSION, "seed": SEED, "first": coarse})
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:6], "big")


def digest_of(found: dict[str, Any]) -> str:
    """SHA-256 of everything in an entry but this: it tells slips of the pen; `--check` tells intent."""
    text = json.dumps({name: value for name, value in found.items() if name != "sha256"}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def text_of(found: dict[str, Any]) -> str:
    """An entry as JSON, each list of numbers in one line."""
    return re.sub(r"\[\n[^\[\]{}\"]*\]", lambda part: " ".join(part[0].split()).replace("[ ", "[").replace(" ]", "]"), json.dumps(found, indent=1)) + "\n"


def read_entry(path: Path) -> dict[str, Any]:
    """A whole entry of this version.

    Raises:
        ValueError: It is no entry, of another version, not whole, or was changed; the message says which.
        OSError: It can't be read.
    """
    try:
        found = json.loads(path.read_text())
        version = found["apertura_benchmark"]
        if version != VERSION:
            raise ValueError(f"{path} is of version {version} of the benchmark; this package has version {VERSION}")
        wrong = _wrong_with(found)
    except (KeyError, TypeError, AttributeError, IndexError, json.JSONDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path} is no entry of the benchmark: {error!r}") from None
    if wrong:
        raise ValueError(f"{path}: {wrong}")
    return dict(found)


def _wrong_with(found: dict[str, Any]) -> str | None:
    """Why an entry is not one as this command writes it."""
    names = [suite.name for suite in SUITES]
    for half in ("first", "second"):
        told = [row["suite"] for row in found[half]["suites"]]
        if told != names:
            unlike = [f"no {name}" for name in names if name not in told] + [f"an unknown {name}" for name in told if name not in names]
            return f"the {half} draw has not the suites of version {VERSION}: {', '.join(unlike) or 'another order, or one twice'}"
        for row in found[half]["suites"]:
            always = ("squared_error", "false_alarm")
            lists = [] if "refused" in row else [row[name] for name in FIGURES if name in always or row[name] is not None]
            if row["scenes"] != SCENES or any(len(values) != SCENES or not all(math.isfinite(value) for value in values) for values in lists):
                return f"the {half} draw has not {SCENES} scenes of {row['suite']}"
    if found["is_whole"] is not True:
        return "is_whole is not true, though all suites are there: it was changed"
    first, second = found["first"]["seed"], found["second"]["seed"]
    if first != SEED:
        return f"the first draw is of seed {first}; version {VERSION} has {SEED}"
    if second != second_seed(found["first"]["suites"]):
        return "it was changed: the seed of its second draw does not follow from the first draw's figures"
    if found["sha256"] != digest_of(found):
        return "it was changed after it was written: its SHA-256 is another one"
    return None


def _part_within(t: float, freedom: int) -> float:
    """How often Student's t lies between -t and t (Abramowitz and Stegun, 26.7.3 and 26.7.4)."""
    angle = math.atan2(t, math.sqrt(freedom))
    term, total = math.cos(angle) ** (freedom % 2), 0.0
    for power in range(freedom % 2, freedom - 1, 2):
        total += term
        term *= (power + 1) / (power + 2) * math.cos(angle) ** 2
    total *= math.sin(angle)
    return 2 / math.pi * (angle + total) if freedom % 2 else total


def errors_allowed(scenes: int, comparisons: int) -> float:
    """Standard errors of `scenes` differences that the mean of one comparison may be off: of all comparisons together one is farther off by chance no
    more often than a single normal mean is off by two (Student's t, by Bonferroni)."""
    low, high = 0.0, 1e6
    while high - low > 1e-6 * high:
        middle = (low + high) / 2
        low, high = (low, middle) if _part_within(middle, scenes - 1) > 1 - BEYOND_TWO_ERRORS / max(comparisons, 1) else (middle, high)
    return high


def differences(told: Draws, found: Draws) -> list[str]:
    """Where figures differ: the mean of a suite by more than last bits, and by more than the paired standard errors that chance explains.

    Args:
        told: Rows of each draw of an entry.
        found: Rows of the same suites and seeds, of as many scenes or fewer: the entry's first ones are compared.
    """
    wrong, compared = [], []
    for half, rows in found.items():
        for a, b in zip(told[half], rows, strict=True):
            where = f"{half} draw, {a['suite']}"
            if ("refused" in a) != ("refused" in b):
                wrong.append(f"{where}: refused {'in the entry' if 'refused' in a else 'here'} alone: {a.get('refused') or b['refused']}")
            for name in FIGURES if "refused" not in a and "refused" not in b else ():
                if (a[name] is None) != (b[name] is None):
                    wrong.append(f"{where}: {name} is there on one side alone")
                elif a[name] is not None:
                    compared.append((f"{where}: {name}", a[name][: b["scenes"]], b[name]))
    differing = [(where, x, y) for where, x, y in compared if any(not math.isclose(*both, rel_tol=LAST_BITS) for both in zip(x, y, strict=True))]
    for where, x, y in differing:
        apart, error = mean_and_error([here - there for there, here in zip(x, y, strict=True)])
        mean = statistics.fmean(x)
        tolerance = max(errors_allowed(len(x), len(differing)) * error, LAST_BITS * abs(mean))
        if abs(apart) > tolerance:
            wrong.append(f"{where} is {mean:.6g} in the entry and {mean + apart:.6g} here; expected within {tolerance:.2g}")
    return wrong


def _pooled(scores: Sequence[float]) -> float:
    """One z of the z of each suite."""
    return sum(scores) / math.sqrt(len(scores)) if scores else 0.0


def _apart(told: Sequence[Row], found: Sequence[Row]) -> list[list[float]]:
    """Squared errors here minus those of the entry for each scene of each suite; differences of last bits are 0."""
    both = [(a["squared_error"], b["squared_error"]) for a, b in zip(told, found, strict=True) if "refused" not in a and "refused" not in b]
    return [[0.0 if math.isclose(x, y, rel_tol=LAST_BITS) else y - x for x, y in zip(there, here)] for there, here in both]


def changed_scenes(told: Sequence[Row], found: Sequence[Row]) -> int:
    """Scenes whose squared error differs by more than last bits."""
    return sum(part != 0 for parts in _apart(told, found) for part in parts)


def paired_z(told: Sequence[Row], found: Sequence[Row]) -> float:
    """How much worse the squared errors are here than in an entry, pooled over the suites that differ by more than last bits."""
    means = [mean_and_error(parts) for parts in _apart(told, found) if any(parts)]
    return _pooled([mean / (error or abs(mean)) for mean, error in means])


def pooled_z(later: Sequence[Row], *earlier: Sequence[Row]) -> float:
    """How much worse the squared errors of a draw are than those of draws before it, pooled over suites: about normal, of variance 1, where a method
    was tuned on none of them. Scenes of different draws are no pairs."""
    scores = []
    for row, *others in zip(later, *earlier, strict=True):
        if all("squared_error" in each for each in (row, *others)):
            here, error = mean_and_error(row["squared_error"])
            there, other_error = mean_and_error([value for other in others for value in other["squared_error"]])
            scores.append((here - there) / (math.hypot(error, other_error) or 1.0))
    return _pooled(scores)


def _percent(values: Sequence[float] | None) -> str:
    return "-" if values is None else f"{100 * statistics.fmean(values):.2f}"


def table(found: dict[str, Any]) -> str:
    """An entry as text: mean SE of both draws, P_D and P_FA of the first."""
    lines = [f"{found['method']['name']}{'' if found['is_whole'] else ' (a part of the benchmark: no entry)'}"]
    lines.append(f"{'suite':28} {'SE':>9} {'SE 2':>9} {'P_D %':>7} {'P_FA %':>7} {'P_D % at P_FA':>15} {'ms':>8}")
    rates = {suite.name: suite.rate for suite in SUITES}
    for a, b in zip(found["first"]["suites"], found["second"]["suites"], strict=True):
        if "refused" in a or "refused" in b:
            lines.append(f"{a['suite']:28} {a.get('refused') or b['refused']}")
            continue
        at = "-" if a["detection_at_rate"] is None else f"{_percent(a['detection_at_rate'])} at {100 * rates[a['suite']]:.2f}"
        first, second = (statistics.fmean(row["squared_error"]) for row in (a, b))
        lines.append(
            f"{a['suite']:28} {first:9.1f} {second:9.1f} {_percent(a['detection']):>7} {_percent(a['false_alarm']):>7} {at:>15} "
            f"{a['median_milliseconds']:8.1f}"
        )
    lines.append(f"second draw against the first: z = {pooled_z(found['second']['suites'], found['first']['suites']):+.2f}")
    return "\n".join(lines)


def markdown(entries: Sequence[dict[str, Any]]) -> str:
    """A table of entries: mean SE of both draws together with its standard error."""
    lines = ["| | " + " | ".join(f"`{found['method']['name']}`" for found in entries) + " |", "|---" * (len(entries) + 1) + "|"]
    for index, suite in enumerate(SUITES):
        cells = []
        for found in entries:
            rows = [found[half]["suites"][index] for half in ("first", "second")]
            if any("refused" in row for row in rows):
                cells.append("refused")
            else:
                mean, error = mean_and_error([value for row in rows for value in row["squared_error"]])
                cells.append(f"{mean:.0f} ± {error:.0f}")
        lines.append(f"| {suite.name} | " + " | ".join(cells) + " |")
    z = [f"{pooled_z(found['second']['suites'], found['first']['suites']):+.2f}" for found in entries]
    lines.append("| z of the second draw against the first | " + " | ".join(z) + " |")
    return "\n".join(lines)
