"""The client against a server: events, edits, chat, commands, voxels, and objects that were closed."""
import asyncio
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import runstone
from conftest import BIN, Server, run

ROOT = Path(__file__).resolve().parents[3]
TIMEOUT_S = 120


class FlatServer(Server):
    """A server of a new flat world, whose port is known."""

    def __enter__(self):
        super().__enter__()
        port = Path(f"{self.place}.port")
        while not port.read_text().strip():  # the server makes the file before it has a port
            assert self.process.poll() is None, "the server does not listen"
            time.sleep(0.02)
        self.address = f"127.0.0.1:{int(port.read_text())}"
        return self


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    if BIN is None:
        pytest.skip("RUNSTONE_BIN names no folder with programs")
    place = str(tmp_path_factory.mktemp("client") / "world")
    np.save(f"{place}.npy", np.ones((32, 4, 32), np.uint16))
    run(f"{BIN}/runstone-server", "import", "file", f"{place}.npy", "--world", place, "--at", "-16,-4,-16", "--edge", 16)
    with FlatServer(place) as made:
        yield made


def client_of(server, name="ada", **options):
    options = {"view_radius": 2, "view_radius_vertical": 1, "encryption": "none", **options}
    return runstone.Client(server.address, name, **options)


def within(coroutine):
    async def limited():
        return await asyncio.wait_for(coroutine, TIMEOUT_S)
    return asyncio.run(limited())


def test_a_player_joins_reads_voxels_edits_and_undoes(server):
    async def play():
        async with client_of(server) as client:
            await client.loaded()
            assert client.state == "open" and client.world["edge"] == 16 and client.world["name"] == "ada"
            assert not client.closed and len(client.chunks()) > 8
            x, y, z = (int(v) for v in client.place[:3])
            sequence = await client.edit(runstone.FillBox((x, y + 2, z), (x + 2, y + 4, z + 3), 1))
            assert sequence > 0
            box = client[x - 1:x + 3, y + 1:y + 5, z - 1:z + 4]
            expected = np.zeros((4, 4, 5), np.uint16)
            expected[1:3, 1:3, 1:4] = 1
            assert box.dtype == np.uint16 and np.array_equal(box, expected)
            assert client.material_at((x, y + 2, z)) == 1
            key = tuple(v // 16 for v in (x, y + 2, z))
            assert client.chunk(key).to_numpy()[x % 16, (y + 2) % 16, z % 16] == 1
            assert client.chunk((5000, 0, 0)) is None and client.material_at((80000, 0, 0)) is None
            assert client.find_material(client.materials[1].name) == 1 and client.find_material("no such") is None
            await client.command("undo")
            while client.material_at((x, y + 2, z)) != 0:
                await asyncio.sleep(0.01)
            with pytest.raises(runstone.Error):
                await client.command("no-such-command")
            with pytest.raises(LookupError, match="not shown"):
                client[80000:80001, 0:1, 0:1]
            with pytest.raises(ValueError, match="both ends"):
                client[:4, 0:1, 0:1]
            await client.travel(x + 100, y, z)
            assert client.place[0] == x + 100 and client.chunk(((x + 100) // 16, y // 16, z // 16)) is not None
    within(play())


def test_events_name_chunks_to_mesh_and_what_others_do(server):
    async def play():
        async with client_of(server) as client, client_of(server, "grace") as other:
            meshed = {}
            async for event in client:
                if event.kind == "chunk":
                    meshed[event.key] = event.mesh()
                    assert len(event.neighbours) == 6 and event.cause == "terrain"
                    assert len(event.chunk.mesh(event.neighbours, [0])) == len(meshed[event.key])
                if client._core.is_complete and client._core.outdated_count == 0:
                    break
            assert sum(len(mesh) for mesh in meshed.values()) > 0
            await other.loaded()
            x, y, z = (int(v) for v in other.place[:3])
            other.chat("hello")
            number = other.submit(runstone.SetVoxel((x, y + 3, z), 2), other.NEW_ACTION)
            seen = set()
            async for event in client:
                if event.kind == "chat" and event.name == "grace":
                    assert event.text == "hello" and "hello" in repr(event)
                    seen.add("chat")
                elif event.kind == "others edit":
                    assert event.chunks and event.author == other.world["author"] and event.sequence > 0
                    seen.add("edit")
                elif event.kind == "chunk" and event.cause == "others edit":
                    seen.add("chunk")
                if len(seen) == 3:
                    break
            assert client.material_at((x, y + 3, z)) == 2
            assert [player["name"] for player in client.players] == ["grace"]
            async for event in other:
                if event.kind == "edit confirmed":
                    assert event.edit == number and event.sequence > 0
                    break
                if event.kind != "chunk":
                    with pytest.raises(ValueError, match="has no chunk"):
                        event.chunk
    within(play())


def test_the_loop_runs_while_a_client_waits(server):
    async def play():
        ticks = 0

        async def tick():
            nonlocal ticks
            while True:
                await asyncio.sleep(0)
                ticks += 1
        task = asyncio.create_task(tick())
        async with client_of(server) as client:
            await client.loaded()
        task.cancel()
        assert ticks > 10
    within(play())


def test_a_client_that_was_closed_raises_clear_errors(server):
    async def play():
        client = client_of(server)
        with pytest.raises(ValueError, match="has not joined"):
            client.chat("early")
        await client.join()
        with pytest.raises(ValueError, match="joined already"):
            await client.join()
        waiting = asyncio.create_task(client.__anext__())
        await client.close()
        await client.close()
        assert client.closed
        edit = runstone.SetVoxel((0, 0, 0), 1)
        for call in [lambda: client.chat("late"), lambda: client.submit(edit), lambda: client.state, lambda: client.place,
                     lambda: client.chunk((0, 0, 0)), lambda: client[0:1, 0:1, 0:1], lambda: client.move(0, 0, 0)]:
            with pytest.raises(ValueError, match="client is closed"):
                call()
        for call in [client.edit(edit), client.command("undo"), client.loaded(), client.join()]:
            with pytest.raises(ValueError, match="client is closed"):
                await call
        try:
            await waiting
        except StopAsyncIteration:
            pass
        assert [event async for event in client] is not None
    within(play())


def test_a_client_that_ends_ends_what_waits_for_it(server):
    async def play():
        async with client_of(server, "mallory") as client:
            await client.loaded()
            # An edit that was sent and whose answer does not come.
            waiter = client._edits[1 << 40] = asyncio.get_running_loop().create_future()
            server.control("ban", "mallory")
            with pytest.raises(runstone.Error):
                await waiter
            assert client.state == "ended"
            for call in [client.edit(runstone.SetVoxel((0, 9, 0), 1)), client.command("undo"), client.loaded()]:
                with pytest.raises(runstone.Error):
                    await call
            lost = [event.is_final async for event in client if event.kind == "lost"]
            assert lost and lost[-1] and not any(lost[:-1])
    within(play())


def test_removed_chunks_are_kept_when_other_events_are_dropped():
    class Event:
        def __init__(self, kind, number):
            self.kind, self.number = kind, number

    client = runstone.Client("127.0.0.1:1")
    client._take([Event("chunk removed", 0)])
    client._take([Event("chat", number) for number in range(5000)])
    assert len(client._events) == 4096
    assert client._events[0].kind == "chunk removed"
    assert [client._events[1].number, client._events[-1].number] == [5000 - 4095, 4999]
    client._take([Event("chunk removed", number) for number in range(5000)])
    assert [event.number for event in client._events if event.kind == "chunk removed"] == [0, *range(5000)]


@pytest.mark.parametrize("options, kind", [
    ({"encryption": "some"}, ValueError), ({"view_radius": 65}, ValueError), ({"name": ""}, ValueError),
    ({"memory_mib": 0}, ValueError), ({"key_file": "/no/such/folder/key"}, ValueError), ({"server": ""}, ValueError),
])
def test_wrong_options_are_refused(options, kind):
    async def play():
        await runstone.Client(**{"server": "127.0.0.1:1", **options}).join()
    with pytest.raises(kind):
        within(play())


def start_example(name, *arguments):
    return subprocess.Popen([sys.executable, "-u", ROOT / "examples/python" / name, *map(str, arguments)],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_the_examples_build_a_height_map_and_watch_it(server, tmp_path):
    file = tmp_path / "heights.npy"
    heights = np.arange(12).reshape(3, 4) % 5
    np.save(file, heights)
    watcher = start_example("watch.py", server.address, 60, "none")
    assert watcher.stdout.readline().startswith("watching")
    mason = start_example("height_map.py", server.address, file, "none")
    out, error = mason.communicate(timeout=TIMEOUT_S)
    assert mason.returncode == 0, error
    assert out.startswith(f"{np.count_nonzero(heights)} columns")
    while "mason changed" not in (line := watcher.stdout.readline()):
        assert line, watcher.stderr.read()
    watcher.terminate()
    watcher.communicate(timeout=TIMEOUT_S)
    x, y, z = (int(v) for v in out.split(";")[0].split()[3:6])

    async def look():
        async with client_of(server) as client:
            await client.loaded()
            box = client[x:x + 3, y:y + 5, z:z + 4]
            assert np.array_equal((box != 0).sum(1), heights)
    within(look())
