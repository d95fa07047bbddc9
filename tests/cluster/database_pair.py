"""Two PostgreSQL servers of the test: a primary, and a standby that has each commit before it returns.

The faults of the database are generators: each step() runs one up to its next `yield`, so that other
faults go on meanwhile. One of them is under way at a time, and it ends with both servers in order.
"""
import shutil
import subprocess
import time

from postgres import Postgres
from small_disk import SmallDisk

PATIENCE_S = 60
CONNECT_S = 2  # after which a server of the world tries the other host

# Takes one file of the log after another, also those that are kept for later: more than `max_wal_size`, and
# fewer than `wal_keep_size`, so that the standby can catch up.
USE_LOG = ("DO $$ BEGIN FOR i IN 1..40 LOOP PERFORM pg_logical_emit_message(false, 'test', 'full'); "
           "PERFORM pg_switch_wal(); END LOOP; END $$")


def until(holds, what):
    """Waits until a condition holds, a step at a time."""
    end = time.monotonic() + PATIENCE_S
    while not holds():
        if time.monotonic() > end:
            raise RuntimeError(f"the database: {what}")
        yield


def pause(seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        yield


class DatabasePair:
    def __init__(self, folder, has_disks, is_synchronous=True):
        """With `has_disks`, each server has a small disk of its own, which must be permitted."""
        self.hosts = [Postgres(folder / name, is_synchronous) for name in ("alpha", "beta")]
        self.primary, self.standby = self.hosts
        self.disks = {}
        self.used = []  # MiB of the data, now and then
        self.work = None
        for host in self.hosts:
            if has_disks:
                self.disks[host] = SmallDisk(host.data)
            host.own_data()
        self.primary.initialise()
        self.primary.start()
        for _ in self._make_standby():
            time.sleep(0.02)

    def _make_standby(self):
        copy = self.standby.begin_copy(self.primary)
        yield from until(lambda: copy.poll() is not None, "the copy for the standby does not end")
        if copy.returncode != 0:
            raise RuntimeError(f"pg_basebackup failed, see {self.standby.log}")
        self.standby.begin_start(self.primary)
        yield from self._until_in_order()

    def _until_in_order(self):
        """Waits until the standby confirms commits. Starts servers that have ended, as a service manager
        does."""
        def is_done():
            for host in self.hosts:
                if host.has_ended():
                    host.begin_start(None if host is self.primary else self.primary)
            return self.primary.has_standby()

        yield from until(is_done, f"the standby does not follow the primary, see {self.primary.log}")

    def is_in_order(self):
        """Returns true if no fault of the database is under way. The standby has every commit then."""
        return self.work is None

    def begin(self, fault):
        """Begins a fault: one of the generators below."""
        self.work = fault
        self.step()

    def step(self):
        if self.work is None:
            return
        try:
            next(self.work)
        except StopIteration:
            self.work = None

    def fail_over(self, is_frozen, notice_s, frozen_s):
        """The primary fails, and the standby becomes the primary after `notice_s`. A primary that stands
        still is ended later: it must never go on beside the new one. It then becomes the new standby."""
        failed = self.primary
        if is_frozen:
            failed.freeze()
        else:
            failed.kill()
        yield from pause(notice_s)
        self.primary, self.standby = self.standby, failed
        self.primary.begin_promote()
        yield from until(self.primary.is_primary, "the standby does not become the primary")
        if is_frozen:
            yield from pause(frozen_s)
            failed.kill()
        yield from self._make_standby()

    def crash(self, host, down_s):
        """A server ends, and starts again. Commits wait meanwhile, whichever of the two it is."""
        host.kill()
        yield from pause(down_s)
        yield from self._until_in_order()

    def freeze(self, host, seconds):
        host.freeze()
        yield from pause(seconds)
        host.thaw()
        yield from self._until_in_order()

    def fill_disk(self, host, seconds, is_log_full):
        """The disk of a server is full. With `is_log_full`, the primary needs a new file for its log at
        once: if the full disk is its own, it ends itself. Otherwise it is often a table that has no room."""
        self.used.append(self.disks[host].used_mib())
        self.disks[host].fill()
        if is_log_full:
            try:
                self.primary.text(USE_LOG)
            except subprocess.SubprocessError:
                pass
        yield from pause(seconds)
        self.disks[host].clear()
        yield from self._until_in_order()

    def used_mib(self):
        """Returns how much the data took at most, of those times at which a disk was filled or unmounted."""
        return max(self.used, default=0)

    def close(self, keeps_data):
        for host in self.hosts:
            host.close()
            if disk := self.disks.get(host):
                disk.clear()
                self.used.append(disk.used_mib())
                if keeps_data:
                    shutil.copytree(host.data, host.folder / "data-kept")
                disk.unmount()
