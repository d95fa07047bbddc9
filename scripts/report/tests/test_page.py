import csv
import re
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from pathlib import Path

from report.page import write_page
from report.style import colour_css

from .sample_data import MACHINE, STEPS, mesh_rows, step_result, thesis, without_drawing, write_report, write_result

# The figures that docs/reproduce.md names.
FIGURES = (
    "verdict",
    "meshers-time",
    "meshers-scenarios",
    "scenarios",
    "meshers-triangles",
    "t-junctions",
    "efficiency",
    *(f"{kind}-group-{g}" for kind in ("memory", "vertices", "phases") for g in (1, 2, 3)),
    "timing-group-2",
    "timing-group-3",
    "chunk-size-1",
    "chunk-size-5",
    "chunk-size-17",
    "frames",
    "fps",
    "seams",
    "storage",
    "landscapes",
    "adversaries",
    "axis-orders",
    "dirty-layers",
    "stacks",
    "voxelise-time",
    "voxelise-memory",
    "voxelise-errors",
    "bytes",
    "transfers",
    "latency",
    "crowds",
    "gateway",
    "siege",
)
VOID = {"meta", "img", "br"}


class Reader(HTMLParser):
    """Reads ids, links and the nesting of elements."""

    def __init__(self):
        super().__init__()
        self.ids, self.links, self.tags, self.open, self.text = [], [], set(), [], []

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        for name, value in attributes:
            if name == "id":
                self.ids.append(value)
            if name in ("href", "src", "xlink:href"):
                self.links.append(value)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-1:]}"
        self.open.pop()

    def handle_data(self, data):
        self.text.append(data)


def page_of(folder):
    text = (Path(folder) / "index.html").read_text(encoding="utf-8")
    reader = Reader()
    reader.feed(text)
    reader.close()
    return text, reader


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        write_report(cls.folder)
        # Half of the time of a drawing is its layout, which no test of the page reads.
        with unittest.mock.patch("matplotlib.layout_engine.do_constrained_layout"):
            write_page(cls.folder, list(STEPS.values()), thesis())
        cls.text, cls.page = page_of(cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_the_page_refers_to_nothing_outside_itself(self):
        for link in self.page.links:
            self.assertTrue(link.startswith(("#", "data:")), link[:60])
        self.assertNotIn("url(http", self.text)
        self.assertNotIn("@import", self.text)
        self.assertFalse(self.page.tags & {"script", "link", "iframe", "object"})

    def test_every_figure_is_there_and_has_its_numbers(self):
        for figure in FIGURES:
            self.assertIn(figure, self.page.ids)
            with open(self.folder / "csv" / f"{figure}.csv", encoding="utf-8", newline="") as lines:
                rows = list(csv.reader(lines))
            self.assertGreater(len(rows), 1, figure)
            self.assertEqual({len(r) for r in rows}, {len(rows[0])}, figure)

    def test_runs_of_triangles_are_compared_with_a_grid_and_an_oracle(self):
        text = self.text[self.text.index('id="voxelise-time"') :]
        self.assertIn(
            "On one core 1,000,000 triangles into 1,024³ take 200 ms, and 4 times as much by way of a grid of one"
            " byte a voxel. The grid takes less with 1,000,000 triangles into 128³.",
            text,
        )
        self.assertIn(
            "1,000,000 triangles into 1,024³ take 40 MB at their peak, and 20 times as much by way of a grid of"
            " one byte a voxel. It takes more in every case.",
            text,
        )
        self.assertIn("Of 800 voxels that an independent oracle computed, 1 differs.", text)

    def test_the_gateway_is_compared_with_tcp(self):
        text = self.text[self.text.index('id="gateway"') :]
        self.assertIn("A gateway for browsers adds 0.5 ms (p99) to a round trip.", text)
        self.assertIn("200 bots that build through it see edits after 1.5 times as long (p99).", text)

    def test_ids_are_unique_and_links_have_targets(self):
        self.assertEqual(len(self.page.ids), len(set(self.page.ids)))
        for link in self.page.links:
            if link.startswith("#"):
                self.assertIn(link[1:], self.page.ids)
        self.assertEqual(self.page.open, [])

    def test_the_drawings_follow_the_colours_of_the_page(self):
        drawings = re.findall(r"<svg.*?</svg>", self.text, re.S)
        self.assertGreater(len(drawings), 30)
        defined = set(re.findall(r"--([\w-]+):", colour_css()))
        for drawing in drawings:
            ElementTree.fromstring(drawing)
            self.assertTrue(set(re.findall(r"var\(--([\w-]+)", drawing)) <= defined)
            self.assertIsNone(re.search(r"(?:fill|stroke): ?#[0-9a-f]{6}", drawing))
        self.assertIn("prefers-color-scheme:dark", self.text)
        self.assertIn("@media print", self.text)

    def test_the_first_screen_has_the_verdict_and_what_speaks_against_it(self):
        start = self.text[: self.text.index('id="answers"')]
        self.assertIn("takes 2 times as long over the 2 scenarios of the thesis that have quads", start)
        self.assertIn("What speaks against it", start)
        self.assertIn("in the real world in 0.9 times the time of ours", start)
        self.assertIn("noise 0.667", start)
        self.assertIn("The frames were drawn by software", start)
        self.assertIn("The chunk in the middle of scenario 1 has no quads", start)
        self.assertIn("Fastest without merging faces", self.text)

    def test_the_summary_has_the_same_verdict(self):
        summary = (self.folder / "summary.md").read_text(encoding="utf-8")
        self.assertIn("| ours: RDM from runs | 1 | 1 |", summary)
        self.assertIn("What speaks against it:\n- ", summary)
        self.assertIn("Sample CPU", summary)


class OtherPages(unittest.TestCase):
    def setUp(self):
        drawing = without_drawing()
        drawing.start()
        self.addCleanup(drawing.stop)

    def test_a_page_without_results_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            write_page(folder, list(STEPS.values()), thesis())
            text, _ = page_of(folder)
            self.assertIn("Nothing was measured yet.", text)
            self.assertEqual((Path(folder) / "summary.md").read_text(), "")

    def test_a_broken_result_is_named_at_its_figure(self):
        with tempfile.TemporaryDirectory() as folder:
            write_report(folder, only=("meshers", "edits"))
            (Path(folder) / "data/edits.json").write_text("{}")
            evidence = write_page(folder, list(STEPS.values()), thesis())
            self.assertIn("edits.json: the field format is missing", evidence.errors()[0])
            text, _ = page_of(folder)
            self.assertIn("edits.json: the field format is missing", text[text.index('id="stacks"') :])
            self.assertFalse((Path(folder) / "csv/stacks.csv").exists())

    def test_the_results_of_two_machines_are_both_shown(self):
        other = MACHINE.__class__("Other CPU", 64, "g++ 12.2.0", "0123abcd", "NEON")
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as copied:
            write_report(folder)
            write_report(copied, other, only=("meshers",))
            caves = {"rows": mesh_rows("caves", ["a"], {"rdm": 3000, "decode_binary": 2000})}
            write_result(Path(copied) / "data", step_result("landscapes", caves, other, quick=True))
            (Path(copied) / "data/adversaries.json").write_text("{}")
            (Path(copied) / "data").rename(Path(folder) / "data/other")
            (Path(folder) / "data/broken").mkdir()
            (Path(folder) / "data/broken/meshers.json").write_text("{")
            evidence = write_page(folder, list(STEPS.values()), thesis())
            text, _ = page_of(folder)
            self.assertEqual(len(evidence.errors()), 2)
            for file in ("broken/meshers.json", "other/adversaries.json"):
                self.assertTrue(any(file in error for error in evidence.errors()), file)
            first = text[: text.index('id="answers"')]
            self.assertIn("In data/other: The result of the step adversaries cannot be used", first)
            self.assertIn("In data/other: The step landscapes was measured differently from the rest", first)
            self.assertIn("In data/broken: The result of the step meshers cannot be used", first)
            self.assertIn("Other CPU: A program that has the grid and its mask ready meshes in the scenarios", first)
            self.assertIn("contains 1: caves 0.667", first)
            self.assertIn("moves between machines: Sample CPU 2; Other CPU 2", text)
            self.assertIn("Also measured on: Other CPU", text)
            with open(Path(folder) / "csv/verdict.csv", encoding="utf-8") as lines:
                self.assertEqual({r["machine"] for r in csv.DictReader(lines)}, {"Sample CPU", "Other CPU"})
