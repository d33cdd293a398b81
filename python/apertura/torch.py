"""A dataset for PyTorch. PyTorch itself is loaded when the first example is asked for."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any, Callable, Literal, Sequence, SupportsIndex

import numpy as np

from ._apertura import Examples, Radar, Scene
from .data import Example
from .objects import ArgumentError

if TYPE_CHECKING:
    import torch as _torch

#: What of an example is no tensor.
_OTHER = ("gain", "kind", "floor", "radar")


class Scenes:
    """Examples to train on, as a map-style dataset: example `i` is a function of (mixture, seed, i) alone.

    No worker needs a seed of its own. Any number of workers and processes gives the same examples, started by fork, spawn or forkserver, and a
    run that was stopped goes on by index. A forked worker computes on one thread (`apertura.set_threads` changes that there), so that as many
    workers as processors keep all of them busy.

    Args:
        mixture: Kinds of scenes (`apertura.kinds()`) with their shares, as in "3" or "1=4,2=12,walls=8".
        seed: Seed of the examples.
        length: How many examples the dataset has; at most 2^32.
        purpose: "training", "validation" or "test": their scenes never meet.
        floor: What lies beneath all scenes: "thesis", "exact", "thermal", "snr=DB" or "dbm=LEVEL".
        thermal: (share, lowest dB, highest dB), in place of `floor`: this share of the scenes lies over thermal noise at a ratio drawn between
            the two, the others over the thesis' floor.
        network: Whose input the examples have beside the samples: "live", "thesis", or "none". Where nothing is said, that of the live network
            before radars of its shape (1024 elements, ends of 12, 512 samples), and none before others.
        elements: (share, gain in decibels, phase in degrees, place in millimetres): this share of the scenes is heard by elements that are off.
            Each such scene has its own part of these standard deviations, uniform from none to all.
        radar: The `Radar` that sees all scenes; "random" for one drawn for each scene, as `Examples` says; that of table 3.1 where none is given.
        targets: The maps to learn, of "ideal", "measured" and "calibrated".
        layout: Name or numbers of the elements that are heard in place of the two ends (`apertura.layout`).
        scene: Makes the scenes in place of `mixture`: called as `scene(random, radar)` with a `numpy.random.Generator`, which is a function of seed,
            purpose and number of the example, and the example's `Radar`; it returns a `Scene`. Its noise is picked by seed, purpose and number.
        transform: Called with each example; what it returns is the example.

    An example is a dict of tensors. `ends` is complex64 `[2, end_elements, samples]`; with `layout` there is `heard` complex64 `[elements of the layout,
    samples]` in its place. `target_ideal` is the map of the array as it should be, without noise; `target_measured` that of what the whole array heard;
    `target_calibrated` that of the array as it should be over the noise, which the live network learns. Each is float32 `[samples, elements]`,
    decades of amplitude, and cos(theta) rises with its column (`Radar.rising_columns`). The live network's input is `fine` float32 `[4, samples, 256]`,
    `coarse` float32 `[10, samples, 64]`, `rows` float32 `[6, samples]`, `scalars` float32 `[2]` and `constants` float32 `[6]`; the thesis' networks' is
    `mag_phase` float32 `[4, samples, elements]`. Samples and targets are relative to the samples' mean power; the rounding of complex64 covers the
    thesis' floor in the samples, and in nothing else.

    Raises:
        ValueError: A name is unknown, a number can't be used, or a kind finds no room before the radar.
    """

    def __init__(
        self,
        mixture: str | int = "world",
        seed: int = 0,
        *,
        length: int = 1 << 20,
        purpose: str = "training",
        floor: str = "thesis",
        thermal: tuple[float, float, float] | None = None,
        network: Literal["live", "thesis", "none"] | None = None,
        elements: tuple[float, float, float, float] | None = None,
        radar: Radar | Literal["random"] | None = None,
        targets: Sequence[str] = ("ideal", "measured"),
        layout: str | Sequence[int] | None = None,
        scene: Callable[[np.random.Generator, Radar], Scene] | None = None,
        transform: Callable[[dict[str, Any]], Any] | None = None,
    ) -> None:
        if network not in (None, "live", "thesis", "none"):
            raise ValueError(f'network is {network!r}; expected "live", "thesis" or "none"')
        if network == "thesis" and layout not in (None, "two-ends"):
            raise ValueError("the thesis' networks hear two ends; expected no layout, or another network")
        for name, function in (("scene", scene), ("transform", transform)):
            if function is not None and not callable(function):
                raise ValueError(f"{name} is {function!r}; expected a function")
        self._network, self._scene, self._transform = network, scene, transform
        if not isinstance(length, SupportsIndex) or not 1 <= operator.index(length) <= 1 << 32:
            raise ArgumentError(f"length is {length!r}; expected a whole number from 1 to {1 << 32}")
        length = operator.index(length)
        self._length = length
        self._arguments: dict[str, Any] = {
            # A function may make scenes that no kind has room for.
            "mixture": str(mixture) if scene is None else "1",
            "seed": seed,
            "purpose": purpose,
            "floor": floor,
            "thermal": thermal,
            "elements": elements,
            "radar": radar,
            "targets": [targets] if isinstance(targets, str) else list(targets),
            "features": {None: None, "live": True}.get(network, False),
            "layout": layout,
        }
        self._examples: Examples | None = Examples(**self._arguments)

    def __len__(self) -> int:
        return self._length

    @property
    def domain(self) -> str:
        """The radars that a network which learns from these examples is trained for, as JSON: a weight file's entry `domain`."""
        return self._made().domain

    def __getitem__(self, index: int) -> Any:
        """Example `index`; negative numbers count from the end.

        Raises:
            IndexError: There are not as many.
            ValueError: The example can't be made.
        """
        return self.__getitems__([index])[0]

    def __getitems__(self, indices: Sequence[int]) -> list[Any]:
        """Several examples, made in parallel: what a DataLoader asks for."""
        import torch

        tensors = ({name: torch.from_numpy(v) for name, v in example.items() if name not in _OTHER} for example in self._batch(indices))
        examples: list[dict[str, _torch.Tensor]] = [Example(each) for each in tensors]
        return examples if self._transform is None else [self._transform(example) for example in examples]

    def arrays(self, index: int) -> dict[str, Any]:
        """Example `index` as NumPy arrays, with its `gain`, `kind`, `floor` and `radar`, as it is before `transform`; this needs no PyTorch."""
        return self._batch([index])[0]

    def _batch(self, indices: Sequence[int]) -> list[dict[str, Any]]:
        numbers = [self._number(index) for index in indices]
        scenes = None if self._scene is None else [self._own(number) for number in numbers]
        made = self._made().batch(numbers, mag_phase=self._network == "thesis", scenes=scenes)
        return [Example(example) for example in made]

    def _own(self, number: int) -> Scene:
        """The scene that `scene` makes for an example."""
        assert self._scene is not None
        purpose = ("training", "validation", "test").index(self._arguments["purpose"])
        random = np.random.default_rng([self._arguments["seed"], purpose, number])
        made = self._scene(random, self._made().radar(number))
        if not isinstance(made, Scene):
            raise ValueError(f"example {number}: scene returned {made!r}; expected a Scene")
        return made

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
        return {**self.__dict__, "_examples": None}

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={value!r}" for name, value in self._arguments.items())
        return f"Scenes({given}, length={self._length})"
