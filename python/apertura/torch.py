"""A dataset for PyTorch. PyTorch itself is loaded when the first example is asked for."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any, Literal, Sequence

from ._apertura import Examples, Radar

if TYPE_CHECKING:
    import torch as _torch

_TENSORS = {"live": ("ends", "fine", "coarse", "rows", "scalars", "constants", "target"), "thesis": ("ends", "mag_phase", "target")}


class Scenes:
    """Examples for the live network, as a map-style dataset: example `i` is a function of (mixture, seed, i) alone.

    No worker needs a seed of its own. Any number of workers and processes gives the same examples, started by fork, spawn or forkserver, and a
    run that was stopped goes on by index. A forked worker computes on one thread (`apertura.set_threads` changes that there), so that as many
    workers as processors keep all of them busy.

    Args:
        set: Kinds of scenes with their shares, as in "3" or "1=4,2=12,walls=8".
        seed: Seed of the examples.
        length: How many examples the dataset has; at most 2^32.
        purpose: "training", "validation" or "test": their scenes never meet.
        floor: What lies beneath all scenes: "thesis", "exact", "thermal", "snr=DB" or "dbm=LEVEL".
        thermal: (share, lowest dB, highest dB), in place of `floor`: this share of the scenes lies over thermal noise at a ratio drawn between
            the two, the others over the thesis' floor.
        network: Whose input the examples have: "live" or "thesis".
        elements: (share, gain in decibels, phase in degrees, place in millimetres): this share of the scenes is heard by elements that are off.
            Each such scene has its own part of these standard deviations, uniform from none to all. `target` stays that of the array as it
            should be.
        radar: The `Radar` that sees all scenes, with 1024 elements, ends of 12 and 512 samples; "random" for one drawn for each scene, as
            `Examples` says; that of table 3.1 where none is given.

    An example is a dict of tensors: `ends` complex64 `[2, 12, 512]`, the network's input `fine` float32 `[4, 512, 256]`, `coarse` float32
    `[10, 512, 64]`, `rows` float32 `[6, 512]`, `scalars` float32 `[2]` and `constants` float32 `[6]`, and `target` float32 `[512, 1024]`, decades of amplitude of the
    whole array's map. With `network="thesis"` the input is `mag_phase` float32 `[4, 512, 1024]`. Ends and target are relative to the samples'
    mean power; the rounding of complex64 covers the thesis' floor in `ends`, and in nothing else.

    Raises:
        ValueError: A name is unknown or a number can't be used.
    """

    def __init__(
        self,
        set: str | int,
        seed: int = 0,
        *,
        length: int = 1 << 20,
        purpose: str = "training",
        floor: str = "thesis",
        thermal: tuple[float, float, float] | None = None,
        network: Literal["live", "thesis"] = "live",
        elements: tuple[float, float, float, float] | None = None,
        radar: Radar | Literal["random"] | None = None,
    ) -> None:
        if network not in _TENSORS:
            raise ValueError(f'network is {network!r}; expected "live" or "thesis"')
        self._network = network
        length = operator.index(length)
        if not 1 <= length <= 1 << 32:
            raise ValueError(f"length is {length}; expected 1 to {1 << 32}")
        self._length = length
        self._arguments: dict[str, Any] = {
            "mixture": str(set),
            "seed": seed,
            "purpose": purpose,
            "floor": floor,
            "thermal": thermal,
            "elements": elements,
            "radar": radar,
        }
        self._examples: Examples | None = Examples(**self._arguments)

    def __len__(self) -> int:
        return self._length

    @property
    def domain(self) -> str:
        """The radars that a network which learns from these examples is trained for, as JSON: a weight file's entry `domain`."""
        return self._made().domain

    def __getitem__(self, index: int) -> dict[str, _torch.Tensor]:
        """Example `index`; negative numbers count from the end.

        Raises:
            IndexError: There are not as many.
            ValueError: The example can't be made.
        """
        return self.__getitems__([index])[0]

    def __getitems__(self, indices: Sequence[int]) -> list[dict[str, _torch.Tensor]]:
        """Several examples, made in parallel: what a DataLoader asks for."""
        import torch

        return [{name: torch.from_numpy(example[name]) for name in _TENSORS[self._network]} for example in self._batch(indices)]

    def arrays(self, index: int) -> dict[str, Any]:
        """Example `index` as NumPy arrays, with its `gain`, `kind` and `floor`; this needs no PyTorch."""
        return self._batch([index])[0]

    def _batch(self, indices: Sequence[int]) -> list[dict[str, Any]]:
        numbers = [self._number(index) for index in indices]
        return self._made().batch(numbers, mag_phase=self._network == "thesis")

    def _number(self, index: int) -> int:
        number = operator.index(index)
        if not -self._length <= number < self._length:
            raise IndexError(f"example {number} is asked for; there are {self._length}")
        return number % self._length

    def _made(self) -> Examples:
        if self._examples is None:
            self._examples = Examples(**self._arguments)
        return self._examples

    def __getstate__(self) -> dict[str, Any]:
        return {"_length": self._length, "_network": self._network, "_arguments": self._arguments, "_examples": None}

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={value!r}" for name, value in self._arguments.items())
        return f"Scenes({given}, length={self._length})"
