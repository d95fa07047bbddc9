"""Prints how many runs a chunk of a world has at each height: run_heights.py WORLD [CHUNKS]"""
import sys

import runstone

with runstone.World.open(sys.argv[1]) as world:
    reach = int(sys.argv[2]) if len(sys.argv) > 2 else 4
    for y in range(5, -4, -1):
        places = [(x, y, z) for x in range(-reach, reach) for z in range(-reach, reach)]
        runs = sum(world.chunk(place).run_count for place in places) / len(places)
        print(f"y {y * world.edge:5} {runs:8.1f} runs {'#' * round(runs / 10)}")
