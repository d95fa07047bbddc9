"""The figure of a siege in which edits never arrive."""
import unittest

from report.figures.network import _siege
from report.rows import Rows


class _Results:
    def rows(self, _step):
        return Rows(
            [
                {"profile": "siege", "case": case, "figure": "p99_ms", "value": value}
                for case, value in (("quiet", 3.0), ("flood", "inf"))
            ]
        )


class _Evidence:
    here = _Results()


class SiegeTest(unittest.TestCase):
    def test_edits_that_never_arrive_are_the_worst(self):
        self.assertIn("(flood), edits of builders never arrive", _siege(_Evidence()).sentence)


if __name__ == "__main__":
    unittest.main()
