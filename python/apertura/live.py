"""The live network in PyTorch: the twin of `src/network/live/module.rs`, with the same layer names and shapes. Needs `torch`."""
import math

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


class Live(nn.Module):
    def __init__(self, c=(16, 32, 64, 96), blocks=(1, 2, 2, 3), fine=16):
        super().__init__()
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
        self.col_kernel = nn.Parameter(tail_prior(ROWS, -0.5))
        self.row_kernel = nn.Parameter(tail_prior(128, -1.0))
        self.col_kernels = nn.Parameter(other_windows(self.col_kernel.detach(), ROWS, 1))
        self.row_kernels = nn.Parameter(other_windows(self.row_kernel.detach(), COLS, 8))
        self.scalar1 = nn.Linear(2 * c3 + 2 + CONSTANTS, 64)
        self.scalar2 = nn.Linear(64, 2)
        nn.init.zeros_(self.scalar2.weight)
        nn.init.zeros_(self.scalar2.bias)
        with torch.no_grad():
            for m in (self.fine2, self.row_sources):
                m.weight.mul_(0.3)
                m.bias.fill_(-1.0)
        r = torch.arange(ROWS, dtype=torch.float32)[:, None].expand(ROWS, GRID)
        u = ((torch.arange(GRID, dtype=torch.float32) - GRID // 2) / (GRID // 2))[None, :].expand(ROWS, GRID)
        grid = torch.stack([r / 256 - 1, torch.log10(r + 4) - 2, u])
        self.register_buffer("grid", grid, persistent=False)

    def forward(self, fine, coarse, rows, scalars, constants):
        """log10 |Y_full| [B, 512, 1024] in decades above the gain, and its minimum [B]."""
        return self.with_picture(fine, coarse, rows, scalars, constants)[:2]

    def with_picture(self, fine, coarse, rows, scalars, constants):
        """The same, and the coarse half's last picture [B, c0, 512, 64], which the heads read."""
        b = fine.shape[0]
        fine_n = ((fine + 3) / 3).clamp(-4, 2)
        coarse_n = torch.cat([((coarse[:, :4] + 3) / 3).clamp(-4, 2), coarse[:, 4:]], 1)
        rows_n = torch.cat([rows[:, :4], ((rows[:, 4:] + 3) / 3).clamp(-4, 2)], 1)
        scalars_n = (scalars + 8) / 3
        cos = self.grid[2] / (1 + constants[:, SPACING_AT])[:, None, None]
        directions = torch.stack([cos, torch.sqrt((1 - cos * cos).clamp(min=0))], 1)
        planes = lambda values: values[:, :, None, None].expand(-1, -1, ROWS, GRID)
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
        """What the features make of every cell, in f32 whatever the convolutions were in: sums over many decades follow."""
        b = f.shape[0]
        pooled = torch.cat([x3.mean((2, 3)), x3.amax((2, 3))], 1)
        s = self.scalar2(F.relu(self.scalar1(torch.cat([pooled, scalars_n, constants], 1))))
        heads = shuffle_cols(f, 4) * 3 - 3
        a = heads.clamp(-18, 4)
        local = torch.exp(LN10 * a[:, 0])
        column = of_windows(constants, self.col_kernel, self.col_kernels, ROWS) @ torch.exp(LN10 * a[:, 1])
        sharp = local + column
        src = shuffle_cols(self.row_sources(y0), 2)[:, 0] * 3 - 3
        wide = torch.exp(LN10 * src.clamp(-18, 4)) + sharp.view(b, ROWS, 128, 8).mean(3)
        row = (wide @ of_windows(constants, self.row_kernel, self.row_kernels, 128)).repeat_interleave(8, 2)
        floor = scalars[:, 0] + s[:, 0]
        total = sharp + row + torch.exp(LN10 * floor)[:, None, None]
        log = torch.log(total) / LN10
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
        """log10 of the error of each cell, [B, 512, 256], and what the head's hidden layer holds on average, [B, hidden]."""
        hidden = F.relu(self.conv1(picture))
        return shuffle_cols(self.conv2(hidden), FINE // GRID)[:, 0].float(), hidden.mean((2, 3)).float()

    def forward(self, picture):
        """log10 of the error in Lambda that nine of ten cells stay below, [B, 512, 256]: one number for four columns.

        The mean of the hidden layer adds the same to every cell of a scene."""
        of_cells, of_scene = self.parts(picture)
        return of_cells + self.scene(of_scene)[:, :, None]


#: Decades between which the head's cells count, and how far a scene's part may go.
CELL_DECADES, SCENE_DECADES = (-4.0, 0.0), 0.5


def expected_error(of_cells, of_scene):
    """The error of Lambda that is said, at most 1: [B, 512, 1024] of the decades of the cells [B, 512, 256] and of the scene [B]."""
    decades = of_cells.clamp(*CELL_DECADES) + of_scene.clamp(-SCENE_DECADES, SCENE_DECADES)[:, None, None]
    return (10 ** decades).clamp(max=1).repeat_interleave(COLS // FINE, 2)


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
        weights["col_kernels"] = other_windows(weights["col_kernel"], ROWS, 1)
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
