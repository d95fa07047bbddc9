"""Checks the world of the test when no server runs: log, epochs and digests."""
import subprocess


class WorldCheck:
    def __init__(self, programs, folder, cluster):
        self.replay, self.report, self.cluster = programs / "runstone-replay", folder / "verify.json", cluster
        self.logged = 0
        self.epochs = []

    def check(self, edits, database="postgres"):
        """Returns what is wrong, given the edits that the bots have counted."""
        self.epochs = sorted(epoch for server in self.cluster.servers for epoch in server.epochs())
        primary = self.cluster.database.primary
        ask = lambda sql: primary.ask(sql, database)  # noqa: E731
        return [*self._log(ask, edits), *self._epochs(ask), *self._ends(),
                *self._digests(primary.url(database))]

    def _log(self, ask, edits):
        wrong = []
        if twice := ask("SELECT count(*) FROM (SELECT 1 FROM edit_log WHERE cause = 0 GROUP BY author, "
                        "instance, client_seq HAVING count(*) > 1) twice"):
            wrong.append(f"{twice} edits are in the log more than once")
        if gaps := ask("SELECT coalesce(max(seq), 0) - count(*) FROM edit_log"):
            wrong.append(f"{gaps} edits are missing in the log")
        for column in ("epoch", "time_us"):
            if falls := ask(f"SELECT count(*) FROM (SELECT {column} AS now, lag({column}) OVER (ORDER BY "
                            "seq) AS before FROM edit_log) pairs WHERE now < before"):
                wrong.append(f"{column} falls {falls} times along the log")
        self.logged = ask("SELECT count(*) FROM edit_log WHERE cause = 0")
        # A client may offer a rejected edit again, as another operation. The log has each edit once at most.
        durable, submitted = edits["durable"], edits["submitted"]
        if not 0 < durable <= self.logged <= submitted:
            wrong.append(f"{self.logged} edits are in the log: {durable} were called durable, and "
                         f"{submitted} made")
        return wrong

    def _epochs(self, ask):
        wrong = []
        if len(set(self.epochs)) != len(self.epochs):
            wrong.append(f"two starts had the same epoch: {self.epochs}")
        last = ask("SELECT integer_value FROM meta WHERE key = 'epoch'")
        if not self.epochs or self.epochs[-1] != last:
            wrong.append(f"the world has the epoch {last}, and the logs of the servers have {self.epochs}")
        if strange := ask("SELECT count(DISTINCT epoch) FROM edit_log WHERE NOT epoch = ANY('{"
                          + ",".join(map(str, self.epochs)) + "}')"):
            wrong.append(f"{strange} epochs of the log are those of no start")
        return wrong

    def _ends(self):
        return [f"{server.name} ended with the codes {server.bad_ends}, see {server.log}"
                for server in self.cluster.servers if server.bad_ends]

    def _digests(self, url):
        lists = [server.digests_file for server in self.cluster.servers if server.has_digests()]
        command = [self.replay, "verify", "--world", url, "--json", self.report]
        if lists:
            command += ["--against", *lists]
        verified = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  check=False)
        if verified.returncode != 0:
            return [f"runstone-replay verify: {verified.stdout}"]
        return [] if lists else ["no server has written its digests"]
