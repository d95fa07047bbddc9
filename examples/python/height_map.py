"""Builds the heights of an array beside the player, as one action: height_map.py SERVER FILE.npy"""
import asyncio
import sys

import numpy as np

import runstone


async def main(server, file, encryption="any certificate"):
    heights = np.load(file).astype(int)
    async with runstone.Client(server, name="mason", encryption=encryption) as client:
        await client.loaded()
        x, y, z = (int(v) for v in client.place[:3])
        stone = client.find_material("stone") or 1
        action, waiting = client.NEW_ACTION, []
        for i, k in np.argwhere(heights > 0):
            at = (x + 2 + int(i), y, z + 2 + int(k))
            column = runstone.FillBox(at, (at[0] + 1, y + int(heights[i, k]), at[2] + 1), stone)
            while True:
                try:
                    number = client.submit(column, action)
                    break
                except runstone.Error:  # the budget does not suffice yet
                    await asyncio.sleep(0.05)
            action = number if action == client.NEW_ACTION else action
            waiting.append(number)
        async for event in client:
            if event.kind == "edit rejected":
                sys.exit(f"the server rejected a column: {event.text}")
            if event.kind == "edit confirmed":
                waiting.remove(event.edit)
                if not waiting:
                    break
        print(f"{np.count_nonzero(heights > 0)} columns from {x + 2} {y} {z + 2}; 'undo' takes them back")


asyncio.run(main(*sys.argv[1:]))
