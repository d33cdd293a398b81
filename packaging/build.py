"""Builds the program, its manual and the Python module, all against an old C library where the system is Linux."""

from __future__ import annotations

import os
import shutil
import sys
import venv
from pathlib import Path

from common import EXE, GLIBC, MACHINE, ROOT, SYSTEM, Fault, output, run, target_folder

#: Tools from PyPI. Zig's C compiler links against whichever glibc is asked for.
TOOLS = ["cargo-zigbuild==0.24.1", "ziglang==0.17.1", "maturin==1.16.0"]
PROFILE = "packages"
TRIPLE = f"{MACHINE}-unknown-linux-gnu"
#: Most bytes that the program may have.
MOST_BYTES = 60_000_000


def tools() -> Path:
    """The folder with the tools' programs; they are installed there where they are missing."""
    folder = target_folder() / "package-tools"
    programs = folder / ("Scripts" if SYSTEM == "windows" else "bin")
    stamp = folder / "tools.txt"
    if not stamp.is_file() or stamp.read_text().split() != TOOLS:
        venv.create(folder, with_pip=True, clear=True)
        run(programs / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *TOOLS)
        stamp.write_text("\n".join(TOOLS))
    return programs


def environment() -> dict[str, str]:
    """Paths of the builder's home don't belong into a program that others run."""
    cargo = os.environ.get("CARGO_HOME") or str(Path.home() / ".cargo")
    crates = Path(cargo) / "registry" / "src"
    library = Path(output(os.environ.get("RUSTC", "rustc"), "--print", "sysroot").strip()) / "lib/rustlib/src/rust"
    places = {f"{crates}{os.sep}": "", str(library): "/rustc"}
    flags = "\x1f".join(f"--remap-path-prefix={place}={shown}" for place, shown in places.items())
    return {
        "CARGO_ENCODED_RUSTFLAGS": os.environ.get("CARGO_ENCODED_RUSTFLAGS", flags),
        "CARGO_INCREMENTAL": "0",
        "PATH": os.pathsep.join([str(tools()), os.environ["PATH"]]),
    }


def program() -> tuple[Path, Path]:
    """The program, and the one that writes its manual. APERTURA_PROGRAM names one that was built before, with apertura-manual beside it."""
    given = os.environ.get("APERTURA_PROGRAM")
    if given:
        path = Path(given).resolve()
        made = path, path.with_name(f"apertura-manual{EXE}")
    else:
        wanted = ["--locked", "--profile", PROFILE, "--features", "manual", "--bin", "apertura", "--bin", "apertura-manual"]
        if SYSTEM == "linux":
            run("rustup" if shutil.which("rustup") else "true", "target", "add", TRIPLE)
            run("cargo", "zigbuild", *wanted, "--target", f"{TRIPLE}.{GLIBC}", **environment())
            folder = target_folder() / TRIPLE / PROFILE
        else:
            run("cargo", "build", *wanted, **environment())
            folder = target_folder() / PROFILE
        made = folder / f"apertura{EXE}", folder / f"apertura-manual{EXE}"
    for path in made:
        if not path.is_file():
            raise Fault(f"{path} is not there; `cargo build --features manual` builds both programs")
    check(made[0], trying=bool(given))
    return made


def check(path: Path, trying: bool) -> None:
    """Holds a program or a module to the oldest C library and to its size; one that is only tried is told about."""
    problems = []
    if SYSTEM == "linux":
        newer = [f"{symbol} of glibc {of}" for symbol, of in glibc_symbols(path) if number(of) > number(GLIBC)]
        if newer:
            problems.append(f"{path} asks for symbols newer than glibc {GLIBC}: {', '.join(newer[:8])}")
    size = path.stat().st_size
    print(f"package: {path} has {size / 1e6:.1f} MB", file=sys.stderr)
    if size > MOST_BYTES:
        problems.append(f"{path} has {size / 1e6:.1f} MB; at most {MOST_BYTES / 1e6:.0f} are allowed")
    if problems and not trying:
        raise Fault("; ".join(problems))
    for problem in problems:
        print(f"package: {problem} (only tried)", file=sys.stderr)


def glibc_symbols(path: Path) -> list[tuple[str, str]]:
    """Every symbol that a program asks of glibc, and the version of glibc that has it, by `objdump -T`."""
    symbols = []
    for line in output("objdump", "-T", path).splitlines():
        words = line.split()
        if "*UND*" in words and "GLIBC_" in line:
            version = next(word for word in words if "GLIBC_" in word).strip("()").removeprefix("GLIBC_")
            symbols.append((words[-1], version))
    if not symbols:
        raise Fault(f"{path}: objdump names no symbol of glibc; is it a program?")
    return symbols


def number(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in version.split(".")) if version[0].isdigit() else (0,)


def module(folder: Path) -> Path:
    """The wheel of the module alone, in `folder`; or APERTURA_MODULE, one that was built before."""
    given = os.environ.get("APERTURA_MODULE")
    if given:
        return Path(given).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    wanted = ["build", "--release", "--locked", "--manifest-path", "python/Cargo.toml", "--out", folder]
    if SYSTEM == "linux":
        wanted += ["--zig", "--target", TRIPLE, "--compatibility", f"manylinux_{GLIBC.replace('.', '_')}"]
    run(tools() / "maturin", *wanted, **{**environment(), "CARGO_TARGET_DIR": str(target_folder())})
    return next(folder.glob("*.whl"))


def page() -> Path:
    """The folder of the page: PAGE_FOLDER, or one that scripts/web makes."""
    given = os.environ.get("PAGE_FOLDER")
    if not given:
        run("bash", "scripts/web")
    folder = Path(given).resolve() if given else target_folder() / "web"
    if not (folder / "index.html").is_file():
        raise Fault(f"{folder} has no index.html; scripts/web makes the page")
    return folder
