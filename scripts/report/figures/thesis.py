"""The thesis' figures, with our numbers beside the thesis'. Its own numbers have hollow marks."""
from ..charts import Axis, Part, Series, dots, lines, points, stacks
from ..comparison import OURS
from ..figure import Figure, Section
from ..meshers import THESIS_MESHERS, mesher
from ..rows import number_of
from ..statistics import Interval, exactly, mean, mean_interval
from ..style import PHASES
from ..steps import SCENARIOS
from ..text import interval_text, number_text, time_text
from ..thesis import MEANS_NOTE, VOXEL_PLUGIN_CHUNKS, VOXEL_PLUGIN_EVENTS

GROUPS = {1: ("general models", range(1, 18)), 2: ("random voxels", range(18, 23)), 3: ("strips", range(23, 38))}
THESIS_GRID_BYTES, GRID_BYTES = 262_144, 65_536  # 32³ voxels of 8 bytes in the thesis, of 2 bytes here
SIDES = (8, 16, 32, 64, 128)
MS = 1e6  # ns
TIMES_NOTE = "Times are over the chunks that have quads; counts of vertices are the thesis' mean over all 27 chunks."


class ThesisFigures:
    def __init__(self, evidence):
        self.evidence, self.thesis = evidence, evidence.thesis
        self._facts = {r["scenario"]: r for r in evidence.here.rows("facts")}
        self._times = {(r["scenario"], r["mesher"]): r for r in evidence.here.rows("thesis")}

    def fact(self, scenario, name):
        return number_of(self._facts.get(scenario, {}).get(name))

    def time(self, scenario, key, name):
        return number_of(self._times.get((scenario, key), {}).get(name))

    def memory(self, group):
        name, scenarios = GROUPS[group]
        theirs = [self.thesis.value(s, "RLE", "model_memory_logged_mean") for s in scenarios]
        ours = [self.fact(s, "run_bytes") for s in scenarios]
        solid = [100 * self.fact(s, "opaque") / self.fact(s, "voxels") for s in scenarios]
        a, b = mean(ours), mean(theirs)
        labels = [f"{s} ({number_text(v)} % solid)" for s, v in zip(scenarios, solid)]
        id_ = f"memory-group-{group}"
        return Figure(
            id_,
            f"Memory of group {group}, {name} (figures 8.4 to 8.9)",
            (
                f"A chunk takes {number_text(a)} bytes of runs on average:"
                f" {number_text(100 * (1 - a / GRID_BYTES))} % less than a flat array of 2 bytes a"
                f" voxel. The thesis' RLE takes {number_text(b)},"
                f" {number_text(100 * (1 - b / THESIS_GRID_BYTES))} % less than its own flat array"
                " of 8 bytes a voxel."
            ),
            ("facts",),
            ["scenario", "thesis: RLE, 12 B a run, as logged", "ours: runs, cheapest axis order", "solid voxels, %"],
            [list(r) for r in zip(scenarios, theirs, ours, solid)],
            [
                dots(
                    id_,
                    "memory of a chunk",
                    labels,
                    [
                        Series("ours: runs, cheapest order", mesher(OURS).light, [exactly(v) for v in ours]),
                        Series("thesis: RLE, as logged", mesher("rle_rdm").light, [exactly(v) for v in theirs], True),
                    ],
                    Axis("bytes of a chunk of 32³", True),
                )
            ],
            notes=["Bytes are counted, so they have no interval.", *self.thesis.notes(scenarios)],
        )

    def vertices(self, group):
        name, scenarios = GROUPS[group]
        theirs = {key: [self.thesis.value(s, t, "vertices_mean") for s in scenarios] for t, key, _ in THESIS_MESHERS}
        rebuilt = {key: [self.time(s, key, "vertices") for s in scenarios] for _, key, _ in THESIS_MESHERS}
        ours = [self.time(s, OURS, "vertices") for s in scenarios]
        same = {
            key: sum(abs(a - b) < 0.01 for a, b in zip(theirs[key], rebuilt[key])) for key in ("grid_rdm", "rle_rdm")
        }
        id_ = f"vertices-group-{group}"
        return Figure(
            id_,
            f"Vertices of group {group}, {name} (figures 8.11 to 8.13)",
            (
                f"Ours needs {number_text(mean(ours))} vertices a chunk on average, the thesis'"
                f" Grid RDM {number_text(mean(theirs['grid_rdm']))}, its RLE RDM"
                f" {number_text(mean(theirs['rle_rdm']))} and Voxel Plugin"
                f" {number_text(mean(theirs['culled']))}. Our rebuilt meshers give the thesis'"
                f" mean: Grid RDM in {same['grid_rdm']} of {len(scenarios)}, RLE RDM in"
                f" {same['rle_rdm']} of {len(scenarios)}."
            ),
            ("thesis",),
            [
                "scenario",
                "ours",
                *(f"thesis: {n}" for _, _, n in THESIS_MESHERS),
                *(f"rebuilt: {k}" for _, k, _ in THESIS_MESHERS),
            ],
            [list(r) for r in zip(scenarios, ours, *theirs.values(), *rebuilt.values())],
            [
                dots(
                    id_,
                    "vertices of a chunk",
                    [str(s) for s in scenarios],
                    [
                        Series(mesher(OURS).short, mesher(OURS).light, [exactly(v) for v in ours]),
                        *(
                            Series(f"thesis: {n}", mesher(k).light, [exactly(v) for v in theirs[k]], True)
                            for _, k, n in THESIS_MESHERS
                        ),
                    ],
                    Axis("vertices of a chunk, mean of 27", True),
                )
            ],
            notes=["Vertices are counted, so they have no interval.", *self.thesis.notes(scenarios)],
        )

    def phases(self, group):
        name, scenarios = GROUPS[group]
        own = ("rdm", "decode_binary", "grid_rdm", "rle_rdm", "culled")
        phases = ("decode", "octree", "mask", "mesh")
        ours = [
            Part(p, c, [mean([self.time(s, k, f"{p}_ns") / 1000 for s in scenarios]) for k in own])
            for p, c in zip(phases, PHASES)
        ]
        metrics = (
            ("octree", "octree_mean"),
            ("meshing", "meshing_mean"),
            ("engine buffers", "buffer_mean"),
            ("other", "other_mean"),
        )
        theirs = [
            Part(p, c, [mean([self.thesis.value(s, t, m) for s in scenarios]) for t, _, _ in THESIS_MESHERS])
            for (p, m), c in zip(metrics, (PHASES[1], PHASES[3], PHASES[2], PHASES[0]))
        ]
        total = {k: mean_interval([self.time(s, k, "mean_ns") / 1000 for s in scenarios]) for k in own}
        id_ = f"phases-group-{group}"
        names = [n for _, _, n in THESIS_MESHERS]
        return Figure(
            id_,
            f"Where the time goes in group {group}, {name} (figures 8.16 to 8.19)",
            (
                f"Ours meshes a chunk in {interval_text(total['rdm'])} µs, with no phase before it"
                " and none after: quads are what the GPU reads. On the same machine the rebuilt"
                f" Grid RDM takes {interval_text(total['grid_rdm'])} µs, RLE RDM"
                f" {interval_text(total['rle_rdm'])}, and decoding first"
                f" {interval_text(total['decode_binary'])}. Compare the thesis' milliseconds by"
                " their shares only: another machine, and an engine around them."
            ),
            ("thesis",),
            ["source", "mesher", "phase", "mean"],
            [["ours, us", k, p.name, v] for p in ours for k, v in zip(own, p.values)]
            + [["thesis, ms", n, p.name, v] for p in theirs for n, v in zip(names, p.values)],
            [
                stacks(
                    id_, "phases, ours", [mesher(k).short for k in own], ours, Axis("mean µs of a chunk, this machine")
                ),
                stacks(
                    f"{id_}-thesis",
                    "phases, thesis",
                    [f"thesis: {n}" for n in names],
                    theirs,
                    Axis("mean ms of a chunk, Unreal Engine, Xeon E3-1240 v5"),
                ),
            ],
            notes=[
                "The brackets hold 95 % bootstrap intervals of the arithmetic mean over the scenarios.",
                TIMES_NOTE,
                *self.thesis.notes(scenarios),
                VOXEL_PLUGIN_EVENTS,
            ],
        )

    def timing(self, group):
        name, scenarios = GROUPS[group]
        ours = [Interval(*(self.time(s, OURS, c) / 1000 for c in ("min_ns", "median_ns", "max_ns"))) for s in scenarios]
        rebuilt = [
            Interval(*(self.time(s, "rle_rdm", c) / 1000 for c in ("min_ns", "median_ns", "max_ns"))) for s in scenarios
        ]
        theirs = [
            Interval(*(1000 * self.thesis.value(s, "RLE", f"total_{c}") for c in ("min", "median", "max")))
            for s in scenarios
        ]
        id_ = f"timing-group-{group}"
        return Figure(
            id_,
            f"Meshing from runs in group {group}, {name}: least, median, greatest (figures 8.20 and 8.21)",
            (
                f"Over the group a chunk takes ours {number_text(mean([v.middle for v in ours]))}"
                f" µs, the rebuilt RLE RDM {number_text(mean([v.middle for v in rebuilt]))} µs on"
                " the same machine, and the thesis' RLE RDM"
                f" {number_text(mean([v.middle for v in theirs]))} µs on its own, with Unreal's"
                " buffers (means of the medians)."
            ),
            ("thesis",),
            ["scenario", "mesher", "least us", "median us", "greatest us"],
            [
                [s, who, v.low, v.middle, v.high]
                for who, values in (("ours", ours), ("rebuilt RLE RDM", rebuilt), ("thesis: RLE RDM", theirs))
                for s, v in zip(scenarios, values)
            ],
            [
                dots(
                    id_,
                    "time of a chunk",
                    [str(s) for s in scenarios],
                    [
                        Series(mesher(OURS).short, mesher(OURS).light, ours),
                        Series("rebuilt RLE RDM", mesher("rle_rdm").light, rebuilt),
                        Series("thesis: RLE RDM", mesher("rle_rdm").light, theirs, True),
                    ],
                    Axis("µs of a chunk: least, median and greatest", True),
                )
            ],
            notes=[TIMES_NOTE, *self.thesis.notes(scenarios)],
        )

    def chunk_sizes(self, scenario):
        is_noise = scenario == 5
        step = "chunk-sizes-terrain" if is_noise else "chunk-sizes"
        rows = self.evidence.here.rows(step)
        rows = rows if is_noise else rows.where(part=str(scenario))
        series, table = [], []

        def add(name, colour, value, hollow=False):
            values = [(side, value(side)) for side in SIDES]
            series.append(Series(name, colour, values, hollow))
            table.extend([name, side, v.middle, v.low, v.high] for side, v in values)

        def measured(key):
            def at(side):
                row = rows.where(mesher=key, edge=side)
                return Interval(*(row.number(f) / MS for f in ("min_ns", "median_ns", "p90_ns")))

            return at

        for key in ("rdm", "decode_binary", "grid_rdm", "rle_rdm"):
            add(mesher(key).short, mesher(key).light, measured(key))
        for their, key, name in THESIS_MESHERS:
            add(
                f"thesis: {name}",
                mesher(key).light,
                lambda side, their=their: exactly(self.thesis.chunk_size_ms(scenario, side, their)),
                True,
            )
        at = measured(OURS)
        notes = [
            "The bands reach from the fastest repetition to the 90th percentile.",
            "Voxel Plugin always uses chunks of 32³ to draw: its line is no test of the side.",
        ]
        if is_noise:
            notes.append(
                "Scenario 5 is data of side 32 whose generator is not public. Ours is one chunk"
                " of our own noise terrain."
            )
        else:
            notes.append("Ours: the chunk in the middle; the thesis: the mean of 27.")
        if scenario == 1:
            notes.append("Ours draws nothing of the chunk in the middle of 27 full ones and knows that from one run.")
        if scenario == 17:
            notes.append("At 128 the thesis has 5 (Grid) and 12 (RLE) of 27 chunks.")
        id_ = f"chunk-size-{scenario}"
        theirs = [time_text(MS * self.thesis.chunk_size_ms(scenario, 128, m)) for m in ("Grid", "RLE")]
        return Figure(
            id_,
            f"Side of the chunk, scenario {scenario} (figures 8.23 to 8.25)",
            (
                f"A chunk of 128³ takes ours {time_text(MS * at(128).middle)}. The thesis called"
                f" that side unsuitable for real time ({theirs[0]} with Grid RDM, {theirs[1]} with"
                " RLE RDM). From 32 to 128 the voxels grow 64 times and our time"
                f" {number_text(at(128).middle / at(32).middle)} times."
            ),
            (step,),
            ["mesher", "side", "ms", "low", "high"],
            table,
            [
                lines(
                    id_,
                    "time by side of the chunk",
                    series,
                    Axis("side of the chunk, voxels", True),
                    Axis("ms of a chunk", True),
                )
            ],
            notes=notes,
        )

    def efficiency(self):
        series, table = [], []

        def add(name, colour, ms, vertices, hollow=False):
            across, up = mean_interval(ms), mean_interval(vertices)
            series.append(Series(name, colour, [(across, up)], hollow))
            table.append([name, across.middle, across.low, across.high, up.middle, up.low, up.high])
            return across, up

        us = {}
        for key in ("rdm", "decode_binary", "grid_rdm", "rle_rdm", "culled"):
            name = mesher(key).short if key in ("rdm", "decode_binary") else f"rebuilt {mesher(key).short}"
            us[key] = add(
                name,
                mesher(key).light,
                [self.time(s, key, "mean_ns") / MS for s in SCENARIOS],
                [self.time(s, key, "vertices") for s in SCENARIOS],
            )
        for their, key, name in THESIS_MESHERS:
            total = "total_mean_nonempty_chunks" if their == "VoxelPlugin" else "total_mean"
            add(
                f"thesis: {name}",
                mesher(key).light,
                [self.thesis.value(s, their, total) for s in SCENARIOS],
                [self.thesis.value(s, their, "vertices_mean") for s in SCENARIOS],
                True,
            )

        def both(key):
            return f"{interval_text(us[key][0].scaled(1000))} µs and {number_text(us[key][1].middle)} vertices"

        return Figure(
            "efficiency",
            "Efficiency: time against vertices (figure 8.26)",
            (
                "The good corner is the lower left. Arithmetic means over the 37 scenarios: ours"
                f" {both('rdm')}; decode + binary greedy {both('decode_binary')}; the rebuilt RLE"
                f" RDM of the thesis {both('rle_rdm')}."
            ),
            ("thesis",),
            ["mesher", "mean ms", "low", "high", "mean vertices", "low", "high"],
            table,
            [
                points(
                    "efficiency",
                    "time against vertices",
                    series,
                    Axis("mean ms of a chunk", True),
                    Axis("mean vertices of a chunk", True),
                )
            ],
            notes=[
                "The lines are 95 % bootstrap intervals over the scenarios.",
                TIMES_NOTE,
                MEANS_NOTE,
                VOXEL_PLUGIN_CHUNKS,
                "The thesis' points were measured on a Xeon E3-1240 v5 inside Unreal Engine 5.4.",
            ],
        )


def thesis_section(evidence):
    figures = ThesisFigures(evidence)
    return Section(
        "thesis",
        "The thesis' figures, again",
        (
            "The 37 scenarios of the thesis with all of their 27 chunks of 32³. The thesis' own "
            "figures have hollow marks, in the colour of the same mesher rebuilt here."
        ),
        [
            figures.efficiency(),
            *(figures.memory(g) for g in GROUPS),
            *(figures.vertices(g) for g in GROUPS),
            *(figures.phases(g) for g in GROUPS),
            *(figures.timing(g) for g in (2, 3)),
            *(figures.chunk_sizes(s) for s in (1, 5, 17)),
        ],
    )
