"""The live network: PyTorch twin of `src/network/live/module.rs`, with the same layer names and shapes."""
import math

import torch
import torch.nn as nn
import torch.nn.functional as F

LN10 = math.log(10.0)
ROWS, COLS, FINE, GRID = 512, 1024, 256, 64
COARSE_CHANNELS = 10
IN_CHANNELS = 16 + COARSE_CHANNELS + 6 + 2 + 4


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


def circulant(log_kernel, n):
    """Matrix [n, n] of the even circular kernel whose log10 at distances 0..n/2 is `log_kernel`."""
    i = torch.arange(n, device=log_kernel.device)
    d = (i[:, None] - i[None, :]) % n
    d = torch.minimum(d, n - d)
    return torch.exp(LN10 * log_kernel)[d]


def tail_prior(n, offset):
    """log10 of the side lobes of a Hann window at distances 0..n/2: they fall as 1/k^3."""
    k = torch.arange(n // 2 + 1, dtype=torch.float32)
    return offset - 3 * torch.log10(k + 1)


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
        self.scalar1 = nn.Linear(2 * c3 + 2, 64)
        self.scalar2 = nn.Linear(64, 2)
        nn.init.zeros_(self.scalar2.weight)
        nn.init.zeros_(self.scalar2.bias)
        with torch.no_grad():
            for m in (self.fine2, self.row_sources):
                m.weight.mul_(0.3)
                m.bias.fill_(-1.0)
        r = torch.arange(ROWS, dtype=torch.float32)[:, None].expand(ROWS, GRID)
        u = ((torch.arange(GRID, dtype=torch.float32) - GRID // 2) / (GRID // 2))[None, :].expand(ROWS, GRID)
        grid = torch.stack([r / 256 - 1, torch.log10(r + 4) - 2, u, torch.sqrt(1 - u * u)])
        self.register_buffer("grid", grid, persistent=False)

    def forward(self, fine, coarse, rows, scalars):
        """log10 |Y_full| [B, 512, 1024] in decades above the gain, and its minimum [B]."""
        return self.with_picture(fine, coarse, rows, scalars)[:2]

    def with_picture(self, fine, coarse, rows, scalars):
        """The same, and the coarse half's last picture [B, c0, 512, 64], which the heads read."""
        b = fine.shape[0]
        fine_n = ((fine + 3) / 3).clamp(-4, 2)
        coarse_n = torch.cat([((coarse[:, :4] + 3) / 3).clamp(-4, 2), coarse[:, 4:]], 1)
        rows_n = torch.cat([rows[:, :4], ((rows[:, 4:] + 3) / 3).clamp(-4, 2)], 1)
        scalars_n = (scalars + 8) / 3
        x = torch.cat([
            unshuffle_cols(fine_n, 4), coarse_n, rows_n[..., None].expand(-1, -1, -1, GRID),
            scalars_n[:, :, None, None].expand(-1, -1, ROWS, GRID), self.grid.expand(b, -1, -1, -1)], 1)
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
            return *self.sources(scalars, scalars_n, x3.float(), y0.float(), f.float()), y0

    def sources(self, scalars, scalars_n, x3, y0, f):
        """What the features make of every cell, in f32 whatever the convolutions were in: sums over many decades follow."""
        b = f.shape[0]
        pooled = torch.cat([x3.mean((2, 3)), x3.amax((2, 3))], 1)
        s = self.scalar2(F.relu(self.scalar1(torch.cat([pooled, scalars_n], 1))))
        heads = shuffle_cols(f, 4) * 3 - 3
        a = heads.clamp(-18, 4)
        local = torch.exp(LN10 * a[:, 0])
        column = circulant(self.col_kernel, ROWS) @ torch.exp(LN10 * a[:, 1])
        sharp = local + column
        src = shuffle_cols(self.row_sources(y0), 2)[:, 0] * 3 - 3
        wide = torch.exp(LN10 * src.clamp(-18, 4)) + sharp.view(b, ROWS, 128, 8).mean(3)
        row = (wide @ circulant(self.row_kernel, 128)).repeat_interleave(8, 2)
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

    def forward(self, fine, coarse, rows, scalars):
        """Decades, their minimum, and the logarithm of the expected error."""
        log, minimum, picture = self.live.with_picture(fine, coarse, rows, scalars)
        return log, minimum, self.doubt(picture.detach())


#: What the tensors of `Doubt` begin with in weight files.
DOUBT = "doubt."


def parted(weights):
    """Tensors of a weight file: the network's, and those of its doubt under their own names."""
    network = {name: t for name, t in weights.items() if not name.startswith(DOUBT)}
    return network, {name.removeprefix(DOUBT): t for name, t in weights.items() if name.startswith(DOUBT)}


def widened(weights):
    """Weights of the first edition, which had no phase between the ends, with channels for it that start at zero."""
    stem = weights["stem.conv.weight"]
    missing = IN_CHANNELS - stem.shape[1]
    if missing == 0:
        return weights
    at = 16 + COARSE_CHANNELS - missing
    zeros = torch.zeros(stem.shape[0], missing, *stem.shape[2:])
    return {**weights, "stem.conv.weight": torch.cat([stem[:, :at], zeros, stem[:, at:]], 1)}


def normalise(log, minimum):
    """Lambda in [0, 1]."""
    m = minimum[:, None, None]
    top = log.amax((1, 2), keepdim=True)
    return (log - m) / (top - m)
