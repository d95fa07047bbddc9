"""All meshers on the thesis' scenarios: time, triangles, T-junctions, and the scenarios themselves."""
import math

from ..charts import Axis, Bar, Series, bars, dots
from ..comparison import OURS, compare
from ..figure import Figure, HeatTable, Section, shade_of
from ..meshers import mesher
from ..statistics import (
    exactly,
    geometric_mean,
    geometric_mean_interval,
    place_text,
    places,
    repetitions_of,
    with_quads,
)
from ..steps import SCENARIOS
from ..text import count_text, interval_text, list_text, number_text, time_text

SHOWN = ("rdm", "decode_binary", "mask_binary", "rle_rdm", "grid_rdm", "culled")
STEPS = ("meshers",)


class MesherTotals:
    """Sums and means of every mesher over the scenarios that have quads."""

    def __init__(self, rows):
        self.rows = with_quads(rows)
        self.parts = list(dict.fromkeys(r["part"] for r in self.rows))
        self.empty = [p for p in rows.kinds("part") if p not in self.parts]
        self.keys = list(dict.fromkeys(r["mesher"] for r in self.rows))
        self._cells = {(r["mesher"], r["part"]): r for r in self.rows}

    def empty_note(self):
        """Returns which scenarios are in no mean and why; an empty text if none was measured."""
        if not self.empty:
            return "Every scenario has quads." if self.parts else ""
        names = list_text(self.empty)
        return (
            f"The chunk in the middle of scenario{'s' if len(self.empty) > 1 else ''} {names} has"
            " no quads, so it is in no mean."
        )

    def cell(self, key, part):
        return self._cells.get((key, part))

    def is_whole(self, key):
        return all((key, part) in self._cells for part in self.parts)

    def sum(self, key, field):
        """Returns a sum over all scenarios; NaN if one is missing."""
        return sum(self.cell(key, p)[field] for p in self.parts) if self.is_whole(key) and self.parts else math.nan

    def mean_ns(self, key):
        return geometric_mean([self.cell(key, p)["median_ns"] for p in self.parts]) if self.is_whole(key) else math.nan

    def against_ours(self, key):
        """Returns how many times as long as ours this mesher takes."""
        if not self.is_whole(key) or not self.is_whole(OURS):
            return exactly(math.nan)
        return geometric_mean_interval(
            [self.cell(key, p)["median_ns"] / self.cell(OURS, p)["median_ns"] for p in self.parts]
        )


def _time(totals):
    def mean_text(key):
        return time_text(totals.mean_ns(key)) if totals.is_whole(key) else "a time that was not measured"

    keys = sorted((k for k in totals.keys if totals.is_whole(k)), key=totals.mean_ns)
    ratios = [totals.against_ours(k) for k in keys]
    ranks = [place_text(p) for p in places(ratios)]
    all_bars = [
        Bar(mesher(k).name, mesher(k).light, ratio, f"{time_text(totals.mean_ns(k))}, place {rank}")
        for k, ratio, rank in zip(keys, ratios, ranks)
    ]
    return Figure(
        "meshers-time",
        "All meshers: time",
        (
            f"From compressed runs ours takes {mean_text(OURS)}, and decoding with binary greedy"
            f" meshing {mean_text('decode_binary')} (geometric means of {len(totals.parts)}"
            " scenarios). With the grid and its mask ready, binary greedy meshing takes"
            f" {mean_text('mask_binary')}."
        ),
        STEPS,
        ["mesher", "geometric mean us", "times ours", "low", "high", "place", "sum us"],
        [
            [k, totals.mean_ns(k) / 1000, r.middle, r.low, r.high, rank, totals.sum(k, "median_ns") / 1000]
            for k, r, rank in zip(keys, ratios, ranks)
        ],
        [
            bars(
                "meshers-time", "time of every mesher", all_bars, Axis("times as long as ours, geometric mean", True, 1)
            )
        ],
        notes=[
            (
                "The lines are 95 % bootstrap intervals over the scenarios. Meshers whose"
                " intervals overlap share places."
            ),
            totals.empty_note(),
            "The chunk in the middle of 27; one core; runs in their cheapest axis order.",
            "Meshers marked 'grid ready' are not charged for making the grid out of what is stored.",
        ],
    )


def _scenarios_chart(totals):
    keys = [k for k in SHOWN if k in totals.keys]
    series = [
        Series(
            mesher(k).short,
            mesher(k).light,
            [repetitions_of(totals.cell(k, p)) if totals.cell(k, p) else exactly(math.nan) for p in totals.parts],
        )
        for k in keys
    ]
    rows, table = [], []
    cells = {
        (k, p): totals.cell(k, p)["median_ns"] / 1000 for k in totals.keys for p in totals.parts if totals.cell(k, p)
    }
    for part in totals.parts:
        values = [cells[k, part] for k in totals.keys if (k, part) in cells]
        line = []
        for k in totals.keys:
            value = cells.get((k, part), math.nan)
            line.append((number_text(value), shade_of(value, min(values), max(values))))
            cell = totals.cell(k, part)
            if cell:
                rows.append(
                    [
                        part,
                        k,
                        value,
                        cell["min_ns"] / 1000,
                        cell["p90_ns"] / 1000,
                        cell["quads"],
                        cell["vertices"],
                        cell["triangles"],
                        cell["t_junctions"],
                        cell["storage_bytes"],
                    ]
                )
        table.append((part, line))
    against = compare(totals.rows, "decode_binary")
    counts = (
        f"In {len(against.faster)} of {len(against.volumes)} scenarios meshing from runs is faster"
        f" than decoding and binary greedy meshing, in {len(against.slower)} slower, and in"
        f" {len(against.undecided)} the repetitions overlap."
        if against
        else "Decoding was not measured."
    )
    return Figure(
        "meshers-scenarios",
        "All meshers over all scenarios",
        counts,
        STEPS,
        [
            "scenario",
            "mesher",
            "us",
            "min us",
            "p90 us",
            "quads",
            "vertices",
            "triangles",
            "t_junctions",
            "storage_bytes",
        ],
        rows,
        [
            dots(
                "meshers-scenarios",
                "time of meshers in every scenario",
                totals.parts,
                series,
                Axis("µs of a chunk", True),
            )
        ],
        HeatTable("µs", [mesher(k).short for k in totals.keys], table),
        [
            (
                "The lines reach from the fastest repetition to the 90th percentile. Empty cells"
                " took longer than 5 s."
            ),
            totals.empty_note(),
            "In the table a darker cell is slower within its scenario.",
        ],
    )


def _counts(totals, id_, title, field, label, log, sentence, notes=()):
    keys = [k for k in totals.keys if totals.is_whole(k) and not mesher(k).is_variant]
    keys.sort(key=lambda k: totals.sum(k, field))
    all_bars = [
        Bar(mesher(k).name, mesher(k).light, exactly(totals.sum(k, field)), count_text(totals.sum(k, field)))
        for k in keys
    ]
    return Figure(
        id_,
        title,
        sentence,
        STEPS,
        ["mesher", field],
        [[k, totals.sum(k, field)] for k in keys],
        [bars(id_, title, all_bars, Axis(label, log))],
        notes=list(notes),
    )


def _triangles(totals):
    ours, best, rle = (totals.sum(key, "triangles") for key in (OURS, "optimal_greedy", "rle_rdm"))
    sentences = []
    if math.isnan(ours):
        sentences.append("Ours was not measured in every scenario.")
    elif math.isfinite(best):
        sentences.append(
            "No mesher that draws the exposed faces as rectangles can use fewer than"
            f" {count_text(best)} triangles. Ours uses {ours / best:.3f} times that."
        )
    else:
        sentences.append(f"Ours uses {count_text(ours)} triangles. The least possible number was not measured.")
    if math.isfinite(rle / ours):
        sentences.append(f"The thesis' RLE RDM uses {number_text(rle / ours)} times as many as ours.")
    return _counts(
        totals,
        "meshers-triangles",
        "All meshers: triangles",
        "triangles",
        "triangles, sum over the scenarios",
        True,
        " ".join(sentences),
        [
            "Monotone and Poly2Tri draw polygons, and run strips over hidden faces draw more than"
            " is exposed: the optimum does not bind them."
        ],
    )


def _t_junctions(totals):
    def count(key):
        return count_text(totals.sum(key, "t_junctions")) if totals.is_whole(key) else "not measured"

    return _counts(
        totals,
        "t-junctions",
        "All meshers: T-junctions (4.2.1)",
        "t_junctions",
        "T-junctions, sum over the scenarios",
        False,
        (
            "A vertex inside another polygon's edge can flicker as a seam. Merging makes them:"
            f" ours has {count(OURS)}, the culled mesher {count('culled')}. Monotone"
            f" ({count('monotone')}) and Poly2Tri ({count('poly2tri')}) lessen them within a plane"
            " and keep them between planes."
        ),
    )


def _gallery(evidence, totals):
    pictures = {r["scenario"]: r["png"] for r in evidence.here.rows("pictures")}
    facts = {r["scenario"]: r for r in evidence.here.rows("facts")}
    against = compare(totals.rows, "decode_binary")
    rle = compare(totals.rows, "rle_rdm")
    cards, rows = [], []
    for s in SCENARIOS:
        part = str(s)
        ratio = against.volumes.get(part) if against else None
        rle_ratio = rle.volumes.get(part) if rle else None
        fact = facts.get(s)
        solid = 100 * fact["opaque"] / fact["voxels"] if fact else math.nan
        rows.append(
            [
                s,
                evidence.thesis.names.get(s, ""),
                solid,
                *([ratio.middle, ratio.low, ratio.high] if ratio else [math.nan] * 3),
                rle_ratio.middle if rle_ratio else math.nan,
            ]
        )
        state = "none" if not ratio else "faster" if ratio.low > 1 else "slower" if ratio.high < 1 else "open"
        cards.append(
            {
                "title": f"{s} {evidence.thesis.names.get(s, '')}",
                "png": pictures.get(s),
                "state": state,
                "lines": [
                    f"{number_text(solid)} % solid" if fact else "",
                    f"decode + binary {interval_text(ratio)}" if ratio else "no quads",
                    f"RLE RDM {interval_text(rle_ratio)}" if rle_ratio else "",
                ],
            }
        )
    return Figure(
        "scenarios",
        "The 37 scenarios",
        (
            "The thesis' models as our client draws them: all 27 chunks, from outside. The share"
            " of solid voxels is of all chunks, and the times are of the chunk in the middle,"
            " divided by ours. A blue edge marks scenarios in which ours is faster than decoding"
            " first, an orange edge those in which it is slower."
        ),
        ("pictures", "facts", "meshers"),
        ["scenario", "name", "solid, %", "decode + binary: times ours", "low", "high", "RLE RDM: times ours"],
        rows,
        cards=cards,
        notes=[
            "The brackets hold the range that the repetitions of both meshers allow. Where it"
            " contains 1, the edge is grey."
        ],
    )


def meshers_section(evidence):
    rows = evidence.here.rows("meshers")
    totals = MesherTotals(rows)
    figures = [_gallery(evidence, totals)]
    if totals.parts:
        figures = [_time(totals), _scenarios_chart(totals), *figures, _triangles(totals), _t_junctions(totals)]
    return Section(
        "meshers",
        "All meshers",
        (
            "Every algorithm of the thesis' chapter 4.2, rebuilt and checked with the same oracle, on"
            f" the same chunks. {totals.empty_note()}"
        ).strip(),
        figures,
    )
