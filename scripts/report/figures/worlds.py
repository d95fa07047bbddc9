"""Beyond the thesis: landscapes, a real world, worlds that are hard to mesh, axis orders, edits."""
import math

from ..charts import Axis, Series, dots, lines
from ..comparison import OURS, compare
from ..figure import Figure, Section
from ..meshers import mesher
from ..statistics import Interval, exactly, geometric_mean, geometric_mean_interval, mean, mean_interval, with_quads
from ..style import INK, OTHER
from ..text import interval_text, number_text

BASELINES = ("decode_binary", "mask_binary", "rle_rdm", "culled")
EDITS = (1, 10, 100, 1000)


def _worlds(evidence, step, title):
    rows = evidence.here.rows(step)
    worlds = rows.kinds("world")
    found = {(w, k): compare(rows.where(world=w), k) for w in worlds for k in rows.kinds("mesher")}
    series = [
        Series(
            mesher(k).short,
            mesher(k).light,
            [found[w, k].gain if found.get((w, k)) else exactly(math.nan) for w in worlds],
        )
        for k in BASELINES
    ]
    volumes = {w: len(found[w, "decode_binary"].volumes) if found.get((w, "decode_binary")) else 0 for w in worlds}
    ratios = "; ".join(f"{w} {interval_text(found[w, 'decode_binary'].gain)}" for w in worlds if volumes[w])
    return Figure(
        step,
        title,
        f"Decoding and binary greedy meshing takes this many times as long as ours: {ratios or 'not measured'}.",
        (step,),
        [
            "world",
            "mesher",
            "volumes",
            "times ours",
            "low",
            "high",
            "sums: times ours",
            "ours mean us",
            "mean us",
            "triangles, times ours",
        ],
        [
            [
                w,
                k,
                len(c.volumes),
                c.gain.middle,
                c.gain.low,
                c.gain.high,
                c.sums.middle,
                c.our_mean_us,
                c.other_mean_us,
                c.triangles,
            ]
            for (w, k), c in found.items()
            if c
        ],
        [
            dots(
                step,
                "ratios by world",
                [f"{w} ({volumes[w]})" for w in worlds],
                series,
                Axis("times as long as ours", True, 1),
            )
        ],
        notes=[
            "The number after a name counts its volumes with quads. The lines are 95 % bootstrap"
            " intervals of the geometric mean over the volumes; with one volume, the range that"
            " its repetitions allow."
        ],
    )


def _orders(evidence):
    rows = evidence.here.rows("orders")
    worlds = rows.kinds("world")
    cells = {
        (r["world"], r["part"], r["mesher"], r["rank"]): r for r in with_quads(rows) if r["rank"] in ("best", "worst")
    }

    def values(world, rank, key, field):
        """Returns a value for each volume.

        If all orders of a volume cost the same, it has no worst order: the best counts as the worst.
        """
        parts = dict.fromkeys(p for w, p, m, r in cells if w == world and m == key and r == "best")
        return [cells.get((world, p, key, rank), cells[world, p, key, "best"])[field] for p in parts]

    def means(rank, key, field, scale=1):
        return [mean_interval([v / scale for v in values(w, rank, key, field)]) for w in worlds]

    fewer = {
        w: geometric_mean([a / b for a, b in zip(values(w, "worst", OURS, "runs"), values(w, "best", OURS, "runs"))])
        for w in worlds
    }
    faster = {
        w: geometric_mean(
            [a / b for a, b in zip(values(w, "worst", OURS, "median_ns"), values(w, "best", OURS, "median_ns"))]
        )
        for w in worlds
    }
    blue, orange = mesher(OURS).light, mesher("decode_binary").light
    runs = [
        Series("cheapest order", blue, means("best", OURS, "runs")),
        Series("dearest order", blue, means("worst", OURS, "runs"), True),
    ]
    times = [
        Series("ours, cheapest order", blue, means("best", OURS, "median_ns", 1000)),
        Series("ours, dearest order", blue, means("worst", OURS, "median_ns", 1000), True),
        Series("decode + binary, cheapest order", orange, means("best", "decode_binary", "median_ns", 1000)),
    ]
    return Figure(
        "axis-orders",
        "Axis orders: compression rotation (9.2)",
        (
            "The cheapest of the six orders has"
            f" {interval_text(geometric_mean_interval(fewer.values()))} times fewer runs than the"
            " dearest (geometric mean over these worlds) and meshes"
            f" {interval_text(geometric_mean_interval(faster.values()))} times faster. Which one"
            " it is differs by chunk, so each holder picks it when a chunk is made."
        ),
        ("orders",),
        ["world", "order", "volumes", "runs", "ours us", "decode_binary us"],
        [
            [
                w,
                o,
                len(of),
                mean(of.numbers("runs")),
                mean(of.numbers("median_ns")) / 1000,
                mean(rows.where(world=w, order=o, mesher="decode_binary").numbers("median_ns")) / 1000,
            ]
            for w in worlds
            for o in rows.kinds("order")
            for of in (rows.where(world=w, order=o, mesher=OURS),)
            if len(of)
        ],
        [
            dots("axis-orders", "runs by axis order", worlds, runs, Axis("runs of a chunk, mean", True)),
            dots("axis-orders-time", "time by axis order", worlds, times, Axis("µs of a chunk, mean", True)),
        ],
        notes=[
            "The lines are 95 % bootstrap intervals over the volumes of the world; a world with one volume has none."
        ],
    )


def _dirty_layers(evidence):
    rows = evidence.here.rows("dirty-layers")
    layers, whole = [v / 1000 for v in rows.numbers("edit_ns")], [v / 1000 for v in rows.numbers("edit_full_mesh_ns")]
    blue = mesher(OURS).light
    return Figure(
        "dirty-layers",
        "Dirty layers: what an edit costs to mesh",
        (
            "After one voxel changed, the runs are spliced and only the layers it touched are"
            f" meshed, neighbours included: {number_text(mean(layers))} µs on average, where"
            f" meshing the chunks whole takes {number_text(mean(whole))} µs."
        ),
        ("dirty-layers",),
        ["world", "edge", "changed layers us", "whole chunk us", "bytes a voxel"],
        [[r["world"], r["edge"], a, b, r["memory_bytes"] / r["voxels"]] for r, a, b in zip(rows, layers, whole)],
        [
            dots(
                "dirty-layers",
                "an edit's mesh",
                [f"{r['world']} {r['edge']}³" for r in rows],
                [
                    Series("changed layers only", blue, [exactly(v) for v in layers]),
                    Series("the whole chunk again", blue, [exactly(v) for v in whole], True),
                ],
                Axis("µs", True),
            )
        ],
        notes=["Each value is a median over edits; the benchmark writes no range."],
    )


def _edit_to_mesh(evidence):
    rows = [r for r in evidence.here.rows("edit-to-mesh") if r["neighbours"]]
    ratios = [r["layers_ns"] / r["whole_ns"] for r in rows]
    places = [f"{r['world']} {r['edge']}³, {r['brush']}" for r in rows]
    worst, where = max(zip(ratios, places), default=(math.nan, "not measured"))
    blue = mesher(OURS).light
    spheres = [r for r in rows if r["brush"] == "voxel" or r["brush"].startswith("sphere")]
    timed = ("apply_ns", "layers_ns", "whole_ns", "sweep_ns", "emit_ns")
    return Figure(
        "edit-to-mesh",
        "Edit to mesh: edits by brush",
        (
            "The layers that a brush touched are meshed again, or the whole chunk where that costs less:"
            f" at worst {number_text(worst)} times the whole mesh ({where})."
        ),
        ("edit-to-mesh",),
        ["world", "edge", "brush", "runs us", "layers us", "whole us", "sweep us", "emit us", "layers / whole", "by layers"],
        [
            [r["world"], r["edge"], r["brush"], *(r[t] / 1000 for t in timed), ratio, r["by_layers"]]
            for r, ratio in zip(rows, ratios)
        ],
        [
            dots(
                "edit-to-mesh",
                "voxels and spheres",
                [f"{r['world']} {r['edge']}³, {r['brush']}" for r in spheres],
                [
                    Series("touched layers", blue, [exactly(r["layers_ns"] / 1000) for r in spheres]),
                    Series("the whole chunk again", blue, [exactly(r["whole_ns"] / 1000) for r in spheres], True),
                ],
                Axis("µs", True),
            )
        ],
        notes=["Each value is a median over edits; the benchmark writes no range."],
    )


def _stacks(evidence):
    rows = evidence.here.rows("edits")

    def at(name, edits):
        row = rows.where(case=name, edits=edits)
        return Interval(row.number("median_us"), row.number("median_us"), row.number("p90_us"))

    cases = [
        (
            f"{how}, {'as a stack' if stack else 'one by one'}",
            f"mixed edits {how} {'as a stack' if stack else 'one by one'}",
            colour,
            not stack,
        )
        for how, colour in (("by hand", INK), ("by brush", OTHER))
        for stack in (True, False)
    ]

    def us(key):
        return interval_text(at(key, 1000))

    return Figure(
        "stacks",
        "Stacked edits (9.2): one sweep instead of many",
        (
            f"A thousand edits of one chunk by hand take {us(cases[0][1])} µs as one stack and"
            f" {us(cases[1][1])} µs one by one; by brush {us(cases[2][1])} and {us(cases[3][1])}."
        ),
        ("edits",),
        ["case", "edits", "median us", "p90 us"],
        [[name, n, at(key, n).middle, at(key, n).high] for name, key, _, _ in cases for n in EDITS],
        [
            lines(
                "stacks",
                "edits as a stack and one by one",
                [Series(name, colour, [(n, at(key, n)) for n in EDITS], hollow) for name, key, colour, hollow in cases],
                Axis("edits of one chunk", True),
                Axis("µs", True),
            )
        ],
        notes=["Bands and brackets show the range from the median to the 90th percentile."],
    )


def worlds_section(evidence):
    return Section(
        "worlds",
        "Beyond the thesis: worlds, orders, edits",
        "Seeded landscapes, a real world made by another program (Luanti), and worlds that are hard to mesh.",
        [
            _worlds(evidence, "landscapes", "Landscapes and a real world"),
            _worlds(evidence, "adversaries", "Worlds that are hard to mesh"),
            _orders(evidence),
            _dirty_layers(evidence),
            _edit_to_mesh(evidence),
            _stacks(evidence),
        ],
    )
