"""Verdict: the first screen of the page.

One sentence, the decisive chart, and what speaks against it.
"""
import math
from dataclasses import dataclass
from operator import truediv

from .charts import Axis, Series, dots
from .comparison import DECISIVE, OURS, compare
from .figures.meshers import MesherTotals
from .figures.network import WAYS, transfer_ms
from .meshers import MESHERS, mesher
from .statistics import UNKNOWN, exactly, geometric_mean_interval, measured
from .text import count_text, interval_text, number_text, quantity_text, time_text

SCENARIOS, REAL_WORLD = MAIN_WORLDS = ("thesis' scenarios", "a real world")
STEPS = ("meshers", "landscapes", "adversaries")
RLE_RDM = MESHERS["rle_rdm"].name
BASELINES = (DECISIVE, "mask_binary", "rle_rdm")
COLUMNS = ["machine", "world", "volumes", "mesher", "times ours", "low", "high", "sums: times ours", "low", "high"]


@dataclass(frozen=True)
class Answer:
    question: str
    best: str
    rest: str
    figure: str


@dataclass(frozen=True)
class Verdict:
    sentence: str
    chart: str  # SVG; empty if nothing was measured
    against: list
    answers: list
    columns: list
    rows: list
    empty_note: str = ""
    steps: tuple = STEPS


def world_rows(results):
    """Returns the rows of each world of the decisive comparison by its name for readers."""
    out = {SCENARIOS: results.rows("meshers")}
    for step in ("landscapes", "adversaries"):
        rows = results.rows(step)
        worlds = sorted(rows.kinds("world"), key=lambda w: w != "luanti")
        out |= {REAL_WORLD if w == "luanti" else w: rows.where(world=w) for w in worlds}
    return out


def _comparisons(evidence):
    """Returns (results, world, {mesher: Comparison}) for each world of each machine, the main
    worlds first.
    """
    out = []
    for results in evidence.machines:
        for world, rows in world_rows(results).items():
            found = {k: c for k in BASELINES if (c := compare(rows, k))}
            if found:
                out.append((results, world, found))
    return sorted(out, key=lambda r: (r[1] != SCENARIOS, r[1] != REAL_WORLD))


def _chart(evidence, comparisons):
    """Draws the worlds of this machine and the main worlds of the others."""
    several = len(evidence.machines) > 1
    comparisons = [c for c in comparisons if c[0] is evidence.here or c[1] in MAIN_WORLDS]
    rows = []
    for results, world, found in comparisons:
        machine = evidence.machine_name(results)
        count = len(next(iter(found.values())).volumes)
        rows.append(f"{world} ({count})" + (f"\n{machine}" if several and world in MAIN_WORLDS else ""))
    series = [
        Series(mesher(k).name, mesher(k).light, [f[k].gain if k in f else UNKNOWN for _, _, f in comparisons])
        for k in BASELINES
    ]
    return dots(
        "verdict",
        "times as long as meshing from runs",
        rows,
        series,
        Axis("times as long as meshing from runs (geometric mean)", True, 1),
    )


def _sentence(scenarios, real):
    if scenarios is None:
        return "The meshers were not measured yet."
    gain = scenarios.gain
    beginning = (
        "Meshing from the stored runs is faster than decoding them first"
        if gain.low > 1
        else (
            "Decoding the stored runs first is faster than meshing from them"
            if gain.high < 1
            else "No difference is measured between meshing from the stored runs and decoding them first"
        )
    )
    out = (
        f"{beginning}: decoding and binary greedy meshing, the fastest dense mesher, takes"
        f" {interval_text(gain)} times as long over the {len(scenarios.volumes)} scenarios of the"
        " thesis that have quads"
    )
    if real:
        out += f", and {interval_text(real.gain)} times over {len(real.volumes)} volumes of a real world"
    return out + "."


def _count_sentence(who, found, of):
    parts = []
    if found.slower:
        names = f" ({', '.join(found.slower)})" if len(found.slower) <= 15 else ""
        parts.append(f"{who} is faster than ours in {len(found.slower)} of {len(found.volumes)} {of}{names}")
    if found.undecided:
        names = f" ({', '.join(found.undecided)})" if len(found.undecided) <= 8 else ""
        parts.append(
            f"in {len(found.undecided)}{names} the repetitions overlap"
            if parts
            else (
                f"{who} is never clearly faster; the repetitions overlap in {len(found.undecided)} of"
                f" {len(found.volumes)} {of}{names}"
            )
        )
    return "; ".join(parts) + "." if parts else ""


def _mean_sentence(who, found):
    return (
        f"By the arithmetic mean, in which slow scenarios weigh most, {who} takes"
        f" {quantity_text(found.other_mean_us, 'µs')} and ours {quantity_text(found.our_mean_us, 'µs')}."
        f" The ratio is {interval_text(found.sums)}."
    )


def _against_worlds(by_world):
    """Returns what a sceptic would say about the comparisons of one machine."""
    out = []
    scenarios = by_world.get(SCENARIOS, {})
    rle = scenarios.get("rle_rdm")
    if rle and (rle.slower or rle.sums.low < 1):
        out.append(
            f"{_count_sentence(f'The {RLE_RDM}', rle, 'scenarios')}"
            f" {_mean_sentence(f'the {RLE_RDM}', rle)} The {RLE_RDM} emits"
            f" {number_text(rle.triangles)} times the triangles."
        )
    if decisive := scenarios.get(DECISIVE):
        out.append(
            f"{_count_sentence('Decoding first', decisive, 'scenarios')} {_mean_sentence('decoding first', decisive)}"
        )
    for world, title in ((SCENARIOS, "in the scenarios"), (REAL_WORLD, "in the real world")):
        ready = by_world.get(world, {}).get("mask_binary")
        if ready and ready.gain.low < 1:
            out.append(
                f"A program that has the grid and its mask ready meshes {title} in"
                f" {interval_text(ready.gain)} times the time of ours: there, runs save memory and"
                " bytes, not time."
            )
    slow = [
        f"{w} {interval_text(f[DECISIVE].gain)}"
        for w, f in by_world.items()
        if DECISIVE in f and f[DECISIVE].gain.low < 1 and w != SCENARIOS
    ]
    if slow:
        out.append(
            "In these worlds decoding first is faster, or the interval of its time divided by"
            f" ours contains 1: {'; '.join(slow)}."
        )
    return out


def _against(evidence, comparisons):
    """Returns what a sceptic would say, each in a sentence or two.

    Sentences about other machines name them.
    """
    out = []
    for results in evidence.machines:
        said = _against_worlds({w: found for r, w, found in comparisons if r is results})
        if results.common.quick:
            said.append("This is a quick run: few repetitions, wide errors.")
        name = "" if results is evidence.here else f"{evidence.machine_name(results)}: "
        out += [name + sentence.strip() for sentence in said]
    out.append(_machines_sentence(evidence, comparisons))
    drawn = evidence.here.find("frames")
    if drawn and isinstance(drawn.result, dict) and drawn.result.get("gl", {}).get("software"):
        out.append("The frames were drawn by software, not by a GPU.")
    return [" ".join(o.split()) for o in out if o.strip()]


def _machines_sentence(evidence, comparisons):
    gains = [
        (evidence.machine_name(r), found[DECISIVE].gain)
        for r, world, found in comparisons
        if world == SCENARIOS and DECISIVE in found
    ]
    if len(gains) > 1:
        return (
            "The ratio to decoding over the scenarios moves between machines: "
            + "; ".join(f"{name} {interval_text(gain)}" for name, gain in gains)
            + "."
        )
    return "The ratios are from one kind of machine. Between machines they move; the interval does not contain that."


def best_of(candidates, text):
    """Returns the candidates (name, interval, value) whose intervals overlap that of the least, and
    the others.

    Returns None if no candidate was measured. One with an infinite interval is never among the
    best.
    """
    ranked = sorted((c for c in candidates if c[1].is_measured), key=lambda c: c[1].middle)
    if not ranked:
        return None
    equal = [c for c in ranked if c[1].is_finite and c[1].overlaps(ranked[0][1])]
    rest = [c for c in ranked if c not in equal]
    if not equal:
        return "none completed", ""
    best = " and ".join(f"{name}: {text(value)}" for name, _, value in equal) + (
        " (intervals overlap)" if len(equal) > 1 else ""
    )
    return best, "; ".join(f"{name}: {text(value)}" for name, _, value in rest[:3])


def _answers(evidence):
    totals = MesherTotals(evidence.here.rows("meshers"))
    out = []

    def answer(question, figure, candidates, text):
        found = best_of(candidates, text)
        if found:
            out.append(Answer(question, *found, figure))

    def times(keys):
        return [(mesher(k).name, totals.against_ours(k), totals.mean_ns(k)) for k in keys if k in totals.keys]

    def counts(keys, field):
        return [(mesher(k).name, exactly(totals.sum(k, field)), totals.sum(k, field)) for k in keys if k in totals.keys]

    plain = [k for k, m in MESHERS.items() if k == OURS or not k.startswith("rdm_")]
    if totals.parts:
        answer(
            "Fastest from the stored runs",
            "meshers-time",
            times([k for k in plain if mesher(k).start == "runs" and k != "padded_binary"]),
            time_text,
        )
        answer(
            "Fastest with a grid or mask ready",
            "meshers-time",
            times([k for k in plain if mesher(k).start in ("grid", "mask")]),
            time_text,
        )
        answer(
            "Fastest without merging faces",
            "meshers-time",
            times([k for k in plain if not mesher(k).merges]),
            time_text,
        )
        rectangles = ("rdm", "decode_binary", "grid_rdm", "rle_rdm", "culled", "greedy", "naive_greedy", "run_strips")
        answer(
            "Fewest triangles without a search for the optimum",
            "meshers-triangles",
            counts(rectangles, "triangles"),
            count_text,
        )
        answer(
            "Fewest T-junctions among meshers that merge",
            "t-junctions",
            counts([k for k in plain if mesher(k).merges and not mesher(k).is_variant], "t_junctions"),
            count_text,
        )
    rows = evidence.here.rows("bytes").where(world="luanti", set="all")
    forms = (
        ("packed", "packed runs"),
        ("coded", "coded runs"),
        ("raw", "raw runs"),
        ("dense_zstd", "dense + zstd"),
        ("luanti", "Luanti's form"),
        ("minecraft", "Minecraft's form"),
    )
    answer(
        "Fewest bytes of a real chunk on the wire",
        "bytes",
        [(name, exactly(size), size) for form, name in forms for size in (rows.where(form=form).number("bytes"),)],
        lambda v: quantity_text(v, "B"),
    )
    for profile, title in (
        ("loopback", "Soonest sent and meshed, on loopback"),
        ("broadband", "The same over broadband"),
    ):
        net = evidence.here.rows(f"transfer-{profile}")
        times = {name: transfer_ms(net, profile, form) for form, name, _, _ in WAYS}
        answer(title, "transfers", _transfer_candidates(times), lambda v: quantity_text(v, "ms"))
    return out


def _transfer_candidates(times):
    """Returns each way with its ratio to the first way that completed all worlds, and with its time
    in the real world.

    Ratio and time of a way that never completed a world are infinite. A way that was not measured
    is left out.
    """
    slowest = {name: max(measured(t.values()), default=math.nan) for name, t in times.items()}
    out = [(name, exactly(math.inf), math.inf) for name, ms in slowest.items() if math.isinf(ms)]
    complete = [name for name, ms in slowest.items() if math.isfinite(ms)]
    for name in complete:
        ratio = geometric_mean_interval(map(truediv, times[name].values(), times[complete[0]].values()))
        out.append((name, ratio, times[name]["luanti"]))
    return out


def verdict_of(evidence):
    comparisons = _comparisons(evidence)
    found = {w: f.get(DECISIVE) for r, w, f in comparisons if r is evidence.here}
    rows = [
        [evidence.machine_name(r), w, len(c.volumes), k]
        + [v for one in (c.gain, c.sums) for v in (one.middle, one.low, one.high)]
        for r, w, f in comparisons
        for k, c in f.items()
    ]
    return Verdict(
        _sentence(found.get(SCENARIOS), found.get(REAL_WORLD)),
        _chart(evidence, comparisons) if comparisons else "",
        _against(evidence, comparisons),
        _answers(evidence),
        COLUMNS,
        rows,
        MesherTotals(evidence.here.rows("meshers")).empty_note(),
    )
