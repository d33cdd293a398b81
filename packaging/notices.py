"""The licence notices of every crate in the program: names, licences, and the texts that come with their sources."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from pathlib import Path

from common import ROOT, Fault, output

_FILES = re.compile(r"(LICEN[CS]E|COPYING|COPYRIGHT|NOTICE|UNLICENSE|OFL|UFL)", re.IGNORECASE)
_NO_TEXT = {".rs", ".py", ".html", ".yml", ".yaml"}
#: Licences of what the program carries beside crates.
_OURS = ["assets/fonts/LICENSE", "assets/recordings/cascade-86.LICENSE", "assets/recordings/chip-8.LICENSE"]


def crates(manifests: list[str], triple: str) -> dict[str, dict]:
    """The crates that are linked into what the manifests make, by "name version"; not those that only build or test it."""
    found: dict[str, dict] = {}
    for manifest in manifests:
        common = ["--locked", "--manifest-path", manifest]
        told = json.loads(output("cargo", "metadata", "--format-version", "1", "--filter-platform", triple, *common))
        packages = {f"{package['name']} {package['version']}": package for package in told["packages"]}
        # Of the two, this command alone knows which optional crates are in use.
        wanted = ["--edges", "normal,no-proc-macro", "--target", triple, "--prefix", "none", "--format", "{p}"]
        for line in output("cargo", "tree", *wanted, *common).splitlines():
            words = line.split()
            label = f"{words[0]} {words[1].removeprefix('v')}" if words else ""
            if label in packages and packages[label]["source"]:
                found[label] = packages[label]
    return found


def texts(package: dict) -> list[str]:
    """The licence texts in a crate's sources, at most one folder below its own."""
    folder = Path(package["manifest_path"]).parent
    paths = sorted(p for pattern in ("*", "*/*") for p in folder.glob(pattern) if _FILES.match(p.name) and p.suffix not in _NO_TEXT)
    return [path.read_text(errors="replace").strip() for path in paths if path.is_file()]


def write(manifests: list[str], triple: str) -> str:
    """The notices as one text: a list of crates, then each licence text once, with the crates that it is of."""
    packages = sorted(crates(manifests, triple).values(), key=lambda p: (p["name"], p["version"]))
    unnamed = [p["name"] for p in packages if not (p["license"] or p["license_file"])]
    if unnamed:
        raise Fault(f"crates without a licence: {', '.join(unnamed)}")
    lines = ["apertura carries the following crates, each under the licence named.", ""]
    of_text: dict[str, list[str]] = defaultdict(list)
    originals: dict[str, str] = {}
    for package in packages:
        label = f"{package['name']} {package['version']}"
        lines.append(f"{label}: {package['license'] or package['license_file']}")
        for text in texts(package):
            key = " ".join(text.split())
            originals.setdefault(key, text)
            if label not in of_text[key]:
                of_text[key].append(label)
    lines += ["", "Where a crate comes without a text, the standard one of its licence holds.", "It also carries parts of Rust's standard library (MIT OR Apache-2.0), and what the last texts here are of.", ""]
    for key, labels in of_text.items():
        lines += ["-" * 80, f"Of {', '.join(labels)}:", "", originals[key], ""]
    for path in _OURS:
        lines += ["-" * 80, f"Of the files beside {path} in apertura's repository:", "", (ROOT / path).read_text(errors="replace").strip(), ""]
    return "\n".join(lines)
