"""Triangles to runs: the voxeliser against a grid of one byte a voxel, and against an oracle."""
import math

from ..charts import Axis, Series, lines
from ..figure import Figure, HeatTable, Section
from ..statistics import exactly
from ..text import count_text, list_text, number_text, quantity_text, time_text

RUNS, GRID = "solid", "solid, byte grid"
COLOURS = ("#3f88c0", "#c2410c", "#1b7f4e", "#5b3fa9")
STEPS = ("voxelise",)


class Voxelised:
    """The measurements by way, mesh and side."""

    def __init__(self, rows):
        self.rows = rows
        self.meshes = sorted(rows.kinds("triangles"))
        self.sides = sorted(rows.kinds("side"))
        self.ways = rows.kinds("way")

    def number(self, way, triangles, side, field):
        return self.rows.where(way=way, triangles=triangles, side=side).number(field)

    def seconds(self, way, triangles, side):
        return self.number(way, triangles, side, "cpu_s")

    def bytes(self, way, triangles, side):
        """Returns the peak of the memory, with the triangles."""
        return sum(self.number(way, triangles, side, field) for field in ("model_bytes", "peak_bytes"))

    def cases(self):
        return [(triangles, side) for triangles in self.meshes for side in self.sides]

    def times_grid(self, value):
        """Returns the value of the grid divided by that of the runs, by case."""
        return {case: value(GRID, *case) / value(RUNS, *case) for case in self.cases() if value(RUNS, *case) > 0}

    def largest(self):
        return (self.meshes[-1], self.sides[-1]) if self.meshes else None


def _case_text(case):
    return f"{number_text(case[0])} triangles into {case[1]:,}³"


def _lower_than_one(ratios):
    return [_case_text(case) for case, ratio in ratios.items() if ratio < 1]


def _sentence(found, what, ratios):
    """Returns the answer at the largest case, and where the grid is better."""
    case = found.largest()
    if case is None or case not in ratios:
        return "Not measured."
    better = _lower_than_one(ratios)
    against = f" The grid takes less with {list_text(better)}." if better else " It takes more in every case."
    return f"{what} {number_text(ratios[case])} times as much by way of a grid of one byte a voxel.{against}"


def _lines(found, name, title, value, label):
    series = [
        Series(
            f"{number_text(triangles)} triangles, {way_name}",
            COLOURS[i % len(COLOURS)],
            [(side, exactly(value(way, triangles, side))) for side in found.sides],
            way == GRID,
        )
        for i, triangles in enumerate(found.meshes)
        for way, way_name in ((RUNS, "runs"), (GRID, "grid"))
    ]
    return lines(name, title, series, Axis("longest side, voxels", True), Axis(label, True))


def _ratio_table(found, ratios):
    return HeatTable(
        "grid / runs",
        [f"{side:,}³" for side in found.sides],
        [
            (
                f"{count_text(triangles)} triangles",
                [
                    (number_text(ratios.get((triangles, side), math.nan)), 0 if ratios.get((triangles, side), 0) >= 1 else 1)
                    for side in found.sides
                ],
            )
            for triangles in found.meshes
        ],
    )


def _time(found):
    ratios = found.times_grid(found.seconds)
    case = found.largest()
    taken = time_text(found.seconds(RUNS, *case) * 1e9) if case else "–"
    what = f"On one core {_case_text(case)} take {taken}, and" if case else ""
    return Figure(
        "voxelise-time",
        "Triangles to runs: time (3.5, 9.2)",
        _sentence(found, what, ratios),
        STEPS,
        ["triangles", "side", "runs s", "grid s", "grid / runs"],
        [[*c, found.seconds(RUNS, *c), found.seconds(GRID, *c), ratios.get(c, math.nan)] for c in found.cases()],
        [_lines(found, "voxelise-time", "time by side", found.seconds, "s of one core")],
        _ratio_table(found, ratios),
        [
            "A closed statue with bumps becomes a solid of one colour. Both ways find the same crossings of"
            " rows and triangles; the grid marks them in its bytes, fills the rows between them, and makes"
            " runs of the bytes. The program aborts if one voxel differs. Times are medians of the"
            " thread's processor time."
        ],
    )


def _memory(found):
    ratios = found.times_grid(found.bytes)
    case = found.largest()
    taken = quantity_text(found.bytes(RUNS, *case) / 1e6, "MB") if case else "–"
    what = f"{_case_text(case)} take {taken} at their peak, and" if case else ""
    return Figure(
        "voxelise-memory",
        "Triangles to runs: peak memory (3.5, 9.2)",
        _sentence(found, what, ratios),
        STEPS,
        ["triangles", "side", "runs bytes", "grid bytes", "grid / runs", "bytes of the result"],
        [
            [
                *c,
                found.bytes(RUNS, *c),
                found.bytes(GRID, *c),
                ratios.get(c, math.nan),
                found.number(RUNS, *c, "run_bytes"),
            ]
            for c in found.cases()
        ],
        [
            _lines(
                found,
                "voxelise-memory",
                "peak memory by side",
                lambda *c: found.bytes(*c) / 1e6,
                "MB at the peak, triangles included",
            )
        ],
        _ratio_table(found, ratios),
        [
            "The triangles are included. The runs of the result are not: both ways give them away section by"
            " section. The memory is the growth of the process in RAM, so pages of the grid that no row"
            " touches do not count."
        ],
    )


def _errors(found):
    compared = sum(found.rows.numbers("compared"))
    differing = sum(found.rows.numbers("differing"))
    triples = [(way, *case) for way in found.ways for case in found.cases()]

    def cell(way, side):
        of = found.rows.where(way=way, side=side)
        wrong, total = sum(of.numbers("differing")), sum(of.numbers("compared"))
        return f"{count_text(wrong)} of {count_text(total)}", 1 if wrong else 0

    return Figure(
        "voxelise-errors",
        "Triangles to runs: errors of volume and surface",
        (
            f"Of {count_text(compared)} voxels that an independent oracle computed, {count_text(differing)}"
            f" {'differs' if differing == 1 else 'differ'}."
            if compared
            else "Not measured."
        ),
        STEPS,
        ["way", "triangles", "side", "compared", "differing"],
        [[*t, *(found.number(*t, field) for field in ("compared", "differing"))] for t in triples],
        table=HeatTable(
            "differing voxels",
            [f"{side:,}³" for side in found.sides],
            [(way, [cell(way, side) for side in found.sides]) for way in found.ways],
        ),
        notes=[
            "The oracle computes each voxel on its own from all triangles, in integers of 128 bits and by"
            " other tests than the voxeliser. Half of the voxels are drawn near the surface, and half"
            " anywhere in the box. The tests compare every voxel of hundreds of random meshes with the"
            " oracle, and the solids are compared with the grid voxel by voxel."
        ],
    )


def voxels_section(evidence):
    found = Voxelised(evidence.here.rows("voxelise"))
    return Section(
        "voxels",
        "Triangles to runs",
        "The thesis leaves open how triangles become runs without a grid. Here they do: the places where"
        " triangles cross a row of voxels are the ends of its runs.",
        [_time(found), _memory(found), _errors(found)],
    )
