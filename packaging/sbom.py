"""A bill of materials in CycloneDX, by cargo-cyclonedx."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from common import ROOT, run, version


def write(folder: Path, triple: str) -> list[Path]:
    """The bill in `folder`; none, and a sentence, where the tool is not installed."""
    if shutil.which("cargo-cyclonedx") is None:
        print("package: no bill of materials: `cargo install --locked cargo-cyclonedx` installs the tool for it", file=sys.stderr)
        return []
    made = ROOT / "apertura-bill.json"
    run("cargo", "cyclonedx", "--format", "json", "--target", triple, "--override-filename", "apertura-bill")
    path = folder / f"apertura-{version()}.cdx.json"
    shutil.move(made, path)
    return [path]
