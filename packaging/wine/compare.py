#!/usr/bin/env python3
"""Compares what the program wrote here with what it wrote under Wine: maps of three scenes, figures of every method.

usage: compare.py HERE THERE      folders with here-1.npz, here-FLOOR.json and there-1.npz; there-FLOOR.json is in HERE
"""
import array
import json
import sys
import zipfile
from pathlib import Path

#: Amplitudes differ by at most this part of the map's peak.
AMPLITUDE = 1e-12
#: Figures of methods differ by at most this part of themselves. The thesis' floor is as low as rounding errors of the last bit, which differ
#: between libraries of sines and logarithms.
FIGURES = {"snr=40": 1e-3, "thesis": 1e-2}
#: On walls these two decide by differences of rounding errors: another instruction set of the same processor changes their answer too.
UNSTABLE = {(3, "iaa"), (3, "esprit")}


def maps_differ_by(*paths):
    """The largest difference of amplitude, from the float64 decades behind the headers of the .npy files, over the peak."""
    stored = [zipfile.ZipFile(path).read("polar_full.npy") for path in paths]
    ours, theirs = ([10**d for d in array.array("d", s[10 + int.from_bytes(s[8:10], "little") :])] for s in stored)
    return max(abs(a - b) for a, b in zip(ours, theirs, strict=True)) / max(ours)


def figures(path):
    """Squared error and P_D by set, method and name."""
    methods = [(of_set["set"], method) for of_set in json.loads(path.read_text())["sets"] for method in of_set["methods"]]
    names = ("squared_error", "detection")
    return {(n, m["name"], name): m[name]["mean"] for n, m in methods for name in names if (n, m["name"]) not in UNSTABLE}


here, there = map(Path, sys.argv[1:3])
worst = max(maps_differ_by(here / f"here-{n}.npz", there / f"there-{n}.npz") for n in (1, 2, 3))
print(f"maps: amplitudes within {worst:.1e} of their peak")
wrong = [f"maps differ by {worst:.1e} of their peak"] if worst > AMPLITUDE else []
for floor, most in FIGURES.items():
    ours, theirs = (figures(here / f"{place}-{floor}.json") for place in ("here", "there"))
    wrong += [f"floor {floor}: other figures: {sorted(map(str, ours.keys() ^ theirs.keys()))}"] if ours.keys() != theirs.keys() else []
    found = [key for key in sorted(ours.keys() & theirs.keys()) if abs(ours[key] - theirs[key]) > most * abs(ours[key])]
    print(f"floor {floor}: {len(ours)} figures of methods, {len(found)} of them differ by more than {most:.1%}")
    wrong += [f"floor {floor}, set {key[0]}, {key[1]}, {key[2]}: {ours[key]:.6g} here, {theirs[key]:.6g} under Wine" for key in found]
sys.exit("\n".join(wrong) if wrong else 0)
