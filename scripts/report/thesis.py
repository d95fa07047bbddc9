"""The thesis' results, from the tables in tests/data/thesis, which were made from its raw logs."""
import csv
import math
from pathlib import Path

from .results import ResultError

MEANS_NOTE = (
    "The thesis averages by v = round((v + new) / 2), in which the last chunk weighs half. Here"
    " its raw events are averaged plainly. Scenarios whose data contradict each other (12, 18,"
    " 31) are in these means."
)
VOXEL_PLUGIN_CHUNKS = (
    "Voxel Plugin: the mean over its chunks with voxels, some 27 of the 484 events it logs a scenario. "
    "The thesis drew the mean over all events, about a seventh of that."
)
VOXEL_PLUGIN_EVENTS = (
    "Voxel Plugin: phases are means over all 484 events it logs a scenario, of which some 27 are chunks with voxels."
)
# Defects of single files of its logs, which the table of defects does not have, since no golden
# test needs them.
LOG_DEFECTS = {
    18: "Voxel Plugin's time is ten times the usual per vertex, likely another model's",
    21: "the RLE meshing file holds events of other sessions; its phases are left out",
    28: "the file of RLE's buffer phase holds Voxel Plugin's events; it is left out",
    30: "the file of Grid's buffer phase is a copy of RLE's; it is left out",
}


def _read(file, columns):
    try:
        with open(file, encoding="utf-8", newline="") as lines:
            rows = list(csv.DictReader(lines))
    except OSError as error:
        raise ResultError(f"{file}: {error.strerror}") from None
    for column in columns:
        if rows and column not in rows[0]:
            raise ResultError(f"{file}: the column {column} is missing")
    return rows


class Thesis:
    def __init__(self, folder):
        folder = Path(folder)
        try:
            self.names = {int(r["number"]): r["name"] for r in _read(folder / "scenarios.csv", ("number", "name"))}
            self._values = {
                (int(r["scenario"]), r["mesher"], r["metric"]): float(r["value"])
                for r in _read(folder / "thesis_results.csv", ("scenario", "mesher", "metric", "value"))
            }
            self._sizes = {
                (int(r["scenario"]), int(r["chunk_size"]), r["mesher"]): float(r["mean_ms"])
                for r in _read(folder / "chunk_sizes.csv", ("scenario", "chunk_size", "mesher", "mean_ms"))
            }
            defects = _read(folder / "scenario_defects.csv", ("number", "reason"))
        except ValueError as error:
            raise ResultError(f"{folder}: {error}") from None
        self._defects = {}
        for row in defects:
            self._defects.setdefault(int(row["number"]), {})[row["reason"]] = None
        for scenario, reason in LOG_DEFECTS.items():
            self._defects.setdefault(scenario, {})[reason] = None

    def value(self, scenario, mesher, metric):
        """Returns a result; NaN where the thesis has none. `mesher` is Grid, RLE or VoxelPlugin."""
        return self._values.get((scenario, mesher, metric), math.nan)

    def chunk_size_ms(self, scenario, side, mesher):
        """Returns the mean time of a chunk of that side, in ms; NaN where the thesis has none."""
        return self._sizes.get((scenario, side, mesher), math.nan)

    def notes(self, scenarios):
        """Returns a sentence for each of these scenarios whose data have a known defect."""
        return [f"Scenario {s} of the thesis: {'; '.join(self._defects[s])}." for s in scenarios if s in self._defects]
