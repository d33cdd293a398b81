"""The program for Windows and the archive of it. It is built on Linux by the compiler of mingw-w64, or on Windows itself by that compiler."""

from __future__ import annotations

import shutil
import struct
from pathlib import Path

from build import MOST_BYTES, environment
from common import ROOT, SYSTEM, Fault, run, target_folder, version
from formats import packed_zip

TRIPLE = "x86_64-pc-windows-gnu"
PROFILE = "packages"
#: Debian's package of the compiler, and its programs as they are called there and on Windows.
COMPILER_PACKAGE = "gcc-mingw-w64-x86-64"
PREFIX = "" if SYSTEM == "windows" else "x86_64-w64-mingw32-"
#: Most bytes of the archive.
MOST_PACKED = 25_000_000
ICON_SIZES = (48, 128, 256)


def label() -> str:
    return f"apertura-{version()}-windows-x86_64"


def need_compiler() -> None:
    """Installs the target and the compiler where they are missing and can be installed."""
    if shutil.which("rustup"):
        run("rustup", "target", "add", TRIPLE)
    if shutil.which(f"{PREFIX}gcc") and shutil.which(f"{PREFIX}windres"):
        return
    if SYSTEM != "linux" or shutil.which("apt-get") is None:
        raise Fault(f"{PREFIX}gcc and {PREFIX}windres are missing; they are in mingw-w64 (Debian's package {COMPILER_PACKAGE})")
    run("apt-get", "update", "-qq")
    run("apt-get", "install", "-y", "-qq", "--no-install-recommends", COMPILER_PACKAGE, DEBIAN_FRONTEND="noninteractive")


def icon() -> bytes:
    """The icon's sizes as one .ico: six bytes that say how many, sixteen for each, then the PNG files themselves."""
    pictures = [(size, (ROOT / f"assets/icon/apertura-{size}.png").read_bytes()) for size in ICON_SIZES]
    told, content = struct.pack("<HHH", 0, 1, len(pictures)), b""
    start = len(told) + 16 * len(pictures)
    for size, picture in pictures:
        # A side of 256 is written as 0.
        told += struct.pack("<BBBBHHII", size % 256, size % 256, 0, 0, 1, 32, len(picture), start + len(content))
        content += picture
    return told + content


def resources(folder: Path) -> Path:
    """Icon, version and manifest as an object that is linked into the program."""
    folder.mkdir(parents=True, exist_ok=True)
    numbers = [*version().split("."), "0"]
    (folder / "apertura.ico").write_bytes(icon())
    manifest = (ROOT / "packaging/apertura.manifest").read_text()
    (folder / "apertura.manifest").write_text(manifest.replace("VERSION", ".".join(numbers)))
    script = (ROOT / "packaging/apertura.rc").read_text().replace("VERSION_NUMBERS", ",".join(numbers))
    # Of the words VERSION, those in quotes are ours.
    (folder / "apertura.rc").write_text(script.replace('"VERSION"', f'"{version()}"'))
    made = folder / "resources.o"
    run(f"{PREFIX}windres", "--include-dir", folder, folder / "apertura.rc", made)
    return made


def programs(folder: Path) -> tuple[Path, Path]:
    """The program with the window, and the one that a console starts, which waits for the other."""
    need_compiler()
    made = resources(folder)
    common = ["--locked", "--profile", PROFILE, "--target", TRIPLE]
    # Marked as a program with a window, it gets no console of its own when it is started by a double click.
    linked = [f"-Clink-arg={made}", "-Clink-arg=-Wl,--subsystem,windows"]
    run("cargo", "rustc", *common, "--bin", "apertura", "--", *linked, **environment())
    run("cargo", "build", *common, "--no-default-features", "--features", "console", "--bin", "apertura-console", **environment())
    built = target_folder() / TRIPLE / PROFILE
    return built / "apertura.exe", built / "apertura-console.exe"


def archive(folder: Path, notices: str) -> Path:
    """The .zip: one folder, which can be unpacked anywhere."""
    program, console = programs(folder / "windows")
    content = {
        "apertura.exe": program.read_bytes(),
        "apertura.com": console.read_bytes(),
        "THIRD-PARTY.txt": notices.encode(),
        **{name: (ROOT / name).read_bytes() for name in ("README.md", "LICENSE-MIT", "LICENSE-APACHE")},
    }
    size = sum(len(data) for data in content.values())
    if size > MOST_BYTES:
        raise Fault(f"the archive unpacks to {size / 1e6:.1f} MB; at most {MOST_BYTES / 1e6:.0f} are allowed")
    path = packed_zip({f"{label()}/{name}": (data, 0o644) for name, data in content.items()}, folder / f"{label()}.zip")
    if path.stat().st_size > MOST_PACKED:
        raise Fault(f"{path} has {path.stat().st_size / 1e6:.1f} MB; at most {MOST_PACKED / 1e6:.0f} are allowed")
    return path
