"""Means and intervals. An interval is a measured value with the range that it may also have."""
import math
from dataclasses import dataclass

import numpy

RESAMPLES = 2000
LEVEL = 0.95
# Meshers that draw exactly the exposed faces: if one of them draws nothing, the chunk is empty.
EXACT_MESHERS = ("rdm", "decode_binary", "culled")


@dataclass(frozen=True)
class Interval:
    low: float
    middle: float
    high: float

    def overlaps(self, other):
        return self.low <= other.high and other.low <= self.high

    def scaled(self, factor):
        return Interval(self.low * factor, self.middle * factor, self.high * factor)

    @property
    def is_known(self):
        return all(math.isfinite(v) for v in (self.low, self.middle, self.high))


UNKNOWN = Interval(math.nan, math.nan, math.nan)


def exactly(value):
    """Returns the interval of a count, which has no error."""
    return Interval(value, value, value)


def known(values):
    return [v for v in values if math.isfinite(v)]


def mean(values):
    """Returns the mean of the known values; NaN if there are none."""
    values = known(values)
    return sum(values) / len(values) if values else math.nan


def geometric_mean(values):
    """Returns the geometric mean of the known positive values; NaN if there are none."""
    logs = [math.log(v) for v in known(values) if v > 0]
    return math.exp(sum(logs) / len(logs)) if logs else math.nan


def _resampled(count):
    """Returns the indices of all resamples. They are the same on every call."""
    return numpy.random.default_rng(1).integers(0, count, size=(RESAMPLES, count))


def _percentiles(samples):
    tail = 100 * (1 - LEVEL) / 2
    low, high = numpy.percentile(samples, [tail, 100 - tail])
    return float(low), float(high)


def mean_interval(values):
    """Returns the mean with its bootstrap interval over the values."""
    values = numpy.array(known(values))
    if not len(values):
        return UNKNOWN
    low, high = _percentiles(values[_resampled(len(values))].mean(axis=1))
    return Interval(low, float(values.mean()), high)


def geometric_mean_interval(values):
    """Returns the geometric mean with its bootstrap interval over the values."""
    logs = mean_interval([math.log(v) for v in known(values) if v > 0])
    return Interval(*(math.exp(v) for v in (logs.low, logs.middle, logs.high))) if logs.is_known else UNKNOWN


def sum_ratio_interval(numerators, denominators):
    """Returns the ratio of two sums over the same volumes with its bootstrap interval."""
    pairs = [(a, b) for a, b in zip(numerators, denominators) if math.isfinite(a) and math.isfinite(b)]
    if not pairs:
        return UNKNOWN
    a, b = numpy.array(pairs).T
    index = _resampled(len(pairs))
    low, high = _percentiles(a[index].sum(axis=1) / b[index].sum(axis=1))
    return Interval(low, float(a.sum() / b.sum()), high)


def repetitions_of(row, unit=1000):
    """Returns the median of a cell with the least and the 90th percentile of its repetitions, in µs."""
    return Interval(row["min_ns"] / unit, row["median_ns"] / unit, row["p90_ns"] / unit)


def ratio_of(numerator, denominator):
    """Returns the ratio of two intervals: the widest that their ends allow."""
    if not (numerator.is_known and denominator.is_known) or denominator.low <= 0:
        return UNKNOWN
    return Interval(
        numerator.low / denominator.high, numerator.middle / denominator.middle, numerator.high / denominator.low
    )


def empty_volumes(rows):
    """Returns the volumes (world, part, edge) without quads. They belong in no mean."""
    return {(r["world"], r["part"], r["edge"]) for r in rows if r["mesher"] in EXACT_MESHERS and r["quads"] == 0}


def with_quads(rows):
    """Returns the rows of volumes that have quads."""
    empty = empty_volumes(rows)
    return [r for r in rows if (r["world"], r["part"], r["edge"]) not in empty]


def places(intervals):
    """Returns the first and the last place that each interval may have; the least value is first.

    Intervals that overlap are not ranked against each other. An unknown interval has no place (None).
    """
    out = []
    for one in intervals:
        others = [o for o in intervals if o is not one and o.is_known]
        better = sum(o.high < one.low for o in others)
        worse = sum(o.low > one.high for o in others)
        out.append((1 + better, 1 + len(others) - worse) if one.is_known else None)
    return out


def place_text(place):
    if place is None:
        return "–"
    first, last = place
    return str(first) if first == last else f"{first}–{last}"
