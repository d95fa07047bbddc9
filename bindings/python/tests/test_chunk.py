"""Chunks against numpy: arrays, runs, bytes, equality."""
import pickle
import struct

import numpy as np
import pytest

import runstone

ORDERS = ["xyz", "xzy", "yxz", "yzx", "zxy", "zyx"]


def ground(shape, seed=1, materials=4):
    """Returns an array with long and short runs in each axis order."""
    rng = np.random.default_rng(seed)
    array = np.zeros(shape, np.uint16)
    height = rng.integers(0, shape[1], (shape[0], shape[2]))
    array[np.arange(shape[1])[None, :, None] < height[:, None, :]] = 1
    spots = rng.random(shape) < 0.03
    array[spots] = rng.integers(0, materials, int(spots.sum()))
    return array


def flat(array, order):
    """Returns the voxels in index order of an axis order, its first axis fastest."""
    axes = ["xyz".index(axis) for axis in reversed(order)]
    return array.transpose(axes).ravel()


def run_starts(line):
    return np.concatenate([[0], 1 + np.flatnonzero(line[1:] != line[:-1])])


@pytest.mark.parametrize("shape", [(8, 8, 8), (32, 32, 32), (16, 128, 9), (64, 40, 70)])
def test_an_array_comes_back_from_each_order(shape):
    array = ground(shape)
    for order in [None, *ORDERS]:
        chunk = runstone.Chunk.from_numpy(array, order)
        assert chunk.shape == shape
        out = chunk.to_numpy()
        assert out.dtype == np.uint16 and out.flags.c_contiguous and out.flags.writeable
        assert np.array_equal(out, array)
        if order:
            assert chunk.order == order


def test_every_memory_layout_is_read():
    array = ground((24, 20, 28))
    wide = np.zeros((48, 20, 56), np.uint16)
    wide[::2, :, ::2] = array
    raw = np.zeros(array.nbytes + 1, np.uint8)
    unaligned = raw[1:].view(np.uint16).reshape(array.shape)
    unaligned[...] = array
    views = [np.asfortranarray(array), wide[::2, :, ::2], unaligned, array[::-1][::-1],
             np.ascontiguousarray(array.transpose(2, 0, 1)).transpose(1, 2, 0)]
    for view in views:
        assert np.array_equal(runstone.Chunk.from_numpy(view).to_numpy(), array)


@pytest.mark.parametrize("shape", [(16, 16, 16), (64, 40, 70)])
def test_runs_are_those_of_numpy(shape):
    array = ground(shape, 2)
    for order in ORDERS:
        chunk = runstone.Chunk.from_numpy(array, order)
        line = flat(array, order)
        starts = run_starts(line)
        assert chunk.run_count == len(starts)
        assert np.array_equal(chunk.run_materials, line[starts])
        assert np.array_equal(chunk.run_ends, [*starts[1:], line.size])
        runs = chunk.runs()
        assert np.array_equal(runs["end"], chunk.run_ends) and np.array_equal(runs["material"], chunk.run_materials)


def test_without_an_order_the_one_with_the_fewest_runs_is_taken():
    for seed in range(5):
        array = ground((20, 32, 24), seed)
        counts = [len(run_starts(flat(array, order))) for order in ORDERS]
        chunk = runstone.Chunk.from_numpy(array)
        assert chunk.run_count == min(counts) and chunk.order == ORDERS[counts.index(min(counts))]
        assert runstone.Chunk.from_numpy(array, "yxz").reorder().order == chunk.order


@pytest.mark.parametrize("edge", [32, 64])
def test_runs_show_the_memory_of_the_chunk_and_outlive_its_name(edge):
    chunk = runstone.Chunk.from_numpy(ground((edge,) * 3))
    views = [chunk.run_ends, chunk.run_materials] + ([chunk.runs()] if edge == 32 else [])
    kept = [view.copy() for view in views]
    assert np.shares_memory(views[1], chunk.run_materials)
    for view in views:
        with pytest.raises(ValueError):
            view[0] = 1
        with pytest.raises(ValueError):
            view.setflags(write=True)
    del chunk
    junk = [runstone.Chunk.from_numpy(ground((edge,) * 3, seed)) for seed in range(20)]
    assert all(np.array_equal(view, copy) for view, copy in zip(views, kept)) and junk


def test_raw_bytes_are_those_of_the_protocol():
    for shape in [(16, 16, 16), (64, 40, 70)]:
        chunk = runstone.Chunk.from_numpy(ground(shape), "yxz")
        data = chunk.encode("raw")
        assert data[:8] == bytes([1, 1, ORDERS.index("yxz"), 0, *shape, 0])
        count, = struct.unpack_from("<I", data, 8)
        assert count == chunk.run_count
        if np.prod(shape) <= 65535:
            runs = np.frombuffer(data, np.dtype([("end", "<u2"), ("material", "<u2")]), offset=12)
            ends, materials = runs["end"], runs["material"]
        else:
            ends = np.frombuffer(data, "<u4", count, 12)
            materials = np.frombuffer(data, "<u2", offset=12 + 4 * count)
        assert np.array_equal(ends, chunk.run_ends) and np.array_equal(materials, chunk.run_materials)


def test_bytes_come_back_and_every_truncation_is_refused():
    chunk = runstone.Chunk.from_numpy(ground((16, 16, 16)))
    for encoding in ["raw", "packed", "coded"]:
        data = chunk.encode(encoding)
        assert runstone.Chunk.decode(data) == chunk
        for length in range(len(data)):
            with pytest.raises(ValueError, match="bytes of a chunk: "):
                runstone.Chunk.decode(data[:length])
        with pytest.raises(ValueError):
            runstone.Chunk.decode(data + b"\0")
        rng = np.random.default_rng(3)
        for _ in range(300):
            bad = bytearray(data)
            bad[rng.integers(len(bad))] ^= 1 << int(rng.integers(8))
            try:
                runstone.Chunk.decode(bytes(bad)).to_numpy()
            except ValueError:
                pass
    assert pickle.loads(pickle.dumps(chunk)) == chunk


def test_equality_is_that_of_the_voxels():
    array = ground((16, 24, 32))
    chunks = [runstone.Chunk.from_numpy(array, order) for order in ORDERS]
    assert len({chunk.digest for chunk in chunks}) == 1 and len(set(chunks)) == 1
    other = array.copy()
    other[3, 4, 5] += 1
    assert runstone.Chunk.from_numpy(other) != chunks[0]
    assert chunks[0] != runstone.Chunk.from_numpy(array.transpose(0, 2, 1).copy())
    assert chunks[0] != 5 and chunks[0] is not None
    assert runstone.Chunk.uniform((16, 8, 8)).digest == "0" * 32
    assert runstone.Chunk.uniform((16, 8, 8)) != runstone.Chunk.uniform((8, 16, 8))
    for at in [(0, 0, 0), (15, 23, 31), (3, 4, 5)]:
        assert chunks[0][at] == array[at]


@pytest.mark.parametrize("call, words", [
    (lambda: runstone.Chunk.from_numpy(np.zeros((16, 16, 16), np.int64)), "dtype uint16, got int64"),
    (lambda: runstone.Chunk.from_numpy(np.zeros((16, 16, 16), ">u2")), "dtype uint16, got >u2"),
    (lambda: runstone.Chunk.from_numpy(np.zeros((16, 16, 16), bool)), "dtype uint16, got bool"),
    (lambda: runstone.Chunk.from_numpy(np.zeros((16, 16), np.uint16)), "three axes x, y, z, got 2 axes"),
    (lambda: runstone.Chunk.from_numpy(np.zeros((4, 4, 4), np.uint16)), "8 to 128 voxels a side, got \\(4, 4, 4\\)"),
    (lambda: runstone.Chunk.from_numpy(np.zeros((256, 256, 256), np.uint16)), "8 to 128 voxels a side"),
    (lambda: runstone.Chunk.from_numpy(np.zeros((16, 16, 0), np.uint16)), "8 to 128 voxels a side"),
    (lambda: runstone.Chunk.from_numpy(np.zeros((16, 16, 16), np.uint16), "zzy"), "axis order is one of"),
    (lambda: runstone.Chunk.uniform((4, 4, 4)), "8 to 128"),
    (lambda: runstone.Chunk.uniform((16, 16, 16), 65536), "0 to 65535, got 65536"),
    (lambda: runstone.Chunk.uniform((16, 16, 16), -1), "0 to 65535, got -1"),
    (lambda: runstone.Chunk.uniform((16, 16, 16)).encode("zip"), "\"raw\", \"packed\" or \"coded\""),
    (lambda: runstone.Chunk.decode(b""), "bytes of a chunk"),
    (lambda: runstone.Chunk.uniform((16, 16, 16)).apply(5), "an edit or a sequence of edits"),
    (lambda: runstone.Chunk.uniform((16, 16, 16)).apply([5]), "a sequence of edits, got 5 in it"),
    (lambda: runstone.Chunk.uniform((16, 16, 16)).apply([], (1 << 29, 0, 0)), "outside the world"),
    (lambda: runstone.Chunk.uniform((16, 16, 16)).mesh([None] * 5), "six chunks or None"),
    (lambda: runstone.Chunk.uniform((16, 16, 16)).mesh([runstone.Chunk.uniform((16, 8, 16))] + [None] * 5), "other sides"),
    (lambda: runstone.Chunk.uniform((16, 16, 16)).mesh(visibility=[0, 3]), "0 \\(empty\\), 1"),
    (lambda: runstone.Chunk.uniform((16, 16, 16)).mesh(visibility=[0] * 65537), "visibilit"),
])
def test_bad_values_are_refused_in_words(call, words):
    with pytest.raises(ValueError, match=words):
        call()


def test_objects_without_content_cannot_be_made_and_used():
    for kind in [runstone.Chunk, runstone.Mesh, runstone.World, runstone.Edit, runstone.Log, runstone.LogRecord]:
        with pytest.raises(TypeError):
            kind()
    empty = runstone.Chunk.__new__(runstone.Chunk)
    for use in [lambda: empty.to_numpy(), lambda: empty.runs(), lambda: empty.mesh(), lambda: empty.digest, lambda: repr(empty)]:
        with pytest.raises((TypeError, RuntimeError)):
            use()
    for kind in [runstone.SetVoxel, runstone.Material, runstone.World, runstone.LogRecord, runstone.Log, runstone.Mesh, runstone.Vertices]:
        blank = kind.__new__(kind)
        for name in dir(kind):
            member = getattr(kind, name)
            if name.startswith("__") and name not in ("__repr__", "__len__", "__iter__", "__next__", "__enter__", "__hash__"):
                continue
            if isinstance(member, property):
                with pytest.raises((TypeError, RuntimeError)):
                    getattr(blank, name)
            elif name not in ("__hash__", "__repr__", "__iter__", "__enter__", "decode", "open"):
                with pytest.raises((TypeError, RuntimeError)):
                    getattr(blank, name)(*[0] * (name in ("at", "chunk", "chunks")))
    with pytest.raises(TypeError):
        runstone.Chunk.to_numpy(None)
    with pytest.raises(IndexError):
        runstone.Chunk.uniform((8, 8, 8))[8, 0, 0]
    with pytest.raises(TypeError):
        runstone.Chunk.from_numpy("no array at all", 5)
