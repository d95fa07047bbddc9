"""Comparison: our mesher with another one on the same volumes, volume by volume and together."""
from dataclasses import dataclass

from .statistics import (
    UNKNOWN,
    Interval,
    geometric_mean_interval,
    mean,
    ratio_of,
    repetitions_of,
    sum_ratio_interval,
    with_quads,
)

OURS = "rdm"
DECISIVE = "decode_binary"
VOLUME_FIELDS = ("world", "part", "edge", "order")


@dataclass(frozen=True)
class Comparison:
    other: str  # mesher
    volumes: dict  # name of a volume: ratio of the other's time to ours, with the range of repetitions
    gain: Interval  # geometric mean of the ratios
    sums: Interval  # ratio of the sums, in which slow volumes weigh most
    our_mean_us: float
    other_mean_us: float
    triangles: float  # the other's triangles divided by ours

    @property
    def faster(self):
        """Returns the volumes in which ours is faster in every repetition that counts."""
        return [name for name, ratio in self.volumes.items() if ratio.low > 1]

    @property
    def slower(self):
        return [name for name, ratio in self.volumes.items() if ratio.high < 1]

    @property
    def undecided(self):
        return [name for name, ratio in self.volumes.items() if ratio.low <= 1 <= ratio.high]


def names_of(volumes):
    """Returns a name for each volume: its part or, if parts repeat, every field in which these volumes differ."""
    parts = [str(volume[VOLUME_FIELDS.index("part")]) for volume in volumes]
    if len(set(parts)) == len(parts):
        return parts
    shown = [i for i, f in enumerate(VOLUME_FIELDS) if f == "part" or len({v[i] for v in volumes}) > 1]
    return [" ".join(str(volume[i]) for i in shown) for volume in volumes]


def compare(rows, other, ours=OURS):
    """Compares over the volumes that have quads and that both meshed. Returns None if there are none."""
    cells = {}
    for row in with_quads(rows):
        if row.get("rank") == "best":
            cells.setdefault(tuple(row[f] for f in VOLUME_FIELDS), {})[row["mesher"]] = row
    cells = {at: (cell[ours], cell[other]) for at, cell in cells.items() if ours in cell and other in cell}
    if not cells:
        return None
    both = dict(zip(names_of(list(cells)), cells.values()))
    volumes = {name: ratio_of(repetitions_of(b), repetitions_of(a)) for name, (a, b) in both.items()}
    ours_ns = [a["median_ns"] for a, _ in both.values()]
    other_ns = [b["median_ns"] for _, b in both.values()]
    if len(both) == 1:
        gain = sums = next(iter(volumes.values()))
    else:
        gain = geometric_mean_interval([b / a for a, b in zip(ours_ns, other_ns)])
        sums = sum_ratio_interval(other_ns, ours_ns)
    triangles = sum(a["triangles"] for a, _ in both.values())
    return Comparison(
        other,
        volumes,
        gain,
        sums,
        mean(ours_ns) / 1000,
        mean(other_ns) / 1000,
        sum(b["triangles"] for _, b in both.values()) / triangles if triangles else UNKNOWN.middle,
    )
