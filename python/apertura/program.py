"""The window: the program `apertura`, if it is there."""

from __future__ import annotations

import atexit
import importlib.metadata
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import suppress
from pathlib import Path

from ._apertura import Scene

#: Longest that the program takes to read a scene, in seconds.
_READING_SECONDS = 5.0

_NAME = "apertura.exe" if sys.platform == "win32" else "apertura"


def find_program() -> str:
    """Path of the program: $APERTURA_PROGRAM, beside this module, where pip put it, beside the Python that runs, or on PATH.

    Raises:
        FileNotFoundError: It is in none of these places, or what $APERTURA_PROGRAM names is no program; the message says how to get it.
    """
    named = os.environ.get("APERTURA_PROGRAM")
    if named:
        if not (os.path.isfile(named) and os.access(named, os.X_OK)):
            raise FileNotFoundError(f"APERTURA_PROGRAM is {named}, which is no program; expected the path of apertura, or nothing")
        return named
    beside = [Path(__file__).parent / "bin" / _NAME, Path(sys.executable).parent / _NAME]
    for path in [beside[0], *_of_wheel(), beside[1]]:
        if path.is_file() and os.access(path, os.X_OK):
            return str(path)
    found = shutil.which(_NAME)
    if found is None:
        raise FileNotFoundError(
            f'the program "{_NAME}" is neither beside this module nor on PATH; `cargo install --path .` in the repository of apertura, or a '
            "release of it, provides it"
        )
    return found


def _of_wheel() -> list[Path]:
    """Where pip put the program of a wheel: a place of its own for each way to install."""
    try:
        files = importlib.metadata.files("apertura") or []
    except importlib.metadata.PackageNotFoundError:
        return []
    # pip notes the place from the folder of modules: "../../../bin/apertura".
    return [Path(os.path.normpath(str(file.locate()))) for file in files if file.name == _NAME]


def open(scene: Scene | str | os.PathLike[str]) -> subprocess.Popen[bytes]:
    """Opens the window on a scene, or on the file of a scene or a recording, and does not wait for it.

    A scene is written to a temporary file, which is removed when the program or Python ends: save what is changed in the window under another
    name. Where it was saved to the temporary file, that stays. A Python that ends at once waits until the program has read the scene, 5 seconds.

    Returns:
        The process of the program.

    Raises:
        FileNotFoundError: The program, or the file, is not there.
        ValueError: The scene can't be written as TOML.
    """
    program = find_program()
    if isinstance(scene, Scene):
        return _open_copy(program, scene)
    path = Path(scene)
    if not path.exists():
        raise FileNotFoundError(f"{path}: there is no such file")
    return subprocess.Popen([program, str(path)])


def _open_copy(program: str, scene: Scene) -> subprocess.Popen[bytes]:
    """Opens the window on a temporary file with the scene."""
    folder = Path(tempfile.mkdtemp(prefix="apertura-"))
    path = folder / "scene.toml"
    try:
        scene.save(path)
        written = path.stat().st_mtime_ns
        process = subprocess.Popen([program, str(path)])
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    started, owner, removal = time.monotonic(), os.getpid(), threading.Lock()

    def remove() -> None:
        # What was saved from the window is not thrown away.
        with removal, suppress(OSError):
            if path.stat().st_mtime_ns == written:
                shutil.rmtree(folder, ignore_errors=True)

    def at_exit() -> None:
        # A fork of this process ends on its own.
        if os.getpid() != owner:
            return
        while process.poll() is None and time.monotonic() < started + _READING_SECONDS:
            time.sleep(0.02)
        remove()

    def at_end() -> None:
        process.wait()
        remove()

    atexit.register(at_exit)
    threading.Thread(target=at_end, name="apertura-window", daemon=True).start()
    return process
