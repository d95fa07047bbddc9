"""Page: writes index.html, the CSV of each figure, and summary.md from the results of a folder."""
import urllib.parse
from pathlib import Path

import jinja2
from markupsafe import Markup

from .evidence import Evidence
from .figure import Figure, csv_of
from .figures import all_sections
from .results import write_atomically
from .runner import duration_text
from .style import colour_css
from .summary import summary_of
from .verdict import verdict_of

HERE = Path(__file__).resolve().parent


def _data_uri(csv):
    return "data:text/csv;charset=utf-8," + urllib.parse.quote(csv, safe="")


def _verdict_figure(verdict):
    """Returns the decisive chart with its numbers as a figure."""
    return Figure(
        "verdict",
        "The decisive comparison",
        verdict.sentence,
        verdict.steps,
        verdict.columns,
        verdict.rows,
        [verdict.chart] if verdict.chart else [],
    )


def render(evidence, sections, verdict):
    """Returns the page. It refers to nothing outside itself."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(HERE),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters.update(svg=Markup, csv_uri=lambda f: _data_uri(csv_of(f)), duration=duration_text)
    css = colour_css() + (HERE / "page.css").read_text(encoding="utf-8")
    return environment.get_template("page.html.j2").render(
        css=Markup(css),
        evidence=evidence,
        here=evidence.here,
        sections=sections,
        verdict=verdict,
        verdict_figure=_verdict_figure(verdict),
    )


def write_page(out, steps, thesis, failures=None):
    """Writes everything. Returns the evidence, so that the caller can name what is broken."""
    out = Path(out)
    evidence = Evidence(out, steps, thesis, failures)
    verdict = verdict_of(evidence)
    sections = all_sections(evidence)
    write_atomically(out / "index.html", render(evidence, sections, verdict))
    (out / "csv").mkdir(exist_ok=True)
    for figure in [_verdict_figure(verdict), *(f for s in sections for f in s.figures)]:
        file = out / "csv" / f"{figure.id}.csv"
        if evidence.here.has_any(figure.steps):
            write_atomically(file, csv_of(figure))
        else:
            file.unlink(missing_ok=True)  # of an earlier page
    write_atomically(out / "summary.md", summary_of(evidence, verdict))
    return evidence
