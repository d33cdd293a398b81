"""Sparse layouts: which elements of an array are heard."""

from __future__ import annotations

import numpy as np

from ._apertura import Radar


def layout(name: str, radar: Radar | None = None) -> list[int]:
    """Numbers of the elements of a layout, in rising order.

    Args:
        name: "two-ends"; "nested=AxB", A neighbours and B elements A + 1 apart (Pal and Vaidyanathan 2010); "coprime=MxN", N elements M apart and 2 M
            elements N apart (Vaidyanathan and Pal 2011); "thinned=K", every K-th element; "random=N" or "random=N:SEED", N elements with the
            outermost two among them.
        radar: The radar; that of table 3.1 where none is given.

    Raises:
        ValueError: The name is unknown, or the array is too short.
    """
    radar = radar or Radar()
    kind, _, numbers = name.partition("=")
    try:
        found = _places(kind, numbers, radar)
    except ValueError:
        found = None
    if found is None:
        raise ValueError(f'layout is "{name}"; expected two-ends, nested=AxB, coprime=MxN, thinned=K, random=N or random=N:SEED, with whole numbers from 1')
    if found[-1] >= radar.elements:
        raise ValueError(f'layout "{name}" reaches to element {found[-1]}; the radar has elements 0 to {radar.elements - 1}')
    return found


def _places(kind: str, numbers: str, radar: Radar) -> list[int] | None:
    """The elements; None where the name is none."""
    if kind == "two-ends" and not numbers:
        return [*range(radar.end_elements), *range(max(radar.end_elements, radar.elements - radar.end_elements), radar.elements)]
    if kind == "random":
        count, _, seed = numbers.partition(":")
        if not 2 <= int(count) <= radar.elements:
            return None
        inner = np.random.default_rng(int(seed or 0)).choice(np.arange(1, radar.elements - 1), int(count) - 2, replace=False)
        return sorted([0, radar.elements - 1, *map(int, inner)])
    if kind == "thinned":
        return [*range(0, radar.elements, int(numbers))] if int(numbers) > 0 else None
    if kind not in ("nested", "coprime"):
        return None
    a, b = (int(number) for number in numbers.split("x"))
    if min(a, b) < 1:
        return None
    if kind == "nested":
        return [*range(a), *(k * (a + 1) - 1 for k in range(1, b + 1))]
    return sorted({*range(0, a * b, a), *range(0, 2 * a * b, b)})
