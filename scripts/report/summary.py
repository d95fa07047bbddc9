"""Summary: the verdict as Markdown, for README.md (scripts/report-figures)."""
import textwrap

from .comparison import OURS, compare
from .figures.meshers import MesherTotals
from .meshers import mesher
from .text import count_text, interval_text, number_text

# The product, the thesis' own mesher, the baselines, and two that a reader knows.
SHOWN = ("rdm", "rle_rdm", "decode_binary", "mask_binary", "culled", "greedy")


def _wrapped(text, first="", then=""):
    return textwrap.fill(
        text, 100, initial_indent=first, subsequent_indent=then, break_long_words=False, break_on_hyphens=False
    )


def _table(evidence):
    rows = evidence.here.rows("meshers")
    totals = MesherTotals(rows)
    keys = sorted((k for k in SHOWN if k in totals.keys and totals.is_whole(k)), key=totals.mean_ns)
    out = [
        (
            f"| mesher, {len(totals.parts)} scenarios of the thesis, 32³ | µs a chunk, geometric"
            " mean | times ours (95 %) | µs a chunk, arithmetic mean | triangles (sum) |"
        ),
        "|---|---|---|---|---|",
    ]
    for key in keys:
        found = compare(rows, key)
        times = "1" if key == OURS or found is None else interval_text(found.gain)
        out.append(
            f"| {mesher(key).name} | {number_text(totals.mean_ns(key) / 1000)} | {times} |"
            f" {number_text(totals.sum(key, 'median_ns') / 1000 / len(totals.parts))} |"
            f" {count_text(totals.sum(key, 'triangles'))} |"
        )
    return "\n".join(out)


def summary_of(evidence, verdict):
    """Returns Markdown; nothing if the meshers were not measured."""
    found = evidence.here.find("meshers")
    if found is None:
        return ""
    blocks = [
        _wrapped(verdict.sentence),
        _table(evidence),
        "What speaks against it:\n" + "\n".join(_wrapped(a, "- ", "  ") for a in verdict.against),
    ]
    blocks += [_wrapped(f"Doubt: {d}") for d in evidence.doubts(verdict.steps)]
    blocks.append(
        _wrapped(
            f"{found.machine.text()}; one core; real world {found.luanti}; a"
            f" {'quick' if found.quick else 'full'} run."
            f" {MesherTotals(evidence.here.rows('meshers')).empty_note()}"
        )
    )
    return "\n\n".join(blocks) + "\n"
