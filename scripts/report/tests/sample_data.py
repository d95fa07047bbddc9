"""A small report folder: three scenarios, a real world of two volumes, and one row or two of the
rest.
"""
import unittest.mock
from pathlib import Path

from report.meshers import MESHERS
from report.results import Machine, StepResult, write_result
from report.steps import PROFILES, report_steps
from report.thesis import Thesis

ROOT = Path(__file__).resolve().parent.parent.parent.parent
MACHINE = Machine("Sample CPU", 2, "g++ 12.2.0", "0123abcd", "AVX2")
STEPS = {step.name: step for step in report_steps(False)}
# A PNG picture of one pixel.
PIXEL = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="


def without_drawing():
    """Returns a patch: each chart is built, but its SVG is empty.

    Writing the SVG takes most of the time of a page.
    """

    def empty_svg(_, name, title):
        return f'<svg viewBox="0 0 1 1" aria-label="{title}"><desc>{name}</desc></svg>'

    return unittest.mock.patch("report.charts.svg_of", empty_svg)


def thesis():
    return Thesis(ROOT / "tests/data/thesis")


def mesh_row(world, part, mesher, median_ns, quads=100, rank="best", edge=32, spread=0.01):
    """Returns a row of `runstone-bench mesh`. `spread` is the share by which repetitions differ."""
    return {
        "world": world,
        "part": part,
        "edge": edge,
        "order": "xyz",
        "rank": rank,
        "mesher": mesher,
        "runs": 50,
        "median_ns": median_ns,
        "min_ns": median_ns * (1 - spread),
        "p90_ns": median_ns * (1 + spread),
        "quads": quads,
        "vertices": 4 * quads,
        "triangles": 2 * quads,
        "t_junctions": quads // 10,
        "storage_bytes": 200,
    }


def mesh_rows(world, parts, times):
    """Returns a row of every mesher for each part. `times` has those that are not 5 µs."""
    return [mesh_row(world, part, key, times.get(key, 5000)) for part in parts for key in MESHERS]


def _net(profile, cases):
    return {
        "figures": [
            {"experiment": "sample", "profile": profile, "case": case, "figure": figure, "value": value}
            for case, figure, value in cases
        ]
    }


def _results():
    times = {"rdm": 1000, "decode_binary": 2000, "mask_binary": 900, "rle_rdm": 1500}
    scenarios = [mesh_row("scenarios", "1", key, 20, quads=0) for key in MESHERS] + mesh_rows(
        "scenarios", ["2", "3"], times
    )
    orders = [
        mesh_row("hills", "0 0 0", key, ns, rank=rank)
        for key in ("rdm", "decode_binary")
        for rank, ns in (("best", 1000), ("worst", 3000))
    ]
    sides = [
        mesh_row("scenarios", part, key, 1000 * side, edge=side)
        for part in ("1", "17")
        for key in ("rdm", "decode_binary")
        for side in (32, 128)
    ]
    fact = {"group": 1, "voxels": 32768, "opaque": 100, "run_bytes": 40, "thesis_bytes": 60}
    facts = [{"scenario": s, **fact} for s in (1, 2, 3)]
    thesis_rows = [
        {
            "scenario": s,
            "group": 1,
            "mesher": key,
            "chunks": 26,
            "mean_ns": 1000,
            "median_ns": 900,
            "min_ns": 800,
            "max_ns": 2000,
            "vertices": 24,
            "mesh_ns": 1000,
            **dict.fromkeys(("decode_ns", "octree_ns", "mask_ns"), 0),
        }
        for s in (2, 3)
        for key in ("rdm", "decode_binary", "grid_rdm", "rle_rdm", "culled")
    ]
    frames = [
        {
            "world": f"scenario_{s}",
            "mesher": key,
            "path": "plain",
            "vertices": 100,
            "p50_ms": 2,
            "p90_ms": 3,
            "fps": 500,
            "lanes": 1.5,
            "pinhole_pixels": 2,
        }
        for s in (13, 23)
        for key in ("rdm", "culled", "rle_rdm", "grid_rdm", "poly2tri")
    ]
    out = {
        "pictures": {"rows": [{"scenario": 2, "png": PIXEL}]},
        "facts": {"rows": facts},
        "thesis": {"rows": thesis_rows},
        "meshers": {"rows": scenarios},
        "landscapes": {"rows": mesh_rows("luanti", ["a", "b"], times) + mesh_rows("hills", ["0 0 0"], times)},
        "adversaries": {"rows": mesh_rows("noise", ["0 0 0"], {"rdm": 3000, "decode_binary": 2000})},
        "orders": {"rows": orders},
        "chunk-sizes": {"rows": sides},
        "chunk-sizes-terrain": {"rows": sides},
        "frames": {
            "gl": {"renderer": "sample", "software": True},
            "width": 64,
            "height": 64,
            "frames": 6,
            "rows": frames,
        },
        "storage": {
            "rows": [
                {"world": "hills", "part": "0", "store": store}
                | dict.fromkeys(("bytes", "read_ns", "walk_ns", "edit_ns", "brush_ns", "build_ns"), n)
                for store, n in (("runs", 10), ("flat", 30))
            ]
        },
        "edits": {
            "rows": [
                {"case": "mixed edits by hand as a stack", "edits": n, "median_us": n, "p90_us": 2 * n}
                for n in (1, 1000)
            ]
        },
        "dirty-layers": [
            {
                "world": "hills",
                "edge": 32,
                "edit_ns": 5000,
                "edit_full_mesh_ns": 9000,
                "memory_bytes": 100,
                "voxels": 32768,
            }
        ],
        "edit-to-mesh": {
            "rows": [
                {"world": "hills", "edge": 32, "neighbours": neighbours, "brush": brush, "by_layers": 1}
                | dict.fromkeys(("apply_ns", "layers_ns", "sweep_ns", "emit_ns"), 3000)
                | {"whole_ns": 9000}
                for neighbours in (True, False)
                for brush in ("voxel", "sphere r 3", "box 6")
            ]
        },
        "voxelise": {
            "rows": [
                {
                    "way": way,
                    "triangles": 1_000_000,
                    "side": side,
                    "cpu_s": seconds,
                    "model_bytes": 20_000_000,
                    "peak_bytes": peak,
                    "voxels": 1000,
                    "runs": 100,
                    "run_bytes": 400,
                    "compared": 200,
                    "differing": differing,
                }
                for way, side, seconds, peak, differing in (
                    ("solid", 128, 0.1, 20_000_000, 0),
                    ("solid, byte grid", 128, 0.05, 30_000_000, 0),
                    ("solid", 1024, 0.2, 20_000_000, 1),
                    ("solid, byte grid", 1024, 0.8, 780_000_000, 0),
                )
            ]
        },
        "bytes": {
            "rows": [
                {"world": "luanti", "set": "all", "form": form, "bytes": n, "encode_us": 1, "decode_us": 1}
                for form, n in (("packed", 90), ("luanti", 180))
            ]
        },
        "gateway": _net(
            "loopback",
            [
                (case, f"{way}_{p}_ms", n)
                for case in ("ping and pong", "edit and commit")
                for way, p, n in (("tcp", "p50", 1), ("tcp", "p99", 2), ("gateway", "p50", 1.5), ("gateway", "p99", 2.5))
            ]
            + [
                (f"200 bots by {way}", f"seen_{p}_ms", n * run)
                for run in (1, 2, 9)
                for way, p, n in (("TCP", "p50", 1), ("TCP", "p99", 2), ("gateway", "p50", 1), ("gateway", "p99", 3))
            ],
        ),
        "siege": _net("loopback", [("window 0 quiet", "p99_ms", 2.0)]),
    }
    for profile in PROFILES:
        transfers = [
            (f"{w} {form}", "complete_ms", n)
            for w in ("luanti", "terrain")
            for form, n in (("packed", 10), ("dense_zstd", 20))
        ]
        out[f"transfer-{profile}"] = _net(profile, transfers)
        out[f"latency-{profile}"] = _net(
            profile, [("idle", f"remote_meshed_{p}_ms", n) for p, n in (("p50", 1), ("p99", 3))]
        )
    for clients in (1, 10, 100, 300, 1000):
        out[f"crowd-{clients}"] = _net(
            "loopback", [(f"{clients} clients", f"seen_{p}_ms", n) for p, n in (("p50", 1), ("p99", 3), ("max", 5))]
        )
    return out


def step_result(name, result, machine=MACHINE, quick=False):
    return StepResult(name, machine, quick, "sample of 1 bytes", "2026-01-31T23:59:59Z", 1.5, result)


def write_report(folder, machine=MACHINE, only=None):
    """Writes the results of all steps, or of some, into folder/data."""
    for name, result in _results().items():
        if only is None or name in only:
            write_result(Path(folder) / "data", step_result(name, result, machine))
