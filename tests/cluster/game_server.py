"""A runstone-server of the test, with its wires and its clock. It is started again when it has ended."""
import random
import re
import signal
import subprocess
import time

from server_clock import ServerClock


def address_of(wire):
    """Returns where a wire begins. Without one, the server adds its own port."""
    return "127.0.0.1" if wire is None else f"127.0.0.1:{wire.port}"


class GameServer:
    def __init__(self, program, folder, name, databases, peers, players, url, lease_s):
        """`databases` are the wires to the hosts of the database, at `url`. `peers` leads from the other
        servers to this one, `players` from players who know it from the list of servers. None: they
        connect without wires."""
        self.program = program
        self.folder = folder / name
        self.name, self.databases, self.peers = name, databases, peers
        self.port_file = self.folder.with_suffix(".port")
        self.digests_file = self.folder.with_suffix(".digests")
        self.log = self.folder.with_suffix(".log")
        self.log.touch()
        self.clock = ServerClock(self.folder.with_suffix(".clock"))
        self.clock.set_off(0)
        # The kernel ends it if the test ends.
        self.command = ["setpriv", "--pdeathsig=KILL", program, "--world", self.folder, "--store", url,
                        "--standby", "--lease-s", str(lease_s), "--listen", "127.0.0.1:0",
                        "--peer-address", address_of(peers), "--player-address", address_of(players),
                        "--port-file", self.port_file,
                        "--digests", self.digests_file, "--sessions-per-address", "0",
                        "--budgets-per-address", "0", "--connections-per-second", "0", "--stop-s", "20"]
        self.process = None
        self.handover = None  # the command under way, or the last one
        self.start_at = 0.0
        self.is_paused = False
        self.sent = set()  # signals that the test has sent to this process
        self.bad_ends = []  # exit codes of starts that gave up, and signals that the test did not send
        self.gave_up = 0  # ends with exit code 1

    def create(self):
        """Makes the world, with this server as its first owner."""
        self._start("--create", "--generator", "flat", "--seed", "1")

    def _start(self, *more):
        self.sent = set()
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen([*self.command, *more], stdin=subprocess.DEVNULL,
                                            stdout=subprocess.DEVNULL, stderr=log,
                                            env=self.clock.environment())

    def forget_ends(self):
        self.bad_ends.clear()

    def _judge(self, code):
        # 0: it was stopped. 1: it lost the world or the database. Below 0: a signal.
        self.gave_up += code == 1
        if code > 1 or (code < 0 and -code not in self.sent):
            self.bad_ends.append(code)

    def step(self):
        """Starts it again, a moment after it has ended, as a service manager does."""
        if self.process is not None and (code := self.process.poll()) is not None:
            self._judge(code)
            self.process = None
            self.start_at = time.monotonic() + random.uniform(0.1, 1)
        if self.process is None and time.monotonic() >= self.start_at:
            self._start()

    def signal(self, number):
        if self.process is not None and self.process.poll() is None:
            self.sent.add(number)
            self.process.send_signal(number)

    def pause(self):
        self.is_paused = True
        self.signal(signal.SIGSTOP)

    def resume(self):
        self.is_paused = False
        self.signal(signal.SIGCONT)

    def hand_over(self):
        """Tells it to let another server own the world. Returns false if that is under way already."""
        if self.handover is not None and self.handover.poll() is None:
            return False
        # The command ends when the server answers, or with the server.
        with open(self.log, "ab") as log:
            self.handover = subprocess.Popen(
                ["setpriv", "--pdeathsig=KILL", self.program, "control", "--world", self.folder, "handover"],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        return True

    def stop(self):
        """Stops it in order. Returns its exit code, or None if it does not end."""
        if self.process is None:
            return 0
        self.digests_file.unlink(missing_ok=True)
        self.signal(signal.SIGTERM)
        try:
            code = self.process.wait(timeout=60)
        except subprocess.TimeoutExpired:
            return None
        self.process = None
        return code

    def has_digests(self):
        """Returns true if its last stop was in order, and it owned the world."""
        return self.digests_file.exists() and '"clean":false' not in self.digests_file.read_text()

    def kill(self):
        if self.handover is not None:
            self.handover.kill()
            self.handover.wait()
        self.signal(signal.SIGKILL)
        if self.process is not None:
            self.process.wait()

    def port(self):
        """Returns the port at which it listens; None if it does not listen."""
        process = self.process
        if process is None or process.poll() is not None:
            return None
        try:
            text = self.port_file.read_text()
            return int(text) if text else None
        except FileNotFoundError:
            return None

    def peer_address(self):
        """Returns where the other servers reach it."""
        return f"127.0.0.1:{self.port()}" if self.peers is None else address_of(self.peers)

    def handovers(self):
        """Returns how often it handed the world over while it went on."""
        return self.log.read_text().count("HANDED OVER: server=")

    def epochs(self):
        """Returns the epoch of each start that took the world over."""
        return [int(epoch) for epoch in re.findall(r"OWNS THE WORLD: epoch=(\d+)", self.log.read_text())]
