"""Muon: momentum whose step is made orthogonal, for the kernels of convolutions (K. Jordan et al., "Muon: an optimizer for hidden layers", 2024).

Steps are scaled to the size of AdamW's (0.2 sqrt of the longer side; Liu et al., arXiv:2502.16982), so that one learning rate serves both.
"""
import torch

#: Of the quintic iteration that brings every singular value near 1.
COEFFICIENTS = (3.4445, -4.7750, 2.0315)
ITERATIONS = 5


def orthogonal(matrix):
    """The nearest half-orthogonal matrix, about: singular values between 0.7 and 1.2."""
    a, b, c = COEFFICIENTS
    wide = matrix if matrix.shape[0] <= matrix.shape[1] else matrix.T
    x = wide / (wide.norm() + 1e-12)
    for _ in range(ITERATIONS):
        gram = x @ x.T
        x = a * x + (b * gram + c * gram @ gram) @ x
    return x if wide is matrix else x.T


class Muon(torch.optim.Optimizer):
    """For parameters of two axes or more; all axes behind the first are one."""

    def __init__(self, parameters, lr, momentum=0.95, weight_decay=1e-4):
        super().__init__(parameters, {"lr": lr, "momentum": momentum, "weight_decay": weight_decay})

    @torch.no_grad()
    def step(self):
        for group in self.param_groups:
            for p in group["params"]:
                if p.grad is None:
                    continue
                state = self.state[p]
                if not state:
                    state["mean"] = torch.zeros_like(p)
                state["mean"].lerp_(p.grad, 1 - group["momentum"])
                ahead = p.grad.lerp(state["mean"], group["momentum"]).flatten(1)
                change = orthogonal(ahead).reshape(p.shape)
                # The rate may be a tensor, which a recorded step reads from the GPU.
                p.mul_(1 - group["lr"] * group["weight_decay"])
                p.sub_(change * (0.2 * max(ahead.shape) ** 0.5 * group["lr"]))
