#!/usr/bin/env python3
"""Measures how long edits wait when the owner of a world changes, and prints docs/figures/pauses.md.

    tests/cluster/measure_pauses.py build/release/bin > docs/figures/pauses.md

Three servers, the database with its synchronous standby, and bots run on this machine, so it must be idle
otherwise. Some bots build through each server that is to stay. It takes some seven minutes, and needs the
packages of the set `postgres` (scripts/packages).
"""
import argparse
import collections
import json
import pathlib
import shutil
import signal
import statistics
import subprocess
import sys

from check_cluster import end_in_order, make_folder
from cluster import Cluster
from measure_servers import machine

LEASE_S = 5    # the setting's default
BOTS = 6       # at each server that is to stay
BUILD_S = 15   # in which the owner changes once
BEFORE_S = 5
RUNS = 3


class Bots:
    """Bots that build at one server and keep replicas."""

    def __init__(self, programs, folder, server):
        self.report = folder / f"{server.name}.json"
        keys = folder / f"{server.name}.keys"
        keys.mkdir()
        self.process = subprocess.Popen(
            ["setpriv", "--pdeathsig=KILL", programs / "runstone-bot", "--connect",
             f"127.0.0.1:{server.port()}", "--name", server.name, "--count", str(BOTS), "--replicas",
             str(BOTS), "--rate", "5", "--behaviour", "build", "--duration", str(BUILD_S), "--key-dir",
             keys, "--patience", "60", "--report", self.report],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def has_ended(self):
        return self.process.poll() is not None

    def result(self):
        """Returns the longest wait of an edit in seconds, and the numbers of edits. Ends the program if an
        edit was lost or a bot drifted."""
        seen = json.loads(self.report.read_text())
        edits = collections.Counter(seen["edits"])
        if (seen["drifted"] != 0 or edits["durable"] + edits["rejected"] != edits["submitted"]
                or seen["local_us"]["infinite"]):
            sys.exit(f"not all is well: {seen['edits']}, drifted {seen['drifted']}, see {self.report}")
        return seen["local_us"]["max"] / 1e6, edits


def kill(cluster, owner):
    owner.signal(signal.SIGKILL)


def stop(cluster, owner):
    owner.signal(signal.SIGTERM)


def hand_over(cluster, owner):
    owner.hand_over()


def fail_over(cluster, owner):
    cluster.database.begin(cluster.database.fail_over(False, 0, 0))


# What happens, whether the owner's own players can stay, and the target in seconds.
CASES = [
    ("the owner is killed (`kill -9`)", kill, False, LEASE_S + 1),
    ("the owner is stopped", stop, False, 0.1),
    ("the owner hands the world over", hand_over, True, 0.1),
    ("the primary of the database is killed, and its standby promoted at once", fail_over, False,
     LEASE_S + 1),
]


def measure(programs, change, has_owner):
    """Returns the longest wait of an edit of a bot that stays, in seconds, and the numbers of edits."""
    folder = make_folder()
    cluster = Cluster(programs, folder, False, True, LEASE_S, has_wires=False)
    bots = []
    try:
        if not cluster.create():
            sys.exit("no server has taken the world")
        cluster.wait(30, lambda: all(server.port() for server in cluster.servers))
        cluster.wait(2)
        owner = cluster.owner()
        bots = [Bots(programs, folder, server) for server in cluster.servers
                if has_owner or server is not owner]
        cluster.wait(BEFORE_S)
        change(cluster, owner)
        if not cluster.wait(BUILD_S + 60, lambda: all(one.has_ended() for one in bots)):
            sys.exit("the bots do not end")
        results = [one.result() for one in bots]
        return max(longest for longest, _ in results), sum((edits for _, edits in results),
                                                           collections.Counter())
    finally:
        for one in bots:
            one.process.kill()
            one.process.wait()
        cluster.close()
        shutil.rmtree(folder, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of the programs")
    programs = parser.parse_args().programs.resolve()
    end_in_order()
    print(f"""# Figures: how long edits wait when the owner changes
`tests/cluster/measure_pauses.py build/release/bin` prints this page. Three servers, PostgreSQL with a
synchronous standby, and {BOTS} bots at each server that stays are on one machine, and encrypted;
`lease_s = {LEASE_S}`. Each bot makes five edits a second. The figure of a run is the longest time from an edit
to its commit. Every edit became durable, unless it was rejected as busy, and no replica drifted.

{machine(programs)}

| what happens | target | median of {RUNS} runs | all runs | edits made | rejected |
|---|---|---|---|---|---|""")
    for name, change, has_owner, target_s in CASES:
        runs = [measure(programs, change, has_owner) for _ in range(RUNS)]
        waits = sorted(longest for longest, _ in runs)
        edits = sum((counts for _, counts in runs), collections.Counter())
        print(f"| {name} | {text(target_s)} | {text(statistics.median(waits))} | "
              f"{', '.join(map(text, waits))} | {edits['submitted']} | {edits['rejected']} |", flush=True)


def text(seconds):
    return f"{seconds:.1f} s" if seconds >= 1 else f"{seconds * 1000:.0f} ms"


if __name__ == "__main__":
    main()
