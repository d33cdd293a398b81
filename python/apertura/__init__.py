"""See what a 1024-element automotive radar sees, and how much of it 24 elements recover.

    import apertura as ap
    scene = ap.Scene.random("3", seed=7)
    maps = scene.simulate(floor="thesis")
    found = ap.method("hybrid").reconstruct(maps.ends)
    print(ap.metrics(maps.target, found.map, found.eta))

Maps are `[range bins, columns]`: row k is range `radar.range_metres[k]`, column k the direction `radar.cos_theta[k]`, which falls from column
to column under the two-way carrier: `map[:, radar.rising_columns]` has left on the left. An error of the library becomes
ValueError, one of a file OSError. Rust works without the interpreter's lock; Ctrl-C stops it. `python/README.md` says more.
"""

import importlib
from types import ModuleType

from . import data, torch
from ._apertura import (
    Examples,
    LinkBudget,
    Maps,
    Method,
    Radar,
    Reconstruction,
    Recording,
    Scene,
    __version__,
    ambiguity,
    cfar,
    chirp_samples,
    cramer_rao,
    dataset,
    evaluate,
    kinds,
    layout,
    live_input,
    maps,
    method,
    methods,
    metrics,
    paired,
    range_doppler,
    robustness,
    roc,
    set_threads,
    threads,
    threshold,
    write_rows,
)
from .objects import (
    ArgumentError,
    Box,
    Cluster,
    Elements,
    Interferer,
    Line,
    Metrics,
    Mirror,
    Paired,
    Point,
    Polygon,
    PositionBound,
    Post,
    Threshold,
    Wall,
)
from .page import Shown, find_page, show
from .program import find_program, open
from .rows import read_rows
from .serve import Request, serve



def __getattr__(name: str) -> ModuleType:
    # Loaded when they are asked for: `live` needs PyTorch, which takes seconds.
    if name in ("benchmark", "campaign", "live"):
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = [
    "ArgumentError",
    "Box",
    "Cluster",
    "Elements",
    "Examples",
    "Interferer",
    "Line",
    "LinkBudget",
    "Maps",
    "Method",
    "Metrics",
    "Mirror",
    "Paired",
    "Point",
    "Polygon",
    "PositionBound",
    "Post",
    "Radar",
    "Reconstruction",
    "Recording",
    "Request",
    "Scene",
    "Shown",
    "Threshold",
    "Wall",
    "__version__",
    "ambiguity",
    "cfar",
    "chirp_samples",
    "cramer_rao",
    "data",
    "dataset",
    "evaluate",
    "find_page",
    "find_program",
    "kinds",
    "layout",
    "live_input",
    "maps",
    "method",
    "methods",
    "metrics",
    "open",
    "paired",
    "range_doppler",
    "read_rows",
    "robustness",
    "roc",
    "serve",
    "set_threads",
    "show",
    "threads",
    "threshold",
    "torch",
    "write_rows",
]
