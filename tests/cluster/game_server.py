"""A runstone-server of the test, with its wire to the database. It is started again when it has ended."""
import pathlib
import random
import re
import signal
import subprocess
import time


class GameServer:
    def __init__(self, program, folder, name, wire, peers, url):
        """`wire` leads to the database, at `url`. `peers` leads from the other servers to this one."""
        self.folder = pathlib.Path(folder) / name
        self.name, self.wire, self.peers = name, wire, peers
        self.port_file = self.folder.with_suffix(".port")
        self.log = self.folder.with_suffix(".log")
        self.command = [program, "--world", self.folder, "--store", url, "--standby", "--lease-s", "2", "--listen",
                        "127.0.0.1:0", "--peer-address", f"127.0.0.1:{peers.port}", "--port-file", self.port_file, "--sessions-per-address", "0",
                        "--budgets-per-address", "0", "--connections-per-second", "0", "--stop-s", "20"]
        self.process = None
        self.start_at = 0.0
        self.is_paused = False
        self.failed_starts = []  # exit codes of starts that gave up

    def create(self):
        """Makes the world, with this server as its first owner."""
        self._start("--create", "--generator", "flat")

    def _start(self, *more):
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen([*self.command, *more], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                            stderr=log)

    def step(self):
        """Starts it again, a moment after it has ended, as a service manager does."""
        if self.process is not None and (code := self.process.poll()) is not None:
            # 0: it was stopped. 1: it lost the world or the database. A signal: it was killed.
            if code > 1:
                self.failed_starts.append(code)
            self.process = None
            self.start_at = time.monotonic() + random.uniform(0.1, 1)
        if self.process is None and time.monotonic() >= self.start_at:
            self._start()

    def signal(self, number):
        if self.process is not None and self.process.poll() is None:
            self.process.send_signal(number)

    def pause(self):
        self.is_paused = True
        self.signal(signal.SIGSTOP)

    def resume(self):
        self.is_paused = False
        self.signal(signal.SIGCONT)

    def stop(self):
        """Returns the exit code of a stop in order."""
        self.signal(signal.SIGTERM)
        return self.process.wait(timeout=60)

    def port(self):
        """Returns the port at which it listens; None if it does not listen."""
        if self.process is None or self.process.poll() is not None:
            return None
        try:
            text = self.port_file.read_text()
            return int(text) if text else None
        except FileNotFoundError:
            return None

    def epochs(self):
        """Returns the epoch of each start that took the world over."""
        return [int(epoch) for epoch in re.findall(r"OWNS THE WORLD: epoch=(\d+)", self.log.read_text())]
