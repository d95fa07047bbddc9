import math
import unittest

from report.comparison import compare, names_of
from report.rows import Rows
from report.statistics import (
    Interval,
    exactly,
    geometric_mean_interval,
    mean_interval,
    place_text,
    places,
    ratio_of,
    sum_ratio_interval,
    with_quads,
)
from report.verdict import best_of

from .sample_data import mesh_row, mesh_rows


class Names(unittest.TestCase):
    def test_a_volume_has_the_name_of_its_part_unless_parts_repeat(self):
        self.assertEqual(names_of([("w", "6", 32, "xyz"), ("w", "20", 32, "yxz")]), ["6", "20"])
        self.assertEqual(
            names_of([("a", "6", 32, "xyz"), ("b", "6", 32, "yxz")]), ["a 6 xyz", "b 6 yxz"]
        )


class Means(unittest.TestCase):
    def test_a_chunk_without_quads_is_in_no_mean(self):
        rows = Rows(
            [
                mesh_row("scenarios", "1", "rdm", 10, quads=0),
                mesh_row("scenarios", "1", "decode_binary", 10_000, quads=0),
                # The thesis' RLE RDM draws hidden faces, also of a buried chunk.
                mesh_row("scenarios", "1", "rle_rdm", 10_000, quads=50),
                *mesh_rows("scenarios", ["2", "3"], {"rdm": 1000, "decode_binary": 2000}),
            ]
        )
        self.assertEqual({r["part"] for r in with_quads(rows)}, {"2", "3"})
        found = compare(rows, "decode_binary")
        self.assertEqual(list(found.volumes), ["2", "3"])
        self.assertAlmostEqual(found.gain.middle, 2)
        self.assertAlmostEqual(found.sums.middle, 2)
        self.assertEqual(list(compare(rows, "rle_rdm").volumes), ["2", "3"])

    def test_a_polygon_mesher_without_quads_does_not_make_a_chunk_empty(self):
        rows = [mesh_row("scenarios", "2", "rdm", 10), mesh_row("scenarios", "2", "monotone", 10, quads=0)]
        self.assertEqual(len(with_quads(rows)), 2)

    def test_the_geometric_mean_and_the_ratio_of_sums_differ(self):
        rows = Rows(
            [
                mesh_row("w", "a", "rdm", 1),
                mesh_row("w", "a", "x", 4),
                mesh_row("w", "b", "rdm", 100),
                mesh_row("w", "b", "x", 100),
            ]
        )
        found = compare(rows, "x")
        self.assertAlmostEqual(found.gain.middle, 2)
        self.assertAlmostEqual(found.sums.middle, 104 / 101)
        self.assertEqual((found.faster, found.slower, found.undecided), (["a"], [], ["b"]))

    def test_volumes_of_different_worlds_edges_and_orders_are_different(self):
        rows = [
            mesh_row(world, "a", key, ns * factor, edge=edge) | {"order": order}
            for world, edge, order, factor in (("v", 32, "xyz", 2), ("w", 32, "xyz", 3), ("w", 16, "zyx", 4))
            for key, ns in (("rdm", 1), ("x", factor))
        ]
        found = compare(Rows(rows), "x")
        self.assertEqual(
            {name: round(ratio.middle) for name, ratio in found.volumes.items()},
            {"v a 32 xyz": 2, "w a 32 xyz": 3, "w a 16 zyx": 4},
        )
        self.assertAlmostEqual(found.sums.middle, (4 + 9 + 16) / (2 + 3 + 4))
        self.assertEqual(list(compare(Rows(rows).where(world="v"), "x").volumes), ["a"])

    def test_nothing_to_compare_is_none(self):
        self.assertIsNone(compare(Rows(), "decode_binary"))
        self.assertIsNone(compare(Rows([mesh_row("w", "a", "rdm", 1)]), "decode_binary"))


class Intervals(unittest.TestCase):
    def test_an_interval_contains_its_mean_and_is_the_same_every_time(self):
        values = [1, 2, 3, 4, 10]
        one = mean_interval(values)
        self.assertAlmostEqual(one.middle, 4)
        self.assertLess(one.low, 4)
        self.assertGreater(one.high, 4)
        self.assertEqual(one, mean_interval(values))
        self.assertGreaterEqual(one.low, 1)
        self.assertLessEqual(one.high, 10)

    def test_equal_values_have_no_error(self):
        one = geometric_mean_interval([2, 2, 2])
        self.assertAlmostEqual(one.low, 2)
        self.assertAlmostEqual(one.high, 2)

    def test_about_95_of_100_intervals_contain_the_mean_of_the_population(self):
        import random

        draw = random.Random(1)
        hits = sum(
            one.low <= 0.5 <= one.high
            for one in (mean_interval([draw.random() for _ in range(30)]) for _ in range(200))
        )
        self.assertGreater(hits, 180)
        self.assertLess(hits, 200)

    def test_unknown_values_are_left_out(self):
        self.assertAlmostEqual(mean_interval([1, math.nan, 3]).middle, 2)
        self.assertFalse(mean_interval([]).is_measured)
        self.assertFalse(geometric_mean_interval([0, -1]).is_measured)
        self.assertFalse(sum_ratio_interval([math.nan], [1]).is_measured)

    def test_a_ratio_takes_the_widest_ends(self):
        self.assertEqual(ratio_of(Interval(8, 10, 12), Interval(1, 2, 4)), Interval(2, 5, 12))
        self.assertFalse(ratio_of(exactly(1), exactly(math.nan)).is_measured)


class Ranks(unittest.TestCase):
    def test_overlapping_intervals_are_not_ranked(self):
        found = places(
            [Interval(1, 2, 3), Interval(2.5, 4, 5), Interval(6, 7, 8), Interval(math.nan, math.nan, math.nan)]
        )
        self.assertEqual(found, [(1, 2), (1, 2), (3, 3), None])
        self.assertEqual([place_text(p) for p in found], ["1–2", "1–2", "3", "–"])

    def test_the_best_are_all_that_overlap_the_least(self):
        best, rest = best_of(
            [("a", Interval(1, 2, 3), 2), ("b", Interval(2.5, 4, 5), 4), ("c", Interval(6, 7, 8), 7)], str
        )
        self.assertEqual(best, "a: 2 and b: 4 (intervals overlap)")
        self.assertEqual(rest, "c: 7")
        self.assertEqual(best_of([("a", exactly(1), 1), ("b", exactly(2), 2)], str), ("a: 1", "b: 2"))
        self.assertIsNone(best_of([("a", exactly(math.nan), math.nan)], str))
