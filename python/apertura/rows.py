"""Rows of evaluations as files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from . import _apertura


def read_rows(path: str | os.PathLike[str]) -> list[dict[str, Any]]:
    """Reads the rows of `apertura evaluate --rows`, of `evaluate(path=...)` or of a campaign.

    Args:
        path: A CSV file, or one of Parquet (`.parquet`), which a campaign writes; that needs `pyarrow`. Rows of Parquet that hold an error in place of
            figures are left out.

    Returns:
        One dict a row, as `evaluate` gives them; figures that an older table does not say are None, and texts empty.

    Raises:
        OSError: The file can't be read.
        ValueError: It is no such table; the message names the line and column.
        ImportError: It is of Parquet, and `pyarrow` isn't installed.
    """
    if Path(path).suffix != ".parquet":
        return _apertura.read_rows(path)
    from ._journal import read_table

    try:
        rows = read_table(Path(path))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    if not all({"set", "index", "method"} <= row.keys() for row in rows):
        raise ValueError(f"{path}: it has no rows of an evaluation; expected the columns set, index and method")
    lacking = {name: "" if kind is str else None for name, kind, _ in _apertura.ROW_COLUMNS}
    return [{name: row.get(name, usual) for name, usual in lacking.items()} for row in rows if row.get("error") is None]
