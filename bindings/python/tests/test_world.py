"""Worlds on disk against the arrays from which they were made."""
import datetime
import subprocess
import threading
from pathlib import Path

import numpy as np
import pytest

import runstone
from conftest import BIN, EDGE, ORIGIN, Server, History, box_of_base, numbers_of, run, sequences_of_builds


def test_a_box_has_the_voxels_of_the_newest_state_and_of_each_moment(history):
    with runstone.World.open(history.place) as world:
        assert world.edge == EDGE and world.generator == "empty" and not world.pinned and world.loss is None
        ends = sequences_of_builds(world)
        assert len(ends) == len(history.builds)
        assert np.array_equal(numbers_of(world, world[box_of_base()]), history.after[-1])
        for after, sequence in zip(history.after, [0, *ends]):
            with world.at(sequence) as then:
                assert then.pinned and then.sequence == sequence
                assert np.array_equal(numbers_of(then, then[box_of_base()]), after)


def test_parts_of_boxes_and_single_layers_are_those_of_the_array(history):
    rng = np.random.default_rng(2)
    whole = history.after[-1]
    with runstone.World.open(history.place) as world:
        for _ in range(30):
            low = [int(rng.integers(0, side)) for side in whole.shape]
            high = [int(rng.integers(a + 1, side + 1)) for a, side in zip(low, whole.shape)]
            box = tuple(slice(o + a, o + b) for o, a, b in zip(ORIGIN, low, high))
            part = world[box]
            assert part.dtype == np.uint16 and part.shape == tuple(b - a for a, b in zip(low, high))
            assert np.array_equal(numbers_of(world, part), whole[tuple(slice(a, b) for a, b in zip(low, high))])
        x, y, z = box_of_base()
        assert np.array_equal(numbers_of(world, world[x, ORIGIN[1] + 5, z]), whole[:, 5, :])
        assert numbers_of(world, world[ORIGIN[0] + 4, ORIGIN[1] + 3, ORIGIN[2]]) == whole[4, 3, 0]
        assert not world[-2000:-1990, 500:520, 70:71].any()


def test_chunks_are_those_of_the_box_and_the_log_makes_them(history):
    with runstone.World.open(history.place) as world, world.at(0) as base:
        for x in range(-2, 2):
            for y in range(-1, 2):
                for z in range(0, 3):
                    key = (x, y, z)
                    box = tuple(slice(EDGE * k, EDGE * (k + 1)) for k in key)
                    chunk = base.chunk(key)
                    assert np.array_equal(chunk.to_numpy(), base[box])
                    for record in world.log():
                        if record.box:
                            chunk = chunk.apply(record.edit, key)
                    assert chunk == world.chunk(key) and np.array_equal(chunk.to_numpy(), world[box])


def test_the_log_is_an_iterator_of_records_in_order(history):
    with runstone.World.open(history.place) as world:
        records = list(world.log())
        assert [record.sequence for record in records] == list(range(1, world.sequence + 1))
        assert records[0].kind == "rights" and records[0].cause == "rights" and records[0].box is None
        boxes = [record for record in records if record.kind == "box"]
        (array, at) = history.builds[0]
        assert boxes[0].box == (at, tuple(a + side for a, side in zip(at, array.shape)))
        assert all(record.author == 0 and record.epoch == 1 for record in records)
        times = [record.time for record in records]
        assert times == sorted(times) and times[0].tzinfo is datetime.timezone.utc
        now = datetime.datetime.now(datetime.timezone.utc)
        assert now - datetime.timedelta(hours=1) < times[0] <= now and world.time == times[-1]
        assert records[1].time_us == round(times[1].timestamp() * 1e6)
        assert [r.sequence for r in world.log(2, 3)] == [2, 3] and list(world.log(10 ** 6)) == [] and list(world.log(1, 0)) == []
        middle = times[1]
        at_time = [r.sequence for r in records if r.time <= middle][-1]
        assert world.at(middle).sequence == world.at(middle.astimezone()).sequence == at_time
        assert world.at(str(world.sequence)).sequence == world.at("-0s").sequence == world.sequence
        assert world.players == {}


def test_a_world_follows_its_server_and_a_moment_does_not(tmp_path, history):
    made = History(tmp_path)
    with Server(made.place) as server, runstone.World.open(made.place) as world:
        start = world.at(world.sequence)
        for number in range(len(made.builds)):
            made.place_build(server, number)
            wait_for_build(world, number + 1)
            assert np.array_equal(numbers_of(world, world[box_of_base()]), made.after[-1])
            assert np.array_equal(numbers_of(start, start[box_of_base()]), made.base)
        server.control("undo")
        wait_for(lambda: any(record.cause == "undo" for record in world.log()))
        assert np.array_equal(numbers_of(world, world[box_of_base()]), made.after[-2])


def wait_for(condition):
    for _ in range(600):
        if condition():
            return
        threading.Event().wait(0.05)
    raise AssertionError("the edit did not become durable")


def wait_for_build(world, count):
    wait_for(lambda: len(sequences_of_builds(world)) == count)


def test_threads_share_a_world(history):
    with runstone.World.open(history.place) as world:
        expected = world[box_of_base()]
        wrong = []

        def read():
            for _ in range(5):
                if not np.array_equal(world[box_of_base()], expected) or len(list(world.log())) != world.sequence:
                    wrong.append(threading.get_ident())
        threads = [threading.Thread(target=read) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert not wrong


def test_a_dump_of_runstone_replay_is_the_same_array(history, tmp_path):
    file = tmp_path / "box.npy"
    corners = [*ORIGIN, *(o + side - 1 for o, side in zip(ORIGIN, history.base.shape))]
    run(f"{BIN}/runstone-replay", "dump", "--world", history.place, "--box", ",".join(map(str, corners)), file)
    with runstone.World.open(history.place) as world:
        dumped = np.load(file)
        assert dumped.dtype == np.uint16 and np.array_equal(dumped, world[box_of_base()])


def test_after_close_every_use_raises(history):
    world = runstone.World.open(history.place)
    pinned, log = world.at(1), world.log()
    next(log)
    world.close()
    world.close()
    assert world.closed and not pinned.closed and pinned.sequence == 1
    uses = [lambda: world[0:1, 0:1, 0:1], lambda: world.chunk((0, 0, 0)), lambda: world.at(0), lambda: world.log(), lambda: world.sequence,
            lambda: world.time, lambda: world.materials, lambda: world.visibility, lambda: world.players, lambda: world.loss]
    for use in uses:
        with pytest.raises(ValueError, match="the world is closed"):
            use()
    assert world.edge == EDGE and history.place in repr(world)
    with pytest.raises(ValueError, match="the world is closed"):
        next(log)


@pytest.mark.parametrize("index, words", [
    ((slice(0, 4), slice(0, 4)), "three indices"),
    (slice(0, 4), "three indices"),
    ((slice(None, 4), slice(0, 4), slice(0, 4)), "axis x needs both ends"),
    ((slice(0, 4), slice(0, 4, 2), slice(0, 4)), "axis y has a step"),
    ((slice(0, 4), slice(0, 4), slice(4, 4)), "axis z is empty"),
    ((slice(0, 4), slice(0, 4), slice(0, 1 << 40)), "axis z is outside the world"),
    ((slice(0, 1 << 20), slice(0, 1 << 20), slice(0, 1 << 20)), "read it in parts"),
    ((slice(0, 4), "y", slice(0, 4)), "neither a slice nor a number"),
])
def test_bad_boxes_are_refused_in_words(history, index, words):
    with runstone.World.open(history.place) as world:
        with pytest.raises(ValueError, match=words):
            world[index]


def test_bad_moments_places_and_chunks_are_refused_in_words(history, tmp_path):
    with runstone.World.open(history.place) as world:
        for moment, words in [(10 ** 6, "ends at seq="), (-1, "0 or greater"), ("yesterday", "is no moment"), (None, "a moment is"),
                              (datetime.datetime(2026, 1, 1), "no time zone")]:
            with pytest.raises(ValueError, match=words):
                world.at(moment)
        with pytest.raises(ValueError, match="outside the world"):
            world.chunk((1 << 29, 0, 0))
        with pytest.raises(ValueError, match="the first sequence is 1"):
            world.log(0)
    with pytest.raises(runstone.Error, match=str(tmp_path)):
        runstone.World.open(str(tmp_path))
    (tmp_path / "world.sqlite").write_bytes(b"no database" * 100)
    with pytest.raises(runstone.Error, match="world.sqlite"):
        runstone.World.open(str(tmp_path))


def test_a_place_can_be_a_path(history):
    with runstone.World.open(Path(history.place)) as world, runstone.World.open(str(history.place)) as other:
        assert world.world_id == other.world_id
    with pytest.raises(TypeError):
        runstone.World.open(3)


def test_threads_that_share_an_iterator_get_each_record_once(history):
    with runstone.World.open(history.place) as world:
        expected = [record.sequence for record in world.log()]
        log, seen = world.log(), []
        threads = [threading.Thread(target=lambda: seen.extend(record.sequence for record in log)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert sorted(seen) == expected and len(expected) > 1


def test_the_world_can_be_served_while_it_is_open(history):
    with runstone.World.open(history.place) as world:
        assert world.sequence > 0
        verified = subprocess.run([f"{BIN}/runstone-replay", "verify", "--world", history.place], capture_output=True, timeout=120)
        assert verified.returncode == 0
