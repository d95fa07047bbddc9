"""The package as a whole: files of other programs, the examples, and the type stubs."""
import ast
import inspect
import json
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import runstone

ROOT = Path(__file__).resolve().parents[3]


def gltf_of(data):
    """Returns the JSON of a binary glTF and its buffer."""
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    buffer_size, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0"
    return json.loads(data[20:20 + size]), data[28 + size:28 + size + buffer_size]


def area_of(gltf, buffer):
    """Returns the area of all triangles in square metres. The scale stands at the root."""
    scale = gltf["nodes"][gltf["scenes"][0]["nodes"][0]]["scale"][0]
    def numbers(index):
        accessor = gltf["accessors"][index]
        view = gltf["bufferViews"][accessor["bufferView"]]
        type_ = {5126: "<f4", 5125: "<u4", 5123: "<u2"}[accessor["componentType"]]
        width = {"VEC3": 3, "SCALAR": 1}[accessor["type"]]
        item = np.dtype(type_).itemsize
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", item * width)
        rows = [np.frombuffer(buffer, type_, width, start + i * stride) for i in range(accessor["count"])]
        return np.array(rows)
    area = 0.0
    for mesh in gltf["meshes"]:
        for primitive in mesh["primitives"]:
            at = numbers(primitive["attributes"]["POSITION"]).astype(float)
            a, b, c = at[numbers(primitive["indices"]).reshape(-1, 3).astype(int)].transpose(1, 0, 2)
            area += np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    return area * scale ** 2


@pytest.mark.parametrize("layout", [np.ascontiguousarray, np.asfortranarray])
def test_a_model_has_the_faces_of_the_array_and_the_colours_of_the_materials(tmp_path, layout):
    array = np.zeros((70, 10, 20), np.uint16)
    array[3:68, 2:9, 5:15] = 7
    file = tmp_path / "box.glb"
    size = runstone.write_build(file, layout(array), [runstone.Material(7, "gold", (255, 200, 0))], metres_per_voxel=2)
    assert size == file.stat().st_size
    gltf, buffer = gltf_of(file.read_bytes())
    assert area_of(gltf, buffer) == pytest.approx(4 * 2 * (65 * 7 + 65 * 10 + 7 * 10))
    assert [material["name"] for material in gltf["materials"]] == ["gold"]


def test_other_formats_hold_the_voxels(tmp_path):
    array = np.random.default_rng(4).integers(0, 3, (9, 130, 11)).astype(np.uint16)
    runstone.write_build(str(tmp_path / "a.npz"), array, [runstone.Material(2, "stone", (9, 9, 9))], origin=(5, -6, 7))
    read = np.load(tmp_path / "a.npz")
    names = {"air": 0, "material 1": 1, "stone": 2}
    numbers = np.array([names[name] for name in read["names"]])
    assert np.array_equal(numbers[read["voxels"]], array) and list(read["origin"]) == [5, -6, 7]


@pytest.mark.parametrize("call, kind, words", [
    (lambda at: runstone.write_build(at / "a.txt", np.ones((2, 2, 2), np.uint16)), ValueError, "a.txt"),
    (lambda at: runstone.write_build(at / "a.glb", np.ones((2, 2, 2))), ValueError, "dtype uint16"),
    (lambda at: runstone.write_build(at / "a.glb", np.ones((2, 2, 0), np.uint16)), ValueError, "a side"),
    (lambda at: runstone.write_build(at / "a.glb", np.zeros((2, 2, 2), np.uint16)), runstone.Error, "a.glb"),
    (lambda at: runstone.write_build(at / "no/a.glb", np.ones((2, 2, 2), np.uint16)), runstone.Error, "no/a.glb"),
    (lambda at: runstone.write_build(at / "a.glb", np.ones((2, 2, 2), np.uint16), metres_per_voxel=0), ValueError, "metres"),
    (lambda at: runstone.write_build(at / "a.glb", np.ones((2, 2, 2), np.uint16), levels=9), ValueError, "levels"),
    (lambda at: runstone.Material(1, "", (1, 2, 3)), ValueError, "name"),
    (lambda at: runstone.Material(1, "a", (1, 2)), ValueError, "3 or 4"),
    (lambda at: runstone.Material(1, "a", (1, 2, 256)), ValueError, "0 to 255"),
    (lambda at: runstone.Material(1, "a", (1, 2, 3, 4)), ValueError, "opaque"),
    (lambda at: runstone.Material(1, "a", (1, 2, 3), "red"), ValueError, "a visibility is"),
])
def test_what_cannot_be_written_is_refused_in_words(tmp_path, call, kind, words):
    with pytest.raises(kind, match=words):
        call(tmp_path)
    assert not list(tmp_path.iterdir())


def run_example(name, *arguments):
    done = subprocess.run([sys.executable, ROOT / "examples/python" / name, *arguments], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_example_with_heights_counts_the_runs_of_a_world(history):
    lines = run_example("run_heights.py", history.place, "2").splitlines()
    with runstone.World.open(history.place) as world:
        keys = [(x, 0, z) for x in range(-2, 2) for z in range(-2, 2)]
        runs = sum(world.chunk(key).run_count for key in keys) / 16
    row = next(line for line in lines if line.split()[1] == "0")
    assert len(lines) == 9 and row.split()[2] == f"{runs:.1f}" and runs > 1


def test_the_example_with_gltf_writes_three_materials(tmp_path):
    assert "bytes" in run_example("array_to_gltf.py", tmp_path / "hill.glb")
    gltf, _ = gltf_of((tmp_path / "hill.glb").read_bytes())
    assert sorted(material["name"] for material in gltf["materials"]) == ["grass", "stone", "water"]


def test_the_type_stubs_name_what_the_module_has():
    folder = Path(runstone.__file__).parent
    assert (folder / "py.typed").exists()
    tree = ast.parse((folder / "__init__.pyi").read_text())
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_")}
    functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    assert set(classes) | functions | {"__version__"} == set(runstone.__all__)
    for name, node in classes.items():
        stub = {part.name for part in node.body if isinstance(part, (ast.FunctionDef, ast.AsyncFunctionDef))}
        stub |= {part.target.id for part in node.body if isinstance(part, ast.AnnAssign)}
        real = {part for part in vars(getattr(runstone, name)) if not part.startswith("_")}
        assert {part for part in stub if not part.startswith("_")} == real, name
        for part in stub - {"__init__", "__enter__"}:
            assert hasattr(getattr(runstone, name), part), (name, part)


def test_every_public_name_has_a_docstring():
    for name in runstone.__all__:
        value = getattr(runstone, name)
        if not inspect.isclass(value):
            continue
        assert value.__doc__, name
        for part, member in vars(value).items():
            if not part.startswith("_"):
                assert inspect.getdoc(member), (name, part)
