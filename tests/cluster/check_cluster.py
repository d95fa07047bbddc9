#!/usr/bin/env python3
"""Checks that servers of one world in PostgreSQL lose nothing, in the manner of Jepsen.

Several servers serve one world: one owns it, the others follow. Bots build through all of them. The
servers, their clocks, the database with its standby and its disks, and the network between all of these
fail at random (faults.py). Then every edit that was called durable must be in the log once, the log must
be in order, no two starts may have had the same epoch, and every digest must be equal (world_check.py).

A seed decides which faults are made, not at which step of a program they come: two runs of a seed differ.

The bots are the first half of the check: they verify each message, count violations of the protocol, and
look at each voxel that they have set. SQL and runstone-replay are the other half. prove_checks.py shows
that the checks fail if something is wrong.
"""
import argparse
import pathlib
import shutil
import signal
import sys
import tempfile

from run import Run
from server_clock import library
from small_disk import can_mount


# If so many handovers were begun, one at least must succeed. Many are refused or fail, because of other faults.
HANDOVERS_BEGUN = 10


def make_folder():
    """Makes a folder for a run, which PostgreSQL may enter."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="runstone-cluster-"))
    folder.chmod(0o755)
    return folder


def end_in_order():
    """Lets SIGTERM end this process in such a way that all that it has started is ended."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of the programs")
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--seconds", type=int, default=60, help="of each run, in which things fail")
    parser.add_argument("--seed", type=int, default=1, help="of the first run; the next ones count on")
    parser.add_argument("--without", action="append", default=[], metavar="FAULT",
                        help="leave a fault out: a name of faults.py; may be given several times")
    options = parser.parse_args()
    end_in_order()
    has_disks = can_mount()
    if not has_disks:
        print("no full disks: this process may not mount any")
    if library() is None:
        print("no wrong clocks: libfaketime is not installed")
    failed = begun = succeeded = 0
    for seed in range(options.seed, options.seed + options.runs):
        folder = make_folder()
        run = Run(options.programs.resolve(), folder, options.seconds, seed, has_disks, options.without)
        wrong = ["the test was interrupted"]
        try:
            wrong = run.check(run.fail_at_random)
        finally:
            run.close(keeps_data=bool(wrong))
        print(f"seed {seed}: {run.summary()}", flush=True)
        begun, succeeded = begun + run.handovers()[0], succeeded + run.handovers()[1]
        if wrong:
            failed += 1
            print(f"seed {seed}: VIOLATION, see {folder}: " + "; ".join(wrong), flush=True)
        else:
            shutil.rmtree(folder)
    if begun >= HANDOVERS_BEGUN and succeeded == 0:
        failed += 1
        print(f"VIOLATION: none of {begun} handovers succeeded", flush=True)
    print(f"{options.runs} runs of {options.seconds} s, {failed} with violations")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
