"""The faults of the test. Each method makes one and returns true. It returns false if it cannot be made
now."""
import collections
import signal

from server_clock import OFF_MAX_S


class Faults:
    def __init__(self, cluster, random, without):
        self.cluster, self.random = cluster, random
        self.made = collections.Counter()
        self.kinds = {
            "kill": self._kill, "stop": self._stop, "pause": self._pause, "handover": self._hand_over,
            "cut players": self._cut_players, "freeze players": self._freeze_players,
            "cut servers": self._cut_servers, "freeze servers": self._freeze_servers,
            "cut database": self._cut_database, "freeze database": self._freeze_database,
            "crash database": self._crash_database, "crash standby": self._crash_standby,
            "freeze standby": self._freeze_standby,
            "fail over, killed": self._fail_over_killed, "fail over, frozen": self._fail_over_frozen,
        }
        if cluster.database.disks:
            self.kinds |= {"full disk": self._fill_disk,
                           "full disk of the standby": self._fill_disk_of_standby}
        if cluster.servers[0].clock.library is not None:
            self.kinds["clocks"] = self._set_clock_off
        if unknown := set(without) - set(self.kinds):
            raise ValueError(f"there is no fault {sorted(unknown)}; there are {sorted(self.kinds)}")
        for kind in without:
            del self.kinds[kind]

    def make_one(self):
        """Makes a fault, any of those that can be made now."""
        for kind in self.random.sample(list(self.kinds), len(self.kinds)):
            if self.kinds[kind]():
                self.made[kind] += 1
                return

    def _server(self):
        """Returns the server that owns the world, or any of them."""
        owner = self.cluster.owner() if self.random.random() < 0.7 else None
        return owner or self.random.choice(self.cluster.servers)

    def _seconds(self):
        return self.random.uniform(0.3, 6)

    def _freeze(self, wires):
        wires.freeze()
        self.cluster.later(self._seconds(), wires.thaw)
        return True

    def _kill(self):
        self._server().signal(signal.SIGKILL)
        return True

    def _stop(self):
        self._server().signal(signal.SIGTERM)
        return True

    def _pause(self):
        server = self._server()
        if server.is_paused:
            return False
        server.pause()
        self.cluster.later(self._seconds(), server.resume)
        return True

    def _hand_over(self):
        owner = self.cluster.owner()
        return owner is not None and owner.hand_over()

    def _cut_players(self):
        self.cluster.players.cut()
        return True

    def _freeze_players(self):
        return self._freeze(self.cluster.players)

    def _cut_servers(self):
        self._server().peers.cut()
        return True

    def _freeze_servers(self):
        return self._freeze(self._server().peers)

    def _cut_database(self):
        self._server().databases.cut()
        return True

    def _freeze_database(self):
        return self._freeze(self._server().databases)

    def _begin(self, make):
        """Begins a fault of the database, unless one is under way."""
        database = self.cluster.database
        if not database.is_in_order():
            return False
        database.begin(make(database))
        return True

    def _crash_database(self):
        return self._begin(lambda pair: pair.crash(pair.primary, self.random.uniform(0, 3)))

    def _crash_standby(self):
        return self._begin(lambda pair: pair.crash(pair.standby, self.random.uniform(0, 3)))

    def _freeze_standby(self):
        return self._begin(lambda pair: pair.freeze(pair.standby, self._seconds()))

    def _fail_over_killed(self):
        return self._begin(lambda pair: pair.fail_over(False, self.random.uniform(0, 3), 0))

    def _fail_over_frozen(self):
        frozen_s = self.random.uniform(0, 4)
        return self._begin(lambda pair: pair.fail_over(True, self.random.uniform(0, 3), frozen_s))

    def _fill_disk(self):
        is_log_full = self.random.random() < 0.5
        return self._begin(lambda pair: pair.fill_disk(pair.primary, self._seconds(), is_log_full))

    def _fill_disk_of_standby(self):
        return self._begin(lambda pair: pair.fill_disk(pair.standby, self._seconds(), True))

    def _set_clock_off(self):
        self._server().clock.set_off(self.random.uniform(-OFF_MAX_S, OFF_MAX_S))
        return True
