"""Meshes against numpy: the unit faces that the quads cover are those of the voxels."""
import numpy as np
import pytest

import runstone

# Materials 0 to 4. The last one has no entry, so it is opaque.
VISIBILITY = np.array([0, 1, 2, 2], np.uint8)
STEPS = [(-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1)]


def sides_visible(padded):
    """Returns the faces (x, y, z, direction, material) of the inside of an array with a border of one voxel."""
    table = np.append(VISIBILITY, [1])
    inner = padded[1:-1, 1:-1, 1:-1]
    faces = set()
    for direction, (dx, dy, dz) in enumerate(STEPS):
        x, y, z = inner.shape
        beyond = padded[1 + dx:1 + dx + x, 1 + dy:1 + dy + y, 1 + dz:1 + dz + z]
        drawn = (table[inner] != 0) & (table[beyond] != 1) & (inner != beyond)
        faces |= {(*map(int, at), direction, int(inner[tuple(at)])) for at in np.argwhere(drawn)}
    return faces


def faces_of(quads):
    """Returns the unit faces of quads. Fails if two quads cover one."""
    faces = set()
    for quad in quads:
        axis = int(quad["direction"]) // 2
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for i in range(int(quad["width"])):
            for j in range(int(quad["height"])):
                at = [int(quad["x"]), int(quad["y"]), int(quad["z"])]
                at[u] += i
                at[v] += j
                face = (*at, int(quad["direction"]), int(quad["material"]))
                assert face not in faces
                faces.add(face)
    return faces


def scene(seed, shape):
    rng = np.random.default_rng(seed)
    array = rng.integers(0, 5, [(side + 3) // 4 for side in shape]).repeat(4, 0).repeat(4, 1).repeat(4, 2)
    array = array[:shape[0], :shape[1], :shape[2]].astype(np.uint16)
    spots = rng.random(shape) < 0.05
    array[spots] = rng.integers(0, 5, int(spots.sum()))
    return array


@pytest.mark.parametrize("shape", [(16, 16, 16), (12, 33, 70)])
@pytest.mark.parametrize("with_neighbours", [False, True])
def test_quads_cover_each_visible_face_once(shape, with_neighbours):
    array = scene(5, shape)
    padded = np.pad(array, 1)
    neighbours = None
    if with_neighbours:
        neighbours = []
        for direction, step in enumerate(STEPS):
            if direction == 2:
                neighbours.append(None)  # its voxels are empty
                continue
            other = scene(20 + direction, shape)
            neighbours.append(runstone.Chunk.from_numpy(other))
            axis, is_positive = direction // 2, direction % 2
            index = [slice(1, -1)] * 3
            index[axis] = -1 if is_positive else 0
            padded[tuple(index)] = other.take(0 if is_positive else -1, axis)
    for order in ["xyz", "zyx", None]:
        mesh = runstone.Chunk.from_numpy(array, order).mesh(neighbours, VISIBILITY)
        expected = sides_visible(padded)
        assert faces_of(mesh.quads) == expected
        assert len(mesh) == len(mesh.quads) == len(mesh.opaque) + len(mesh.transparent)
        assert {int(m) for m in mesh.opaque["material"]} == {1, 4} and {int(m) for m in mesh.transparent["material"]} == {2, 3}
        assert len(mesh) < len(expected)


def test_packed_quads_hold_the_same_numbers_and_outlive_the_mesh():
    mesh = runstone.Chunk.from_numpy(scene(6, (20, 24, 28))).mesh(visibility=VISIBILITY)
    quads = mesh.opaque
    bits = mesh.opaque_packed
    assert np.shares_memory(bits, mesh.opaque_packed) and not bits.flags.writeable
    assert mesh.transparent_packed.size == len(mesh.transparent) > 0
    del mesh
    for name, shift, width, plus in [("x", 0, 7, 0), ("y", 7, 7, 0), ("z", 14, 7, 0), ("width", 21, 7, 1), ("height", 28, 7, 1),
                                     ("direction", 35, 3, 0), ("material", 38, 16, 0)]:
        field = (bits >> np.uint64(shift)) & np.uint64((1 << width) - 1)
        assert np.array_equal(field + np.uint64(plus), quads[name])


def test_vertices_are_the_corners_of_the_quads_and_wind_outwards():
    mesh = runstone.Chunk.from_numpy(scene(7, (16, 20, 24))).mesh(visibility=VISIBILITY)
    vertices = mesh.vertices()
    quads = mesh.quads
    assert vertices.positions.shape == vertices.normals.shape == (4 * len(quads), 3)
    assert vertices.triangles.shape == (2 * len(quads), 3) and vertices.positions.dtype == np.float32
    assert np.array_equal(vertices.materials, quads["material"].repeat(4))
    a, b, c = (vertices.positions[vertices.triangles[:, i]].astype(float) for i in range(3))
    cross = np.cross(b - a, c - a)
    area = quads["width"].astype(float) * quads["height"]
    steps = np.array(STEPS, float)[quads["direction"]].repeat(2, 0)
    assert np.array_equal(cross, steps * area.repeat(2)[:, None])
    assert np.array_equal(vertices.normals, np.array(STEPS, np.float32)[quads["direction"]].repeat(4, 0))
    low = vertices.positions.reshape(-1, 4, 3).min(1)
    voxel = np.stack([quads["x"], quads["y"], quads["z"]], 1).astype(np.float32)
    assert np.array_equal(low, voxel + np.maximum(np.array(STEPS, np.float32)[quads["direction"]], 0))


def test_an_empty_chunk_has_a_mesh_without_quads():
    mesh = runstone.Chunk.uniform((8, 8, 8)).mesh()
    assert len(mesh) == 0 and mesh.quads.shape == (0,) and mesh.vertices().triangles.shape == (0, 3)
    assert mesh.opaque_packed.size == 0
