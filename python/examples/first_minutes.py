"""The first minutes with apertura in Python: a scene, what the radar sees, what methods make of 24 elements. Draws figure 4-7 of the thesis.

    pip install ./python matplotlib tqdm
    python python/examples/first_minutes.py figure-4-7.png

Each `# %%` is a cell of a notebook: editors such as VS Code and Spyder run them one by one.
"""

# %% A scene: the thesis' set 3, three to six points and lines. The same numbers give the same scene everywhere.
import sys

import numpy as np

import apertura as ap

scene = ap.Scene.random("3", seed=0, index=0)
print(scene, "before a radar whose bins are", f"{100 * scene.radar.range_resolution_metres:.1f} cm")

# %% What all 1024 elements see, over the rounding floor of the thesis' program.
maps = scene.simulate(floor="thesis")
print("samples", maps.samples.shape, "two ends", maps.ends.shape, "target", maps.target.shape)

# %% What methods make of the two ends alone. `thesis` needs a build with burn (python/README.md).
names = [name for name in ("thesis", "live", "hybrid") if name in ap.methods()]
outputs = {"target": maps.target}
for name in names:
    found = ap.method(name).reconstruct(maps.ends)
    outputs[name] = found.map
    print(f"{name:8}", ap.metrics(maps.target, found.map, found.eta))

# %% Figure 4-7: each map, and where it exceeds 0.7 and 0.9.
import matplotlib

if len(sys.argv) > 1:
    matplotlib.use("Agg")
import matplotlib.pyplot as plt

figure, axes = plt.subplots(len(outputs), 3, figsize=(11, 2.8 * len(outputs)), squeeze=False, layout="constrained")
extent = (-1.0, 1.0, 0.0, scene.radar.max_range_metres)
for row, (name, output) in zip(axes, outputs.items()):
    for axis, eta in zip(row, (None, 0.7, 0.9)):
        cells = output if eta is None else (output > eta).astype(np.float32)
        axis.imshow(cells, origin="lower", aspect="auto", extent=extent, cmap="inferno" if eta is None else "gray", vmin=0, vmax=1)
        axis.set_title(name if eta is None else f"{name} > {eta}")
        axis.set_xlabel("cos θ")
        axis.set_ylabel("range (m)")

if len(sys.argv) > 1:
    figure.savefig(sys.argv[1], dpi=100)
    print("wrote", sys.argv[1])
else:
    plt.show()

# %% Many scenes, row by row, with a bar of progress where tqdm is there.
try:
    from tqdm import tqdm
except ImportError:
    tqdm = None
count = 5
bar = tqdm(total=count) if tqdm else None
rows = ap.evaluate(["live"], ["3"], count=count, on_row=lambda row: bar.update() if bar else None)
print("mean SE of live on set 3:", np.mean([row["squared_error"] for row in rows]))
