"""Style: colours of the page, and matplotlib figures as inline SVG that follow them.

matplotlib draws in the colours for white paper. In the SVG each becomes a CSS variable with that
colour as its default, so that one drawing serves the light page, the dark page and print.
"""
import io
import re

import matplotlib
from matplotlib.figure import Figure as Canvas

from .meshers import MESHERS

WIDTH = 5.6  # inches; the page scales a drawing to its column
FONT = 8.5

# Colours that are not of a mesher: name, on white, on black.
NEUTRAL = (
    ("ink", "#1b1b1c", "#ececed"),
    ("quiet", "#5b5b5c", "#acacad"),
    ("grid", "#dcdcdd", "#3d3d3e"),
    ("paper", "#fefefe", "#161617"),
    ("other", "#707071", "#a6a6a7"),
    ("phase1", "#c4c4c5", "#5f5f60"),
    ("phase2", "#9a9a9b", "#8a8a8b"),
    ("phase3", "#66666a", "#b9b9ba"),
    ("phase4", "#303032", "#ededee"),
)
COLOURS = {name: light for name, light, _ in NEUTRAL}
INK, QUIET, GRID, PAPER, OTHER = (COLOURS[n] for n in ("ink", "quiet", "grid", "paper", "other"))
PHASES = tuple(COLOURS[f"phase{i}"] for i in range(1, 5))

_ALL = (*NEUTRAL, *((m.key.replace("_", "-"), m.light, m.dark) for m in MESHERS.values()))
_VARIABLES = {light: f"var(--{name},{light})" for name, light, _ in _ALL}
assert len(_VARIABLES) == len(_ALL), "two names share a colour, so the SVG could not tell them apart"

matplotlib.rcParams.update(
    {
        "svg.fonttype": "none",
        "font.size": FONT,
        "axes.edgecolor": GRID,
        "axes.labelcolor": QUIET,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": GRID,
        "grid.linewidth": 0.6,
        "xtick.color": GRID,
        "ytick.color": GRID,
        "xtick.labelcolor": QUIET,
        "ytick.labelcolor": INK,
        "text.color": INK,
        "legend.frameon": False,
        "xtick.major.size": 2.5,
        "ytick.major.size": 0,
        "figure.facecolor": "none",
        "axes.facecolor": "none",
        "savefig.facecolor": "none",
    }
)


def colour_css():
    """Returns the rules that define the colours for screen, dark screen and print."""
    light = ";".join(f"--{name}:{colour}" for name, colour, _ in _ALL)
    dark = ";".join(f"--{name}:{colour}" for name, _, colour in _ALL)
    return f":root{{{light}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n"


def new_canvas(height):
    """Returns a figure of the page's width and its axes."""
    canvas = Canvas(figsize=(WIDTH, height), layout="constrained")
    return canvas, canvas.subplots()


def svg_of(canvas, name, title):
    """Returns the drawing as an <svg> element. `name` makes its ids unique in the page."""
    text = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": name}):
        canvas.savefig(text, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    svg = text.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", svg, flags=re.S)
    used = set(re.findall(r'(?:href="|url\()#([^")]+)', svg))
    svg = re.sub(r' id="([^"]+)"', lambda m: f' id="{name}-{m[1]}"' if m[1] in used else "", svg)
    svg = re.sub(r'(href="|url\()#', rf"\g<1>#{name}-", svg)
    svg = re.sub(r"#[0-9a-f]{6}", lambda m: _VARIABLES.get(m[0], m[0]), svg)
    svg = re.sub(r"'DejaVu Sans', [^;\"]*|'DejaVu Sans'", "system-ui, sans-serif", svg)
    box = re.search(r'viewBox="[^"]+"', svg)[0]
    head = f'<svg class="chart" role="img" aria-label="{_escaped(title)}" {box} xmlns="http://www.w3.org/2000/svg"'
    if "xlink:" in svg:
        head += ' xmlns:xlink="http://www.w3.org/1999/xlink"'
    svg = head + ">" + svg[svg.index(">") + 1 :]
    return re.sub(r"\n\s*", "\n", svg).strip()


def svg_file_of(svg):
    """Returns a file of its own with the same drawing."""
    box = re.search(r'viewBox="[\d.]+ [\d.]+ ([\d.]+) ([\d.]+)"', svg)
    svg = svg.replace("<svg ", f'<svg width="{float(box[1]) * 1.6:.0f}" height="{float(box[2]) * 1.6:.0f}" ', 1)
    return svg.replace(">", f"><style>{colour_css()}svg{{background:var(--paper)}}</style>", 1) + "\n"


def _escaped(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
