"""The rows of a campaign that goes on: a file that lines are appended to, and the table it becomes."""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path
from typing import Any, Iterable, Iterator

from ._apertura import ROW_COLUMNS, write_rows

#: Set, number of the scene, method.
Key = tuple[str, int, str]

#: What made a row: the same for all rows of a set and a method.
PARTS = tuple(name for name, _, is_of_origin in ROW_COLUMNS if is_of_origin)

#: The format of the journal.
VERSION = 1


#: Bytes; rows have some 500.
_LONGEST_LINE = 1 << 20


class Journal:
    """Beside the table: one line of JSON a row, whole as soon as it is found. The first line says which run it is.

    Raises:
        ValueError: The file is of another run, or damaged.
        OSError: It can't be read or written.
    """

    def __init__(self, path: Path, run: dict[str, Any]) -> None:
        self.path = path
        self.rows: dict[Key, dict[str, Any]] = {}
        self._origins: dict[str, dict[str, Any]] = {}
        head = {"apertura_campaign": VERSION, **run}
        if path.exists() and not path.is_file():
            raise ValueError(f"{path} is no file; expected the name of a file")
        whole = self._read(head) if path.exists() else 0
        self._file = path.open("r+b" if path.exists() else "x+b")
        self._file.truncate(whole)
        self._file.seek(whole)
        if whole == 0:
            self._append(head)
            self._file.flush()

    def _read(self, head: dict[str, Any]) -> int:
        """Reads what is there; how many bytes its whole lines have."""
        whole = 0
        with self.path.open("rb") as file:
            for number, line in enumerate(iter(lambda: file.readline(_LONGEST_LINE), b""), 1):
                if len(line) == _LONGEST_LINE:
                    raise ValueError(f"{self.path}: line {number} is no row of a campaign; remove the file to begin anew")
                if not line.endswith(b"\n"):
                    # The writer was stopped within a line.
                    break
                try:
                    entry = json.loads(line)
                except ValueError:
                    raise ValueError(f"{self.path}: line {number} is no row of a campaign; remove the file to begin anew") from None
                if number == 1:
                    for name in {*head, *entry}:
                        if head.get(name) != entry.get(name):
                            raise ValueError(
                                f"{self.path} is of another campaign: {name} is {entry.get(name)!r} there and {head.get(name)!r} here; "
                                "name another file, or remove this one"
                            )
                elif "origin" in entry:
                    self._origins[entry["origin"]] = entry["parts"]
                else:
                    self.rows[key_of(entry)] = {**entry, **self._origins.get(_origin(entry), {})}
                whole += len(line)
        return whole

    def add(self, rows: Iterable[dict[str, Any]]) -> None:
        """Appends rows that are not there yet."""
        for row in rows:
            if key_of(row) in self.rows:
                continue
            if row.get("error") is None and _origin(row) not in self._origins:
                self._origins[_origin(row)] = {part: row[part] for part in PARTS}
                self._append({"origin": _origin(row), "parts": self._origins[_origin(row)]})
            self._append({name: value for name, value in row.items() if name not in PARTS})
            # Rows share the dict of their conditions: a row takes half the memory then.
            self.rows[key_of(row)] = {**row, **self._origins.get(_origin(row), {})} if row.get("error") is None else row
        self._file.flush()

    def _append(self, entry: dict[str, Any]) -> None:
        self._file.write(json.dumps(entry).encode() + b"\n")

    def close(self) -> None:
        self._file.close()


def key_of(row: dict[str, Any]) -> Key:
    return row["set"], row["index"], row["method"]


def _origin(row: dict[str, Any]) -> str:
    return f"{row['set']} by {row['method']}"


def sorted_rows(rows: dict[Key, dict[str, Any]], keys: Iterable[Key]) -> Iterator[dict[str, Any]]:
    return (rows[key] for key in keys if key in rows)


def write_table(path: Path, rows: list[dict[str, Any]]) -> None:
    """Writes the table in one step: CSV in the program's format, with failures in a file beside it, or Parquet with a column `error`."""
    if path.suffix == ".parquet":
        _write_parquet(path, rows)
        return
    failed = [row for row in rows if row.get("error") is not None]
    write_rows(path, [row for row in rows if row.get("error") is None])
    beside = errors_path(path)
    if failed:
        part = beside.with_name(beside.name + ".part")
        with part.open("w", newline="") as file:
            writer = csv.DictWriter(file, ["set", "index", "seed", "method", "error"])
            writer.writeheader()
            writer.writerows(failed)
        os.replace(part, beside)
    elif beside.exists():
        beside.unlink()


def errors_path(path: Path) -> Path:
    return path.with_name(f"{path.stem}.errors.csv")


def _write_parquet(path: Path, rows: list[dict[str, Any]]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    names = list(dict.fromkeys(name for row in rows for name in row))
    types = {str: pa.string(), int: pa.int64(), float: pa.float64()}
    type_of = {name: types[kind] for name, kind, _ in ROW_COLUMNS} | {"seed": pa.uint64(), "error": pa.string()}
    columns = {name: pa.array([row.get(name) for row in rows], type_of[name]) for name in [*names, *({"error"} - {*names})]}
    part = path.with_name(path.name + ".part")
    pq.write_table(pa.table(columns), part)
    os.replace(part, path)


def read_table(path: Path) -> list[dict[str, Any]]:
    """Rows of a Parquet file that a campaign wrote."""
    import pyarrow.parquet as pq

    return list(pq.read_table(path).to_pylist())
