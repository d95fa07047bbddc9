"""Figure: one figure of the page, with its numbers and a sentence about its content."""
import csv
import io
import math
from dataclasses import dataclass, field


@dataclass(frozen=True)
class HeatTable:
    """Numbers in a table, shaded by their ratio to the least of the row or column."""

    corner: str
    columns: list
    rows: list  # of (name, [cell text, shade 0 .. 1])


@dataclass(frozen=True)
class Figure:
    id: str  # anchor in the page, and name of its CSV
    title: str
    sentence: str  # what the figure shows
    steps: tuple  # the steps from which it is drawn
    columns: list  # of the CSV
    rows: list
    charts: list = field(default_factory=list)  # SVG elements
    table: HeatTable = None
    notes: list = field(default_factory=list)  # how to read it, known defects of data
    cards: list = field(default_factory=list)  # pictures with numbers


@dataclass(frozen=True)
class Section:
    id: str
    title: str
    introduction: str
    figures: list


def shade_of(value, least, most):
    """Returns where a value stands between the least and the greatest, on a logarithmic scale."""
    if not (math.isfinite(value) and value > 0 and least > 0 and most > least):
        return 0
    return math.log(value / least) / math.log(most / least)


def _csv_cell(value):
    """Returns six significant digits of a float, "inf" if it is infinite, and an empty text for NaN."""
    if not isinstance(value, float):
        return value
    return "" if math.isnan(value) else f"{value:.6g}"


def csv_of(figure):
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(figure.columns)
    writer.writerows([_csv_cell(v) for v in row] for row in figure.rows)
    return out.getvalue()
