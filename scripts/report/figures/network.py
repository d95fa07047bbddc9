"""The same voxels under networked conditions: bytes, transfers, latency, crowds, a gateway, a siege."""
import math
from operator import truediv

import numpy

from ..charts import Axis, Bar, Series, Span, bars, dots, lines
from ..figure import Figure, Section
from ..meshers import mesher
from ..rows import number_of
from ..statistics import UNKNOWN, Interval, exactly, geometric_mean_interval
from ..steps import FLEET_SIZES, PROFILES
from ..style import INK, OTHER, QUIET
from ..text import after_text, count_text, interval_text, list_text, number_text, quantity_text

OURS, BINARY = mesher("rdm").light, mesher("decode_binary").light
FORMS = (
    ("coded", "ours: coded (slow links)", OURS),
    ("packed", "ours: packed", OURS),
    ("raw", "ours: raw runs", OURS),
    ("minecraft", "Minecraft's form + zlib", OTHER),
    ("dense_zstd", "dense + zstd", BINARY),
    ("luanti", "Luanti's form + zstd", OTHER),
    ("luanti_light", "the same with its light", OTHER),
)
WAYS = (
    ("packed", "packed runs + RDM", OURS, False),
    ("raw", "raw runs + RDM", OURS, True),
    ("dense_zstd", "dense + zstd + binary greedy", BINARY, False),
    ("dense", "dense + binary greedy", BINARY, True),
)
WORLDS = ("luanti", "terrain", "caves", "town", "noise")
NET_COLUMNS = ["link", "case", "figure", "value"]


def _net_table(rows):
    return [[r["profile"], r["case"], r["figure"], r["value"]] for r in rows]


def _bytes(evidence):
    every = evidence.here.rows("bytes")
    rows = every.where(world="luanti", set="all")
    size = {form: rows.where(form=form).number("bytes") for form, _, _ in FORMS}

    shares = [
        f"{number_text(100 * size['packed'] / size[form])} % of {name}"
        for form, name in (
            ("dense_zstd", "dense voxels under zstd"),
            ("luanti", "Luanti's form"),
            ("minecraft", "Minecraft's"),
        )
        if math.isfinite(size["packed"] / size[form])
    ]

    all_bars = [
        Bar(
            name,
            colour,
            exactly(size[form]),
            (
                f"{number_text(size[form])} B; write"
                f" {number_text(rows.where(form=form).number('encode_us'))}, read"
                f" {number_text(rows.where(form=form).number('decode_us'))} µs"
            ),
        )
        for form, name, colour in FORMS
    ]
    return Figure(
        "bytes",
        "A chunk on the wire",
        (
            f"Packed runs take {list_text(shares) if shares else 'an unknown share of the other forms'}."
            " Dense and plain they would be 65,536 bytes."
        ),
        ("bytes",),
        ["world", "chunks", "form", "bytes", "encode us", "decode us"],
        [[r["world"], r["set"], r["form"], r["bytes"], r["encode_us"], r["decode_us"]] for r in every],
        [bars("bytes", "bytes of a chunk", all_bars, Axis("bytes of a chunk of 32³, mean over a real world"))],
        notes=["Bytes are counted, so they have no interval."],
    )


def transfer_ms(rows, profile, form):
    """Returns for each world the time until all its chunks are meshed: infinite if that never
    happened.
    """
    return {w: rows.where(profile=profile, case=f"{w} {form}", figure="complete_ms").number("value") for w in WORLDS}


def _never_completed(times):
    """Returns a sentence for each link that has worlds whose transfer never completed."""
    out = []
    for profile, by_form in times.items():
        found = [f"{w} as {name}" for form, name, _, _ in WAYS for w, ms in by_form[form].items() if math.isinf(ms)]
        if found:
            out.append(f"Over {profile} these worlds never completed: {', '.join(found)}.")
    return out


def _not_measured(rows, times):
    """Returns a sentence for each measured link of which worlds have no result."""
    out = []
    for profile in rows.kinds("profile"):
        found = [w for w in WORLDS if any(math.isnan(times[profile][form][w]) for form in ("packed", "dense_zstd"))]
        if found:
            out.append(f"Over {profile} no ratio was measured of {list_text(found)}.")
    return out


def _transfers(evidence):
    steps = tuple(f"transfer-{p}" for p in PROFILES)
    rows = evidence.here.all_rows(steps)
    times = {p: {form: transfer_ms(rows, p, form) for form, _, _, _ in WAYS} for p in PROFILES}

    def gain(profile):
        """Returns how many times as long dense voxels take; unknown if a world never completed."""
        dense, packed = (times[profile][form].values() for form in ("dense_zstd", "packed"))
        return UNKNOWN if math.inf in (*dense, *packed) else geometric_mean_interval(map(truediv, dense, packed))

    gains = {p: gain(p) for p in PROFILES}
    ratios = "; ".join(f"{p} {interval_text(g)}" for p, g in gains.items() if g.is_measured)
    without = [p for p in PROFILES if math.inf in (*times[p]["dense_zstd"].values(), *times[p]["packed"].values())]
    never = _never_completed(times)
    if without:
        never.append(f"So there is no ratio for {list_text(without)}.")
    never += _not_measured(rows, times)
    return Figure(
        "transfers",
        "Send, unpack, mesh: under each link (9.2)",
        (
            "Until everything is meshed, dense voxels under zstd take this many times as long as"
            f" packed runs (geometric mean over worlds): {ratios or 'not measured'}. On slow links"
            f" bytes decide, on fast ones the meshing. {' '.join(never)}"
        ).strip(),
        steps,
        NET_COLUMNS,
        _net_table(rows),
        [
            dots(
                "transfers",
                "transfer and mesh",
                list(PROFILES),
                [
                    Series(name, colour, [exactly(times[p][form]["luanti"]) for p in PROFILES], hollow)
                    for form, name, colour, hollow in WAYS
                ],
                Axis("ms until all 64 chunks are meshed, real world", True),
            ),
            dots(
                "transfers-ratio",
                "ratio of transfers",
                list(PROFILES),
                [Series("dense + zstd + binary greedy", BINARY, [gains[p] for p in PROFILES])],
                Axis("times as long as packed runs + RDM", False, 1),
            ),
        ],
        notes=[
            "Lines and brackets show 95 % bootstrap intervals over the worlds. Each time is the"
            " median of few repetitions."
        ],
    )


def _latency(evidence):
    steps = tuple(f"latency-{p}" for p in PROFILES)
    rows = evidence.here.all_rows(steps)

    def value(profile, case, figure):
        return rows.where(profile=profile, case=case, figure=figure).number("value")

    def spread(profile, case, figure):
        p50 = value(profile, case, f"{figure}_p50_ms")
        return Interval(p50, p50, value(profile, case, f"{figure}_p99_ms"))

    kinds = (
        ("local edit", "idle", "local_predicted_meshed", OTHER, False),
        ("remote edit", "idle", "remote_meshed", INK, False),
        ("remote edit beside terrain, 20 clients", "streaming 20 clients", "remote_meshed", QUIET, True),
    )

    def after_p50(profile, figure):
        return after_text(value(profile, "idle", f"{figure}_p50_ms"))

    return Figure(
        "latency",
        "Latency plus mesh, by link",
        (
            "The local edit is predicted, so its mesh does not wait for the network. On loopback"
            f" it is meshed {after_p50('loopback', 'local_predicted_meshed')}, on broadband"
            f" {after_p50('broadband', 'local_predicted_meshed')} (p50). A remote edit waits for"
            f" the network: on loopback it is meshed {after_p50('loopback', 'remote_meshed')}, on"
            f" broadband {after_p50('broadband', 'remote_meshed')}."
        ),
        steps,
        NET_COLUMNS,
        _net_table(rows),
        [
            dots(
                "latency",
                "latency",
                list(PROFILES),
                [
                    Series(name, colour, [spread(p, case, figure) for p in PROFILES], hollow)
                    for name, case, figure, colour, hollow in kinds
                ],
                Axis("ms from the click to the mesh", True),
            )
        ],
        notes=[
            "The lines reach from the median (p50) to the 99th percentile; the maximum is in the CSV.",
            "An arrow marks a percentile that never arrived.",
        ],
    )


def _crowds(evidence):
    steps = tuple(f"crowd-{n}" for n in FLEET_SIZES)
    rows = evidence.here.all_rows(steps)

    def value(clients, figure):
        return rows.where(case=f"{clients} clients", figure=figure).number("value")

    most = max((n for n in FLEET_SIZES if not math.isnan(value(n, "seen_p99_ms"))), default=1)
    counts = (("samples", "samples"), ("never", "never arrived"), ("disconnects", "disconnects"))
    counted = [f"{count_text(n)} {name}" for figure, name in counts if not math.isnan(n := value(most, figure))]
    p50, p99 = value(most, "seen_p50_ms"), value(most, "seen_p99_ms")
    if math.isinf(p50):
        arrival = "At least half of their edits never arrived at the others"
    elif math.isinf(p99):
        arrival = f"They see each other's edits {after_text(p50)} (p50), but at least 1 % of the edits never arrived"
    else:
        arrival = f"They see each other's edits {after_text(p50)} (p50) and {after_text(p99)} (p99)"
    cores = evidence.here.common.machine.cores if evidence.here.common else 0
    series = [
        Series(name, colour, [(n, exactly(value(n, figure))) for n in FLEET_SIZES if n > 1], False, marker)
        for name, colour, figure, marker in (
            ("p50", OTHER, "seen_p50_ms", "o"),
            ("p99", INK, "seen_p99_ms", "s"),
            ("max", QUIET, "seen_max_ms", "^"),
        )
    ]
    return Figure(
        "crowds",
        "Crowds: 1 to 1,000 clients",
        (
            f"{count_text(most)} clients in one place use one server, on the same {cores} cores."
            f" {arrival}{': ' if counted else ''}{', '.join(counted)}."
            if most > 1
            else "No crowd of two or more clients was measured."
        ),
        steps,
        NET_COLUMNS,
        _net_table(rows),
        [
            lines(
                "crowds",
                "crowds",
                series,
                Axis("clients in one place, two edits a second each", True),
                Axis("ms until the others have an edit", True),
            )
        ],
        notes=["A single client has nobody to see its edits; its figures are in the CSV."],
    )


def _gateway(evidence):
    rows = evidence.here.rows("gateway")
    ways = (("TCP", "tcp", OTHER), ("gateway", "gateway", INK))

    def round_trip(case, way):
        p50, p99 = (rows.where(case=case, figure=f"{way}_{p}_ms").number("value") for p in ("p50", "p99"))
        return Interval(p50, p50, p99)

    def fleet(bots, name):
        """Returns the medians of all runs."""
        case = f"{bots} bots by {name}"
        runs = (rows.where(case=case, figure=f"seen_{p}_ms").numbers("value") for p in ("p50", "p99"))
        p50, p99 = (float(numpy.median(values)) if values else math.nan for values in runs)
        return Interval(p50, p50, p99)

    frames = ("ping and pong", "edit and commit")
    fleets = [case.split(" ")[0] for case in rows.kinds("case") if case.endswith(" bots by TCP")]
    series = [
        Series(name, colour, [round_trip(f, way) for f in frames] + [fleet(n, name) for n in fleets])
        for name, way, colour in ways
    ]
    added = max(
        (after.high - before.high for before, after in zip(*(s.values[: len(frames)] for s in series))),
        default=math.nan,
    )
    ratios = [truediv(*(fleet(n, name).high for name in ("gateway", "TCP"))) for n in fleets]
    findings = []
    if math.isfinite(added):
        findings.append(f"A gateway for browsers adds {quantity_text(added, 'ms')} (p99) to a round trip.")
    findings += [
        f"{count_text(int(n))} bots that build through it see edits after {number_text(ratio)} times as long (p99)."
        for n, ratio in zip(fleets, ratios)
        if math.isfinite(ratio)
    ]
    return Figure(
        "gateway",
        "A gateway for browsers",
        " ".join(findings) or "No gateway was measured.",
        ("gateway",),
        NET_COLUMNS,
        _net_table(rows),
        [
            dots(
                "gateway",
                "latency through a gateway",
                [*frames, *(f"{n} bots that build" for n in fleets)],
                series,
                Axis("ms until the answer, or until the others have an edit", True),
            )
        ],
        notes=["The lines reach from the median (p50) to the 99th percentile. Fleets are medians of their runs."],
    )


def siege_charts(rows):
    """Returns the charts of a siege by name: latency, memory and disk over its windows."""
    windows = [case for case in rows.where(experiment="siege").kinds("case") if case.startswith("window ")]

    def value(case, figure):
        return rows.where(experiment="siege", case=case, figure=figure).number("value")

    middle = {w: (value(w, "from_s") + value(w, "to_s")) / 2 for w in windows}
    spans = [
        Span(value(w, "from_s"), value(w, "to_s"), w.split(" ", 2)[2]) for w in windows if not w.endswith(" quiet")
    ]

    def line(name, colour, figure):
        return Series(name, colour, [(middle[w], exactly(value(w, figure))) for w in windows])

    x = Axis("time since the server started, s")
    return {
        "siege-p99": lines(
            "siege-p99",
            "latency of edits in a siege",
            [line("p99", INK, "p99_ms"), line("p50", OTHER, "p50_ms")],
            x,
            Axis("latency, ms", True),
            spans,
        ),
        "siege-memory": lines(
            "siege-memory",
            "memory of the server in a siege",
            [line("server", INK, "server_resident_mb")],
            x,
            Axis("resident memory, MB"),
            spans,
        ),
        "siege-disk": lines(
            "siege-disk",
            "disk writes of the server in a siege",
            [line("server", INK, "disk_kb_s")],
            x,
            Axis("written, KB/s"),
            spans,
        ),
    }


def _siege(evidence):
    rows = evidence.here.rows("siege")
    values = [(number_of(r["value"]), r["case"]) for r in rows.where(figure="p99_ms")]
    ms, case = max((v for v in values if not math.isnan(v[0])), default=(math.nan, ""))
    if math.isnan(ms):
        at_worst = "No latency was measured."
    elif math.isinf(ms):
        at_worst = f"Under the worst one ({case}), edits of builders never arrive."
    else:
        at_worst = f"The worst p99 of the builders is {quantity_text(ms, 'ms')} ({case})."
    return Figure(
        "siege",
        "A siege: builders under attack",
        f"All attacks take turns against one server. {at_worst}",
        ("siege",),
        NET_COLUMNS,
        _net_table(rows),
        list(siege_charts(rows).values()),
        notes=["Windows under attack are shaded and have the name of their attack."],
    )


def network_section(evidence):
    figures = [_bytes(evidence), _transfers(evidence), _latency(evidence), _crowds(evidence)]
    if evidence.here.has_any(("gateway",)):
        figures.append(_gateway(evidence))
    if evidence.here.has_any(("siege",)):
        figures.append(_siege(evidence))
    return Section(
        "network",
        "Under networked conditions",
        (
            "Real programs, simulated links: delay, jitter, rate and loss. Nothing here was asked"
            " of the thesis' prototype."
        ),
        figures,
    )
