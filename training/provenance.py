"""What a run is made of: every part of it is recorded when it STARTS, kept in the checkpoint and written into the weights."""
import datetime
import hashlib
import json
import os
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))


def sha256(path):
    with open(path, "rb") as f:
        return hashlib.file_digest(f, "sha256").hexdigest()


def programs():
    """One hash over all programs of this folder and the live network's, names included."""
    import apertura.live
    paths = [os.path.join(HERE, n) for n in os.listdir(HERE) if n.endswith(".py")] + [apertura.live.__file__]
    digest = hashlib.sha256()
    for path in sorted(paths, key=os.path.basename):
        digest.update(f"{os.path.basename(path)} {sha256(path)}\n".encode())
    return digest.hexdigest()


def commit():
    """The commit this folder was at, with a mark where it differed from it."""
    def git(*command):
        return subprocess.run(["git", "-C", HERE, *command], capture_output=True, text=True).stdout.strip()

    return (git("rev-parse", "--short=12", "HEAD") or "unknown") + ("-changed" if git("status", "--porcelain", ".") else "")


class Part:
    """One start of the program, until it stops or is killed. `initial` is the file its weights came from, if any; `optimiser` a name such as "AdamW"."""

    def __init__(self, initial, maps, optimiser):
        import torch
        self.began, self.first = time.time(), maps
        # The last part of a path is enough.
        self.record = {
            "started": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
            "commit": commit(), "programs_sha256": programs(), "arguments": [a.rsplit("/", 1)[-1] for a in sys.argv[1:]], "torch": torch.__version__, "optimiser": optimiser,
            "initial_weights_sha256": sha256(initial) if initial else None, "maps_before": maps,
            "processes": int(os.environ.get("WORLD_SIZE", 1)), "restarts": int(os.environ.get("TORCHELASTIC_RESTART_COUNT", 0)),
        }

    def now(self, maps):
        """The record as of now, after `maps` maps of the whole run."""
        minutes = (time.time() - self.began) / 60
        return {**self.record, "maps_seen": maps - self.first, "wall_minutes": round(minutes, 1),
                "processor_minutes": round(time.process_time() / 60, 1)}


def parts_of(path):
    """The record in the weight file at `path`, for a run that goes on from it: one part without particulars where it has none."""
    with open(path, "rb") as f:
        header = json.loads(f.read(int.from_bytes(f.read(8), "little")))
    meta = header.get("__metadata__", {})
    if "parts" in meta:
        return json.loads(meta["parts"])
    maps = float(meta.get("maps_seen", 0))
    return [{"started": "not recorded", "optimiser": meta.get("optimiser", "not recorded"), "maps_before": 0, "maps_seen": maps,
             "wall_minutes": float(meta.get("minutes", 0))}]


def maps_of(parts):
    return sum(p["maps_seen"] for p in parts)


def optimisers(parts):
    """The optimisers in the order they followed each other: "SGD, then Muon"."""
    names = [p.get("optimiser", "not recorded") for p in parts if p["maps_seen"]]
    return ", then ".join(name for name, before in zip(names, [None, *names]) if name != before)


def metadata(parts):
    """For a weight file, whose values are strings."""
    return {"optimiser": optimisers(parts), "maps_seen": f"{maps_of(parts):.0f}", "minutes": f"{sum(p['wall_minutes'] for p in parts):.0f}",
            "parts": json.dumps(parts)}
