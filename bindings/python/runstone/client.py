"""The client that joins a server, with asyncio."""
import asyncio
import os
from collections import deque

import numpy as np

from ._runstone import ClientCore, Error

_EVENTS_MAX = 4096
_STEP_S = 0.01
_CLOSED = "the client is closed"


class Client:
    """A player in the world of a server, and the chunks around the player.

    A client is an asynchronous context manager, which joins a world and leaves it, and an
    asynchronous iterator of events (ClientEvent). While the client is joined, a task of the running
    loop steps it, so chunks and edits arrive whether or not a program takes the events.
    """

    def __init__(self, server, name="builder", *, invite="", password="", key_file="", encryption="any certificate",
                 authorities_file="", view_radius=8, view_radius_vertical=4, memory_mib=1024, cache_folder="",
                 cache_mib=256):
        """Prepare to join a server: HOST, HOST:PORT or a link runstone://HOST:PORT/#INVITE.

        encryption is "any certificate", "authorities" or "none", which is for servers with
        --insecure. Without a key_file the identity of the player is not kept. The radii of the view
        are in chunks.
        """
        self._options = (server, name, invite, password, os.fspath(key_file), encryption, os.fspath(authorities_file),
                         (view_radius, view_radius_vertical), memory_mib, os.fspath(cache_folder), cache_mib)
        self._core = None
        self._closed = False
        self._events = deque()
        self._edits = {}
        self._outcomes = {}
        self._command = None
        self._opened_once = False
        self._fault = None

    # Joining and leaving.

    async def join(self):
        """Connect and wait until the world is open.

        Raise Error if the server refuses this client.
        """
        if self._closed:
            raise ValueError(_CLOSED)
        if self._core is not None:
            raise ValueError("the client has joined already")
        self._loop = asyncio.get_running_loop()
        self._progress = asyncio.Event()
        self._woken = asyncio.Event()
        self._core = ClientCore(*self._options)
        self._loop.add_reader(self._core.fileno(), self._wake)
        self._task = self._loop.create_task(self._pump())
        try:
            await self._until(lambda: self._opened_once)
        except BaseException:
            await self.close()
            raise
        return self

    async def close(self):
        """Leave the world. Later calls of other methods raise ValueError."""
        if self._closed:
            return
        self._closed = True
        if self._core is None:
            return
        self._loop.remove_reader(self._core.fileno())
        self._task.cancel()
        await asyncio.gather(self._task, return_exceptions=True)
        self._end_waiters(ValueError(_CLOSED))
        self._progress.set()
        await self._loop.run_in_executor(None, self._core.close)

    async def __aenter__(self):
        return await self.join()

    async def __aexit__(self, kind, error, trace):
        await self.close()

    @property
    def closed(self):
        """True after close()."""
        return self._closed

    # Events.

    def __aiter__(self):
        return self

    async def __anext__(self):
        core = self._joined()
        while True:
            if self._events:
                return self._events.popleft()
            if self._closed:
                raise StopAsyncIteration
            chunks = core.drain(1)
            if chunks:
                self._take(chunks)
                continue
            if self._fault is not None or core.state == "ended":
                raise StopAsyncIteration
            await self._next_progress()

    def _wake(self):
        self._core.clear()
        self._woken.set()

    async def _pump(self):
        while True:
            try:
                has_more = self._core.step()
                # Chunks stay in the library until a program takes them. The library merges the
                # changes of each chunk.
                self._take(self._core.drain(0))
            except Exception as error:  # such as MemoryError: nobody awaits this task
                self._fault = error
            self._progress.set()
            if self._fault is not None:  # the client has ended
                self._end_waiters(self._fault)
                return
            if has_more:
                await asyncio.sleep(0)
                continue
            try:
                await asyncio.wait_for(self._woken.wait(), _STEP_S)
            except asyncio.TimeoutError:
                pass
            self._woken.clear()

    def _end_waiters(self, error):
        """Raise an error where edit() and command() wait: their events will not come."""
        for waiter in [*self._edits.values(), self._command]:
            if waiter is not None and not waiter.done():
                waiter.set_exception(error)
                waiter.exception()  # asyncio would warn of one that nobody awaits

    def _append(self, event):
        # Removed chunks are kept, so that a program can remove their meshes. Their number is
        # bounded by the chunks that the program took.
        if len(self._events) >= _EVENTS_MAX:
            for index, oldest in enumerate(self._events):
                if oldest.kind != "chunk removed":
                    del self._events[index]
                    break
        self._events.append(event)

    def _take(self, events):
        for event in events:
            self._append(event)
            kind = event.kind
            if kind == "opened":
                self._opened_once = True
            elif kind == "lost" and event.is_final:
                self._fault = Error(event.text)
            elif kind == "command done" and self._command is not None and not self._command.done():
                self._command.set_result(event)
            elif kind in ("edit confirmed", "edit rejected", "edit unseen"):
                waiter = self._edits.pop(event.edit, None)
                if waiter is not None and not waiter.done():
                    waiter.set_result(event)

    def _check_fault(self):
        if self._fault is not None:
            raise self._fault

    async def _next_progress(self):
        self._check_fault()
        self._progress.clear()
        await self._progress.wait()

    async def _until(self, is_reached):
        while not is_reached():
            if self._closed:
                raise ValueError(_CLOSED)
            await self._next_progress()

    def _joined(self):
        if self._core is None:
            raise ValueError(_CLOSED if self._closed else "the client has not joined: use 'async with' or await join()")
        return self._core

    def _open(self):
        core = self._joined()
        if self._closed:
            raise ValueError(_CLOSED)
        return core

    # The world.

    @property
    def state(self):
        """The connection: "connecting", "open" or "ended".

        After a loss the client connects again.
        """
        return self._open().state

    @property
    def world(self):
        """The world as a dict.

        The keys are id, edge, y_min, y_max, edit_volume_max, spawn, author, name and fingerprint.
        """
        return self._open().world

    @property
    def materials(self):
        """The materials of the world by number, as objects of Material."""
        return self._open().materials

    def find_material(self, name):
        """Return the number of the material of this name, or None."""
        return self._open().find_material(name)

    @property
    def players(self):
        """The other players, as dicts with author, name, role and place.

        place is None if it is not known.
        """
        return self._open().players

    @property
    def place(self):
        """The place of the player: x, y, z of the eye, yaw and pitch in degrees."""
        return self._open().place

    def move(self, x, y, z, yaw=0.0, pitch=0.0):
        """Move the player, and the view with it. Raise Error if that is not possible."""
        self._open().move(x, y, z, yaw, pitch)

    async def travel(self, x, y, z, yaw=0.0, pitch=0.0):
        """Move the player and wait until all chunks around the place have arrived."""
        self.move(x, y, z, yaw, pitch)
        await self.loaded()

    async def loaded(self):
        """Wait until all chunks around the player have arrived."""
        core = self._open()
        await self._next_progress()  # a move takes effect in a step
        await self._until(lambda: self._closed or core.is_complete)
        if self._closed:
            raise ValueError(_CLOSED)

    def set_view(self, radius, radius_vertical):
        """Change the radii of the view, 0 to 64 chunks."""
        self._open().set_view(radius, radius_vertical)

    # Voxels.

    def chunk(self, key):
        """Return the Chunk at (x, y, z) of the grid of chunks as it is shown now, or None."""
        return self._open().chunk(key)

    def chunks(self):
        """Return the places of the chunks that are shown, ascending."""
        return self._open().chunks()

    def material_at(self, at):
        """Return the material of a voxel, or None if its chunk is not shown."""
        return self._open().material_at(at)

    def __getitem__(self, box):
        """Return a box of voxels as they are shown now: uint16 with the axes x, y, z.

        Raise LookupError if a chunk of the box is not shown.
        """
        core = self._open()
        if not isinstance(box, tuple) or len(box) != 3:
            raise ValueError("a box has three slices, such as client[0:16, 0:32, 0:16]")
        edge = (core.world or {}).get("edge")
        if edge is None:
            raise LookupError("no world is open yet")
        low, high = [], []
        for part in box:
            if not isinstance(part, slice):
                part = slice(part, part + 1)
            if part.start is None or part.stop is None or part.step not in (None, 1):
                raise ValueError("a slice of a box has both ends and no step")
            if part.stop <= part.start:
                raise ValueError(f"the slice {part.start}:{part.stop} is empty")
            low.append(part.start)
            high.append(part.stop)
        sides = [h - l for l, h in zip(low, high)]
        if sides[0] * sides[1] * sides[2] > 1 << 33:
            raise ValueError("a box has at most 8589934592 voxels")
        keys = [range(l // edge, (h - 1) // edge + 1) for l, h in zip(low, high)]
        out = None
        for x in keys[0]:
            for y in keys[1]:
                for z in keys[2]:
                    chunk = core.chunk((x, y, z))
                    if chunk is None:
                        raise LookupError(f"the chunk {(x, y, z)} is not shown")
                    if out is None:
                        out = np.empty(sides, np.uint16)
                    to, of = [], []
                    for key, l, h in zip((x, y, z), low, high):
                        first, last = max(l, key * edge), min(h, (key + 1) * edge)
                        to.append(slice(first - l, last - l))
                        of.append(slice(first - key * edge, last - key * edge))
                    out[tuple(to)] = chunk.to_numpy()[tuple(of)]
        return out

    # Edits, chat and commands.

    def submit(self, edit, action=None):
        """Show an edit at once and send it. Return its number, which later events have.

        action is None for an edit by itself, Client.NEW_ACTION for the first edit of an action, and
        the number of the first edit for the others. One undo takes all edits of an action back.
        Raise Error if the player may not make the edit, or if the budget does not suffice yet.
        """
        return self._open().submit(edit, action)

    async def edit(self, edit, action=None):
        """Submit an edit as soon as the budget suffices, and return its sequence in the log.

        Return None if the answer was lost with a connection. Raise Error if the edit is rejected,
        or if the client ends before the answer.
        """
        core = self._open()
        while (wait := core.wait_us(edit)) > 0:
            await asyncio.sleep(wait / 1e6)
            core = self._open()
        self._check_fault()
        number = core.submit(edit, action)
        waiter = self._edits[number] = self._loop.create_future()
        try:
            event = await waiter
        finally:
            self._edits.pop(number, None)
        if event.kind == "edit rejected":
            raise Error(event.text)
        return event.sequence

    def chat(self, line):
        """Send a line to everybody. Raise Error if it cannot be sent."""
        self._open().chat(line)

    async def command(self, text):
        """Send a command, such as "undo", and return the lines of its answer.

        Raise Error if the command fails.
        """
        core = self._open()
        self._check_fault()
        core.command(text)
        self._command = self._loop.create_future()
        event = await self._command
        if not event.is_ok:
            raise Error(event.text or "the connection was lost before the answer")
        return event.text.splitlines()


Client.NEW_ACTION = ClientCore.NEW_ACTION
