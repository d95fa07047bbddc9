"""Steps: the measurements of the report. Each step is one call of runstone-bench with --json."""
from dataclasses import dataclass, field

MESH_FIELDS = (
    "world",
    "part",
    "edge",
    "order",
    "rank",
    "mesher",
    "runs",
    "median_ns",
    "min_ns",
    "p90_ns",
    "quads",
    "vertices",
    "triangles",
    "t_junctions",
    "storage_bytes",
)
NET_FIELDS = ("profile", "case", "figure", "value")
PROFILES = ("loopback", "lan", "broadband", "mobile", "lossy")
FLEET_SIZES = (1, 10, 100, 300, 1000)
SCENARIOS = range(1, 38)
PICTURE_PIXELS = 128


@dataclass(frozen=True)
class Step:
    name: str
    arguments: tuple  # of runstone-bench, without --json and --luanti
    seconds: float  # expected duration
    fields: tuple  # that each row of the result must have
    rows: str = "rows"  # name of the array of rows; empty: the result is the array
    is_default: bool = True  # False: runs only if --steps names it

    @property
    def uses_luanti(self):
        return self.arguments[0] in ("net", "frames", "storage") or "luanti" in " ".join(self.arguments)

    @property
    def command(self):
        """Returns the command line for readers."""
        luanti = " --luanti DIR" if self.uses_luanti else ""
        return f"runstone-bench {' '.join(self.arguments)}{luanti} --json FILE"


@dataclass(frozen=True)
class PictureStep(Step):
    """Draws the scenarios with the client's renderer: a call of `view` for each picture."""

    scenarios: tuple = field(default=tuple(SCENARIOS))

    def picture_arguments(self, scenario):
        return (*self.arguments, "--world", f"scenario_{scenario}")


def _mesh(name, seconds, repetitions, worlds, *more, edges="32", orders="best"):
    arguments = (
        "mesh",
        "--worlds",
        worlds,
        "--edges",
        edges,
        "--orders",
        orders,
        *more,
        "--min-runs",
        str(repetitions),
    )
    return Step(name, arguments, seconds, MESH_FIELDS)


def _net(name, seconds, *arguments, is_default=True):
    return Step(name, ("net", "--experiments", *arguments), seconds, NET_FIELDS, "figures", is_default)


def _scenario_steps(quick):
    size = f"{PICTURE_PIXELS}x{PICTURE_PIXELS}"
    yield PictureStep(
        "pictures",
        (
            "view",
            "--mesher",
            "rdm",
            "--no-edges",
            "--no-captions",
            "--size",
            size,
            "--repetitions",
            "1",
            "--frames",
            "1",
        ),
        40,
        ("scenario", "png"),
    )
    yield Step("facts", ("scenario-facts",), 2, ("scenario", "group", "voxels", "opaque", "run_bytes", "thesis_bytes"))
    yield Step(
        "thesis",
        ("scenario-times", "--min-runs", "1" if quick else "9"),
        15 if quick else 100,
        ("scenario", "group", "mesher", "chunks", "mean_ns", "median_ns", "min_ns", "max_ns", "vertices"),
    )


def _mesh_steps(quick):
    n = 3 if quick else 15
    scaled = ("--meshers", "rdm,decode_binary,grid_rdm,rle_rdm,culled")
    sides = "8,16,32,64,128"
    yield _mesh("meshers", 10 if quick else 60, n, "scenarios")
    yield _mesh("landscapes", 20 if quick else 120, n, "hills,terrain,overhangs,caves,town,luanti")
    yield _mesh("adversaries", 5 if quick else 30, n, "noise,noise_mixed,sparse,checkerboard")
    yield _mesh(
        "orders",
        10 if quick else 90,
        n,
        "scenarios,hills,terrain,overhangs,caves,town",
        "--meshers",
        "rdm,decode_binary",
        orders="all",
    )
    yield _mesh("chunk-sizes", 5 if quick else 30, n, "scenarios", "--parts", "1,17", *scaled, edges=sides)
    yield _mesh("chunk-sizes-terrain", 5 if quick else 30, n, "terrain", *scaled, edges=sides)


def _drawing_steps(quick):
    worlds = ",".join(f"scenario_{s}" for s in (5, 8, 13, 14, 20, 23, 33)) + ",luanti"
    small = ("--size", "640x360", "--worlds", worlds)
    arguments = (
        ("--frames", "6", "--pictures", "1", "--vertices-max", "3000000", *small)
        if quick
        else ("--frames", "15", "--pictures", "2", "--vertices-max", "12000000")
    )
    yield Step(
        "frames", ("frames", *arguments), 45 if quick else 700, ("world", "mesher", "path", "vertices", "p50_ms", "fps")
    )
    yield Step(
        "storage",
        ("storage", "--edges", "32", "--min-runs", "3" if quick else "9"),
        20 if quick else 120,
        ("world", "part", "store", "bytes", "read_ns", "walk_ns", "edit_ns", "brush_ns", "build_ns"),
    )


def _edit_steps(quick):
    yield Step(
        "edits",
        ("edits", "--edits", "20000" if quick else "200000", "--min-runs", "3" if quick else "15"),
        2 if quick else 20,
        ("case", "edits", "median_us", "p90_us"),
    )
    yield Step(
        "dirty-layers",
        ("chunk-edge", "--worlds", "terrain" if quick else "hills,terrain,caves,town,luanti", "--edges", "16,32,64"),
        10 if quick else 60,
        ("world", "edge", "edit_ns", "edit_full_mesh_ns", "memory_bytes", "voxels"),
        "",
    )
    yield Step(
        "edit-to-mesh",
        (
            "edit-to-mesh",
            "--worlds",
            "hills" if quick else "hills,caves,town,luanti",
            "--edges",
            "32" if quick else "32,64",
            "--min-runs",
            "10" if quick else "60",
        ),
        10 if quick else 120,
        ("world", "edge", "neighbours", "brush", "apply_ns", "layers_ns", "whole_ns", "sweep_ns", "emit_ns", "by_layers"),
    )
    yield Step(
        "bytes",
        ("bytes", "--worlds", "luanti,terrain", "--min-runs", "3" if quick else "5"),
        5 if quick else 20,
        ("world", "set", "form", "bytes", "encode_us", "decode_us"),
    )


def _voxel_steps(quick):
    yield Step(
        "voxelise",
        (
            "voxelise",
            "--triangles",
            "10000,100000" if quick else "10000,100000,1000000",
            "--edges",
            "128,256" if quick else "128,256,512,1024",
            "--min-runs",
            "1" if quick else "5",
        ),
        10 if quick else 300,
        (
            "way",
            "triangles",
            "side",
            "cpu_s",
            "model_bytes",
            "peak_bytes",
            "voxels",
            "run_bytes",
            "compared",
            "differing",
        ),
    )


def _network_steps(quick):
    for profile in PROFILES:
        if quick and profile not in ("loopback", "broadband"):
            continue
        yield _net(
            f"latency-{profile}",
            20 if quick else 60,
            "latency",
            "--profiles",
            profile,
            "--edits",
            "100" if quick else "400",
        )
        yield _net(
            f"transfer-{profile}",
            8 if quick else 60,
            "transfer",
            "--profiles",
            profile,
            "--worlds",
            "luanti,terrain,caves,town,noise",
            "--min-runs",
            "1" if quick else "3",
        )
    for clients in FLEET_SIZES:
        if quick and clients > 100:
            continue
        yield _net(
            f"crowd-{clients}",
            8 if quick else 40 + clients / 20,
            "crowd",
            "--clients",
            str(clients),
            "--crowd-seconds",
            "3" if quick else "20",
        )
    yield _net(
        "gateway",
        30 if quick else 300,
        "gateway",
        "--min-runs",
        "1" if quick else "5",
        "--crowd-seconds",
        "3" if quick else "6",
        *(("--edits", "100", "--gateway-bots", "20") if quick else ()),
        is_default=False,
    )
    yield _net("siege", 60 if quick else 660, "siege", *(("--siege-seconds", "30") if quick else ()), is_default=False)


def report_steps(quick):
    """Returns all steps in the order in which they run."""
    out = []
    for group in (_scenario_steps, _mesh_steps, _drawing_steps, _edit_steps, _voxel_steps, _network_steps):
        out += group(quick)
    return out
