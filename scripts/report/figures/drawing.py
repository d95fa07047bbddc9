"""What the meshes cost to draw, and what other ways to store the same voxels cost."""
import math

from ..charts import Axis, Bar, Series, bars, dots
from ..figure import Figure, HeatTable, Section, shade_of
from ..meshers import THESIS_MESHERS, mesher
from ..rows import Rows
from ..statistics import exactly, geometric_mean, geometric_mean_interval, mean, mean_interval, place_text, places
from ..text import interval_text, number_text

COLUMNS = (
    "vertices",
    "triangles",
    "upload_bytes",
    "p50_ms",
    "p90_ms",
    "p99_ms",
    "fps",
    "t_junctions",
    "thin_16",
    "thin_100",
    "overdraw",
    "depth_complexity",
    "lanes",
    "seam_pixels",
    "pinhole_pixels",
)
FPS_SCENARIOS = (13, 17, 23, 33)
FRAMES_SHARE = 0.75  # a mesher that drew fewer of the worlds than this is in no mean


class Frames:
    """Plain frames of the worlds that all of these meshers drew."""

    def __init__(self, rows: Rows, setting):
        self.rows, self.setting = rows.where(path="plain"), setting if isinstance(setting, dict) else {}
        counts = {m: len(self.rows.where(mesher=m)) for m in self.rows.kinds("mesher") if m != "none"}
        most = max(counts.values(), default=0)
        self.meshers = [m for m, n in counts.items() if n >= FRAMES_SHARE * most]
        self.left_out = [m for m in counts if m not in self.meshers]
        self.worlds = [
            w
            for w in self.rows.kinds("world")
            if all(self.rows.where(world=w, mesher=m).number("vertices") > 0 for m in self.meshers)
        ]

    def of(self, key, column):
        return [self.rows.where(world=w, mesher=key).number(column) for w in self.worlds]

    def notes(self):
        gl = self.setting.get("gl", {})
        out = [
            f"Drawn by {gl.get('renderer', 'an unknown renderer')}, {self.setting.get('width')} by"
            f" {self.setting.get('height')} pixels, {self.setting.get('frames')} frames of each"
            " mesher in each world."
        ]
        if gl.get("software"):
            out.append("The processor draws here, so a frame is bound by vertices far more than on a GPU.")
        if self.left_out:
            out.append(
                "Too large to be drawn in most worlds, so in no mean:"
                f" {', '.join(mesher(m).name for m in self.left_out)}."
            )
        return out

    def table(self):
        return ["world", "mesher", "path", *COLUMNS], [
            [r["world"], r["mesher"], r["path"], *(r.get(c) for c in COLUMNS)] for r in self.rows
        ]


def _ranked(id_, title, frames, label, interval_of, mark=None):
    keys = sorted(frames.meshers, key=lambda m: interval_of(m).middle)
    values = [interval_of(m) for m in keys]
    return bars(
        id_,
        title,
        [Bar(mesher(m).name, mesher(m).light, v, number_text(v.middle)) for m, v in zip(keys, values)],
        Axis(label, False, mark),
    )


def _frame_times(frames):
    def ratio(key):
        return geometric_mean_interval([a / b for a, b in zip(frames.of(key, "p50_ms"), frames.of("rdm", "p50_ms"))])

    def ms(key):
        return number_text(geometric_mean(frames.of(key, "p50_ms")))

    keys = sorted(frames.meshers, key=lambda m: ratio(m).middle)
    ratios = [ratio(m) for m in keys]
    all_bars = [
        Bar(mesher(m).name, mesher(m).light, r, f"{ms(m)} ms, place {place_text(p)}")
        for m, r, p in zip(keys, ratios, places(ratios))
    ]
    columns, table = frames.table()
    return Figure(
        "frames",
        "Frame time by mesher (8.5)",
        (
            "The same chunks, shader and vertex format: only the polygons differ. A frame takes"
            f" {ms('rdm')} ms with our mesh (geometric mean of {len(frames.worlds)} worlds),"
            f" {ms('culled')} with culled faces, {ms('rle_rdm')} with the thesis' RLE RDM."
        ),
        ("frames",),
        columns,
        table,
        [
            bars(
                "frames",
                "frame time by mesher",
                all_bars,
                Axis("median frame, times ours, geometric mean over worlds", True, 1),
            )
        ],
        notes=[
            (
                "The lines are 95 % bootstrap intervals over the worlds. Meshers whose intervals"
                " overlap share places."
            ),
            *frames.notes(),
        ],
    )


def _thesis_frames(evidence, frames):
    def fps(scenario, key):
        return frames.rows.where(world=f"scenario_{scenario}", mesher=key).number("fps")

    rows = [str(s) for s in FPS_SCENARIOS]
    ours = [
        Series(
            mesher(k).short if k == "rdm" else f"rebuilt {mesher(k).short}",
            mesher(k).light,
            [exactly(fps(s, k)) for s in FPS_SCENARIOS],
        )
        for k in ("rdm", *(key for _, key, _ in THESIS_MESHERS))
    ]
    theirs = [
        Series(
            f"thesis: {n}",
            mesher(k).light,
            [exactly(evidence.thesis.value(s, t, "fps_mean")) for s in FPS_SCENARIOS],
            True,
        )
        for t, k, n in THESIS_MESHERS
    ]
    return Figure(
        "fps",
        "Frames a second in the thesis' four scenarios (figure 8.14)",
        (
            f"In scenario 23 our mesh gives {number_text(fps(23, 'rdm'))} frames a second here,"
            f" the rebuilt Grid RDM {number_text(fps(23, 'grid_rdm'))} and culled faces"
            f" {number_text(fps(23, 'culled'))}. The thesis has"
            f" {number_text(evidence.thesis.value(23, 'Grid', 'fps_mean'))} with Grid RDM and"
            f" {number_text(evidence.thesis.value(23, 'RLE', 'fps_mean'))} with its RLE RDM."
        ),
        ("frames",),
        ["scenario", *(s.name for s in ours), *(s.name for s in theirs)],
        [[s, *(v.values[i].middle for v in (*ours, *theirs))] for i, s in enumerate(FPS_SCENARIOS)],
        [
            dots("fps", "frames a second, ours", rows, ours, Axis("frames a second, here", True)),
            dots(
                "fps-thesis",
                "frames a second, thesis",
                rows,
                theirs,
                Axis("frames a second, RTX 3050 in Unreal Engine"),
            ),
        ],
        notes=[
            *frames.notes(),
            (
                "The thesis' empty scene ran at 77 frames a second. Voxel Plugin drew lower"
                " levels of detail farther away."
            ),
        ],
    )


def _seams(frames):
    def pixels(key):
        return mean_interval(frames.of(key, "pinhole_pixels"))

    def lanes(key):
        return mean_interval(frames.of(key, "lanes"))

    columns, table = frames.table()
    return Figure(
        "seams",
        "T-junctions and thin triangles on screen (4.2.1, 4.2.2)",
        (
            "Pixels inside a plane that differ from the picture of culled faces:"
            f" {interval_text(pixels('rdm'))} a picture with our mesh,"
            f" {interval_text(pixels('poly2tri'))} with Poly2Tri. A GPU shades in blocks of 2 x 2,"
            " so it shades more lanes than fragments along every edge:"
            f" {number_text(lanes('rdm').middle)} lanes a fragment with our mesh,"
            f" {number_text(lanes('culled').middle)} with culled faces."
        ),
        ("frames",),
        columns,
        table,
        [
            _ranked("seams", "pinholes", frames, "pinholes a picture, pixels, mean over worlds", pixels),
            _ranked("seams-lanes", "lanes", frames, "shaded lanes a fragment, mean over worlds: 1 is ideal", lanes, 1),
        ],
        notes=["The lines are 95 % bootstrap intervals over the worlds.", *frames.notes()],
    )


def _storage(evidence):
    rows = evidence.here.rows("storage")
    columns = (
        ("bytes", "bytes"),
        ("read_ns", "random read"),
        ("walk_ns", "walk"),
        ("edit_ns", "one edit"),
        ("brush_ns", "brush"),
        ("build_ns", "build"),
    )
    stores = rows.kinds("store")
    means = {(s, c): geometric_mean(rows.where(store=s).numbers(c)) for s in stores for c, _ in columns}
    least = {c: min((means[s, c] for s in stores if math.isfinite(means[s, c])), default=math.nan) for c, _ in columns}
    most = {c: max((means[s, c] for s in stores if math.isfinite(means[s, c])), default=math.nan) for c, _ in columns}
    best = "; ".join(
        f"{name}: {next((s for s in stores if means[s, c] == least[c]), 'not measured')}" for c, name in columns
    )
    return Figure(
        "storage",
        "Ways to store voxels (3.3, 3.4, 3.7)",
        f"The least of each column, geometric means over scenarios and worlds: {best}.",
        ("storage",),
        ["store", *(c for c, _ in columns)],
        [[s, *(means[s, c] for c, _ in columns)] for s in stores],
        table=HeatTable(
            "times the least",
            [n for _, n in columns],
            [
                (
                    s,
                    [
                        (number_text(means[s, c] / least[c]), shade_of(means[s, c], least[c], most[c]))
                        for c, _ in columns
                    ],
                )
                for s in stores
            ],
        ),
        notes=[
            "Runs are ours, in their cheapest order. A brush is a sphere of radius 5; times are of a whole edit.",
            (
                f"Means of {number_text(mean([len(rows.where(store=s)) for s in stores]))}"
                " volumes. A volume without quads is stored like any other."
            ),
        ],
    )


def drawing_section(evidence):
    found = evidence.here.find("frames")
    frames = Frames(evidence.here.rows("frames"), found.result if found else {})
    return Section(
        "drawing",
        "Drawing and storing",
        "What the meshes cost to draw, and what other ways to keep the same voxels cost.",
        [_frame_times(frames), _thesis_frames(evidence, frames), _seams(frames), _storage(evidence)],
    )
