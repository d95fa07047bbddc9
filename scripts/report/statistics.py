"""Means and intervals. An interval is a measured value with the range that it may also have.

NaN is a value that was not measured: means leave it out. An infinite value was measured and is, for
example, the time of something that never happened: it makes a mean infinite.
"""
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
    def is_measured(self):
        """Returns True if no value is NaN."""
        return not any(math.isnan(v) for v in (self.low, self.middle, self.high))

    @property
    def is_finite(self):
        return all(math.isfinite(v) for v in (self.low, self.middle, self.high))


UNKNOWN = Interval(math.nan, math.nan, math.nan)


def exactly(value):
    """Returns the interval of a count, which has no error."""
    return Interval(value, value, value)


def measured(values):
    """Returns the values without NaN."""
    return [v for v in values if not math.isnan(v)]


def mean(values):
    """Returns the mean of the measured values; NaN if there are none."""
    values = measured(values)
    return sum(values) / len(values) if values else math.nan


def _logs(values):
    """Returns the logarithms of the measured values; none if one of them is not positive and so has
    no logarithm.
    """
    values = measured(values)
    return [math.log(v) for v in values] if all(v > 0 for v in values) else []


def geometric_mean(values):
    """Returns the geometric mean of the measured values; NaN if there are none or one is not
    positive.
    """
    logs = _logs(values)
    return math.exp(sum(logs) / len(logs)) if logs else math.nan


def _resampled(count):
    """Returns the indices of all resamples. They are the same on every call."""
    return numpy.random.default_rng(1).integers(0, count, size=(RESAMPLES, count))


def _percentiles(samples):
    tail = 100 * (1 - LEVEL) / 2
    low, high = numpy.percentile(samples, [tail, 100 - tail])
    return float(low), float(high)


def mean_interval(values):
    """Returns the mean of the measured values with its bootstrap interval.

    Without values it is unknown.
    """
    values = numpy.array(measured(values))
    if not len(values):
        return UNKNOWN
    if not numpy.isfinite(values).all():
        return exactly(float(values.mean()))
    low, high = _percentiles(values[_resampled(len(values))].mean(axis=1))
    return Interval(low, float(values.mean()), high)


def geometric_mean_interval(values):
    """Returns the geometric mean of the measured values with its bootstrap interval.

    It is unknown if there are no values or one is not positive.
    """
    logs = mean_interval(_logs(values))
    return Interval(*(math.exp(v) for v in (logs.low, logs.middle, logs.high)))


def sum_ratio_interval(numerators, denominators):
    """Returns the ratio of two sums over the same volumes with its bootstrap interval.

    A volume without one of the two is left out. The ratio is unknown if no volume is left or a
    value is infinite.
    """
    pairs = [(a, b) for a, b in zip(numerators, denominators) if not (math.isnan(a) or math.isnan(b))]
    if not pairs or not numpy.isfinite(pairs).all():
        return UNKNOWN
    a, b = numpy.array(pairs).T
    index = _resampled(len(pairs))
    low, high = _percentiles(a[index].sum(axis=1) / b[index].sum(axis=1))
    return Interval(low, float(a.sum() / b.sum()), high)


def repetitions_of(row):
    """Returns the median of a cell with the least and the 90th percentile of its repetitions, in µs."""
    return Interval(row["min_ns"] / 1000, row["median_ns"] / 1000, row["p90_ns"] / 1000)


def ratio_of(numerator, denominator):
    """Returns the ratio of two intervals: the widest that their ends allow.

    It is unknown if an end is not finite.
    """
    if not (numerator.is_finite and denominator.is_finite) or denominator.low <= 0:
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

    Intervals that overlap are not ranked against each other. An interval that was not measured has
    no place (None).
    """
    out = []
    for one in intervals:
        others = [o for o in intervals if o is not one and o.is_measured]
        better = sum(o.high < one.low for o in others)
        worse = sum(o.low > one.high for o in others)
        out.append((1 + better, 1 + len(others) - worse) if one.is_measured else None)
    return out


def place_text(place):
    if place is None:
        return "–"
    first, last = place
    return str(first) if first == last else f"{first}–{last}"
