#!/usr/bin/env python3
"""Proves that the checks of check_cluster.py fail if something is wrong, and that its faults have effect.

A world without faults is broken on purpose, in one way after another, and each time a check must say so.
Then a database that confirms commits before its standby has them fails over: the edits that are lost must
be noticed.
"""
import contextlib
import copy
import json
import re
import shutil
import signal
import subprocess
import sys
import pathlib

from builders import judge
from check_cluster import end_in_order, make_folder
from run import Run
from small_disk import can_mount

LAST = "(SELECT max(seq) FROM edit_log WHERE cause = 0)"
COLUMNS = ("epoch, author, instance, client_seq, time_us, cause, subject, min_x, min_y, min_z, max_x, max_y, "
           "max_z, descriptor, checksum")
# What is done to the world: what a check must say.
BROKEN_WORLDS = {
    f"DELETE FROM edit_log WHERE seq = {LAST}": "were called durable",
    f"DELETE FROM edit_log WHERE seq = {LAST} - 1": "missing in the log",
    f"INSERT INTO edit_log(log, seq, {COLUMNS}) SELECT log, seq + 1, {COLUMNS} FROM edit_log "
    f"WHERE seq = (SELECT max(seq) FROM edit_log)": "more than once",
    f"UPDATE edit_log SET epoch = 7 WHERE seq = {LAST} - 1": "epoch falls",
    f"UPDATE edit_log SET epoch = 7 WHERE seq = {LAST}": "those of no start",
    f"UPDATE edit_log SET time_us = time_us + 3600000000 WHERE seq = {LAST} - 1": "time_us falls",
    "UPDATE meta SET integer_value = 7 WHERE key = 'epoch'": "the world has the epoch 7",
    f"UPDATE edit_log SET descriptor = set_byte(descriptor, 1, 1) WHERE seq = {LAST}": "runstone-replay",
    "UPDATE snapshot SET digest0 = digest0 + 1 WHERE x = (SELECT min(x) FROM snapshot)": "runstone-replay",
}
# What the bots report: what a check must say.
BROKEN_REPORTS = {
    "standing.changed": "voxels", "drifted": "drifted", "standing.intact": "checked no voxel",
    "digests_checked": "checked no voxel", "verified.versions_checked": "checked no voxel",
}


class Proof:
    def __init__(self):
        self.failed = 0
        self.passed = 0

    def expect(self, what, wrong, words):
        """Expects that one of the texts in `wrong` has certain words."""
        if any(words in text for text in wrong):
            self.passed += 1
            return
        self.failed += 1
        print(f"NOT NOTICED: {what}: no check says \"{words}\", they say {wrong}", flush=True)

    def expect_true(self, what, is_so):
        self.expect(what, ["yes" if is_so else "no"], "yes")


@contextlib.contextmanager
def changed(file, change):
    """Changes the text of a file for a while."""
    text = file.read_text()
    file.write_text(change(text))
    try:
        yield
    finally:
        file.write_text(text)


def prove_faults(run, proof):
    """Makes the faults whose effect is not plain, while nobody builds."""
    proof.expect_true("a world", run.cluster.create())
    pair, server = run.cluster.database, run.cluster.servers[0]
    if server.clock.library is not None:
        server.clock.set_off(5 * 3600)
        server.signal(signal.SIGTERM)  # it writes to its log then
        run.cluster.wait(5, lambda: False)
        times = re.findall(r"^(\d{4}-\d\d-\d\dT\d\d):", server.log.read_text(), re.MULTILINE)
        proof.expect_true("a server's clock", len(set(times)) > 1)
    if disk := pair.disks.get(pair.primary):
        disk.fill()
        try:
            pair.primary.text("CREATE TABLE ballast AS SELECT generate_series(1, 1000000)")
            proof.expect_true("a full disk", False)
        except subprocess.CalledProcessError:
            proof.expect_true("a full disk", True)
        disk.clear()
        pair.begin(pair.fill_disk(pair.primary, 0.5, True))
        run.cluster.wait(60, pair.is_in_order)
        proof.expect_true("a full disk ends PostgreSQL", pair.primary.panics() > 0)
    was = pair.primary
    pair.begin(pair.fail_over(False, 0, 0))
    run.cluster.wait(60, pair.is_in_order)
    proof.expect_true("fail over", pair.primary is not was and pair.primary.has_standby())


def prove_world(run, proof):
    """Breaks the world in each way."""
    primary = run.cluster.database.primary
    for sql, words in BROKEN_WORLDS.items():
        primary.text("CREATE DATABASE broken TEMPLATE postgres")
        primary.text(sql, "broken")
        proof.expect(sql, run.world.check(run.edits(), "broken"), words)
        primary.text("DROP DATABASE broken")
    fewer = run.edits()
    fewer["submitted"] = fewer["durable"] = run.world.logged - 1
    proof.expect("an edit that nobody made", run.world.check(fewer), "made")
    servers = run.cluster.servers
    lines = [line for server in servers for line in server.log.read_text().splitlines() if "OWNS" in line]
    with changed(servers[1].log, lambda text: text + lines[-1] + "\n"):
        proof.expect("an epoch that two starts have", run.world.check(run.edits()), "the same epoch")
    owner = next(server for server in servers if server.has_digests())
    with changed(owner.digests_file, lambda text: re.sub(r'"digest":"\w', '"digest":"x', text, count=1)):
        proof.expect("a digest list", run.world.check(run.edits()), "runstone-replay")
    with changed(owner.digests_file, lambda text: re.sub(r'(?<="digest":")\w{32}', "0" * 32, text, count=1)):
        proof.expect("a server's digest", run.world.check(run.edits()), "differences")
    servers[2].bad_ends.append(-signal.SIGSEGV)
    proof.expect("a server that crashed", run.world.check(run.edits()), "ended with the codes")
    servers[2].bad_ends.clear()


def prove_builders(run, proof):
    """Breaks what the bots report in each way."""
    seen = json.loads(run.builders.report.read_text())
    for path, words in BROKEN_REPORTS.items():
        broken = copy.deepcopy(seen)
        *groups, name = path.split(".")
        group = broken
        for key in groups:
            group = group[key]
        group[name] = 0 if group[name] else 1
        proof.expect(path, judge(broken, 0), words)
    broken = copy.deepcopy(seen)
    broken["verified"]["violations"] = {"answer twice": {"count": 1}}
    proof.expect("a violation", judge(broken, 0), "break the protocol")
    proof.expect("an exit code", judge(seen, 1), "exit code")
    run.builders.edits["durable"] = run.builders.edits["submitted"] // 3
    proof.expect("rejections all the time", run.builders.check_that_most_is_durable(), "became durable")
    run.latecomers.edits["rejected"] = 1
    proof.expect("a rejected edit", run.latecomers.check_that_all_is_durable(), "rejected")


def lose_commits(run):
    """The database fails over to a standby that lacks commits, and no server has them either."""
    pair = run.cluster.database
    pair.standby.kill()
    run.cluster.wait(4)
    for server in run.cluster.servers:
        server.signal(signal.SIGKILL)
    pair.primary.kill()
    pair.standby.start(pair.primary)
    pair.begin(pair.fail_over(False, 0, 0))


def with_run(programs, seconds, has_disks, is_synchronous, use):
    folder = make_folder()
    run = Run(programs, folder, seconds, 1, has_disks, is_synchronous=is_synchronous)
    try:
        use(run)
    finally:
        run.close()
    shutil.rmtree(folder)


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    end_in_order()
    has_disks = can_mount()
    proof = Proof()

    def break_everything(run):
        wrong = run.check(lambda: None)
        proof.expect("a world in order", wrong or ["nothing is wrong"], "nothing is wrong")
        prove_world(run, proof)
        prove_builders(run, proof)

    def lose(run):
        wrong = run.check(lambda: lose_commits(run))
        print("lost commits: " + "; ".join(wrong), flush=True)
        proof.expect("lost commits: the log", wrong, "were called durable")
        proof.expect("lost commits: the voxels", wrong, "voxels")

    with_run(programs, 1, has_disks, True, lambda run: prove_faults(run, proof))
    with_run(programs, 6, False, True, break_everything)
    with_run(programs, 12, False, False, lose)
    print(f"{proof.passed} checks notice what was broken, {proof.failed} do not")
    return 1 if proof.failed else 0


if __name__ == "__main__":
    sys.exit(main())
