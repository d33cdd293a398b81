"""What every package needs to know: the version, the machine, how a command is run."""

from __future__ import annotations

import os
import platform
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
#: The oldest C library that the packages run on: that of Debian 10, Ubuntu 20.04 and RHEL 8.
GLIBC = "2.28"
SYSTEM = {"Linux": "linux", "Darwin": "macos", "Windows": "windows"}.get(platform.system(), platform.system().lower())
MACHINE = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
EXE = ".exe" if SYSTEM == "windows" else ""


class Fault(Exception):
    """A package can't be made; the message says why and what would help."""


def version() -> str:
    return tomllib.loads((ROOT / "Cargo.toml").read_text())["package"]["version"]


def name() -> str:
    """What every archive is called, less its ending: apertura-0.2.0-linux-x86_64."""
    return f"apertura-{version()}-{SYSTEM}-{MACHINE}"


def run(*command: str | Path, **environment: str) -> None:
    """Runs a command in the repository; a failure of it ends the script."""
    words = [str(word) for word in command]
    print("package:", " ".join(words), file=sys.stderr, flush=True)
    subprocess.run(words, cwd=ROOT, env={**os.environ, **environment}, check=True)


def output(*command: str | Path) -> str:
    return subprocess.run([str(word) for word in command], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def target_folder() -> Path:
    """Where cargo builds."""
    return (ROOT / os.environ.get("CARGO_TARGET_DIR", "target")).resolve()


def moment() -> int:
    """Seconds since 1970 that every packed file is dated with: those of the commit, so that a second run packs the same bytes."""
    given = os.environ.get("SOURCE_DATE_EPOCH")
    return int(given) if given else int(output("git", "log", "-1", "--format=%ct"))


def window_libraries() -> list[str]:
    """Debian's packages of the libraries that the window loads when it opens: those of scripts/setup, less what builds."""
    found = re.search(r"^packages=\((.*)\)$", (ROOT / "scripts/setup").read_text(), re.MULTILINE)
    if found is None:
        raise Fault("scripts/setup has no line packages=(...)")
    return [package for package in found.group(1).split() if package not in ("gcc", "libc6-dev")]
