"""The packages themselves: an archive, a Debian package, a wheel."""

from __future__ import annotations

import base64
import email.utils
import gzip
import hashlib
import io
import os
import shutil
import tarfile
import time
import zipfile
from pathlib import Path

import tree
from common import EXE, GLIBC, MACHINE, ROOT, Fault, moment, name, run, version, window_libraries

#: What a session without X, a graphics driver or a file dialog of the system would miss.
RECOMMENDED = ["libegl1", "libgl1-mesa-dri", "libwayland-client0", "libwayland-egl1", "xdg-desktop-portal"]
ARCHITECTURES = {"x86_64": "amd64", "aarch64": "arm64"}
DESCRIPTION = """\
Description: window, command line and simulator of sparse automotive radars
 apertura shows what a 1024-element automotive radar sees, and how much of it
 is recovered from 24 elements. It simulates scenes, draws range-angle maps,
 runs 23 reconstruction methods and measures their errors. Its window follows
 every drag of a reflector; its command line writes maps, tables and data sets.
"""


def archive(laid: Path, folder: Path) -> Path:
    """A .tar.gz of a tree. Its one folder can be unpacked anywhere, or over ~/.local."""
    path = folder / f"{name()}.tar.gz"
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.GNU_FORMAT) as out:
        for file in tree.files(laid):
            about = tarfile.TarInfo(f"{name()}/{file.as_posix()}")
            content = (laid / file).read_bytes()
            about.size, about.mtime = len(content), moment()
            about.mode = 0o755 if file.parts[0] == "bin" else 0o644
            out.addfile(about, io.BytesIO(content))
    path.write_bytes(gzip.compress(packed.getvalue(), 9, mtime=0))
    return path


def debian(laid: Path, folder: Path, libraries: list[str]) -> Path:
    """A .deb of a tree. `libraries` are the packages of the libraries that the program is linked with."""
    if shutil.which("dpkg-deb") is None:
        raise Fault("dpkg-deb is not there; it comes with Debian, and as the package dpkg elsewhere")
    architecture = ARCHITECTURES.get(MACHINE)
    if architecture is None:
        raise Fault(f"Debian's name of the architecture {MACHINE} is not known here")
    path = folder / f"apertura_{version()}_{architecture}.deb"
    staging = folder / "debian"
    shutil.rmtree(staging, ignore_errors=True)
    shutil.copytree(laid, staging / "usr")
    document = staging / "usr/share/doc/apertura"
    shutil.move(document / "LICENSE-MIT", document / "copyright")
    with (document / "copyright").open("a") as text:
        text.write("\nOr, at your choice, the Apache License 2.0 (/usr/share/common-licenses/Apache-2.0).\n")
        text.write("THIRD-PARTY.txt.gz beside this file has the notices of what the program carries.\n")
    (document / "LICENSE-APACHE").unlink()
    tree.write(document / "CHANGELOG.md.gz", tree.packed((ROOT / "CHANGELOG.md").read_bytes()))
    # Whoever publishes the package says where mail reaches them.
    maintainer = f"{os.environ.get('DEBFULLNAME', 'The apertura authors')} <{os.environ.get('DEBEMAIL', 'apertura@localhost')}>"
    when = email.utils.formatdate(moment())
    changes = f"apertura ({version()}) unstable; urgency=medium\n\n  * CHANGELOG.md.gz says what changed.\n\n -- {maintainer}  {when}\n"
    tree.write(document / "changelog.gz", tree.packed(changes.encode()))
    paths = tree.files(staging)
    sums = "".join(f"{hashlib.md5((staging / p).read_bytes()).hexdigest()}  {p.as_posix()}\n" for p in paths)
    installed = sum((staging / p).stat().st_size // 1024 + 1 for p in paths)
    depends = ", ".join([f"libc6 (>= {GLIBC})", *libraries, *window_libraries()])
    control = (
        f"Package: apertura\nVersion: {version()}\nArchitecture: {architecture}\nSection: science\nPriority: optional\n"
        f"Maintainer: {maintainer}\nInstalled-Size: {installed}\nDepends: {depends}\n"
        f"Recommends: {', '.join(RECOMMENDED)}\n{DESCRIPTION}"
    )
    tree.write(staging / "DEBIAN/control", control.encode())
    tree.write(staging / "DEBIAN/md5sums", sums.encode())
    tree.date(staging)
    run("dpkg-deb", "--root-owner-group", "-Zxz", "--build", staging, path, SOURCE_DATE_EPOCH=str(moment()))
    shutil.rmtree(staging)
    return path


def wheel(plain: Path, program: Path, page: Path | None, notices: str, folder: Path) -> Path:
    """The module's wheel with the program, the page and the notices in it: pip puts the program beside Python's own."""
    path = folder / plain.name
    label = f"apertura-{version()}"
    added: dict[str, tuple[bytes, int]] = {f"{label}.data/scripts/apertura{EXE}": (program.read_bytes(), 0o755)}
    for file in tree.files(page) if page else []:
        added[f"apertura/page/{file.as_posix()}"] = ((page / file).read_bytes(), 0o644)
    for file in ("LICENSE-MIT", "LICENSE-APACHE"):
        added[f"{label}.dist-info/licenses/{file}"] = ((ROOT / file).read_bytes(), 0o644)
    added[f"{label}.dist-info/licenses/THIRD-PARTY.txt"] = (notices.encode(), 0o644)
    record = f"{label}.dist-info/RECORD"
    with zipfile.ZipFile(plain) as source:
        if record not in source.namelist():
            raise Fault(f"{plain} has no {record}; is its version another than that of the program?")
        content = {n: (source.read(n), 0o644) for n in source.namelist() if n != record and not n.endswith("/")}
    content.update(added)
    lines = [f"{n},sha256={_digest(data)},{len(data)}" for n, (data, _) in sorted(content.items())]
    content[record] = ("\n".join([*lines, f"{record},,"]).encode() + b"\n", 0o644)
    # As the format wants it: what tells of the wheel comes last.
    return packed_zip(dict(sorted(content.items(), key=lambda item: (".dist-info/" in item[0], item[0]))), path)


def packed_zip(content: dict[str, tuple[bytes, int]], path: Path) -> Path:
    """A zip archive of bytes and permissions by name."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
        for entry, (data, mode) in content.items():
            about = zipfile.ZipInfo(entry, time.gmtime(moment())[:6])
            about.external_attr, about.compress_type = (0o100000 | mode) << 16, zipfile.ZIP_DEFLATED
            out.writestr(about, data)
    return path


def _digest(data: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
