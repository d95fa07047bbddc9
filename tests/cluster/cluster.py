"""The servers of one world, their database, and the wires between all of them and the players."""
import random
import subprocess
import time

from database_pair import CONNECT_S, DatabasePair
from game_server import GameServer
from wire import WireBundle, Wires

SERVERS = 3


class Cluster:
    def __init__(self, programs, folder, has_disks, is_synchronous, lease_s=2, has_wires=True):
        """Wires cost time: without them, only servers and the database can fail."""
        self.heals = []  # (time, what ends a fault)
        self.servers = []
        self.wires = Wires()
        self.database = DatabasePair(folder / "postgres", has_disks, is_synchronous)
        own_wires = []  # of the players, one for each server
        try:
            for i in range(SERVERS):
                if not has_wires:
                    self.servers.append(GameServer(programs / "runstone-server", folder, f"server{i}", None,
                                                   None, None, url_of(self.database.hosts), lease_s))
                    continue
                # The hosts keep their wires, as machines keep their addresses: the server finds the primary.
                databases = [self.wires.add(lambda host=host: host.port) for host in self.database.hosts]
                peers, players = [self.wires.add(lambda i=i: self.servers[i].port()) for _ in range(2)]
                own_wires.append(players)
                self.servers.append(GameServer(programs / "runstone-server", folder, f"server{i}",
                                               WireBundle(databases), peers, players, url_of(databases),
                                               lease_s))
            # Players come to any server, and from there to those of its list.
            self.door = self.wires.add(self.player_port)
            self.players = WireBundle([self.door, *own_wires])
        except BaseException:
            self.close()
            raise

    def owner(self):
        """Returns the server that has the lease, or None."""
        try:
            address = self.database.primary.text("SELECT address FROM lease")
        except subprocess.SubprocessError:  # there is no world yet, or the database is down
            return None
        return next((one for one in self.servers if address == one.peer_address()), None)

    def player_port(self):
        """Returns the port of any server that listens."""
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
        self.database.step()
        time.sleep(0.05)

    def wait(self, seconds, until=lambda: False):
        """Lets time pass until a condition holds. Returns false if it does not hold in time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if until():
                return True
            self.step()
        return until()

    def create(self):
        """Makes the world. Returns false if no server takes it."""
        self.servers[0].create()
        if not self.wait(30, self.owner):
            return False
        self.wait(2)
        # Before the world was there, the others could not start.
        for server in self.servers:
            server.forget_ends()
        return True

    def heal(self):
        """Ends all faults."""
        for _, heal in self.heals:
            heal()
        self.heals = []
        self.wait(120, self.database.is_in_order)

    def stop(self):
        """Stops the servers in order, the owner last. Returns what is wrong with how they end."""
        wrong = []
        owner = self.owner()
        for server in sorted(self.servers, key=lambda one: one is owner):
            code = server.stop()
            if code is None:
                wrong.append(f"{server.name} does not stop")
            elif code not in (0, -15):
                wrong.append(f"{server.name} stopped with exit code {code}")
        return wrong

    def close(self, keeps_data=False):
        for server in self.servers:
            server.kill()
        self.database.close(keeps_data)
        self.wires.stop()


def url_of(ends):
    """Returns the address of a database with several hosts, or wires to them, one of which can be
    written."""
    hosts = ",".join(f"127.0.0.1:{end.port}" for end in ends)
    return (f"postgresql://runstone@{hosts}/postgres?target_session_attrs=read-write&"
            f"connect_timeout={CONNECT_S}")
