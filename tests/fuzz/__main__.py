"""``make fuzz``: all targets, or those that are named, within a budget of seconds; exit code 1 where a fault was found."""

from __future__ import annotations

import argparse
import sys
import time

from . import targets
from .target import fuzz


def main() -> int:
    """Run the targets and print what came of them."""
    known = targets.by_name()
    parser = argparse.ArgumentParser(prog="make fuzz", description=__doc__)
    parser.add_argument("targets", nargs="*", help=f"all by default: {', '.join(known)}")
    parser.add_argument("--seconds", type=float, default=1800.0, help="budget of all targets together (1800)")
    parser.add_argument("--count", type=int, help="tries per target; that of the target by default")
    parser.add_argument("--seed", type=int, default=1, help="another seed makes other tries (1)")
    parser.add_argument("--only", type=int, metavar="NUMBER", help="this try alone, as a fault names it")
    options = parser.parse_args()
    unknown = [name for name in options.targets if name not in known]
    if unknown:
        parser.error(f"there is no target {unknown[0]!r}; targets are {', '.join(known)}")
    chosen = [known[name] for name in options.targets or known]
    end, faults = time.monotonic() + options.seconds, 0
    for remaining, target in zip(range(len(chosen), 0, -1), chosen):
        share = (end - time.monotonic()) / remaining  # what one leaves over is the others'
        count, first = (1, options.only) if options.only is not None else (options.count, 0)
        report = fuzz(
            target, count, seed=options.seed, first=first, budget=share, tell=lambda text: print(text, file=sys.stderr)
        )
        faults += len(report.faults)
        print(report, flush=True)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
