#!/usr/bin/env python3
"""Checks that servers of one world in PostgreSQL lose nothing, in the manner of Jepsen.

Several servers serve one world: one owns it, the others follow. Bots build through all of them, and
servers, database and the network between all of these fail at random. Then every edit that was called
durable must be in the log once, the log must be in order, no two starts may have had the same epoch, and
every digest must be equal.

A seed decides which faults are made, not at which step of a program they come: two runs of a seed differ.

The bots are the first half of the check: they verify each message, count violations of the protocol, and
look at each voxel that they have set. SQL and runstone-replay are the other half.
"""
import argparse
import collections
import json
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

from game_server import GameServer
from postgres import Postgres
from wire import Wires

SERVERS = 3
BOTS = 20
PATIENCE_S = 120


class Run:
    def __init__(self, bin_folder, folder, seconds, seed):
        self.bin, self.folder, self.seconds = bin_folder, pathlib.Path(folder), seconds
        self.random = random.Random(seed)
        self.faults = collections.Counter()
        self.heals = []  # (time, what ends a fault)
        self.wires = Wires()
        self.postgres = Postgres(self.folder / "postgres")
        self.servers = []
        for i in range(SERVERS):
            wire = self.wires.add(lambda: self.postgres.port)
            peers = self.wires.add(lambda i=i: self.servers[i].port())
            self.servers.append(GameServer(self.bin / "runstone-server", self.folder, f"server{i}", wire, peers,
                                           self.postgres.url(wire.port)))
        self.players = self.wires.add(self.player_port)

    def owner(self):
        """Returns the server that has the lease, or None."""
        try:
            address = self.postgres.text("SELECT address FROM lease")
        except subprocess.SubprocessError:  # there is no world yet, or the database is down
            return None
        return next((one for one in self.servers if address == f"127.0.0.1:{one.peers.port}"), None)

    def player_port(self):
        """Returns the port of any server that listens: players come to all of them."""
        ports = [port for server in self.servers if (port := server.port())]
        return random.choice(ports) if ports else None

    def later(self, seconds, heal):
        self.heals.append((time.monotonic() + seconds, heal))

    def step(self):
        for heal in [heal for at, heal in self.heals if at <= time.monotonic()]:
            heal()
        self.heals = [(at, heal) for at, heal in self.heals if at > time.monotonic()]
        for server in self.servers:
            server.step()
        time.sleep(0.05)

    def wait(self, seconds, until=lambda: False):
        end = time.monotonic() + seconds
        while time.monotonic() < end and not until():
            self.step()
        return until()

    def fail_something(self):
        # The server that owns the world, or any of them.
        server = self.owner() if self.random.random() < 0.7 else None
        server = server or self.random.choice(self.servers)
        seconds = self.random.uniform(0.3, 6)
        fault = self.random.choice(["kill", "stop", "pause", "freeze database", "cut database", "cut players",
                                    "freeze players", "cut servers", "freeze servers", "crash database"])
        if fault == "kill":
            server.signal(signal.SIGKILL)
        elif fault == "stop":
            server.signal(signal.SIGTERM)
        elif fault == "pause":
            if server.is_paused:
                return
            server.pause()
            self.later(seconds, server.resume)
        elif fault == "freeze database":
            server.wire.freeze()
            self.later(seconds, server.wire.thaw)
        elif fault == "cut database":
            server.wire.cut()
        elif fault == "cut players":
            self.players.cut()
        elif fault == "freeze players":
            self.players.freeze()
            self.later(seconds, self.players.thaw)
        elif fault == "cut servers":
            server.peers.cut()
        elif fault == "freeze servers":
            server.peers.freeze()
            self.later(seconds, server.peers.thaw)
        elif fault == "crash database":
            self.postgres.crash()
            self.wait(self.random.uniform(0, 3))
            self.postgres.start()
        self.faults[fault] += 1

    def play(self):
        """Lets bots build while things fail. Returns what was wrong with what they saw."""
        self.servers[0].create()
        if not self.wait(30, self.owner):
            return ["no server has taken the world"]
        self.wait(2)
        # Before the world was there, the others could not start.
        for server in self.servers:
            server.failed_starts.clear()
        keys, report = self.folder / "keys", self.folder / "bots.json"
        keys.mkdir()
        with open(self.folder / "bots.log", "wb") as log:
            bots = subprocess.Popen([self.bin / "runstone-bot", "--connect", f"127.0.0.1:{self.players.port}", "--count",
                                     str(BOTS), "--replicas", "4", "--rate", "3", "--duration", str(self.seconds),
                                     "--patience", str(PATIENCE_S), "--key-dir", keys, "--report", report],
                                    stdout=log, stderr=log)
            end = time.monotonic() + self.seconds
            self.wait(2)
            while time.monotonic() < end:
                self.fail_something()
                self.wait(self.random.uniform(0.5, 5))
            for _, heal in self.heals:
                heal()
            self.heals = []
            if not self.wait(2 * PATIENCE_S, lambda: bots.poll() is not None):
                bots.kill()
                return ["the bots do not end"]
        seen = json.loads(report.read_text())
        self.edits = seen["edits"]
        wrong = [f"the bots ended with exit code {bots.returncode}, see {report}"] if bots.returncode != 0 else []
        if seen["standing"]["changed"] != 0 or seen["drifted"] != 0:
            wrong.append(f"voxels of bots: {seen['standing']}; replicas that drifted: {seen['drifted']}")
        return wrong

    def check_world(self):
        """Returns what is wrong with the world on disk. Requires that no server runs."""
        wrong = []
        ask = self.postgres.ask
        if twice := ask("SELECT count(*) FROM (SELECT 1 FROM edit_log WHERE cause = 0 GROUP BY author, instance, "
                        "client_seq HAVING count(*) > 1) twice"):
            wrong.append(f"{twice} edits are in the log more than once")
        if gaps := ask("SELECT coalesce(max(seq), 0) - count(*) FROM edit_log"):
            wrong.append(f"{gaps} edits are missing in the log")
        if falls := ask("SELECT count(*) FROM (SELECT epoch, lag(epoch) OVER (ORDER BY seq) AS before FROM edit_log) "
                        "pairs WHERE epoch < before"):
            wrong.append(f"the epoch falls {falls} times along the log")
        self.logged = ask("SELECT count(*) FROM edit_log WHERE cause = 0")
        # An edit that a server refused before it ended, without an answer, is neither rejected nor durable.
        durable, kept_max = self.edits["durable"], self.edits["submitted"] - self.edits["rejected"]
        if not durable <= self.logged <= kept_max:
            wrong.append(f"{self.logged} edits are in the log: {durable} were called durable, and {kept_max} not refused")
        for server in self.servers:
            if server.failed_starts:
                wrong.append(f"{server.name} could not start: exit codes {server.failed_starts}")
        epochs = [epoch for server in self.servers for epoch in server.epochs()]
        self.takeovers = len(epochs)
        if len(set(epochs)) != len(epochs):
            wrong.append(f"two starts had the same epoch: {sorted(epochs)}")
        verified = subprocess.run([self.bin / "runstone-replay", "verify", "--world", self.postgres.url()],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if verified.returncode != 0:
            wrong.append(f"runstone-replay verify: {verified.stdout}")
        return wrong

    def close(self):
        for server in self.servers:
            server.resume()
            server.signal(signal.SIGKILL)
            if server.process is not None:
                server.process.wait()
        self.postgres.crash()
        self.wires.stop()

    def check(self):
        wrong = self.play()
        if wrong:
            return wrong
        # The owner stops last.
        owner = self.owner()
        for server in sorted(self.servers, key=lambda one: one is owner):
            if server.process is not None and (code := server.stop()) not in (0, -signal.SIGTERM):
                wrong.append(f"{server.name} stopped with exit code {code}")
        return wrong + self.check_world()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of the programs")
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--seconds", type=int, default=60, help="of each run, in which things fail")
    parser.add_argument("--seed", type=int, default=1, help="of the first run; the next ones count on")
    options = parser.parse_args()
    failed = 0
    for seed in range(options.seed, options.seed + options.runs):
        folder = tempfile.mkdtemp(prefix="runstone-cluster-")
        pathlib.Path(folder).chmod(0o755)
        run = Run(options.programs.resolve(), folder, options.seconds, seed)
        try:
            wrong = run.check()
        finally:
            run.close()
        if wrong:
            failed += 1
            print(f"seed {seed}: VIOLATION, see {folder}: " + "; ".join(wrong), flush=True)
            continue
        subprocess.run(["rm", "-rf", folder], check=True)
        print(f"seed {seed}: {run.edits['submitted']} edits, {run.edits['durable']} durable, {run.edits['rejected']} rejected, "
              f"{run.logged} in the log; {run.takeovers} starts took the world; faults: {dict(run.faults)}", flush=True)
    print(f"{options.runs} runs of {options.seconds} s, {failed} with violations")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
