"""A function of one's own as a method of the program: `docs/own-network.md` says what goes over the two pipes."""

from __future__ import annotations

import inspect
import io
import json
import os
import sys
import traceback
from dataclasses import dataclass
from typing import Any, BinaryIO, Callable, Literal, Mapping

import numpy as np
import numpy.typing as npt

from ._apertura import Radar
from .objects import ArgumentError

VERSION = 1


@dataclass(frozen=True)
class Request:
    """What a method is told beside the samples and the radar.

    `noise` is "thesis" (rounding), "exact" (none), "white" (of a level that is unknown) or "white=SIGMA"; `normalisation` is "min-max" or
    "db=RANGE"; `snapshot_range_metres` is where the echoes of a single sample come from, if it is known.
    """

    noise: str
    normalisation: str
    snapshot_range_metres: float | None


def serve(
    function: Callable[..., Any],
    *,
    name: str | None = None,
    description: str = "",
    told: str = "",
    eta: float = 0.9,
    answers: Literal["lambda", "decades"] = "lambda",
    weights: str = "",
) -> None:
    """Answers the program's questions by `function` until it asks no more: `apertura --method-command "python my_network.py"`.

    What `function` prints goes to standard error. An exception in it becomes the answer, and the next question is waited for.

    Args:
        function: Called as `function(ends, radar)` or `function(ends, radar, request)`: complex128 `[2, end_elements, samples]`, whose largest
            real or imaginary part lies between 1 and 2, a `Radar` and a `Request`. It returns a map, numbers `[samples, elements]`, or a
            pair of a map and its threshold. A tensor of PyTorch will do.
        name: Name of the method: letters, digits, "-", "_" and "."; the file's name without its ending where none is given.
        description: One sentence for lists.
        told: What it knows beside samples and radar, such as what it was trained on.
        eta: Threshold of answers that bring none.
        answers: What a map holds: "lambda", 0 to 1, or "decades" of amplitude, which the program makes Lambda of.
        weights: Hexadecimal digits that tell these weights from others, such as the first 12 of their SHA-256; rows of an evaluation hold them.

    Raises:
        ArgumentError: `function` can't be called.
        ValueError: `answers` is neither of the two.
    """
    if not callable(function):
        raise ArgumentError(f"function is {function!r}; expected a function of ends and radar")
    if answers not in ("lambda", "decades"):
        raise ValueError(f'answers is {answers!r}; expected "lambda" or "decades"')
    source, sink = _pipes()
    greeting = {
        "name": name or os.path.splitext(os.path.basename(sys.argv[0] or "own"))[0],
        "description": description,
        "told": told,
        "eta": eta,
        "weights": weights,
    }
    takes_request = _takes_request(function)
    try:
        while (line := source.readline()) != b"":
            question = json.loads(line)
            arrays = {sent["name"]: np.load(io.BytesIO(_exactly(source, sent["bytes"]))) for sent in question.get("arrays", [])}
            if question.get("apertura") != VERSION:
                _send(sink, {"error": f"this is version {VERSION} of the protocol"}, question)
            elif question["ask"] == "hello":
                _send(sink, greeting, question)
            elif question["ask"] == "map":
                _answer(sink, function, takes_request, answers, question, arrays["ends"])
            else:
                _send(sink, {"error": f"it doesn't know the question {question['ask']!r}"}, question)
    except (BrokenPipeError, EOFError, KeyboardInterrupt):
        # The program is gone.
        pass


def _pipes() -> tuple[BinaryIO, BinaryIO]:
    """Standard input and output; other writers to standard output write on standard error from now on."""
    sys.stdout.flush()
    sink = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return sys.stdin.buffer, sink


def _takes_request(function: Callable[..., Any]) -> bool:
    try:
        inspect.signature(function).bind(None, None, None)
    except (TypeError, ValueError):
        return False
    return True


def _exactly(source: BinaryIO, count: int) -> bytes:
    found = source.read(count)
    if len(found) < count:
        raise EOFError
    return found


def _answer(
    sink: BinaryIO,
    function: Callable[..., Any],
    takes_request: bool,
    answers: str,
    question: Mapping[str, Any],
    ends: npt.NDArray[np.complex128],
) -> None:
    try:
        told = [Request(question["noise"], question["normalisation"], question["snapshot_range_metres"])] if takes_request else []
        found = function(ends, Radar(**question["radar"]), *told)
        found, eta = found if isinstance(found, tuple) else (found, None)
        said = {} if eta is None else {"eta": float(eta)}
        cells = _cells(found)
    except Exception as error:
        traceback.print_exc()
        _send(sink, {"error": f"{type(error).__name__}: {error}"}, question)
        return
    _send(sink, said, question, {answers: cells})


def called(
    function: Callable[..., Any], ends: npt.NDArray[np.complex128], radar: Radar, told: tuple[str, str, float | None]
) -> tuple[npt.NDArray[Any], float | None]:
    """What a method of this process answers: its map, and its threshold where it has one."""
    found = function(ends, radar, Request(*told)) if _takes_request(function) else function(ends, radar)
    found, eta = found if isinstance(found, tuple) else (found, None)
    return _cells(found), None if eta is None else float(eta)


def _cells(found: Any) -> npt.NDArray[Any]:
    """The map as an array of float32 or float64."""
    if hasattr(found, "detach"):
        found = found.detach().cpu().numpy()
    cells = np.asarray(found)
    if cells.dtype.kind not in "fiub":
        raise TypeError(f"the map's dtype is {cells.dtype}; expected real numbers")
    return np.ascontiguousarray(cells, np.float64 if cells.dtype.itemsize > 4 and cells.dtype.kind == "f" else np.float32)


def _send(sink: BinaryIO, said: Mapping[str, Any], question: Mapping[str, Any], arrays: Mapping[str, npt.NDArray[Any]] | None = None) -> None:
    files: dict[str, bytes] = {}
    for name, array in (arrays or {}).items():
        written = io.BytesIO()
        np.save(written, array)
        files[name] = written.getvalue()
    listed = [{"name": name, "bytes": len(file)} for name, file in files.items()]
    sink.write(json.dumps({"apertura": VERSION, "id": question.get("id", 0), **said, "arrays": listed}).encode() + b"\n")
    for file in files.values():
        sink.write(file)
    sink.flush()
