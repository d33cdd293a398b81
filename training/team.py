"""Training in one process, or in several that `torchrun` starts: gradients are averaged over all, and the first alone writes files.

    torchrun --nproc-per-node 2 --max-restarts 3 train_live.py --out DIR    # two processes on this machine

Gloo on processors, NCCL where each process has a GPU of its own. When a process dies, torchrun ends the others and starts all of them again;
they go on from the checkpoint.
"""
import datetime
import itertools
import os

import torch
import torch.distributed as dist

#: Longest that a process waits for the others: the first validates meanwhile.
MAX_WAIT = datetime.timedelta(hours=1)


class Team:
    def __init__(self, threads):
        self.rank, self.size = int(os.environ.get("RANK", 0)), int(os.environ.get("WORLD_SIZE", 1))
        #: How often torchrun started all processes again.
        self.restarts = int(os.environ.get("TORCHELASTIC_RESTART_COUNT", 0))
        local, beside = int(os.environ.get("LOCAL_RANK", 0)), int(os.environ.get("LOCAL_WORLD_SIZE", 1))
        self.device = torch.device("cuda", local) if beside <= torch.cuda.device_count() else torch.device("cpu")
        torch.set_num_threads(threads)
        if self.size > 1:
            backend = "nccl" if self.device.type == "cuda" else "gloo"
            # torchrun's store outlives a restart, and with it the addresses of processes that are gone: every start has keys of its own.
            store, rank, size = next(dist.rendezvous("env://"))
            dist.init_process_group(backend, store=dist.PrefixStore(f"start-{self.restarts}", store), rank=rank, world_size=size, timeout=MAX_WAIT)

    @property
    def is_first(self):
        return self.rank == 0

    def share(self, model):
        """The model whose backward pass averages gradients over all processes."""
        return torch.nn.parallel.DistributedDataParallel(model) if self.size > 1 else model

    def mean(self, value):
        """The mean of a number over all processes."""
        total = torch.tensor(float(value), dtype=torch.float64, device=self.device)
        if self.size > 1:
            dist.all_reduce(total)
        return float(total) / self.size

    def agreed(self, number):
        """What the first process says."""
        if self.size == 1:
            return number
        said = torch.tensor([float(number)], dtype=torch.float64, device=self.device)
        dist.broadcast(said, 0)
        return said.item()

    def say(self, text):
        if self.is_first:
            print(text, flush=True)

    def end(self):
        if self.size > 1:
            dist.destroy_process_group()


class Numbers:
    """Batches of numbers of examples: of every `batch * size` in a row, each process takes its own `batch`. A batch sampler without an end."""

    def __init__(self, first, batch, team):
        self.first, self.batch, self.team = first, batch, team

    def __iter__(self):
        for step in itertools.count():
            start = self.first + (step * self.team.size + self.team.rank) * self.batch
            yield list(range(start, start + self.batch))


def batches(data, first, batch, team, loaders):
    """An endless iterator of this process' batches of `data`, from example `first` on, made by `loaders` processes beside it."""
    return iter(torch.utils.data.DataLoader(data, batch_sampler=Numbers(first, batch, team), num_workers=loaders, pin_memory=team.device.type == "cuda"))


class Log:
    """`log.csv`, as `apertura train` writes it: the window's panel *Training* follows it. The figures on validation scenes go to `validation.jsonl`."""

    HEADING = "step,epoch,maps,seconds,learning_rate,loss,smoothed_loss"

    def __init__(self, folder, step):
        """Goes on behind `step`: what a killed run wrote beyond its checkpoint goes."""
        path, lines = os.path.join(folder, "log.csv"), []
        if step > 0 and os.path.exists(path):
            with open(path) as f:
                whole = [line for line in f if line.endswith("\n")][1:]
            lines = [line for line in whole if int(line.split(",", 1)[0]) <= step]
        self.seconds = float(lines[-1].split(",")[3]) if lines else 0.0
        self.smoothed = float(lines[-1].split(",")[6]) if lines else None
        with open(path + ".part", "w") as f:
            f.writelines([self.HEADING + "\n", *lines])
        os.replace(path + ".part", path)
        self.file = open(path, "a")

    def line(self, step, maps, seconds, rate, loss):
        self.smoothed = loss if self.smoothed is None else 0.98 * self.smoothed + 0.02 * loss
        # A run of scenes that are all new is one epoch.
        self.file.write(f"{step},0,{maps:.0f},{self.seconds + seconds:.1f},{rate!r},{loss!r},{self.smoothed!r}\n")
        self.file.flush()
