"""The command line of make-report."""
import argparse
import sys
from pathlib import Path

from .page import write_page
from .results import ResultError, error_text
from .runner import Runner
from .steps import report_steps
from .thesis import Thesis

ROOT = Path(__file__).resolve().parent.parent.parent


def _options(arguments):
    parser = argparse.ArgumentParser(
        prog="make-report",
        description=(
            "Measures with runstone-bench of the release build and writes a page: "
            "FOLDER/index.html. The same command continues a run that was interrupted."
        ),
    )

    def add_path(name, metavar, default, help_text):
        parser.add_argument(name, metavar=metavar, type=Path, default=default, required=default is None, help=help_text)

    add_path("--out", "FOLDER", None, "folder of the page, its tables (csv/) and results (data/)")
    parser.add_argument("--quick", action="store_true", help="all figures with few repetitions: some five minutes")
    add_path("--luanti", "DIR", ROOT / "tests/data/luanti_v7_small", "folder of a Luanti world")
    parser.add_argument("--steps", metavar="S,...", help="measure only these steps; all but gateway and siege by default")
    parser.add_argument(
        "--page-only", action="store_true", help="measure nothing: write the page from the existing results"
    )
    parser.add_argument("--again", action="store_true", help="measure steps again that have a result")
    add_path("--bench", "FILE", ROOT / "build/release/bin/runstone-bench", "the program to measure with")
    return parser, parser.parse_args(arguments)


def _wanted(parser, options, steps):
    if not options.steps:
        return [s for s in steps if s.is_default]
    names = options.steps.split(",")
    known = {s.name for s in report_steps(False)}
    for name in names:
        if name not in known:
            parser.error(f"no step {name}; the steps are {', '.join(sorted(known))}")
        if name not in {s.name for s in steps}:
            parser.error(f"a quick run has no step {name}")
    return [s for s in steps if s.name in names]


def main(arguments=None, err=None):
    err = err or sys.stderr
    parser, options = _options(arguments)
    steps = report_steps(options.quick)
    wanted = _wanted(parser, options, steps)
    # The page shows every step of a full run, also those that only an earlier run measured.
    shown = {s.name: s for s in [*report_steps(False), *steps]}
    try:
        options.out.mkdir(parents=True, exist_ok=True)
        thesis = Thesis(ROOT / "tests/data/thesis")
        failures = {}
        if not options.page_only:
            if not options.bench.exists():
                raise ResultError(f"{options.bench} is missing: build it as docs/reproduce.md says")
            runner = Runner(options.bench, options.out, options.luanti, options.quick, options.again)
            if why := runner.objection(wanted):
                raise ResultError(why)
            try:
                runner.run(wanted, failures, err)
            except KeyboardInterrupt:
                print("interrupted: the same command continues", file=err)
                failures["the rest"] = "interrupted"
        evidence = write_page(options.out, list(shown.values()), thesis, failures)
    except (ResultError, OSError) as error:
        print(f"make-report: {error_text(error)}", file=err)
        return 1
    for error in evidence.errors():
        print(f"make-report: {error}", file=err)
    print(f"{options.out / 'index.html'}", file=err)
    return 1 if failures or evidence.errors() else 0
