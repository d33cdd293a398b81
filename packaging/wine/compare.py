#!/usr/bin/env python3
"""Compares what the program wrote here with what it wrote under Wine: maps of three scenes, figures of every method.

usage: compare.py HERE THERE      folders with here-1.npz, here.json and there-1.npz; there.json is in HERE
"""
import json
import sys
from pathlib import Path

import numpy as np

#: Amplitudes differ by at most this part of the map's peak; figures of methods by at most this part of themselves.
AMPLITUDE, FIGURE = 1e-12, 1e-3


def maps_differ_by(here, there):
    ours, theirs = (10 ** np.load(path)["polar_full"] for path in (here, there))
    return float(np.abs(ours - theirs).max() / ours.max())


def figures(path):
    for of_set in json.loads(path.read_text())["sets"]:
        for method in of_set["methods"]:
            for name in ("squared_error", "detection"):
                yield (of_set["set"], method["name"], name), method[name]["mean"]


here, there = map(Path, sys.argv[1:3])
worst = max(maps_differ_by(here / f"here-{n}.npz", there / f"there-{n}.npz") for n in (1, 2, 3))
print(f"maps: amplitudes within {worst:.1e} of their peak")
wrong = [f"maps differ by {worst:.1e} of their peak"] if worst > AMPLITUDE else []
ours, theirs = dict(figures(here / "here.json")), dict(figures(here / "there.json"))
if ours.keys() != theirs.keys():
    wrong.append(f"other figures: {sorted(map(str, ours.keys() ^ theirs.keys()))}")
for key in ours.keys() & theirs.keys():
    if abs(ours[key] - theirs[key]) > FIGURE * abs(ours[key]):
        wrong.append(f"set {key[0]}, {key[1]}, {key[2]}: {ours[key]:.6g} here, {theirs[key]:.6g} under Wine")
print(f"{len(ours)} figures of methods, {len(wrong)} of them differ by more than {FIGURE:.1%}")
sys.exit("\n".join(wrong) if wrong else 0)
