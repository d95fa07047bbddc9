import json
import tempfile
import unittest
from pathlib import Path

from report.evidence import Results
from report.results import NotMeasured, ResultError, read_result, result_file
from report.thesis import Thesis

from .sample_data import MACHINE, STEPS, mesh_row, step_result, thesis, write_report, write_result


class Loading(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.step = STEPS["meshers"]
        self.file = result_file(self.folder, "meshers")
        write_result(self.folder, step_result("meshers", {"rows": [mesh_row("scenarios", "2", "rdm", 10)]}))

    def error(self):
        with self.assertRaises(ResultError) as caught:
            read_result(self.folder, self.step)
        self.assertIn(str(self.file), str(caught.exception))
        return str(caught.exception)

    def change(self, change):
        content = json.loads(self.file.read_text())
        change(content)
        self.file.write_text(json.dumps(content))

    def test_a_result_is_read_as_it_was_written(self):
        self.assertEqual(read_result(self.folder, self.step).machine, MACHINE)

    def test_a_missing_file_is_not_measured(self):
        self.file.unlink()
        with self.assertRaises(NotMeasured):
            read_result(self.folder, self.step)

    def test_a_broken_file_is_named(self):
        self.file.write_text(self.file.read_text()[:40])
        self.error()
        self.file.write_bytes(b"\xff\xfe")
        self.error()

    def test_a_missing_field_is_named(self):
        self.change(lambda c: c["result"]["rows"][0].pop("median_ns"))
        self.assertIn("result.rows[0].median_ns is missing", self.error())

    def test_a_missing_field_of_the_machine_is_named(self):
        self.change(lambda c: c["machine"].pop("cpu"))
        self.assertIn("machine.cpu is missing", self.error())

    def test_a_field_of_another_type_is_named(self):
        self.change(lambda c: c.update(quick="yes"))
        self.assertIn("the field quick is not of type bool", self.error())
        self.change(lambda c: c.update(quick=False, result={"rows": 5}))
        self.assertIn("result.rows is not of type list", self.error())

    def test_a_result_without_rows_is_an_error(self):
        self.change(lambda c: c.update(result={"rows": []}))
        self.assertIn("result.rows is empty", self.error())

    def test_a_result_of_another_format_or_step_is_an_error(self):
        self.change(lambda c: c.update(format=1))
        self.assertIn("the field format is 1", self.error())
        self.change(lambda c: c.update(format=2, step="edits"))
        self.assertIn("the field step is edits", self.error())


class Doubts(unittest.TestCase):
    def test_results_of_another_commit_are_named(self):
        with tempfile.TemporaryDirectory() as folder:
            write_report(folder)
            other = MACHINE.__class__(**{**vars(MACHINE), "commit": "ffff"})
            write_report(folder, other, only=("edits",))
            results = Results(Path(folder) / "data", STEPS.values(), {"bytes": "no disk"})
            self.assertEqual(results.common.machine, MACHINE)
            self.assertIn("commit ffff", results.doubts(("edits",))[0])
            self.assertIn("no disk. The older result is shown.", results.doubts(("bytes",))[0])
            self.assertEqual(results.doubts(("meshers",)), [])
            (Path(folder) / "data/facts.json").unlink()
            self.assertEqual(
                results.__class__(Path(folder) / "data", STEPS.values()).doubts(("facts",)), ["Not measured: facts."]
            )


class ThesisTables(unittest.TestCase):
    def test_the_tables_of_the_thesis_are_read(self):
        tables = thesis()
        self.assertEqual(len(tables.names), 37)
        self.assertAlmostEqual(tables.value(1, "Grid", "total_mean"), 4.6556)
        self.assertAlmostEqual(tables.chunk_size_ms(1, 8, "RLE"), 0.3048)
        self.assertIn("scenario 10", tables.notes([12])[0])

    def test_a_missing_table_is_named(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(ResultError) as caught:
            Thesis(folder)
        self.assertIn("scenarios.csv", str(caught.exception))
