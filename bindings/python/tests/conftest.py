"""A world on disk whose history every test knows, made with the programs of RUNSTONE_BIN."""
import os
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

BIN = os.environ.get("RUNSTONE_BIN")
EDGE = 16
ORIGIN = (-20, -7, 5)
TIMEOUT_S = 120


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=TIMEOUT_S)
    assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"
    return done.stdout


class Server:
    """A server that runs a world until the block ends."""

    def __init__(self, place):
        self.place = place

    def __enter__(self):
        port = Path(f"{self.place}.port")
        port.unlink(missing_ok=True)
        self.process = subprocess.Popen(
            [f"{BIN}/runstone-server", "--world", self.place, "--listen", "127.0.0.1:0", "--insecure", "true", "--port-file", port],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + TIMEOUT_S
        while not (port.exists() and Path(f"{self.place}/control.sock").exists()):
            assert self.process.poll() is None and time.monotonic() < deadline, "the server does not listen"
            time.sleep(0.02)
        return self

    def control(self, *words):
        return run(f"{BIN}/runstone-server", "control", "--world", self.place, *words)

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(timeout=TIMEOUT_S)


class History:
    """An imported array, and the voxels after each placed build, in numbers of the arrays."""

    def __init__(self, folder):
        self.folder = folder
        self.place = str(folder / "world")
        rng = np.random.default_rng(1)
        self.base = np.zeros((40, 24, 36), np.uint16)
        self.base[:, :10] = rng.integers(1, 5, (40, 10, 36))
        self.base[3:30, 10:14, 4:20] = 2
        np.save(folder / "base.npy", self.base)
        run(f"{BIN}/runstone-server", "import", "file", folder / "base.npy", "--world", self.place, "--at",
            ",".join(map(str, ORIGIN)), "--edge", EDGE)
        self.after = [self.base]
        mixed = rng.integers(1, 4, (9, 7, 20)).astype(np.uint16)
        self.builds = [(np.full((6, 5, 4), 3, np.uint16), (1, 2, 20)), (mixed, (-18, -4, 14)),
                       (np.full((1, 30, 1), 4, np.uint16), (-1, -12, 33))]

    def place_build(self, server, number):
        array, at = self.builds[number]
        file = self.folder / f"build{number}.npy"
        np.save(file, array)
        server.control("import", file, "at", *at)
        x, y, z = (a - o for a, o in zip(at, ORIGIN))
        after = self.after[-1].copy()
        low = max(0, -y)  # a build may begin below the array
        after[x:x + array.shape[0], y + low:y + array.shape[1], z:z + array.shape[2]] = array[:, low:after.shape[1] - y, :]
        self.after.append(after)


def sequences_of_builds(world):
    """Returns the sequence after each action of the log that placed a build."""
    actions = {}
    for record in world.log():
        if record.kind in ("box", "paste", "voxel"):
            actions[record.subject or record.sequence] = record.sequence
    return [actions[key] for key in sorted(actions)]


def numbers_of(world, array):
    """Returns voxels of a world as numbers n of its materials called "material n"."""
    names = {m.id: int(m.name.removeprefix("material ")) for m in world.materials if m.name.startswith("material ")}
    table = np.zeros(len(world.materials), np.uint16)
    for number, name in names.items():
        table[number] = name
    return table[array]


def box_of_base():
    return tuple(slice(o, o + side) for o, side in zip(ORIGIN, (40, 24, 36)))


@pytest.fixture(scope="session")
def history(tmp_path_factory):
    if BIN is None:
        pytest.skip("RUNSTONE_BIN names no folder with programs")
    made = History(tmp_path_factory.mktemp("history"))
    with Server(made.place) as server:
        for number in range(len(made.builds)):
            made.place_build(server, number)
    return made
