"""Charts: dots, bars, lines, stacks and points, each from plain numbers to one SVG element.

A value that was not measured (NaN) is left out. An infinite value is an arrow at the end of its
axis with the word "never". Without any value there is no chart, but an empty text. An interval is
drawn as a thin line through its mark.
"""
import math
from dataclasses import dataclass, field

from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from .statistics import Interval
from .style import FONT, GRID, INK, PAPER, QUIET, new_canvas, svg_of
from .text import number_text

ROW = 0.24  # inches of a row of a chart
LEGEND_LINE = 0.19


@dataclass(frozen=True)
class Axis:
    label: str
    log: bool = False
    mark: float = None  # where a line shows a value that matters, such as "as fast"

    def end_for(self, intervals):
        """Returns where infinite values are drawn: beyond the greatest finite value."""
        most = max((v for i in intervals for v in (i.low, i.middle, i.high) if math.isfinite(v)), default=1)
        return most * (3 if self.log else 1.2)


@dataclass(frozen=True)
class Series:
    """One mark in each row, or one line."""

    name: str
    colour: str
    values: list  # of Interval; for lines of (x, Interval)
    hollow: bool = False  # figures of the thesis, or the second of a pair
    marker: str = "o"


@dataclass(frozen=True)
class Bar:
    name: str
    colour: str
    value: Interval
    note: str = ""


@dataclass(frozen=True)
class Span:
    """A part of the x axis with a name."""

    low: float
    high: float
    name: str


@dataclass(frozen=True)
class Part:
    name: str
    colour: str
    values: list = field(default_factory=list)  # one number for each row


def _set_axis(axis, which, axes):
    set_scale, target = (axes.set_xscale, axes.xaxis) if which == "x" else (axes.set_yscale, axes.yaxis)
    if axis.log:
        set_scale("log")
        low, high = sorted(axes.get_xlim() if which == "x" else axes.get_ylim())
        narrow = low > 0 and high / low < 100
        target.set_major_locator(LogLocator(subs=(1, 2, 5) if narrow else (1,), numticks=9))
        target.set_minor_formatter(NullFormatter())
    target.set_major_formatter(FuncFormatter(lambda v, _: number_text(v)))
    (axes.set_xlabel if which == "x" else axes.set_ylabel)(axis.label)
    if axis.mark is not None:
        (axes.axvline if which == "x" else axes.axhline)(axis.mark, color=INK, linewidth=0.9, zorder=1)


def _legend(canvas, handles):
    """Puts the legend above the axes, in as many columns as its names leave room for."""
    if len(handles) < 2:
        return
    longest = max(len(h.get_label()) for h in handles)
    columns = min(len(handles), 2 if longest > 24 else 3 if longest > 14 else 4)
    height = LEGEND_LINE * math.ceil(len(handles) / columns) + 0.05
    width, total = canvas.get_size_inches()
    canvas.set_size_inches(width, total + height)
    canvas.get_layout_engine().set(rect=(0, 0, 1, 1 - height / (total + height)))
    canvas.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0, 1),
        ncols=columns,
        fontsize=FONT,
        handletextpad=0.4,
        columnspacing=1.2,
        borderaxespad=0.3,
        borderpad=0.1,
    )


def _handle(series, line="none"):
    return Line2D(
        [],
        [],
        color=series.colour,
        marker=series.marker,
        linestyle=line,
        markersize=5,
        markerfacecolor=PAPER if series.hollow else series.colour,
        label=series.name,
    )


def _shown(value):
    return not math.isnan(value.middle)


def _mark(axes, series, at, ends, size):
    """Draws the mark of a series at a point.

    `ends` has the place of an infinite coordinate on each axis.
    """
    x, y = (min(v, end) for v, end in zip(at, ends))
    arrow = ">" if math.isinf(at[0]) else "^" if math.isinf(at[1]) else ""
    axes.plot(
        [x],
        [y],
        color=series.colour,
        marker=arrow or series.marker,
        markersize=size,
        markerfacecolor=PAPER if series.hollow else series.colour,
        linestyle="none",
    )
    if arrow:
        axes.annotate(
            number_text(math.inf),
            (x, y),
            xytext=(3, 3) if arrow == ">" else (0, -6),
            textcoords="offset points",
            ha="right" if arrow == ">" else "center",
            va="bottom" if arrow == ">" else "top",
            color=series.colour,
            fontsize=FONT - 1,
        )


def dots(name, title, rows, series, axis):
    """Draws a mark for each series in each row, with its interval."""
    values = [v for one in series for v in one.values if _shown(v)]
    if not values:
        return ""
    ends = axis.end_for(values), math.inf
    step = min(0.22, 0.6 / max(1, len(series)))
    canvas, axes = new_canvas(
        0.6 + ROW * len(rows) * (1 if len(series) < 4 else 1.25) * (1 + 0.4 * any("\n" in r for r in rows))
    )
    for i, one in enumerate(series):
        shift = (i - (len(series) - 1) / 2) * step
        for row, value in enumerate(one.values):
            if not _shown(value) or (axis.log and value.middle <= 0):
                continue
            if value.low < value.high:
                limits = [min(v, ends[0]) for v in (value.low, value.high)]
                axes.plot(limits, [row + shift] * 2, color=one.colour, linewidth=1.3, solid_capstyle="butt")
            for at in {value.middle, math.inf} if math.isinf(value.high) else {value.middle}:
                _mark(axes, one, (at, row + shift), ends, 4.6)
    axes.set_yticks(range(len(rows)), rows)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    _set_axis(axis, "x", axes)
    _legend(canvas, [_handle(s) for s in series])
    return svg_of(canvas, name, title)


def bars(name, title, all_bars, axis):
    """Draws a bar for each value, on a logarithmic axis a dot, with a note behind it."""
    values = [b.value for b in all_bars if _shown(b.value)]
    if not values:
        return ""
    ends = axis.end_for(values), math.inf
    canvas, axes = new_canvas(0.6 + ROW * len(all_bars))
    for row, bar in enumerate(all_bars):
        if not _shown(bar.value):
            continue
        # On a logarithmic axis a bar's length would depend on where the axis begins.
        if axis.log or math.isinf(bar.value.middle):
            _mark(axes, Series(bar.name, bar.colour, []), (bar.value.middle, row), ends, 6)
        else:
            axes.barh(row, bar.value.middle, height=0.62, color=bar.colour)
        limits = [min(v, ends[0]) for v in (bar.value.low, bar.value.high)]
        if limits[0] < limits[1]:
            axes.plot(limits, [row, row], color=bar.colour if axis.log else INK, linewidth=1.3)
        axes.annotate(
            bar.note,
            (limits[1], row),
            xytext=(6, 0),
            textcoords="offset points",
            va="center",
            color=QUIET,
            fontsize=FONT - 1,
        )
    axes.set_yticks(range(len(all_bars)), [b.name for b in all_bars])
    axes.set_ylim(len(all_bars) - 0.4, -0.6)
    most = max(min(v.high, ends[0]) for v in values)
    if axis.log:
        least = min((min(v.low, ends[0]) for v in values if v.low > 0), default=1)
        axes.set_xlim(least / 2, most * 6)
    else:
        axes.set_xlim(0, most * 1.35)
    _set_axis(axis, "x", axes)
    axes.grid(axis="y", visible=False)
    return svg_of(canvas, name, title)


def lines(name, title, series, x, y, spans=()):
    """Draws a line for each series; an interval is a band around it."""
    values = [v for one in series for _, v in one.values if _shown(v)]
    if not values:
        return ""
    ends = math.inf, y.end_for(values)
    canvas, axes = new_canvas(3.1)
    for one in series:
        shown = [(at, v) for at, v in one.values if _shown(v)]
        if not shown:
            continue
        xs = [at for at, _ in shown]
        if any(v.low < v.high for _, v in shown):
            low, high = ([min(limit, ends[1]) for limit in of] for of in zip(*((v.low, v.high) for _, v in shown)))
            axes.fill_between(xs, low, high, color=one.colour, alpha=0.16, linewidth=0)
        for at, v in shown:
            if math.isinf(v.middle):
                _mark(axes, one, (at, v.middle), ends, 5)
        # matplotlib interrupts a line at NaN.
        axes.plot(
            xs,
            [v.middle if math.isfinite(v.middle) else math.nan for _, v in shown],
            color=one.colour,
            marker=one.marker,
            markersize=4,
            linewidth=1.4,
            linestyle="--" if one.hollow else "-",
            markerfacecolor=PAPER if one.hollow else one.colour,
        )
    for span in spans:
        axes.axvspan(span.low, span.high, color=GRID, alpha=0.5, linewidth=0)
        axes.annotate(
            span.name,
            ((span.low + span.high) / 2, 0.98),
            xycoords=("data", "axes fraction"),
            rotation=90,
            ha="center",
            va="top",
            fontsize=FONT - 2,
            color=QUIET,
        )
    _set_axis(x, "x", axes)
    ticks = sorted({at for one in series for at, v in one.values if _shown(v)})
    if x.log and len(ticks) < 8:
        axes.set_xticks(ticks)
        axes.xaxis.set_minor_locator(NullLocator())
    _set_axis(y, "y", axes)
    _legend(canvas, [_handle(s, "--" if s.hollow else "-") for s in series])
    return svg_of(canvas, name, title)


def stacks(name, title, rows, parts, axis):
    """Draws a bar of parts for each row.

    A row with an infinite part has the word "never" in its name.
    """
    if all(math.isnan(v) for part in parts for v in part.values):
        return ""
    canvas, axes = new_canvas(0.6 + ROW * len(rows))
    left = [0.0] * len(rows)
    for part in parts:
        values = [v if math.isfinite(v) else 0 for v in part.values]
        axes.barh(range(len(rows)), values, left=left, height=0.62, color=part.colour)
        left = [a + b for a, b in zip(left, values)]
    endless = [math.inf in (part.values[row] for part in parts) for row in range(len(rows))]
    names = [f"{row} ({number_text(math.inf)})" if is_endless else row for row, is_endless in zip(rows, endless)]
    axes.set_yticks(range(len(rows)), names)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    _set_axis(axis, "x", axes)
    axes.grid(axis="y", visible=False)
    _legend(canvas, [_handle(Series(p.name, p.colour, [], marker="s")) for p in parts])
    return svg_of(canvas, name, title)


def points(name, title, series, x, y):
    """Draws one point (x, y) of each series with both intervals. The lower left is the best."""
    shown = [(one, *one.values[0]) for one in series if all(map(_shown, one.values[0]))]
    if not shown:
        return ""
    x_end, y_end = x.end_for(across for _, across, _ in shown), y.end_for(up for _, _, up in shown)
    canvas, axes = new_canvas(3.6)
    for one, across, up in shown:
        at = min(across.middle, x_end), min(up.middle, y_end)
        limits = [[min(v, x_end) for v in (across.low, across.high)], [min(v, y_end) for v in (up.low, up.high)]]
        axes.plot(limits[0], [at[1]] * 2, color=one.colour, linewidth=1.1)
        axes.plot([at[0]] * 2, limits[1], color=one.colour, linewidth=1.1)
        _mark(axes, one, (across.middle, up.middle), (x_end, y_end), 6)
    _set_axis(x, "x", axes)
    _set_axis(y, "y", axes)
    _legend(canvas, [_handle(s) for s in series])
    return svg_of(canvas, name, title)
