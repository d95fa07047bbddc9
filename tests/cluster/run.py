"""One run of the test: bots build while something fails, and everything is checked afterwards."""
import random
import time

from builders import END_S, Builders
from cluster import Cluster
from faults import Faults
from world_check import WorldCheck

BUILDERS = 20
LATECOMERS = 6  # they build for LATE_S when nothing fails any more
LATE_S = 3


class Run:
    def __init__(self, programs, folder, seconds, seed, has_disks, without=(), is_synchronous=True):
        self.seconds = seconds
        self.random = random.Random(seed)
        self.cluster = Cluster(programs, folder, has_disks, is_synchronous)
        self.faults = Faults(self.cluster, self.random, without)
        self.builders = Builders(programs, folder, "builders", BUILDERS, seed)
        self.latecomers = Builders(programs, folder, "latecomers", LATECOMERS, seed)
        self.world = WorldCheck(programs, folder, self.cluster)

    def fail_at_random(self):
        end = time.monotonic() + self.seconds - 2
        while time.monotonic() < end:
            self.faults.make_one()
            self.cluster.wait(self.random.uniform(0.5, 5))

    def check(self, disturb):
        """Lets bots build, and calls `disturb` meanwhile. Returns what is wrong."""
        if not self.cluster.create():
            return ["no server has taken the world"]
        self.builders.start(self.cluster.door.port, self.seconds)
        self.cluster.wait(2)
        disturb()
        self.cluster.heal()
        wrong = self._see_off(self.builders) + self.builders.check_that_most_is_durable()
        # Everything must work again.
        self.latecomers.start(self.cluster.door.port, LATE_S)
        wrong += self._see_off(self.latecomers) + self.latecomers.check_that_all_is_durable()
        wrong += self.cluster.stop()
        return wrong + self.world.check(self.edits())

    def _see_off(self, builders):
        """Waits for the end of bots. Returns what is wrong with what they saw."""
        self.cluster.wait(END_S, builders.have_ended)
        return builders.check()

    def edits(self):
        """Returns the numbers of edits of all bots."""
        return self.builders.edits + self.latecomers.edits

    def handovers(self):
        """Returns how many handovers were begun, and how many succeeded."""
        return (self.faults.made["handover"],
                sum(server.handovers() for server in self.cluster.servers))

    def summary(self):
        edits = self.edits()
        database = self.cluster.database
        panics = sum(host.panics() for host in database.hosts)
        return (f"{edits['submitted']} edits, {edits['durable']} durable, {edits['rejected']} rejections, "
                f"{self.world.logged} in the log; longest wait {self.builders.longest_s:.1f} s; "
                f"{len(self.world.epochs)} starts took the world, {self.handovers()[1]} of them by a handover; "
                f"servers ended by themselves {sum(s.gave_up for s in self.cluster.servers)} times; "
                f"PostgreSQL ended itself {panics} times, its disks held {database.used_mib()} MiB at most; "
                f"faults: {dict(sorted(self.faults.made.items()))}")

    def close(self, keeps_data=False):
        self.builders.close()
        self.latecomers.close()
        self.cluster.close(keeps_data)
