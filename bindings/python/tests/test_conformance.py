"""The golden vectors of the conformance kit, and the kit's judgement of Client."""
import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest
import runstone


KIT = pathlib.Path(__file__).parents[3] / "tests/conformance"
CLIENT = KIT / "clients/python_client.py"


def vectors(name):
    return json.loads((KIT / "files" / name).read_text())


def named(entries):
    return [pytest.param(entry, id=entry["name"]) for entry in entries]


def digest_of(chunk):
    return [chunk.digest[:16], chunk.digest[16:]]


@pytest.mark.parametrize("vector", named(vectors("chunks.json")["chunks"]))
def test_chunks_of_the_kit_are_read(vector):
    for encoding, digits in vector["bytes"].items():
        chunk = runstone.Chunk.decode(bytes.fromhex(digits))
        assert [[int(end), int(material)] for end, material in zip(chunk.run_ends, chunk.run_materials)] == vector["runs"]
        assert list(chunk.to_numpy().shape) == vector["sides"]
        assert digest_of(chunk) == vector["digest"]
        # Releases of zstd make different bytes.
        if encoding != "packed" or bytes.fromhex(digits)[2] < 8:
            assert chunk.encode(encoding).hex() == digits


@pytest.mark.parametrize("vector", named(vectors("chunks.json")["refused"]))
def test_chunks_that_the_kit_refuses_are_refused(vector):
    with pytest.raises(ValueError):
        runstone.Chunk.decode(bytes.fromhex(vector["bytes"]))


@pytest.mark.parametrize("vector", named(vectors("edits.json")["edits"]))
def test_edits_of_the_kit_have_their_effect(vector):
    edit = runstone.Edit.decode(bytes.fromhex(vector["descriptor"]))
    edge = vector["edge"]
    assert edit.encode().hex() == vector["descriptor"]
    assert [list(corner) for corner in edit.box] == vector["box"]
    assert [list(key) for key in edit.chunks(edge)] == [chunk["key"] for chunk in vector["chunks"]]
    ground = {(chunk["edge"], *chunk["key"]): chunk["raw"] for chunk in vectors("edits.json")["ground"]}
    for touched in vector["chunks"]:
        before = runstone.Chunk.decode(bytes.fromhex(ground[(edge, *touched["key"])]))
        after = before.apply(edit, key=tuple(touched["key"]))
        assert after == runstone.Chunk.decode(bytes.fromhex(touched["after"]))
        assert digest_of(after) == touched["digest"]
        assert np.count_nonzero(before.to_numpy() != after.to_numpy()) == touched["voxels_changed"]


@pytest.mark.parametrize("vector", named(vectors("edits.json")["refused"]))
def test_edits_that_the_kit_refuses_are_refused(vector):
    with pytest.raises(ValueError):
        runstone.Edit.decode(bytes.fromhex(vector["bytes"]))


@pytest.mark.parametrize("vector", named(vectors("borders.json")["chunks"]))
def test_borders_of_the_kit_are_the_outermost_layers(vector):
    voxels = runstone.Chunk.decode(bytes.fromhex(vector["raw"])).to_numpy()
    for direction, runs in vector["layers"].items():
        axis = "xyz".index(direction[1])
        layer = voxels.take(0 if direction[0] == "-" else -1, axis)
        # The first of the two other axes is fastest.
        expected = np.repeat([material for _, material in runs], [length for length, _ in runs])
        assert np.array_equal(layer.ravel(order="F"), expected)


def test_the_client_gets_full_marks():
    programs = pathlib.Path(os.environ["RUNSTONE_BIN"])
    run = subprocess.run([programs / "runstone-conformance", "judge", "--jobs", "4", "--", sys.executable, CLIENT],
                         capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    assert "not tried" not in run.stdout, run.stdout
