"""Infinite values: times of what never happened. They are in every mean, sentence, chart and CSV."""
import math
import tempfile
import unittest
from pathlib import Path

from report.charts import Axis, Bar, Part, Series, bars, dots, lines, points, stacks
from report.evidence import Evidence
from report.figure import Figure, csv_of
from report.figures.meshers import MesherTotals, _t_junctions, _time, _triangles
from report.figures.network import _crowds, _latency, _siege, _transfers
from report.results import write_result
from report.rows import Rows
from report.statistics import Interval, exactly, geometric_mean_interval, mean_interval, places, sum_ratio_interval
from report.text import after_text, count_text, interval_text, number_text, quantity_text, time_text
from report.verdict import _answers, best_of

from .sample_data import STEPS, _net, mesh_rows, step_result, thesis, without_drawing

NEVER = exactly(math.inf)


class Means(unittest.TestCase):
    def test_an_infinite_value_makes_the_mean_infinite(self):
        self.assertEqual(mean_interval([math.inf, 2, 2]), NEVER)
        self.assertEqual(geometric_mean_interval([math.inf, 2, 2]), NEVER)
        self.assertEqual(geometric_mean_interval([math.inf, math.nan]), NEVER)

    def test_a_ratio_to_an_infinite_value_makes_the_mean_unknown(self):
        self.assertFalse(geometric_mean_interval([2 / math.inf, 2, 2]).is_measured)
        self.assertFalse(sum_ratio_interval([1, 2], [math.inf, 2]).is_measured)

    def test_an_infinite_value_is_last_and_never_best(self):
        self.assertEqual(places([NEVER, exactly(1)]), [(2, 2), (1, 1)])
        candidates = [("a", NEVER, math.inf), ("b", exactly(1), 1)]
        self.assertEqual(best_of(candidates, number_text), ("b: 1", "a: never"))
        self.assertEqual(best_of(candidates[:1], number_text), ("none completed", ""))


class Texts(unittest.TestCase):
    def test_only_finite_values_have_a_unit(self):
        self.assertEqual([quantity_text(v, "ms") for v in (2, math.inf, math.nan)], ["2 ms", "never", "–"])
        self.assertEqual([time_text(v) for v in (2000, math.inf, math.nan)], ["2 µs", "never", "–"])
        self.assertEqual([after_text(v) for v in (2, math.inf)], ["after 2 ms", "never"])
        self.assertEqual([count_text(v) for v in (2, math.inf, math.nan)], ["2", "never", "–"])
        self.assertEqual(interval_text(Interval(1, 2, math.inf)), "2 (1 to never)")
        self.assertEqual(interval_text(NEVER), "never")

    def test_the_csv_has_infinite_values(self):
        figure = Figure("id", "title", "sentence", (), ["a", "b", "c"], [[math.inf, math.nan, 2.5]])
        self.assertEqual(csv_of(figure), "a,b,c\ninf,,2.5\n")


class Charts(unittest.TestCase):
    def assert_never(self, svg, count=1):
        self.assertEqual(svg.count(">never</text>"), count)

    def test_every_chart_shows_infinite_values(self):
        for log in (False, True):
            axis, one = Axis("ms", log), Series("one", "#000000", [exactly(2), NEVER])
            self.assert_never(dots("a", "a", ["1", "2"], [one], axis))
            self.assert_never(bars("a", "a", [Bar("1", "#000000", exactly(2)), Bar("2", "#000000", NEVER)], axis))
            line = Series("one", "#000000", [(1, exactly(2)), (2, NEVER), (3, exactly(2))])
            self.assert_never(lines("a", "a", [line], axis, axis))
            pair = [Series("one", "#000000", [(exactly(1), exactly(1))]), Series("b", "#111111", [(exactly(1), NEVER)])]
            self.assert_never(points("a", "a", pair, axis, axis))
        self.assertIn(">2 (never)</text>", stacks("a", "a", ["1", "2"], [Part("p", "#000000", [1, math.inf])], axis))

    def test_an_infinite_end_of_an_interval_is_shown(self):
        for value in (Interval(1, 2, math.inf), Interval(1, math.inf, math.inf), NEVER):
            self.assert_never(dots("a", "a", ["1"], [Series("one", "#000000", [value])], Axis("ms", True)))


class Figures(unittest.TestCase):
    def setUp(self):
        drawing = without_drawing()
        drawing.start()
        self.addCleanup(drawing.stop)

    def evidence(self, results):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for step, (profile, cases) in results.items():
            write_result(Path(folder.name) / "data", step_result(step, _net(profile, cases)))
        return Evidence(folder.name, list(STEPS.values()), thesis())

    def transfers(self, form):
        """Returns a loopback on which noise never completes in this form."""
        cases = [
            (f"{w} {f}", "complete_ms", "inf" if (w, f) == ("noise", form) else n)
            for w in ("luanti", "noise")
            for f, n in (("packed", 10), ("dense_zstd", 20), ("dense", 40))
        ]
        return self.evidence({"transfer-loopback": ("loopback", cases)})

    def test_a_transfer_that_never_completes_is_named_and_has_no_ratio(self):
        for form, name in (("dense_zstd", "dense + zstd + binary greedy"), ("packed", "packed runs + RDM")):
            figure = _transfers(self.transfers(form))
            self.assertIn(f"Over loopback these worlds never completed: noise as {name}.", figure.sentence)
            self.assertIn("So there is no ratio for loopback.", figure.sentence)
            self.assertNotIn("loopback 2", figure.sentence)
        sentence = _transfers(self.transfers("none")).sentence
        self.assertIn("loopback 2.", sentence)
        self.assertIn("Over loopback no ratio was measured of terrain, caves and town.", sentence)

    def test_a_way_that_never_completes_is_not_the_best(self):
        (answer,) = _answers(self.transfers("packed"))
        self.assertEqual(answer.best, "dense + zstd + binary greedy: 20 ms")
        self.assertEqual(answer.rest, "dense + binary greedy: 40 ms; packed runs + RDM: never")

    def test_the_largest_crowd_is_shown_also_if_edits_never_arrive(self):
        def crowd(p50, p99):
            cases = [("1000 clients", "seen_p50_ms", p50), ("1000 clients", "seen_p99_ms", p99)]
            small = [("100 clients", "seen_p50_ms", 1), ("100 clients", "seen_p99_ms", 2)]
            return self.evidence({"crowd-1000": ("loopback", cases), "crowd-100": ("loopback", small)})

        figure = _crowds(crowd(5, "inf"))
        self.assertIn("1,000 clients", figure.sentence)
        self.assertIn("after 5 ms (p50), but at least 1 % of the edits never arrived", figure.sentence)
        self.assertIn("At least half of their edits never arrived", _crowds(crowd("inf", "inf")).sentence)

    def test_a_latency_that_is_infinite_has_no_unit(self):
        cases = [("idle", "remote_meshed_p50_ms", "inf"), ("idle", "local_predicted_meshed_p50_ms", 3)]
        sentence = _latency(self.evidence({"latency-loopback": ("loopback", cases)})).sentence
        self.assertIn("On loopback it is meshed after 3 ms", sentence)
        self.assertIn("on loopback it is meshed never", sentence)

    def test_edits_of_a_siege_that_never_arrive_are_the_worst(self):
        cases = [("quiet", "p99_ms", 3.0), ("flood", "p99_ms", "inf")]
        self.assertIn("(flood), edits of builders never arrive", _siege(self.evidence({"siege": ("", cases)})).sentence)

    def test_what_was_not_measured_is_named(self):
        evidence = self.evidence(
            {
                "crowd-1": ("loopback", [("1 clients", "seen_p99_ms", None)]),
                "latency-loopback": ("loopback", [("idle", "x", 1)]),
                "siege": ("", [("quiet", "p50_ms", 1)]),
            }
        )
        self.assertEqual(_crowds(evidence).sentence, "No crowd of two or more clients was measured.")
        self.assertIn("On loopback it is meshed after an unknown time", _latency(evidence).sentence)
        self.assertIn("No latency was measured.", _siege(evidence).sentence)

    def test_a_mesher_that_was_not_measured_is_in_no_ratio(self):
        rows = [r for r in mesh_rows("scenarios", ["2"], {}) if r["mesher"] not in ("optimal_greedy", "mask_binary")]
        totals = MesherTotals(Rows(rows))
        self.assertIn("The least possible number was not measured.", _triangles(totals).sentence)
        self.assertIn("takes a time that was not measured.", _time(totals).sentence)
        self.assertEqual(totals.empty_note(), "Every scenario has quads.")
        self.assertEqual(MesherTotals(Rows()).empty_note(), "")
        for figure in (_triangles(totals), _time(totals), _t_junctions(totals)):
            self.assertNotIn("nan", figure.sentence)
