"""Chunks of voxels as runs, edits, meshes, worlds and the client of Runstone.

Arrays of voxels are numpy arrays of uint16 with the axes x, y (up) and z. A voxel is the number of its material, and
0 is empty. docs/python.md has examples.
"""
from ._runstone import (Chunk, ClientEvent, Edit, Error, FillBox, FillSphere, FillStroke, Log, LogRecord, Material, Mesh, Paste, SetVoxel,
                        Vertices, World, __version__, write_build)
from .client import Client

__all__ = ["Chunk", "Client", "ClientEvent", "Edit", "Error", "FillBox", "FillSphere", "FillStroke", "Log", "LogRecord", "Material", "Mesh", "Paste",
           "SetVoxel", "Vertices", "World", "__version__", "write_build"]

for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = "runstone"
del _name
