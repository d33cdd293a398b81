"""Methods on very many scenes, on Dask: `python -m apertura.campaign --methods live,hybrid --sets 1,2,3 --count 100000 --out rows.parquet`.

Without `--scheduler` it starts workers on this machine; with the address of a scheduler it uses that cluster, on whose machines this package is
installed. Rows are those of `apertura evaluate --rows`. A worker that dies loses its task, which another does again. A campaign that is started
again with the same arguments goes on where its rows end. A scene on which a method fails is a row with the error. `docs/scale.md` says what
a million scenes cost. Needs `pip install "dask[distributed]"`, and `pyarrow` for Parquet.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any, Callable, Iterator, Sequence

from . import _apertura
from ._journal import Journal, Key, sorted_rows, write_table

#: Scenes of a task: each task asks every method once more than it has rows, untimed.
SCENES_A_TASK = 16

#: Tasks that are handed out beyond those that run, for each worker thread.
AHEAD = 3

#: How often a task may be lost with its worker before its rows are tried one by one.
TRIES = 3


@dataclass(frozen=True)
class Run:
    """What a campaign is; two with equal fields have equal rows."""

    methods: tuple[str, ...]
    sets: tuple[str, ...]
    count: int
    seed: int = 0
    floor: str = "thesis"
    normalisation: str = "min-max"
    #: Programs of one's own (docs/own-network.md).
    commands: tuple[str, ...] = ()
    #: The radar; that of table 3.1 where none is given.
    radar: _apertura.Radar | None = None
    #: Standard deviations of the elements (gain in decibels, phase in degrees, place in millimetres), drawn for each scene.
    elements: tuple[float, float, float] | None = None
    #: What outputs are held against: "measured", "ideal" or "calibrated".
    target: str = "measured"
    #: Numbers of the elements that methods hear in place of the two ends.
    layout: tuple[int, ...] | None = None

    def keys(self) -> Iterator[Key]:
        """Every row, in the order of the table."""
        return ((s, i, method) for s in self.sets for i in range(self.count) for method in self.methods)

    def told(self) -> dict[str, Any]:
        """For the first line of a journal."""
        version = _apertura.__version__
        fields = {name: list(value) if isinstance(value, tuple) else value for name, value in vars(self).items()}
        usual = {"radar": None, "elements": None, "target": "measured", "layout": None}
        # Journals of earlier editions have none of these.
        fields = {name: value for name, value in fields.items() if name not in usual or value != usual[name]}
        if self.radar is not None:
            fields["radar"] = _apertura.Scene(radar=self.radar).to_toml()
        return {**fields, "program": version}

    def evaluate(self, only: Sequence[Key], on_row: Callable[[dict[str, Any]], object] | None = None) -> None:
        """Finds the rows of these keys.

        Raises:
            ValueError: A name is unknown, or a method can't work on a scene.
        """
        _apertura.evaluate(
            self.methods,
            self.sets,
            count=self.count,
            seed=self.seed,
            floor=self.floor,
            normalisation=self.normalisation,
            radar=self.radar,
            elements=self.elements,
            target=self.target,
            layout=self.layout,
            only=list(only),
            on_row=on_row,
        )


_STARTED: set[str] = set()


def start_commands(commands: Sequence[str], seconds: float = 300.0) -> list[str]:
    """Starts programs of one's own that this process hasn't started yet; the names of their methods."""
    names = []
    for command in commands:
        if command not in _STARTED:
            names.append(_apertura.Method.of_command(command, seconds=seconds).name)
            _STARTED.add(command)
    return names


def rows_of(run: Run, keys: Sequence[Key]) -> list[dict[str, Any]]:
    """The rows of these keys; a method that fails on a scene gives a row with the error. What a worker does."""
    _apertura.set_threads(1)
    start_commands(run.commands)
    found: dict[Key, dict[str, Any]] = {}

    def keep(row: dict[str, Any]) -> None:
        found[row["set"], row["index"], row["method"]] = row

    try:
        run.evaluate(keys, keep)
    except ValueError:
        # A row failed: the others run one by one, so that no failure hides another row.
        for key in keys:
            if key not in found:
                try:
                    run.evaluate([key], keep)
                except ValueError as error:
                    found[key] = failed(run, key, str(error))
    return [found[key] for key in keys]


def failed(run: Run, key: Key, error: str) -> dict[str, Any]:
    """A row without figures."""
    return {"set": key[0], "index": key[1], "seed": run.seed, "method": key[2], "error": error}


def tasks_of(run: Run, done: Any) -> Iterator[list[Key]]:
    """What is left to do, in tasks."""
    keys = (key for key in run.keys() if key not in done)
    while task := list(islice(keys, SCENES_A_TASK * len(run.methods))):
        yield task


class Progress:
    """Rows, rate and time left on standard error; one line that is drawn over on a terminal."""

    def __init__(self, done: int, of: int, seconds: float) -> None:
        self.began, self.first, self.done, self.of = time.monotonic(), done, done, of
        self.is_terminal = sys.stderr.isatty()
        self.every = 0.5 if self.is_terminal else seconds
        self.told = self.began

    def rows(self, count: int) -> None:
        self.done += count
        now = time.monotonic()
        if now - self.told >= self.every or self.done == self.of:
            self.told = now
            rate = (self.done - self.first) / max(now - self.began, 1e-9)
            left = (self.of - self.done) / rate if rate else 0.0
            line = f"{self.done} of {self.of} rows, {rate:.1f} a second, {duration(left)} left"
            print(f"\r{line}\x1b[K" if self.is_terminal else line, end="" if self.is_terminal else "\n", file=sys.stderr, flush=True)

    def close(self) -> None:
        if self.is_terminal:
            print(file=sys.stderr)


def duration(seconds: float) -> str:
    minutes, seconds = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {seconds:02} s"


def work(client: Any, run: Run, done: Any, on_rows: Callable[[list[dict[str, Any]]], None]) -> None:
    """Does what is left on a Dask client; `on_rows` gets the rows of each task once."""
    from dask.distributed import as_completed
    from distributed.scheduler import KilledWorker

    tasks = tasks_of(run, done)
    keys_of: dict[str, list[Key]] = {}

    def submit(keys: list[Key]) -> Any:
        future = client.submit(rows_of, run, keys, pure=False)
        keys_of[future.key] = keys
        return future

    threads = max(1, sum(client.nthreads().values()))
    waiting = as_completed([submit(keys) for keys in islice(tasks, AHEAD * threads)])
    for future in waiting:
        keys = keys_of.pop(future.key)
        error = future.exception()
        if error is None:
            on_rows(future.result())
        elif isinstance(error, KilledWorker) and len(keys) > 1:
            # One of these rows ends every worker that tries it.
            for key in keys:
                waiting.add(submit([key]))
        elif isinstance(error, KilledWorker):
            on_rows([failed(run, keys[0], f"it ended {TRIES} workers")])
        else:
            raise error
        future.release()
        for more in islice(tasks, 1):
            waiting.add(submit(more))


def hearing(run: Run) -> Run:
    """The run without methods that can't hear its layout; standard error names them.

    Raises:
        ValueError: No method can.
    """
    if run.layout is None:
        return run
    refusals = {name: _apertura.method(name).refusal(run.radar, layout=run.layout) for name in run.methods}
    able = tuple(name for name, refusal in refusals.items() if refusal is None)
    for refusal in filter(None, refusals.values()):
        if not able:
            raise ValueError(refusal)
        print(f"left out: {refusal}", file=sys.stderr)
    return replace(run, methods=able)


def _dask() -> None:
    try:
        import dask.distributed  # noqa: F401
    except ImportError as error:
        raise ImportError(f'a campaign needs Dask: pip install "dask[distributed]" ({error})') from None


def client_of(scheduler: str | None, workers: int | None) -> Any:
    """A client of the cluster at this address, or of workers on this machine."""
    import dask
    from dask.distributed import Client, LocalCluster

    # Dask gives a task up when it was lost more often than this. A scheduler of one's own has its own setting.
    dask.config.set({"distributed.scheduler.allowed-failures": TRIES - 1})
    if scheduler is not None:
        return Client(scheduler, timeout="30s")
    cluster = LocalCluster(n_workers=workers or os.cpu_count() or 1, threads_per_worker=1, processes=True, dashboard_address=":0")
    return Client(cluster)


def campaign(run: Run, out: Path, *, scheduler: str | None = None, workers: int | None = None, progress_seconds: float = 30.0) -> list[dict[str, Any]]:
    """Runs or goes on; writes the table to `out` once all rows are there.

    Raises:
        ValueError: A name is unknown, or a file of another campaign is there.
        OSError: A file can't be written, or the scheduler isn't there.
        ImportError: Dask, or pyarrow for Parquet, isn't installed.
    """
    out = Path(out)
    if out.suffix not in (".csv", ".parquet"):
        raise ValueError(f"{out}: expected a name that ends in .csv or .parquet")
    own = [name for name in run.methods if not isinstance(name, str)]
    if own:
        raise ValueError(f"methods holds {own[0]!r}; expected names: a campaign's workers start programs of one's own by `commands`")
    if out.suffix == ".parquet":
        import pyarrow  # noqa: F401  (told before the work, not after it)
    journal_path = out.with_name(out.name + ".journal")
    if out.exists() and not journal_path.exists():
        raise ValueError(f"{out} is there already; name another file, or remove it")
    start_commands(run.commands)
    run = hearing(run)
    # Names are checked before workers start.
    run.evaluate([])
    _dask()
    journal = Journal(journal_path, run.told())
    try:
        total = run.count * len(run.sets) * len(run.methods)
        if journal.rows:
            print(f"{journal_path} holds {len(journal.rows)} of {total} rows already: going on with the rest", file=sys.stderr)
        if len(journal.rows) < total:
            _work_on(journal, run, total, scheduler, workers, progress_seconds)
        rows = list(sorted_rows(journal.rows, run.keys()))
        write_table(out, rows)
    finally:
        journal.close()
    journal_path.unlink()
    return rows


def _work_on(journal: Journal, run: Run, total: int, scheduler: str | None, workers: int | None, seconds: float) -> None:
    client = client_of(scheduler, workers)
    try:
        print(f"dashboard: {client.dashboard_link}", file=sys.stderr)
        progress = Progress(len(journal.rows), total, seconds)

        def keep(rows: list[dict[str, Any]]) -> None:
            journal.add(rows)
            progress.rows(len(rows))

        work(client, run, frozenset(journal.rows), keep)
        progress.close()
    finally:
        cluster = client.cluster
        client.close()
        if scheduler is None and cluster is not None:
            cluster.close()


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(",") if name.strip())


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m apertura.campaign", description=(__doc__ or "").split("\n\n")[1])
    parser.add_argument("--methods", type=_names, default=(), help="names, separated by commas")
    parser.add_argument("--method-command", action="append", default=[], metavar="COMMAND", help="a program of your own as a method, for two ends; beside --methods its name is one of them")
    parser.add_argument("--sets", type=_names, required=True, help=f"kinds of scenes, separated by commas: {', '.join(_apertura.kinds())}")
    parser.add_argument("--count", type=int, required=True, help="scenes of each set")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--floor", default="thesis", help="thesis, exact, thermal, snr=DB or dbm=LEVEL")
    parser.add_argument("--radar", type=Path, metavar="FILE", help="a .toml with a table [radar], such as a scene [default: table 3.1]")
    parser.add_argument("--elements", type=float, nargs=3, metavar=("DB", "DEGREES", "MM"), help="elements that are off: standard deviations")
    parser.add_argument("--target", default="measured", choices=("measured", "ideal", "calibrated"), help="what outputs are held against")
    parser.add_argument("--layout", help="elements that methods hear in place of the two ends, as apertura.layout names them, such as nested=12x78")
    parser.add_argument("--normalisation", default="min-max", help="min-max or db=RANGE")
    parser.add_argument("--out", type=Path, required=True, help="the table to write: .csv or .parquet")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="a Dask cluster, such as tcp://host:8786; workers on this machine where none is given")
    parser.add_argument("--workers", type=int, help="worker processes on this machine [default: its processors]")
    parser.add_argument("--progress", type=float, default=30.0, metavar="SECONDS", help="between lines of progress where there is no terminal")
    given = parser.parse_args(arguments)
    try:
        own = start_commands(given.method_command)
        methods = given.methods or tuple(own)
        if not methods:
            parser.error("--methods or --method-command is needed")
        radar = _apertura.Radar.load(given.radar) if given.radar else None
        run = Run(
            methods,
            given.sets,
            given.count,
            given.seed,
            given.floor,
            given.normalisation,
            tuple(given.method_command),
            radar,
            tuple(given.elements) if given.elements else None,
            given.target,
            tuple(_apertura.layout(given.layout, radar)) if given.layout else None,
        )
        rows = campaign(run, given.out, scheduler=given.scheduler, workers=given.workers, progress_seconds=given.progress)
    except (ValueError, OSError, ImportError) as error:
        sys.exit(f"error: {error}")
    errors = sum(row.get("error") is not None for row in rows)
    print(f"wrote {given.out}: {len(rows)} rows" + (f", {errors} of them errors" if errors else ""))


if __name__ == "__main__":
    # Imported by its own name, so that workers import this module and start with nothing of this process.
    from apertura import campaign as own

    own.main()
