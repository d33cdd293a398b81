"""The options of both training programs. They need no PyTorch, so that a wrong one is told at once."""
import argparse
import os


def common(parser):
    parser.add_argument("--out", metavar="DIR", help="folder of the run, new or to go on with")
    parser.add_argument("--threads", type=int, default=1, help="threads a process")
    parser.add_argument("--loaders", type=int, default=0, help="processes that make scenes beside each training process")
    parser.add_argument("--validate-every", type=float, default=15, help="minutes")
    parser.add_argument("--save-every", type=float, default=2, help="minutes")
    parser.add_argument("--steps", type=int, help="stop at this step, also before the minutes are over")
    parser.add_argument("--cool", type=float, default=0.0, help="minutes at the end of this part over which the learning rate falls to zero")
    parser.add_argument("--pool", type=int, default=0, help="keep this many scenes on the GPU and draw batches from them; for one process (0: no)")
    parser.add_argument("--uses", type=float, default=2.0, help="with --pool: how often a scene is drawn, on average, at most")
    parser.add_argument("--graph", action="store_true", help="record the step as a CUDA graph and replay it: for one process with a GPU")
    parser.add_argument("--log-every", type=int, default=1, help="steps a line of log.csv: reading the loss waits for the GPU")
    parser.add_argument("--untrained", action="store_true", help="with --export: write weights that no step was taken with, all the same")
    parser.add_argument("--export", metavar="FILE", help="write the averaged weights to this file, with their validation figures, and stop")


def refuse_untrained(args, maps):
    """Ends the program where `--export` would write weights that saw no map, unless `--untrained` asks for them."""
    if args.export and maps == 0 and not args.untrained:
        raise SystemExit(f"{args.out}: the weights of this run saw no map; expected a folder with the checkpoint.pt of a run, or --untrained "
                         "to write them all the same")


def checked(parser, arguments):
    """Parsed arguments; those that make no sense together end the program with a message."""
    args = parser.parse_args(arguments)
    for name, least in (("batch", 1), ("threads", 1), ("loaders", 0), ("validation", 0), ("minutes", 0), ("cool", 0), ("lr", 0), ("pool", 0), ("log_every", 1), ("filters", 1)):
        value = getattr(args, name, least)
        if not least <= value < float("inf"):
            parser.error(f"--{name.replace('_', '-')} is {value}; expected {least} or more")
    if args.out and os.path.exists(args.out) and not os.path.isdir(args.out):
        parser.error(f"--out {args.out} is a file; expected a folder, new or of a run")
    if not args.out and not getattr(args, "judge", None):
        parser.error("--out DIR is missing: the folder of the run, new or to go on with")
    for name in ("init", "judge"):
        path = getattr(args, name, None)
        if path and not os.path.isfile(path):
            parser.error(f"--{name} {path}: there is no such file")
    for name in ("pool", "graph"):
        if getattr(args, name) and int(os.environ.get("WORLD_SIZE", 1)) > 1:
            parser.error(f"--{name} is for one process; leave torchrun away, or --{name}")
    if args.pool and (args.pool < args.batch or args.uses <= 0):
        parser.error(f"--pool {args.pool} --uses {args.uses}: expected at least --batch ({args.batch}) scenes, and uses above 0")
    if (args.export or getattr(args, "judge", None)) and args.validation < 1:
        parser.error(f"--validation is {args.validation}; expected 1 or more beside --export or --judge: figures are of validation scenes")
    if args.export and not args.init and not os.path.exists(os.path.join(args.out, "checkpoint.pt")):
        refuse_untrained(args, 0)
    return args


def live(arguments=None):
    ap = argparse.ArgumentParser(description="Trains the live network; train_live.py says more in its head.")
    ap.add_argument("--minutes", type=float, default=80, help="of training in this part of the run; validation comes on top")
    ap.add_argument("--seed", type=int, default=0)
    ap.add_argument("--batch", type=int, default=4, help="scenes a step of each process, all of them new")
    ap.add_argument("--lr", type=float, default=5e-4)
    ap.add_argument("--bf16", action="store_true", help="convolutions in bfloat16 (weights, sums and loss stay in f32): faster where the processor has AMX")
    ap.add_argument("--edge-weight", type=float, default=0.0)
    ap.add_argument("--validation", type=int, default=6, help="validation scenes a kind")
    ap.add_argument("--mixture", default="world", metavar="KINDS", help="kinds of training scenes with their shares, as in 2=1,walls=3")
    ap.add_argument("--radar", default="random", metavar="random|thesis|FILE",
                    help="what sees them: radars drawn at random, that of table 3.1, or that of a .toml with a table [radar], whose shape the network gets")
    ap.add_argument("--windows", metavar="NAMES", help="with --pool: of radars drawn at random only those with these windows, as in hann,blackman")
    ap.add_argument("--tiny", action="store_true", help="a network of a few thousand weights, to try the program with")
    ap.add_argument("--snr-share", type=float, default=0.5, help="part of the scenes over thermal noise")
    ap.add_argument("--snr", type=float, nargs=2, default=(10.0, 100.0), metavar="DB", help="lowest and highest ratio of that noise")
    ap.add_argument("--init", metavar="FILE", help="weight file to start from; one of the first edition gets channels of zeros for what it lacks")
    ap.add_argument("--first-scene", type=int, default=0, help="with --init: number of the first training scene, so that none is seen twice")
    common(ap)
    ap.add_argument("--judge", metavar="FILE", help="print the validation figures of this weight file, and stop; needs no --out")
    args = checked(ap, arguments)
    if args.radar not in ("random", "thesis") and not os.path.isfile(args.radar):
        ap.error(f"--radar {args.radar}: there is no such file; expected random, thesis, or a .toml with a table [radar]")
    if args.windows and not (args.pool and args.radar == "random"):
        ap.error(f"--windows {args.windows} chooses among radars drawn at random and kept in a pool; expected --pool N and --radar random beside it")
    return args


def thesis(arguments=None):
    ap = argparse.ArgumentParser(description="Trains the thesis' network; train_thesis.py says more in its head.")
    ap.add_argument("--experiment", type=int, choices=[1, 2], required=True)
    ap.add_argument("--filters", type=int, default=16, help="filters of a convolution: 64 in the thesis")
    ap.add_argument("--minutes", type=float, default=60, help="of training in this part of the run; validation comes on top")
    ap.add_argument("--batch", type=int, default=2, help="whole maps a step of each process")
    ap.add_argument("--lr", type=float, default=3e-3)
    ap.add_argument("--whole-from", type=int, default=2000, help="step from which on batches hold whole maps; with --pool all do")
    ap.add_argument("--init", metavar="FILE", help="checkpoint (.pt) or weights (.safetensors) of another run to start from")
    ap.add_argument("--muon", action="store_true", help="of a new run: Muon for the kernels, AdamW for the rest")
    ap.add_argument("--bf16", action="store_true", help="convolutions in bfloat16: weights, sums and loss stay in f32")
    ap.add_argument("--first-scene", type=int, default=0, help="with --init of weights: number of the first training scene, so that none is seen twice")
    ap.add_argument("--validation", type=int, default=8, help="validation scenes a set")
    common(ap)
    return checked(ap, arguments)
