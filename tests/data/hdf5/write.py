"""Writes the files beside it: python3 write.py FOLDER. Needs h5py and NumPy."""
import sys

import h5py
import numpy as np

folder = sys.argv[1]
n = np.arange(60.0).reshape(3, 5, 4)

with h5py.File(f"{folder}/arrays.h5", "w") as out:
    out.create_dataset("cube", data=(n - 2j * n).astype("c8"), chunks=(2, 3, 4), compression="gzip", shuffle=True)
    out.create_dataset("summed", data=n.astype("u2"), chunks=(1, 2, 3), fletcher32=True)
    out.create_dataset("radar/raw/adcData", data=np.arange(-6, 6).reshape(2, 6).astype(">i2"))
    out["half"] = np.array([0.0, -1.5, 6.1e-05, 2.0**-24, 65504.0], "f2")
    out.create_dataset("unwritten", (3, 2), "i4")
    out["text"] = "no numbers"
    out["one"] = 3.0

with h5py.File(f"{folder}/new.mat", "w", userblock_size=512) as out:
    pair = np.zeros((3, 4), [("real", "f8"), ("imag", "f8")])
    pair["real"], pair["imag"] = n[0, :3], -n[1, :3]
    out.create_dataset("z", data=pair, chunks=(2, 2), compression="gzip")
    out.create_dataset("radar/adcData", data=np.arange(24, dtype="i2").reshape(2, 3, 4))
    out.create_dataset("#refs#/a", data=np.arange(999))
with open(f"{folder}/new.mat", "r+b") as out:
    out.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\0\2IM")

with h5py.File(f"{folder}/latest.h5", "w", libver="latest") as out:
    out["whole"] = n
    out.create_dataset("chunks", data=n, chunks=(1, 2, 2), maxshape=(None, 5, 4))
