"""make-report as a program.

A small script takes the place of runstone-bench, except in the last tests.
"""
import io
import json
import os
import runpy
import subprocess
import tempfile
import unittest
import unittest.mock
from pathlib import Path
from types import SimpleNamespace

from report.command import main
from report.results import ResultError
from report.runner import Runner
from report.steps import PictureStep, report_steps

from .sample_data import MACHINE, ROOT, _results, without_drawing

BENCH = """#!/usr/bin/python3
import json, sys
arguments = sys.argv[1:]
with open({calls!r}, "a") as calls:
    calls.write(arguments[0] + "\\n")
if arguments[0] == "edits":
    sys.exit("runstone-bench: no disk")
known = json.load(open({known!r}))
json.dump(known[arguments[0]], open(arguments[arguments.index("--json") + 1], "w"))
"""


class Command(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.calls, self.bench = self.folder / "calls", self.folder / "bench"
        self.set_machine(vars(MACHINE))
        # Drawing takes most of the time, and these tests do not read the page.
        page = unittest.mock.patch("report.command.write_page", return_value=SimpleNamespace(errors=list))
        self.write_page = page.start()
        self.addCleanup(page.stop)
        self.bench.write_text(BENCH.format(calls=str(self.calls), known=str(self.folder / "known.json")))
        self.bench.chmod(0o755)

    def set_machine(self, machine):
        results = _results()
        known = {"machine": machine, "scenario-facts": results["facts"], "bytes": results["bytes"]}
        (self.folder / "known.json").write_text(json.dumps(known))

    def run_report(self, *arguments):
        err = io.StringIO()
        code = main(["--out", str(self.folder / "out"), "--bench", str(self.bench), *arguments], err)
        calls = self.calls.read_text().split() if self.calls.exists() else []
        self.calls.unlink(missing_ok=True)
        return code, err.getvalue(), [c for c in calls if c != "machine"]

    def test_a_step_is_measured_once(self):
        self.assertEqual(self.run_report("--steps", "facts,bytes")[::2], (0, ["scenario-facts", "bytes"]))
        self.write_page.assert_called_once()
        code, text, calls = self.run_report("--steps", "facts,bytes")
        self.assertEqual((code, calls), (0, []))
        self.assertIn("[1/2] facts, about 22 s left: is there", text)
        self.assertEqual(self.run_report("--steps", "facts", "--again")[2], ["scenario-facts"])
        self.assertEqual(self.run_report("--page-only")[::2], (0, []))

    def test_another_commit_and_changed_trees_are_measured_again(self):
        self.run_report("--steps", "facts")
        self.set_machine({**vars(MACHINE), "commit": "ffff-dirty"})
        self.assertEqual(self.run_report("--steps", "facts")[2], ["scenario-facts"])
        self.assertEqual(self.run_report("--steps", "facts")[2], ["scenario-facts"])

    def test_a_quick_run_does_not_replace_a_full_one(self):
        self.run_report("--steps", "facts")
        code, text, calls = self.run_report("--steps", "facts", "--quick")
        self.assertEqual((code, calls), (1, []))
        self.assertIn("has results of a full run", text)
        self.assertEqual(self.run_report("--steps", "facts", "--quick", "--again")[0], 0)

    def test_a_step_that_fails_is_named_and_the_others_run(self):
        code, text, calls = self.run_report("--steps", "edits,bytes")
        self.assertEqual((code, calls), (1, ["edits", "bytes"]))
        self.assertIn("failed: bench edits ended with code 1: runstone-bench: no disk", text)
        self.assertIn("no disk", self.write_page.call_args[0][3]["edits"])

    def test_unknown_steps_are_rejected(self):
        for arguments in (("--steps", "everything"), ("--quick", "--steps", "latency-lossy")):
            with self.assertRaises(SystemExit), unittest.mock.patch("sys.stderr", io.StringIO()):
                self.run_report(*arguments)

    def test_a_missing_program_is_named(self):
        self.bench.unlink()
        code, text, _ = self.run_report("--steps", "facts")
        self.assertEqual(code, 1)
        self.assertIn("bench is missing", text)

    def assert_one_line(self, text, *parts):
        self.assertEqual(len(text.splitlines()), 1, text)
        self.assertTrue(text.startswith("make-report: "), text)
        for part in parts:
            self.assertIn(str(part), text)

    def test_a_program_that_cannot_run_is_named(self):
        self.bench.chmod(0o644)
        code, text, _ = self.run_report("--steps", "facts")
        self.assertEqual(code, 1)
        self.assert_one_line(text, self.bench, "Permission denied")

    def test_a_folder_that_is_a_file_is_named(self):
        (self.folder / "out").write_text("")
        code, text, _ = self.run_report("--steps", "facts")
        self.assertEqual(code, 1)
        self.assert_one_line(text, self.folder / "out", "File exists")

    def test_a_folder_that_cannot_be_written_is_named(self):
        # Root may write into every folder, so a file stands in the place of a folder.
        self.write_page.side_effect = NotADirectoryError(20, "Not a directory", "out/csv/crowds.csv")
        code, text, _ = self.run_report("--page-only")
        self.assertEqual(code, 1)
        self.assert_one_line(text, "out/csv/crowds.csv: Not a directory")

    def test_a_step_that_does_not_end_is_named(self):
        with unittest.mock.patch("report.runner.subprocess.run", side_effect=[subprocess.TimeoutExpired("x", 1)]):
            runner = Runner(self.bench, self.folder, self.folder, False, False)
            with self.assertRaises(ResultError) as caught:
                runner.call("siege", 660, ["net"], io.StringIO())
        self.assertEqual(str(caught.exception), "bench net of the step siege did not end in 120.0 min")


@unittest.skipUnless(os.environ.get("RUNSTONE_BENCH"), "RUNSTONE_BENCH does not name runstone-bench")
class WithRunstoneBench(unittest.TestCase):
    def test_every_step_is_a_command_that_runstone_bench_accepts(self):
        commands = {
            step.picture_arguments(37) if isinstance(step, PictureStep) else (*step.arguments, "--json", "x")
            for quick in (True, False)
            for step in report_steps(quick)
        }
        for arguments in commands:
            done = subprocess.run(
                [os.environ["RUNSTONE_BENCH"], *arguments, "--help"], capture_output=True, text=True, check=False
            )
            self.assertEqual(done.returncode, 0, f"{arguments}: {done.stderr}")

    def test_runstone_bench_writes_what_the_page_needs(self):
        with tempfile.TemporaryDirectory() as folder:
            err = io.StringIO()
            arguments = ["--out", folder, "--quick", "--steps", "facts,edits,bytes"]
            with without_drawing():
                code = main([*arguments, "--bench", os.environ["RUNSTONE_BENCH"]], err)
            self.assertEqual(code, 0, err.getvalue())
            text = (Path(folder) / "index.html").read_text(encoding="utf-8")
            self.assertIn("A chunk takes", text[text.index('id="memory-group-1"') :])


class Siege(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file = self.folder / "net.json"
        self.write({"window 0 quiet": 2, "window 1 views": 9})

    def write(self, p99_by_case):
        figures = [
            {"experiment": "siege", "profile": "loopback", "case": case, "figure": figure, "value": value}
            for case, p99 in p99_by_case.items()
            for figure, value in (
                ("from_s", p99),
                ("to_s", p99 + 5),
                ("p50_ms", 1),
                ("p99_ms", p99),
                ("server_resident_mb", 50),
                ("disk_kb_s", 3),
            )
        ]
        self.file.write_text(json.dumps({"figures": figures}))

    def draw(self, file, folder):
        return subprocess.run(
            [ROOT / "scripts/report/draw-siege", file, folder], capture_output=True, text=True, check=False
        )

    def test_the_charts_of_a_siege_are_files_of_their_own(self):
        self.assertEqual(self.draw(self.file, self.folder).returncode, 0)
        for name in ("siege-p99", "siege-memory", "siege-disk"):
            text = (self.folder / f"{name}.svg").read_text()
            self.assertTrue(text.startswith("<svg "))
            self.assertIn(">views</text>", text)
            self.assertIn("prefers-color-scheme:dark", text)

    def assert_fails(self, file, folder, *parts):
        # In this process, since a new one takes long to load the libraries.
        with unittest.mock.patch("sys.argv", ["draw-siege", str(file), str(folder)]), without_drawing():
            with self.assertRaises(SystemExit) as ended:
                runpy.run_path(str(ROOT / "scripts/report/draw-siege"))
        # A text is written to stderr, and the program ends with code 1.
        text = str(ended.exception.code)
        self.assertEqual(len(text.splitlines()), 1, text)
        for part in parts:
            self.assertIn(str(part), text)

    def test_a_file_that_cannot_be_used_is_named_in_one_line(self):
        missing = self.folder / "missing.json"
        self.assert_fails(missing, self.folder, f"{missing} is missing")
        self.assert_fails(self.folder, self.folder, f"{self.folder}: Is a directory")
        self.assert_fails(self.file, self.file, self.file, "File exists")
        self.write({"sample": 2})
        self.assert_fails(self.file, self.folder, f"{self.file} has no windows of a siege")
