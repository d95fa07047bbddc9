"""A PostgreSQL server of the test: it is made in a folder, and can crash."""
import os
import pathlib
import shutil
import socket
import subprocess


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Postgres:
    def __init__(self, folder):
        versions = pathlib.Path("/usr/lib/postgresql").glob("*/bin")
        self.bin = max(versions, key=lambda path: int(path.parent.name))
        self.folder = pathlib.Path(folder)
        self.folder.mkdir()
        # PostgreSQL refuses to run as root.
        self.prefix = []
        if os.geteuid() == 0:
            shutil.chown(self.folder, "postgres")
            self.prefix = ["setpriv", "--reuid=postgres", "--regid=postgres", "--init-groups"]
        self.port = free_port()
        self._run("initdb", "-D", str(self.folder / "data"), "-U", "runstone", "-A", "trust", "-E", "UTF8",
                  "--no-locale")
        self.start()

    def _run(self, program, *arguments):
        subprocess.run([*self.prefix, str(self.bin / program), *arguments], cwd=self.folder, check=True,
                       stdout=subprocess.DEVNULL)

    def start(self):
        options = f"-k {self.folder} -c listen_addresses=127.0.0.1 -c port={self.port} -c max_connections=100"
        self._run("pg_ctl", "-D", str(self.folder / "data"), "-l", str(self.folder / "log"), "-w", "-o", options, "start")

    def crash(self):
        """Ends it without a checkpoint, as a power failure of its processes."""
        self._run("pg_ctl", "-D", str(self.folder / "data"), "-m", "immediate", "-w", "stop")

    def url(self, port=None):
        """Returns the address of the database, at another port if it is reached through a wire."""
        return f"postgresql://runstone@127.0.0.1:{port or self.port}/postgres"

    def ask(self, sql):
        """Returns the first number of a query."""
        return int(self.text(sql).split()[0])

    def text(self, sql):
        """Returns the first row of a query as text."""
        asked = subprocess.run([self.bin / "psql", self.url(), "-At", "-c", sql], check=True, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        return asked.stdout.strip()
