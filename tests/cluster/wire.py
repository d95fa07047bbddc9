"""A TCP connection that the test can freeze and cut: a relay between a port and a target."""
import asyncio
import threading


class Wires:
    """Runs the wires in a thread of their own."""

    def __init__(self):
        self.loop = asyncio.new_event_loop()
        threading.Thread(target=self.loop.run_forever, daemon=True).start()

    def add(self, target):
        """`target` returns the port to which a new connection leads, or None if there is none now."""
        return asyncio.run_coroutine_threadsafe(Wire.open(target), self.loop).result()

    def stop(self):
        self.loop.call_soon_threadsafe(self.loop.stop)


class WireBundle:
    """Several wires that fail together."""

    def __init__(self, wires):
        self.wires = wires

    def freeze(self):
        for wire in self.wires:
            wire.freeze()

    def thaw(self):
        for wire in self.wires:
            wire.thaw()

    def cut(self):
        for wire in self.wires:
            wire.cut()


class Wire:
    @classmethod
    async def open(cls, target):
        self = cls()
        self.target = target
        self.loop = asyncio.get_running_loop()
        self.flows = asyncio.Event()
        self.flows.set()
        self.ends = set()
        server = await asyncio.start_server(self._relay, "127.0.0.1", 0)
        self.port = server.sockets[0].getsockname()[1]
        return self

    def freeze(self):
        """Holds back all bytes, in both directions, until thaw()."""
        self.loop.call_soon_threadsafe(self.flows.clear)

    def thaw(self):
        self.loop.call_soon_threadsafe(self.flows.set)

    def cut(self):
        """Ends all connections."""
        self.loop.call_soon_threadsafe(lambda: [end.transport.abort() for end in self.ends])

    async def _relay(self, reader, writer):
        await self.flows.wait()
        port = self.target()
        try:
            there = await asyncio.open_connection("127.0.0.1", port) if port else None
        except OSError:
            there = None
        if there is None:
            writer.transport.abort()
            return
        ends = {writer, there[1]}
        self.ends |= ends
        await asyncio.gather(self._pump(reader, there[1]), self._pump(there[0], writer))
        for end in ends:
            end.transport.abort()
        self.ends -= ends

    async def _pump(self, reader, writer):
        try:
            while data := await reader.read(65536):
                await self.flows.wait()
                writer.write(data)
                await writer.drain()
            writer.write_eof()
        except (OSError, RuntimeError):
            writer.transport.abort()
