"""The live network in PyTorch: the twin of `src/network/live/engine.rs`, under the tensors' names of its weight files. Needs `torch` and `safetensors`.

`Estimator` makes a method of any weights that `training/train_live.py` wrote, those for radars of other shapes included. The program's own engine answers
the same, and faster (`apertura.method("live", weights=FILE)`). `python -m apertura.live FILE` serves this one to the program:
`apertura --method-command "python -m apertura.live FILE"`.
"""

from __future__ import annotations

import json
import math
from pathlib import Path

import torch
import torch.nn as nn
import torch.nn.functional as F

LN10 = math.log(10.0)
ROWS, COLS, FINE, GRID = 512, 1024, 256, 64
COARSE_CHANNELS = 10
#: Constants of the radar: migration, spacing, three windows, pattern.
CONSTANTS, SPACING_AT, WINDOWS_AT = 6, 1, 2
IN_CHANNELS = 16 + COARSE_CHANNELS + 6 + 2 + 4 + CONSTANTS
#: Weights of the cosines that the windows are sums of, as in `src/radar/window.rs`.
WINDOWS = {"hann": (0.5, 0.5, 0.0), "hamming": (0.54, 0.46, 0.0), "blackman": (0.42, 0.5, 0.08), "rectangular": (1.0, 0.0, 0.0)}


def wrap_cols(x, n=1):
    return torch.cat([x[..., -n:], x, x[..., :n]], -1)


class Conv(nn.Module):
    """3x3 convolution, circular in angle (columns), zero-padded in range (rows)."""

    def __init__(self, cin, cout):
        super().__init__()
        self.conv = nn.Conv2d(cin, cout, 3, padding=(1, 0))

    def forward(self, x):
        return self.conv(wrap_cols(x))


class Context(nn.Module):
    """Row, column and global means, mixed and broadcast back."""

    def __init__(self, c):
        super().__init__()
        self.row = nn.Conv2d(2 * c, c, 1)
        self.col = nn.Conv2d(2 * c, c, 1)

    def forward(self, x):
        r = torch.cat([x.mean(3, keepdim=True), x.amax(3, keepdim=True)], 1)
        c = torch.cat([x.mean(2, keepdim=True), x.amax(2, keepdim=True)], 1)
        return x + F.relu(self.row(r)) + F.relu(self.col(c))


class Block(nn.Module):
    """Residual block of two convolutions; the second starts at zero."""

    def __init__(self, c, context=False):
        super().__init__()
        self.conv1 = Conv(c, c)
        self.conv2 = Conv(c, c)
        self.context = Context(c) if context else None
        nn.init.zeros_(self.conv2.conv.weight)
        nn.init.zeros_(self.conv2.conv.bias)

    def forward(self, x):
        h = self.conv1(F.relu(x))
        if self.context is not None:
            h = self.context(h)
        return x + self.conv2(F.relu(h))


def shuffle_cols(x, r):
    """[B, C*r, H, W] -> [B, C, H, W*r]."""
    b, c, h, w = x.shape
    return x.view(b, c // r, r, h, w).permute(0, 1, 3, 4, 2).reshape(b, c // r, h, w * r)


def unshuffle_cols(x, r):
    b, c, h, w = x.shape
    return x.view(b, c, h, w // r, r).permute(0, 1, 4, 2, 3).reshape(b, c * r, h, w // r)


def up2(x):
    """[B, 4C, H, W] -> [B, C, 2H, 2W]."""
    return F.pixel_shuffle(x, 2)


def circulants(log_kernels, n):
    """Matrices [B, n, n] of the even circular kernels whose log10 at distances 0..n/2 are `log_kernels` [B, n/2 + 1]."""
    i = torch.arange(n, device=log_kernels.device)
    d = (i[:, None] - i[None, :]) % n
    d = torch.minimum(d, n - d)
    return torch.exp(LN10 * log_kernels)[:, d]


def of_windows(constants, hann, others, n):
    """The matrix of each scene's window, [B, n, n]: that of the kernel `hann`, or of the one of `others` [3, k] that the constants [B, 6] name by a 1."""
    matrices = circulants(torch.cat([hann[None], others]), n).flatten(1)
    windows = constants[:, WINDOWS_AT : WINDOWS_AT + len(WINDOWS) - 1]
    return (torch.cat([1 - windows.sum(1, keepdim=True), windows], 1) @ matrices).view(-1, n, n)


def tail_prior(n, offset):
    """log10 of the side lobes of a Hann window at distances 0..n/2: they fall as 1/k^3."""
    k = torch.arange(n // 2 + 1, dtype=torch.float32)
    return offset - 3 * torch.log10(k + 1)


def other_windows(hann, n, step):
    """Kernels [3, k] of the other windows to start from: that of Hann's window [k], higher by what their side lobes are, at distances of 0, step,
    2 step ... cells of n. Where they are half a decade or more below the side lobes of a point they are raised: a gradient lowers a kernel that is
    too high, and can't raise one that doesn't show."""
    places = torch.arange(n, dtype=torch.float64) / (n - 1)
    finer = 8
    envelopes = []
    for a, b, c in WINDOWS.values():
        window = a - b * torch.cos(2 * math.pi * places) + c * torch.cos(4 * math.pi * places)
        lobes = torch.fft.fft(window, finer * n).abs()[: finer * n // 2 + 1] / window.sum()
        reach = torch.nn.functional.max_pool1d(lobes[None], finer * step + 1, finer * step, finer * step // 2)[0, : len(hann)]
        envelopes.append(torch.log10(reach + 1e-12))
    hann_window, *others = (envelope.float() for envelope in envelopes)
    return torch.stack([torch.maximum(hann + other - hann_window, other - 0.5) for other in others])


def resampled(x, columns):
    """Columns of the network's grid [..., COLS] as those of an array of so many elements; cos(theta) rises with both."""
    if columns == COLS:
        return x
    places = (torch.arange(columns, device=x.device, dtype=torch.float64) - columns // 2) * (COLS / columns) + COLS // 2
    low = places.floor()
    part = (places - low).to(x.dtype)
    low = low.long()
    return x[..., low % COLS] * (1 - part) + x[..., (low + 1) % COLS] * part


def size_of(radar):
    """How large the network for a radar is: arguments of `Live`.

    Raises:
        ValueError: Its samples can't be halved three times.
    """
    if radar.samples % 8:
        raise ValueError(f"the radar has {radar.samples} samples; expected a multiple of 8, which the network halves three times")
    if (radar.samples, radar.elements, radar.end_elements) == (ROWS, COLS, 12):
        return {}
    widths = (12, 24, 44, 60) if radar.samples * radar.elements <= ROWS * COLS // 2 else (16, 32, 64, 96)
    return {"c": widths, "rows": radar.samples, "columns": radar.elements}


class Live(nn.Module):
    """The network for maps of `rows` range bins and `columns` columns. Inside, its pictures have 64, 256 and 1024 columns for any radar."""

    def __init__(self, c=(16, 32, 64, 96), blocks=(1, 2, 2, 3), fine=16, rows=ROWS, columns=COLS):
        super().__init__()
        self.rows, self.columns = rows, columns
        c0, c1, c2, c3 = c
        b0, b1, b2, b3 = blocks
        self.stem = Conv(IN_CHANNELS, c0)
        self.enc0 = nn.Sequential(*[Block(c0) for _ in range(b0)])
        self.down1 = nn.Conv2d(c0, c1, 2, 2)
        self.enc1 = nn.Sequential(*[Block(c1) for _ in range((b1 + 1) // 2)])
        self.down2 = nn.Conv2d(c1, c2, 2, 2)
        self.enc2 = nn.Sequential(*[Block(c2, True) for _ in range((b2 + 1) // 2)])
        self.down3 = nn.Conv2d(c2, c3, 2, 2)
        self.enc3 = nn.Sequential(*[Block(c3, True) for _ in range(b3)])
        self.up2 = nn.Conv2d(c3, 4 * c2, 1)
        self.dec2 = nn.Sequential(*[Block(c2, True) for _ in range(b2)])
        self.up1 = nn.Conv2d(c2, 4 * c1, 1)
        self.dec1 = nn.Sequential(*[Block(c1) for _ in range(b1)])
        self.up0 = nn.Conv2d(c1, 4 * c0, 1)
        self.dec0 = nn.Sequential(*[Block(c0) for _ in range(b0)])
        self.widen = Conv(c0, 4 * 8)
        self.fine1 = Conv(8 + 4, fine)
        self.fine2 = nn.Conv2d(fine, 8, 1)
        self.row_sources = nn.Conv2d(c0, 2, 1)
        self.col_kernel = nn.Parameter(tail_prior(rows, -0.5))
        self.row_kernel = nn.Parameter(tail_prior(128, -1.0))
        self.col_kernels = nn.Parameter(other_windows(self.col_kernel.detach(), rows, 1))
        self.row_kernels = nn.Parameter(other_windows(self.row_kernel.detach(), COLS, 8))
        self.scalar1 = nn.Linear(2 * c3 + 2 + CONSTANTS, 64)
        self.scalar2 = nn.Linear(64, 2)
        nn.init.zeros_(self.scalar2.weight)
        nn.init.zeros_(self.scalar2.bias)
        with torch.no_grad():
            for m in (self.fine2, self.row_sources):
                m.weight.mul_(0.3)
                m.bias.fill_(-1.0)
        r = torch.arange(rows, dtype=torch.float32)[:, None].expand(rows, GRID)
        u = ((torch.arange(GRID, dtype=torch.float32) - GRID // 2) / (GRID // 2))[None, :].expand(rows, GRID)
        grid = torch.stack([r / (rows / 2) - 1, torch.log10(r + 4) - 2, u])
        self.register_buffer("grid", grid, persistent=False)

    def forward(self, fine, coarse, rows, scalars, constants):
        """log10 |Y_full| [B, rows, columns] in decades above the gain, and its minimum [B]."""
        return self.with_picture(fine, coarse, rows, scalars, constants)[:2]

    def with_picture(self, fine, coarse, rows, scalars, constants):
        """The same, and the coarse half's last picture [B, c0, rows, 64], which the heads read."""
        b = fine.shape[0]
        fine_n = ((fine + 3) / 3).clamp(-4, 2)
        coarse_n = torch.cat([((coarse[:, :4] + 3) / 3).clamp(-4, 2), coarse[:, 4:]], 1)
        rows_n = torch.cat([rows[:, :4], ((rows[:, 4:] + 3) / 3).clamp(-4, 2)], 1)
        scalars_n = (scalars + 8) / 3
        cos = self.grid[2] / (1 + constants[:, SPACING_AT])[:, None, None]
        directions = torch.stack([cos, torch.sqrt((1 - cos * cos).clamp(min=0))], 1)
        planes = lambda values: values[:, :, None, None].expand(-1, -1, self.rows, GRID)
        x = torch.cat([
            unshuffle_cols(fine_n, 4), coarse_n, rows_n[..., None].expand(-1, -1, -1, GRID),
            planes(scalars_n), self.grid[:2].expand(b, -1, -1, -1), directions, planes(constants)], 1)
        x0 = self.enc0(self.stem(x.contiguous(memory_format=torch.channels_last)))
        x1 = self.enc1(self.down1(x0))
        x2 = self.enc2(self.down2(x1))
        x3 = self.enc3(self.down3(x2))
        y2 = self.dec2(x2 + up2(self.up2(x3)))
        y1 = self.dec1(x1 + up2(self.up1(y2)))
        y0 = F.relu(self.dec0(x0 + up2(self.up0(y1))))
        f = torch.cat([shuffle_cols(self.widen(y0), 4), fine_n], 1)
        f = self.fine2(F.relu(self.fine1(f)))
        with torch.autocast(fine.device.type, enabled=False):
            return *self.sources(scalars, scalars_n, constants, x3.float(), y0.float(), f.float()), y0

    def sources(self, scalars, scalars_n, constants, x3, y0, f):
        """What the features make of every cell, in f32 for convolutions in any precision: sums over many decades follow."""
        b = f.shape[0]
        pooled = torch.cat([x3.mean((2, 3)), x3.amax((2, 3))], 1)
        s = self.scalar2(F.relu(self.scalar1(torch.cat([pooled, scalars_n, constants], 1))))
        heads = shuffle_cols(f, 4) * 3 - 3
        a = heads.clamp(-18, 4)
        local = torch.exp(LN10 * a[:, 0])
        column = of_windows(constants, self.col_kernel, self.col_kernels, self.rows) @ torch.exp(LN10 * a[:, 1])
        sharp = local + column
        src = shuffle_cols(self.row_sources(y0), 2)[:, 0] * 3 - 3
        wide = torch.exp(LN10 * src.clamp(-18, 4)) + sharp.view(b, self.rows, 128, 8).mean(3)
        row = (wide @ of_windows(constants, self.row_kernel, self.row_kernels, 128)).repeat_interleave(8, 2)
        floor = scalars[:, 0] + s[:, 0]
        total = sharp + row + torch.exp(LN10 * floor)[:, None, None]
        log = resampled(torch.log(total) / LN10, self.columns)
        minimum = floor - 2.5 + s[:, 1]
        return log, minimum


class Doubt(nn.Module):
    """How far off the live network expects to be: a head on its picture, which learns from the errors and teaches the network nothing."""

    def __init__(self, c=16, hidden=16):
        super().__init__()
        self.conv1 = Conv(c, hidden)
        self.conv2 = nn.Conv2d(hidden, FINE // GRID, 1)
        self.scene = nn.Linear(hidden, 1)
        with torch.no_grad():
            self.conv2.weight.mul_(0.1)
            self.conv2.bias.fill_(-1.5)
            self.scene.weight.zero_()
            self.scene.bias.zero_()

    def parts(self, picture):
        """log10 of the error of each cell, [B, rows, 256], and what the head's hidden layer holds on average, [B, hidden]."""
        hidden = F.relu(self.conv1(picture))
        return shuffle_cols(self.conv2(hidden), FINE // GRID)[:, 0].float(), hidden.mean((2, 3)).float()

    def forward(self, picture):
        """log10 of the error in Lambda that nine of ten cells stay below, [B, rows, 256]: one number for four columns.

        The mean of the hidden layer adds the same to every cell of a scene."""
        of_cells, of_scene = self.parts(picture)
        return of_cells + self.scene(of_scene)[:, :, None]


#: Decades between which the head's cells count, and how far a scene's part may go.
CELL_DECADES, SCENE_DECADES = (-4.0, 0.0), 0.5


def widened_cells(of_cells, columns=COLS):
    """Of [B, rows, 256], one number for four columns of the network's grid, those of an array of so many elements: [B, rows, columns]."""
    return resampled(of_cells.repeat_interleave(COLS // FINE, 2), columns)


def expected_error(of_cells, of_scene, columns=COLS):
    """The error of Lambda that is said, at most 1: [B, rows, columns] of the decades of the cells [B, rows, 256] and of the scene [B]."""
    decades = of_cells.clamp(*CELL_DECADES) + of_scene.clamp(-SCENE_DECADES, SCENE_DECADES)[:, None, None]
    return widened_cells((10 ** decades).clamp(max=1), columns)


class Doubting(nn.Module):
    """The network with its doubt."""

    def __init__(self, live, doubt):
        super().__init__()
        self.live, self.doubt = live, doubt

    def forward(self, *inputs):
        """Decades, their minimum, and the logarithm of the expected error."""
        log, minimum, picture = self.live.with_picture(*inputs)
        return log, minimum, self.doubt(picture.detach())


#: What the tensors of `Doubt` begin with in weight files.
DOUBT = "doubt."


def parted(weights):
    """Tensors of a weight file: the network's, and those of its doubt under their own names."""
    network = {name: t for name, t in weights.items() if not name.startswith(DOUBT)}
    return network, {name.removeprefix(DOUBT): t for name, t in weights.items() if name.startswith(DOUBT)}


def widened(weights):
    """Weights of earlier editions: zeros for the phase between the ends and for the radar's constants, and for the other windows the side lobes of
    Hann's, higher by what the windows' own are."""
    weights = dict(weights)
    stem = weights["stem.conv.weight"]
    if "col_kernels" not in weights:
        stem = F.pad(stem, (0, 0, 0, 0, 0, CONSTANTS))
        weights["scalar1.weight"] = F.pad(weights["scalar1.weight"], (0, CONSTANTS))
        weights["col_kernels"] = other_windows(weights["col_kernel"], 2 * (len(weights["col_kernel"]) - 1), 1)
        weights["row_kernels"] = other_windows(weights["row_kernel"], COLS, 8)
    missing = IN_CHANNELS - stem.shape[1]
    at = 16 + COARSE_CHANNELS - missing
    zeros = torch.zeros(stem.shape[0], missing, *stem.shape[2:])
    return {**weights, "stem.conv.weight": torch.cat([stem[:, :at], zeros, stem[:, at:]], 1)}


def normalise(log, minimum):
    """Lambda in [0, 1]."""
    m = minimum[:, None, None]
    top = log.amax((1, 2), keepdim=True)
    return (log - m) / (top - m)


#: The entries of a weight file that say how large its network is, and for which radars it is.
SIZE, DOMAIN = "size", "domain"

#: What changes no sample that a network sees.
_SILENT = {"transmit_power_watts": None, "chirp_seconds": None, "chirps": None, "chirp_interval_seconds": None}


def trained_radar(domain):
    """The radar of a weight file's domain; None where the weights are for several, or say nothing."""
    from ._apertura import Radar

    given = domain.get("radar")
    if given is None:
        return None
    # Antennas say how many elements there are, and where.
    of_pairs = ("elements", "element_spacing_metres") if "transmitter_x_metres" in given else ()
    return Radar(**{name: value for name, value in given.items() if name not in of_pairs})


class Estimator:
    """A method of the weights of a file: a function as `apertura.evaluate` takes it.

    Args:
        path: Weights (safetensors) as `training/train_live.py` writes them.

    Raises:
        ValueError: The file can't be read, or its weights are another network's.
        OSError: It is not there.
    """

    def __init__(self, path):
        from safetensors import SafetensorError, safe_open
        from safetensors.torch import load_file

        path = Path(path)
        path.open("rb").close()
        try:
            with safe_open(path, "pt") as file:
                record = file.metadata() or {}
            network, _ = parted(load_file(path))
        except SafetensorError as error:
            raise ValueError(f"{path} is no weight file: {error}") from None
        if record.get("network") != "live" or "stem.conv.weight" not in network:
            raise ValueError(f'{path} holds weights of "{record.get("network", "")}"; expected those of "live"')
        self.model = Live(**json.loads(record.get(SIZE, "{}"))).eval()
        try:
            self.model.load_state_dict(widened({name: t.float() for name, t in network.items()}))
        except RuntimeError as error:
            raise ValueError(f"{path}: {error}") from None
        domain = json.loads(record.get(DOMAIN, "{}"))
        #: The radar that the weights are for; None where they are for several, or say nothing.
        self.radar = trained_radar(domain)
        self.eta = float(record.get("eta", 0.8))
        stem = "".join(c if c.isascii() and (c.isalnum() or c in "-_.") else "-" for c in path.stem)
        self.__name__ = (stem if stem.startswith("live") else f"live-{stem}")[:40]
        if self.__name__ == "live":
            self.__name__ = "live-torch"

    @torch.no_grad()
    def __call__(self, ends, radar, request):
        """Lambda of the whole array's map, `[samples, elements]`, and its threshold.

        Raises:
            ValueError: The radar is not the one that the weights are for.
        """
        from ._apertura import live_input

        if self.radar is not None and self.radar.replace(**_SILENT) != radar.replace(**_SILENT):
            raise ValueError(f"the weights are for {self.radar!r}; this radar is {radar!r}")
        if (radar.samples, radar.elements) != (self.model.rows, self.model.columns):
            raise ValueError(f"the network draws {self.model.rows} x {self.model.columns} cells; this radar has {radar.samples} x {radar.elements}")
        given = live_input(ends, radar)
        log, minimum = self.model(*(torch.from_numpy(given[name])[None] for name in ("fine", "coarse", "rows", "scalars", "constants")))
        if request.normalisation == "min-max":
            found = normalise(log, minimum)
        else:
            decibels = float(request.normalisation.removeprefix("db="))
            found = 1 + 20 * (log - log.amax((1, 2), keepdim=True)) / decibels
        # The network's columns rise with cos(theta), for any radar.
        return found[0].clamp(0, 1).numpy()[:, radar.rising_columns], self.eta


def main():
    """Serves the weights of a file as a method of the program."""
    import argparse

    from ._apertura import threads
    from .serve import serve

    parser = argparse.ArgumentParser(prog="python -m apertura.live", description="The live network with the weights of a file, as a method of the program.")
    parser.add_argument("file", metavar="FILE", help="weights as train_live.py writes them (safetensors)")
    path = parser.parse_args().file
    try:
        estimator = Estimator(path)
    except (ValueError, OSError) as error:
        raise SystemExit(f"error: {error}") from None
    torch.set_num_threads(threads())
    serve(estimator, name=estimator.__name__, eta=estimator.eta, description="the live network with weights from a file", weights=_digits(path))


def _digits(path):
    """Digits that tell the weights of a file from others."""
    import hashlib

    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:12]


if __name__ == "__main__":
    main()
