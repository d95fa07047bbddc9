"""A PostgreSQL server of the test: a folder, and processes that can crash, stand still and follow others."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

START_S = 60
ANSWER_S = 20
# Segments are small, so that a full disk is met soon. The others make the replication react at once.
SETTINGS = {
    "listen_addresses": "127.0.0.1", "max_connections": "100", "shared_buffers": "16MB",
    "dynamic_shared_memory_type": "mmap", "min_wal_size": "2MB", "max_wal_size": "32MB",
    "wal_keep_size": "128MB",
    "synchronous_commit": "on", "wal_retrieve_retry_interval": "200ms",
}


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def children_of(pid):
    """Returns the ids of the processes that a process has started."""
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            after_name = stat.read_text().rpartition(")")[2].split()
        except OSError:  # the process has ended
            continue
        if int(after_name[1]) == pid:
            found.append(int(stat.parent.name))
    return found


class Postgres:
    def __init__(self, folder, is_synchronous=True):
        """With `is_synchronous`, a commit returns when a standby has it."""
        self.settings = SETTINGS | ({"synchronous_standby_names": "standby"} if is_synchronous else {})
        versions = pathlib.Path("/usr/lib/postgresql").glob("*/bin")
        self.bin = max(versions, key=lambda path: int(path.parent.name))
        self.folder = pathlib.Path(folder)
        self.data = self.folder / "data"
        self.memory = self.folder / "memory"
        self.data.mkdir(parents=True)
        self.memory.mkdir()
        # PostgreSQL refuses to run as root.
        self.prefix = []
        if os.geteuid() == 0:
            shutil.chown(self.folder, "postgres")
            shutil.chown(self.memory, "postgres")
            self.prefix = ["setpriv", "--reuid=postgres", "--regid=postgres", "--init-groups"]
        self.log = self.folder / "log"
        self.log.touch()
        self.port = free_port()
        self.process = None
        self.crashes = 0

    def _begin(self, program, *arguments):
        with open(self.log, "ab") as log:
            # The kernel ends it if the test ends.
            return subprocess.Popen([*self.prefix, "setpriv", "--pdeathsig=QUIT", self.bin / program,
                                     *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=log,
                                    stderr=log)

    def own_data(self):
        """Gives the folder of the data to the user of PostgreSQL, which refuses one that others may read."""
        if self.prefix:
            shutil.chown(self.data, "postgres", "postgres")
        self.data.chmod(0o700)

    def initialise(self):
        """Makes an empty database."""
        made = self._begin("initdb", "-D", self.data, "-U", "runstone", "-A", "trust", "-E", "UTF8",
                           "--no-locale", "--wal-segsize=1", "--no-sync").wait()
        if made != 0:
            raise RuntimeError(f"initdb failed, see {self.log}")

    def begin_copy(self, primary):
        """Begins to copy another server's data into this one's folder. Returns the process that does it."""
        self._forget_memory()
        for entry in self.data.iterdir():
            if entry.is_dir() and not entry.is_symlink():
                shutil.rmtree(entry)
            else:
                entry.unlink()
        return self._begin("pg_basebackup", "-D", self.data, "-h", "127.0.0.1", "-p", str(primary.port), "-U",
                           "runstone", "--checkpoint=fast", "--wal-method=stream", "--no-sync")

    def begin_start(self, primary=None):
        """Starts it, as a standby of another server if there is one."""
        # The shared memory of a real server does not lie on the disk of the data.
        memory = self.data / "pg_dynshmem"
        if not memory.is_symlink():
            memory.rmdir()
            memory.symlink_to(self.memory)
        mark = self.data / "standby.signal"
        settings = self.settings | {"port": str(self.port), "unix_socket_directories": str(self.folder)}
        if primary is not None:
            mark.touch()
            settings["primary_conninfo"] = (f"host=127.0.0.1 port={primary.port} user=runstone "
                                            "application_name=standby")
        words = [word for name, value in settings.items() for word in ("-c", f"{name}={value}")]
        self.process = self._begin("postgres", "-D", self.data, *words)

    def is_up(self):
        """Returns true if it answers."""
        try:
            return self.ask("SELECT 1") == 1
        except subprocess.SubprocessError:
            return False

    def has_ended(self):
        return self.process is None or self.process.poll() is not None

    def start(self, primary=None):
        """Starts it, and waits until it answers."""
        self.begin_start(primary)
        end = time.monotonic() + START_S
        while not self.is_up():
            if self.has_ended() or time.monotonic() > end:
                raise RuntimeError(f"PostgreSQL does not start, see {self.log}")
            time.sleep(0.02)

    def _signal(self, number):
        """Sends a signal to all its processes. Requires that the first one stands still."""
        for pid in [*children_of(self.process.pid), self.process.pid]:
            try:
                os.kill(pid, number)
            except ProcessLookupError:  # it has just ended
                pass

    def freeze(self):
        """Lets all its processes stand still."""
        if not self.has_ended():
            self.process.send_signal(signal.SIGSTOP)  # it starts no more processes
            self._signal(signal.SIGSTOP)

    def thaw(self):
        if not self.has_ended():
            self._signal(signal.SIGCONT)

    def kill(self):
        """Ends all its processes at once, without a checkpoint, as a power failure of the machine."""
        if not self.has_ended():
            self.freeze()
            self._signal(signal.SIGKILL)
            self.process.wait()

    def _forget_memory(self):
        """Removes the shared memory of a server that was killed. Otherwise only its next start would."""
        try:
            memory = (self.data / "postmaster.pid").read_text().splitlines()[6].split()[1]
        except (OSError, IndexError):
            return
        subprocess.run(["ipcrm", "-m", memory], check=False, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)

    def close(self):
        self.kill()
        self._forget_memory()

    def begin_promote(self):
        """Lets a standby become a primary, which takes a moment: see is_primary()."""
        self.text("SELECT pg_promote(false)")

    def is_primary(self):
        try:
            return self.text("SELECT pg_is_in_recovery()") == "f"
        except subprocess.SubprocessError:
            return False

    def has_standby(self):
        """Returns true if a standby has all commits, and confirms each new one if it is synchronous."""
        try:
            return self.ask("SELECT count(*) FROM pg_stat_replication WHERE state = 'streaming' AND "
                            "(sync_state = 'sync' OR current_setting('synchronous_standby_names') = '')") == 1
        except subprocess.SubprocessError:
            return False

    def url(self, database="postgres"):
        return f"postgresql://runstone@127.0.0.1:{self.port}/{database}"

    def ask(self, sql, database="postgres"):
        """Returns the first number of a query."""
        return int(self.text(sql, database).split()[0])

    def text(self, sql, database="postgres"):
        """Returns the first row of a query as text. Fails with SubprocessError if no answer comes in time."""
        asked = subprocess.run([self.bin / "psql", self.url(database), "-AtX", "-c", sql], check=True,
                               text=True, timeout=ANSWER_S, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, env=os.environ | {"PGCONNECT_TIMEOUT": "2"})
        return asked.stdout.strip()

    def panics(self):
        """Returns how often it has ended itself because it could not write its log."""
        return self.log.read_text(errors="replace").count("PANIC:")
