"""The players of the test: bots that build, and check what they are sent."""
import collections
import json
import subprocess

PATIENCE_S = 120
# How long they may need to end after nothing fails any more: they wait for the world, and for the disk.
END_S = 2 * PATIENCE_S


class Builders:
    def __init__(self, programs, folder, name, count, seed):
        self.program, self.name, self.count, self.seed = programs / "runstone-bot", name, count, seed
        self.keys, self.log, self.report = (folder / f"{name}.{end}" for end in ("keys", "log", "json"))
        self.keys.mkdir()
        self.process = None
        self.edits = collections.Counter()
        self.longest_s = float("nan")

    def start(self, port, seconds):
        # Half of them keep a replica: these look at each voxel that they have set. The others check messages
        # more strictly.
        with open(self.log, "wb") as log:
            self.process = subprocess.Popen(
                ["setpriv", "--pdeathsig=KILL", self.program, "--connect", f"127.0.0.1:{port}",
                 "--count", str(self.count), "--replicas", str(self.count // 2), "--rate", "3",
                 "--duration", str(seconds), "--patience", str(PATIENCE_S), "--name", self.name,
                 "--key-dir", self.keys, "--seed", str(self.seed), "--report", self.report],
                stdout=log, stderr=log)

    def have_ended(self):
        return self.process.poll() is not None

    def close(self):
        if self.process is not None and not self.have_ended():
            self.process.kill()
            self.process.wait()

    def check(self):
        """Returns what is wrong with what they saw."""
        if not self.have_ended():
            self.close()
            return [f"the {self.name} do not end"]
        try:
            seen = json.loads(self.report.read_text())
        except (OSError, ValueError):
            return [f"the {self.name} ended with exit code {self.process.returncode}, without a report: "
                    f"see {self.log}"]
        self.edits = collections.Counter(seen["edits"])
        # An edit whose answer was lost with a connection has no time, and makes the maximum infinite.
        waits = seen["local_us"]
        if waits["rows"]:
            longest = waits["max"] if waits["infinite"] == 0 else waits["rows"][-1][1]
            self.longest_s = longest / 1e6
        return [f"{self.name}: {wrong}" for wrong in judge(seen, self.process.returncode)]

    def check_that_most_is_durable(self):
        """Returns what is wrong if these edits came while things failed for some seconds each."""
        edits = self.edits
        if edits["durable"] < edits["submitted"] / 2:
            return [f"of {edits['submitted']} edits only {edits['durable']} became durable: a server that "
                    "could accept edits did not"]
        return []

    def check_that_all_is_durable(self):
        """Returns what is wrong if these edits came when nothing failed."""
        edits = self.edits
        if edits["submitted"] == 0 or edits["durable"] != edits["submitted"] or edits["rejected"] != 0:
            return [f"nothing failed any more, and of {edits['submitted']} edits {edits['durable']} are "
                    f"durable, and {edits['rejected']} were rejected"]
        return []


def judge(seen, exit_code):
    """Returns what is wrong with a report of bots."""
    wrong = []
    if exit_code != 0:
        wrong.append(f"exit code {exit_code} {seen['failure']}")
    if violations := seen["verified"]["violations"]:
        wrong.append(f"messages that break the protocol: {violations}")
    standing = seen["standing"]
    if standing["changed"] != 0 or seen["drifted"] != 0:
        wrong.append(f"voxels that they have set: {standing}; chunks that drifted: {seen['drifted']}")
    if standing["intact"] == 0 or seen["digests_checked"] == 0 or seen["verified"]["versions_checked"] == 0:
        wrong.append("they have checked no voxel, no digest or no version")
    return wrong
