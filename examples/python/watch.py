"""Prints what happens around the spawn of a world: watch.py SERVER [SECONDS]"""
import asyncio
import sys

import runstone


async def watch(client):
    names = {client.world["author"]: client.world["name"]}
    async for event in client:
        names |= {player["author"]: player["name"] for player in client.players}
        if event.kind == "others edit":
            print(f"{names.get(event.author, event.author)} changed {len(event.chunks)} chunks: record {event.sequence}",
                  flush=True)
        elif event.kind == "chat":
            print(f"{event.name or 'server'}: {event.text}", flush=True)
        elif event.kind == "lost":
            print(event.text, flush=True)


async def main(server, seconds="inf", encryption="any certificate"):
    async with runstone.Client(server, name="watcher", encryption=encryption, view_radius=4) as client:
        await client.loaded()
        print(f"watching {len(client.chunks())} chunks", flush=True)
        try:
            await asyncio.wait_for(watch(client), None if seconds == "inf" else float(seconds))
        except asyncio.TimeoutError:
            pass


asyncio.run(main(*sys.argv[1:]))
