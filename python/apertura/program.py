"""The window: the program `apertura`, if it is there."""

from __future__ import annotations

import importlib.metadata
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from ._apertura import Scene

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

    A scene is written to a temporary file: what is changed in the window is kept where it is saved there.

    Returns:
        The process of the program.

    Raises:
        FileNotFoundError: The program, or the file, is not there.
        ValueError: The scene can't be written as TOML.
    """
    program = find_program()
    if isinstance(scene, Scene):
        folder = Path(tempfile.mkdtemp(prefix="apertura-"))
        path = folder / "scene.toml"
        scene.save(path)
    else:
        path = Path(scene)
        if not path.exists():
            raise FileNotFoundError(f"{path}: there is no such file")
    return subprocess.Popen([program, str(path)])
