"""What is installed, laid out as below /usr: the same for the archive and the Debian package."""

from __future__ import annotations

import gzip
import os
import shutil
from pathlib import Path

from common import ROOT, moment, run

#: Where each shell looks for the completions that `apertura-manual` writes.
COMPLETIONS = {
    "apertura.bash": "bash-completion/completions/apertura",
    "apertura.fish": "fish/vendor_completions.d/apertura.fish",
    "_apertura": "zsh/vendor-completions/_apertura",
}


def lay(folder: Path, program: Path, manual: Path, notices: str) -> None:
    """Lays the tree into an empty `folder`."""
    shutil.rmtree(folder, ignore_errors=True)
    put(program, folder / "bin/apertura", mode=0o755)
    document = folder / "share/doc/apertura"
    for path in ("README.md", "LICENSE-MIT", "LICENSE-APACHE"):
        put(ROOT / path, document / path)
    write(document / "THIRD-PARTY.txt.gz", packed(notices.encode()))
    made = folder / "made"
    run(manual, made)
    for page in sorted((made / "man").iterdir()):
        write(folder / f"share/man/man1/{page.name}.gz", packed(page.read_bytes()))
    for file, place in COMPLETIONS.items():
        put(made / "completions" / file, folder / "share" / place)
    shutil.rmtree(made)
    put(ROOT / "packaging/apertura.desktop", folder / "share/applications/apertura.desktop")
    icons = folder / "share/icons/hicolor"
    put(ROOT / "assets/icon/apertura.svg", icons / "scalable/apps/apertura.svg")
    for size in (48, 128, 256):
        put(ROOT / f"assets/icon/apertura-{size}.png", icons / f"{size}x{size}/apps/apertura.png")


def packed(content: bytes) -> bytes:
    """Without the time of packing, so that a second run packs the same bytes."""
    return gzip.compress(content, 9, mtime=0)


def put(source: Path, place: Path, mode: int = 0o644) -> None:
    write(place, source.read_bytes(), mode)


def write(place: Path, content: bytes, mode: int = 0o644) -> None:
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_bytes(content)
    place.chmod(mode)


def files(folder: Path) -> list[Path]:
    """Every file of a tree, relative to it, in a fixed order."""
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())


def date(folder: Path) -> None:
    """Dates every file and folder of a tree with the commit's moment."""
    for path in [*folder.rglob("*"), folder]:
        if path.is_dir():
            path.chmod(0o755)
        os.utime(path, (moment(), moment()))
