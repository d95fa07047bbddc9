"""Writes a numpy array as a model that other programs show: array_to_gltf.py FILE.glb"""
import sys

import numpy
import runstone

x, y, z = numpy.indices((48, 32, 48))
hill = 10 + 6 * numpy.sin(x / 7) + 5 * numpy.cos(z / 9)
voxels = numpy.zeros(x.shape, numpy.uint16)
voxels[y < hill] = 1
voxels[(y < hill) & (y >= hill - 2)] = 2
voxels[(y < 9) & (voxels == 0)] = 3

materials = [
    runstone.Material(1, "stone", (128, 128, 132)),
    runstone.Material(2, "grass", (90, 150, 60)),
    runstone.Material(3, "water", (60, 110, 200, 150), "transparent"),
]
size = runstone.write_build(sys.argv[1], voxels, materials, metres_per_voxel=0.5)
print(f"{sys.argv[1]}: {size} bytes")
