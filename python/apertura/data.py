"""Datasets that `apertura dataset` or `apertura.dataset` wrote, for NumPy and PyTorch."""

from __future__ import annotations

import hashlib
import json
import operator
import os
from bisect import bisect_right
from itertools import accumulate
from pathlib import Path
from typing import Any, Literal

import numpy as np

from ._apertura import Radar

#: Versions of the manifest that are read. Before version 2 the only target had no name.
_VERSIONS = (1, 2)


class Example(dict[str, Any]):
    """One example, by the names of its arrays."""

    def __missing__(self, name: str) -> Any:
        if name != "target":
            raise KeyError(name)
        there = ", ".join(key for key in self if key.startswith("target_")) or "none"
        raise KeyError(
            "a target has a name: target_ideal (the array as it should be, without noise) or target_measured (what the whole array heard); "
            f"this example has {there}"
        )


class Files:
    """One split of a dataset on disk, as a map-style dataset: a `torch.utils.data.DataLoader` takes it as it is.

    Item `i` is a dict of arrays: those that were written of `ends` complex128 `[2, end_elements, samples]` (or `heard` `[elements of the layout,
    samples]`), `fine` `[4, 512, 256]`, `coarse` `[10, 512, 64]`, `rows` `[6, 512]`, `scalars` `[2]`, `constants` `[6]` and the targets `target_ideal`,
    `target_measured` and `target_calibrated` `[samples, elements]`, and `gain`. Halves become float32. Files are mapped into memory: nothing is
    read before it is asked for, and worker processes share what was. The target of a dataset of version 1 is its `target_measured`.

    Args:
        folder: The dataset's folder.
        split: "train", "validation" or "test".
        check: Whether to compare every file with its SHA-256 first, which reads all of them.

    Raises:
        FileNotFoundError: There is no manifest, or a file of it is missing.
        ValueError: The manifest has another version, the split is unknown, or a file is not the one that was written.
    """

    def __init__(self, folder: str | os.PathLike[str], split: Literal["train", "validation", "test"] = "train", *, check: bool = False) -> None:
        self._folder = Path(folder)
        path = self._folder / "manifest.json"
        if not path.exists():
            raise FileNotFoundError(f"{path}: there is no such file; expected the manifest of a dataset that was written to its end")
        try:
            self.manifest: dict[str, Any] = json.loads(path.read_text())
            version, splits = self.manifest["apertura_dataset"], self.manifest["splits"]
        except (ValueError, KeyError, TypeError) as error:
            raise ValueError(f"{path} is no manifest of a dataset: {error}") from None
        if version not in _VERSIONS:
            raise ValueError(f"{path} has version {version}; this package reads versions {_VERSIONS[0]} to {_VERSIONS[-1]}")
        if split not in splits:
            raise ValueError(f"split is {split!r}; expected {', '.join(splits)}")
        self._shards: list[dict[str, Any]] = splits[split]
        if version == 1:
            self._shards = [{**shard, "files": {_named(name): file for name, file in shard["files"].items()}} for shard in self._shards]
        self._ends = list(accumulate(shard["examples"] for shard in self._shards))
        self._open: dict[tuple[int, str], Any] = {}
        for shard in self._shards:
            for file in shard["files"].values():
                self._check(file, check)

    def _check(self, file: dict[str, Any], whole: bool) -> None:
        path = self._folder / file["name"]
        if not path.is_file():
            raise FileNotFoundError(f"{path}: there is no such file; the manifest names it")
        if path.stat().st_size != file["bytes"]:
            raise ValueError(f"{path} has {path.stat().st_size} bytes; the manifest says {file['bytes']}")
        if whole:
            with path.open("rb") as opened:
                found = hashlib.file_digest(opened, "sha256").hexdigest() if hasattr(hashlib, "file_digest") else _digest(opened)
            if found != file["sha256"]:
                raise ValueError(f"{path} has SHA-256 {found}; the manifest says {file['sha256']}")

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0

    def __getitem__(self, index: int) -> dict[str, Any]:
        """Example `index`; negative numbers count from the end.

        Raises:
            IndexError: There are not as many.
        """
        shard, row = self._place(index)
        example = Example()
        for name in self._shards[shard]["files"]:
            value = self._array(shard, name)[row]
            example[name] = value.astype(np.float32) if value.dtype == np.float16 else np.array(value)
        return example

    def kind(self, index: int) -> str:
        """Kind of the scene of example `index`."""
        shard, row = self._place(index)
        return str(self._shards[shard]["kinds"][row])

    def radar(self, index: int) -> Radar:
        """The radar that saw example `index`."""
        shard, row = self._place(index)
        drawn = self._shards[shard].get("radars")
        fields: dict[str, Any] = drawn[row] if drawn else self.manifest["radar"]
        return Radar(**fields)

    def _place(self, index: int) -> tuple[int, int]:
        number = operator.index(index)
        if not -len(self) <= number < len(self):
            raise IndexError(f"example {number} is asked for; there are {len(self)}")
        number %= len(self)
        shard = bisect_right(self._ends, number)
        return shard, number - (self._ends[shard - 1] if shard else 0)

    def _array(self, shard: int, name: str) -> Any:
        key = (shard, name)
        if key not in self._open:
            self._open[key] = np.load(self._folder / self._shards[shard]["files"][name]["name"], mmap_mode="r")
        return self._open[key]

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_open": {}}

    def __repr__(self) -> str:
        return f"Files({str(self._folder)!r}: {len(self)} examples)"


def _named(array: str) -> str:
    """Name of an array of version 1. No element was off then."""
    return "target_measured" if array == "target" else array


def _digest(opened: Any) -> str:
    digest = hashlib.sha256()
    while piece := opened.read(1 << 20):
        digest.update(piece)
    return digest.hexdigest()
