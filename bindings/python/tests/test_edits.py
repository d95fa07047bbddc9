"""Edits against numpy: each voxel of a chunk after random edits, by arithmetic of its own."""
import numpy as np
import pytest

import runstone

SHAPE = (32, 32, 32)


def places(key):
    """Returns the world coordinates of the voxels of a chunk."""
    return [axis + 32 * place for axis, place in zip(np.indices(SHAPE).astype(np.int64), key)]


def near_segment(at, a, b, radius):
    """Returns where the squared distance to the segment from a to b is at most r * r + r, without fractions."""
    d = [q - p for p, q in zip(a, b)]
    dd = sum(v * v for v in d)
    dot = sum((x - p) * v for x, p, v in zip(at, a, d))
    to_a = sum((x - p) ** 2 for x, p in zip(at, a))
    to_b = sum((x - q) ** 2 for x, q in zip(at, b))
    limit = radius * radius + radius
    return np.where(dot <= 0, to_a <= limit, np.where(dot >= dd, to_b <= limit, to_a * dd - dot * dot <= limit * dd))


def admitted(array, mask):
    if mask == "everything":
        return np.ones(array.shape, bool)
    if mask == "empty":
        return array == 0
    return array != 0 if mask == "solid" else array == mask


def turned(array, turns, mirror):
    """+z turns to +x and +x to -z; then the axes of `mirror` are reversed."""
    for _ in range(turns % 4):
        array = array.transpose(2, 1, 0)[:, :, ::-1]
    return np.flip(array, ["xyz".index(axis) for axis in mirror]) if mirror else array


def random_edit(rng, near):
    """Returns an edit, and a function that makes the same change to an array whose voxels are at `at`."""
    mask = [*["everything"] * 3, "empty", "solid", int(rng.integers(0, 5))][rng.integers(6)]
    material = int(rng.integers(0, 5))
    a = tuple(int(v) for v in near + rng.integers(-8, 40, 3))
    kind = rng.integers(5)

    def fill(covers, edit):
        def change(array, at):
            where = covers(at) & admitted(array, mask)
            array[where] = material
        return edit, change

    if kind == 0:
        return fill(lambda at: (at[0] == a[0]) & (at[1] == a[1]) & (at[2] == a[2]), runstone.SetVoxel(a, material, mask))
    if kind == 1:
        b = tuple(v + int(side) for v, side in zip(a, rng.integers(1, 30, 3)))
        return fill(lambda at: np.logical_and.reduce([(x >= p) & (x < q) for x, p, q in zip(at, a, b)]),
                    runstone.FillBox(a, b, material, mask))
    if kind == 2:
        r = int(rng.integers(0, 15))
        return fill(lambda at: sum((x - p) ** 2 for x, p in zip(at, a)) <= r * r + r, runstone.FillSphere(a, r, material, mask))
    if kind == 3:
        r = int(rng.integers(1, 6))
        points = [a]
        for _ in range(rng.integers(1, 4)):
            points.append(tuple(int(v) for v in points[-1] + rng.integers(-20, 20, 3) + [0, 0, 21]))
        return fill(lambda at: np.logical_or.reduce([near_segment(at, p, q, r) for p, q in zip(points, points[1:])]),
                    runstone.FillStroke(points, r, material, mask))
    cells = rng.integers(0, 4, rng.integers(1, 14, 3)).astype(np.uint16)
    if rng.random() < 0.5:
        cells = np.asfortranarray(cells)
    touched = None if rng.random() < 0.3 else rng.random(cells.shape) < 0.6
    if touched is not None:
        touched.flat[0] = True
    turns, mirror = int(rng.integers(-3, 5)), ["", "x", "z", "xy", "y"][rng.integers(5)]
    edit = runstone.Paste(a, cells, touched, turns, mirror, mask)
    inside = turned(cells, turns, mirror)
    written = turned(np.ones(cells.shape, bool) if touched is None else touched, turns, mirror)

    def change(array, at):
        index = [x - p for x, p in zip(at, a)]
        here = np.logical_and.reduce([(i >= 0) & (i < side) for i, side in zip(index, inside.shape)])
        i, j, k = (np.where(here, axis, 0) for axis in index)
        where = here & written[i, j, k] & admitted(array, mask)
        array[where] = inside[i, j, k][where]
    return edit, change


@pytest.mark.parametrize("key", [(0, 0, 0), (-1, 2, -3)])
def test_edits_change_the_voxels_that_numpy_changes(key):
    rng = np.random.default_rng(7 + key[1])
    at = places(key)
    kinds = set()
    for _ in range(40):
        array = (rng.random(SHAPE) < 0.1).astype(np.uint16) * rng.integers(1, 5, SHAPE).astype(np.uint16)
        array[:, :9] = 1
        chunk = runstone.Chunk.from_numpy(array)
        before = array.copy()
        edits = []
        for _ in range(int(rng.integers(1, 6))):
            edit, change = random_edit(rng, np.array(key) * 32)
            kinds.add(edit.kind)
            edits.append(edit)
            change(array, at)
        after = chunk.apply(edits, key)
        assert np.array_equal(after.to_numpy(), array)
        assert after == runstone.Chunk.from_numpy(array) and after.digest == runstone.Chunk.from_numpy(array).digest
        assert np.array_equal(chunk.to_numpy(), before)  # the first chunk stays as it is
        one_by_one = chunk
        for edit in edits:
            assert runstone.Edit.decode(edit.encode()) == edit and type(runstone.Edit.decode(edit.encode())) is type(edit)
            one_by_one = one_by_one.apply(edit, key=key)
        assert one_by_one == after
    assert kinds == {"voxel", "box", "sphere", "stroke", "paste"}


def test_an_edit_says_what_it_is():
    edit = runstone.FillSphere((10, 20, 30), 2, material=3, mask=7)
    assert (edit.kind, edit.material, edit.mask) == ("sphere", 3, 7)
    assert edit.box == ((8, 18, 28), (13, 23, 33))
    grid = np.indices((5, 5, 5)) - 2
    assert edit.voxel_count == int(((grid ** 2).sum(0) <= 6).sum())
    assert edit.chunks(16) == [(x, 1, z) for x in (0,) for z in (1, 2)]
    assert runstone.FillBox((-1, 0, 0), (1, 1, 1), 2).chunks(32) == [(-1, 0, 0), (0, 0, 0)]
    assert edit == runstone.FillSphere((10, 20, 30), 2, 3, 7) != runstone.FillSphere((10, 20, 30), 2, 3)
    assert len({edit, runstone.FillSphere((10, 20, 30), 2, 3, 7)}) == 1
    assert "sphere (8, 18, 28) to (13, 23, 33), material 3" in repr(edit)


CELLS = np.ones((2, 2, 2), np.uint16)


@pytest.mark.parametrize("call, words", [
    (lambda: runstone.SetVoxel((1 << 29, 0, 0), 1), "outside the world"),
    (lambda: runstone.SetVoxel((0, 0, 0), 65536), "0 to 65535"),
    (lambda: runstone.SetVoxel((0, 0, 0), 1, "some"), "a mask is"),
    (lambda: runstone.SetVoxel((0, 0, 0), 1, None), "a mask is"),
    (lambda: runstone.FillBox((0, 0, 0), (0, 1, 1), 1), "box"),
    (lambda: runstone.FillBox((0, 0, 0), (5000, 1, 1), 1), "box"),
    (lambda: runstone.FillBox((0, 0, 0), (1 << 40, 1, 1), 1), "outside the world"),
    (lambda: runstone.FillSphere((0, 0, 0), 513, 1), "radius is a number from 0 to 512, got 513"),
    (lambda: runstone.FillSphere((0, 0, 0), -1, 1), "radius"),
    (lambda: runstone.FillStroke([(0, 0, 0)], 1, 1), "stroke"),
    (lambda: runstone.FillStroke([(0, 0, 0), (0, 0, 0)], 1, 1), "stroke"),
    (lambda: runstone.FillStroke([(0, 0, 0), (0, 0, 9)], 0, 1), "stroke"),
    (lambda: runstone.Paste((0, 0, 0), CELLS.astype(int)), "dtype uint16"),
    (lambda: runstone.Paste((0, 0, 0), np.zeros((129, 1, 1), np.uint16)), "1 to 128 voxels a side"),
    (lambda: runstone.Paste((0, 0, 0), CELLS, CELLS), "touched has the dtype bool"),
    (lambda: runstone.Paste((0, 0, 0), CELLS, np.ones((2, 2, 3), bool)), "another shape"),
    (lambda: runstone.Paste((0, 0, 0), CELLS, np.zeros((2, 2, 2), bool)), "cells of a paste"),
    (lambda: runstone.Paste((0, 0, 0), CELLS, mirror="w"), "mirror names axes"),
    (lambda: runstone.Paste((0, 0, 0), np.arange(64 ** 3).astype(np.uint16).reshape((64,) * 3)), "cells of a paste"),
    (lambda: runstone.Edit.decode(b"\x02"), "bytes of an edit"),
    (lambda: runstone.SetVoxel((0, 0, 0), 1).chunks(48), "16, 32, 64 or 128"),
    (lambda: runstone.FillBox((0, 0, 0), (4096, 4096, 4096), 1).chunks(16), "more than 1048576 chunks"),
])
def test_bad_edits_are_refused_in_words(call, words):
    with pytest.raises(ValueError, match=words):
        call()
