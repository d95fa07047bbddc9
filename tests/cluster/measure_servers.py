#!/usr/bin/env python3
"""Measures what servers of one world cost, and prints docs/figures/cluster.md.

    tests/cluster/measure_servers.py build/release/bin > docs/figures/cluster.md

Servers, database and bots run on this machine, so it must be idle otherwise. The processor time of a
server is that of its process, of the database that of all its processes, in the middle of a run. It takes
some ten minutes, and needs the packages of the set `postgres` (scripts/packages).
"""
import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from postgres import Postgres, children_of

GROUPS = 2       # of builders, far apart
BUILDERS = 150   # of each group
RATES = (3, 20)  # edits a second of each
JOIN_S = 7       # until all have joined
MEASURE_S = 12
PAIRS = 3        # of runs that are compared
TICKS = os.sysconf("SC_CLK_TCK")


def cpu_s(pid):
    """Returns the processor time that a process has used."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


class Server:
    def __init__(self, programs, folder, number, url):
        self.port_file = folder / f"{number}.port"
        with open(folder / f"{number}.log", "wb") as log:
            self.process = subprocess.Popen(
                ["setpriv", "--pdeathsig=KILL", programs / "runstone-server", "--world", folder / f"{number}",
                 "--store", url, "--standby", "--create", "--generator", "flat", "--seed", "1", "--listen", "127.0.0.1:0",
                 "--peer-address", "127.0.0.1", "--port-file", self.port_file, "--sessions-per-address", "0",
                 "--sessions-max", "1000",
                 "--budgets-per-address", "0", "--connections-per-second", "0"],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        end = time.monotonic() + 60
        while not (self.port_file.exists() and self.port_file.read_text()):
            if self.process.poll() is not None or time.monotonic() > end:
                sys.exit(f"a server does not start, see {folder}/{number}.log")
            time.sleep(0.05)
        self.port = int(self.port_file.read_text())

    def stop(self):
        self.process.terminate()
        self.process.wait(timeout=60)


class Fleet:
    """Bots that build, or that only watch, on sites of their own."""

    def __init__(self, programs, folder, name, port, *more):
        self.report = folder / f"{name}.json"
        self.process = subprocess.Popen(
            ["setpriv", "--pdeathsig=KILL", programs / "runstone-bot", "--connect", f"127.0.0.1:{port}",
             "--name", name, "--replicas", "0", "--view", "1", "--duration", str(JOIN_S + MEASURE_S + 2),
             "--report", self.report, *more],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def wait(self):
        if self.process.wait(timeout=120) != 0:
            sys.exit("the bots have failed")
        return json.loads(self.report.read_text())


class Costs:
    """Processor time in the middle of a run, in seconds."""

    def __init__(self, servers, database):
        self.servers, self.database = servers, database

    def all_servers(self):
        return sum(self.servers)


def measure(programs, servers, fleets):
    """Runs servers of a new world and bots, and returns their Costs. `fleets`: (server, what they do)."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="runstone-costs-"))
    folder.chmod(0o755)
    postgres = Postgres(folder / "postgres", is_synchronous=False)
    running, bots = [], []
    try:
        postgres.own_data()
        postgres.initialise()
        postgres.start()
        for number in range(servers):
            running.append(Server(programs, folder, number, postgres.url()))
        time.sleep(1)  # until the second one follows
        for number, (server, what) in enumerate(fleets):
            bots.append(Fleet(programs, folder, f"fleet{number}", running[server].port, *what))
        time.sleep(JOIN_S)

        def spent():
            database = [postgres.process.pid, *children_of(postgres.process.pid)]
            return [cpu_s(one.process.pid) for one in running], sum(cpu_s(pid) for pid in database)
        before, before_database = spent()
        time.sleep(MEASURE_S)
        after, after_database = spent()
        for one in bots:
            seen = one.wait()
            if seen["edits"]["submitted"] != seen["edits"]["durable"]:
                sys.exit(f"not all edits are durable: {seen['edits']}")
        return Costs([late - early for late, early in zip(after, before)], after_database - before_database)
    finally:
        for one in bots:
            one.process.kill()
            one.process.wait()
        for one in reversed(running):
            one.stop()
        postgres.close()
        shutil.rmtree(folder, ignore_errors=True)


def builders(group, rate):
    """Returns what a group of builders does, who stand far from the other groups."""
    sites = 100 * GROUPS
    return ["--count", str(BUILDERS), "--rate", str(rate), "--sites", str(sites), "--first-site",
            str(100 * group), "--seed", str(group)]


def compiler(programs):
    """Returns the compiler of a program, as it is written in it."""
    text = subprocess.run(["strings", "-n", "8", programs / "runstone-server"], check=True, text=True,
                          stdout=subprocess.PIPE).stdout
    return next((line.rpartition(" ")[2] for line in text.splitlines() if line.startswith("GCC: ")),
                "unknown compiler")


def machine(programs):
    model = next(line.partition(": ")[2].strip() for line in pathlib.Path("/proc/cpuinfo").read_text()
                 .splitlines() if line.startswith("model name"))
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], check=True, text=True,
                            stdout=subprocess.PIPE,
                            cwd=pathlib.Path(__file__).parent).stdout.strip()
    return f"{model}, {os.cpu_count()} cores; g++ {compiler(programs)}; commit {commit}"


class Load:
    """What servers cost at one rate of edits."""

    def __init__(self, run, rate):
        groups = [builders(group, rate) for group in range(GROUPS)]
        one, two = [], []
        for _ in range(PAIRS):  # in turn, so that a disturbance meets both
            one.append(run("one server", 1, [(0, group) for group in groups]))
            two.append(run("two servers", 2, list(enumerate(groups))))
        idle = run("one server, and another one that nobody is at", 2, [(0, group) for group in groups])
        away = run("all builders at the server that follows", 2, [(1, group) for group in groups])
        self.edits_each_second = GROUPS * BUILDERS * rate
        edits = self.edits_each_second * MEASURE_S
        self.one = statistics.median(run.all_servers() for run in one)
        self.two = statistics.median(run.all_servers() for run in two)
        self.ratios = [after.all_servers() / before.all_servers() for before, after in zip(one, two)]
        self.costs_us = [seconds / edits * 1e6 for seconds in
                         (self.one, statistics.median(run.database for run in one), idle.servers[1],
                          away.servers[0], away.servers[1])]


COSTS = ("an edit of a builder at the owner, with the builder's session",
         "the same edit in the database",
         "one more server: at that server, each edit",
         "an edit of a builder at another server: at the owner",
         "an edit of a builder at another server: at that server")


def strand_table(programs):
    """Returns the table of `runstone-bench relay`."""
    printed = subprocess.run([programs / "runstone-bench", "relay"], check=True, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
    return printed[printed.index("|"):].strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of the programs")
    programs = parser.parse_args().programs.resolve()

    def run(name, servers, fleets):
        print("running", name, file=sys.stderr)
        return measure(programs, servers, fleets)

    loads = [Load(run, rate) for rate in RATES]

    def row(name, cells):
        return f"| {name} | {' | '.join(cells)} |"
    print(f"""# Figures: several servers of one world
`tests/cluster/measure_servers.py build/release/bin` prints this page. Servers, PostgreSQL and bots are on
one machine, and encrypted. Two groups of {BUILDERS} builders stand far apart, and make edits of one voxel.
Processor time is that of processes in {MEASURE_S} s, after all have joined. It contains all that the players
of these servers cost: their moves and poses, and what they see of each other.

{machine(programs)}
""")
    print(row("two groups of builders", [f"{load.edits_each_second:,} edits/s" for load in loads]))
    print("|---|" + "---|" * len(loads))
    print(row("at one server, s", [f"{load.one:.2f}" for load in loads]))
    print(row("each at a server of its own, s", [f"{load.two:.2f}" for load in loads]))
    print(row("two servers against one: median (and each pair of runs)",
              [f"{statistics.median(load.ratios):.2f} ({', '.join(f'{ratio:.2f}' for ratio in load.ratios)})"
               for load in loads]))
    print()
    print(row("cost, µs of processor time", [f"{load.edits_each_second:,} edits/s" for load in loads]))
    print("|---|" + "---|" * len(loads))
    for number, name in enumerate(COSTS):
        costs = [load.costs_us[number] for load in loads]
        print(row(name, [f"{cost:.0f}" if abs(cost) >= 20 else f"{cost:.1f}" for cost in costs]))
    print(f"""
## The world strand
`runstone-bench relay` measures the same without sockets, encryption and database: the processor time of
the world strand, the one thread that orders edits, and of the codec of the messages between servers.
20 players at each server see each other's edits.

{strand_table(programs)}""")


if __name__ == "__main__":
    main()
