"""Numbers as readers see them."""
import math


def number_text(value):
    """Returns three significant digits, with commas between thousands: 0.31, 4.2, 63, 1,940.

    An infinite value is what never happened; NaN was not measured.
    """
    if value == math.inf:
        return "never"
    if not math.isfinite(value):
        return "–"
    size = abs(value)
    if size == 0:
        return "0"
    if size >= 100:
        return f"{value:,.0f}"
    digits = max(0, 2 - math.floor(math.log10(size)))
    text = f"{value:.{min(digits, 9)}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def count_text(value):
    return f"{value:,.0f}" if math.isfinite(value) else "–"


def time_text(ns):
    """Returns a time with its unit."""
    for unit, name in ((1e9, "s"), (1e6, "ms"), (1e3, "µs")):
        if ns >= unit:
            return f"{number_text(ns / unit)} {name}"
    return f"{number_text(ns)} ns"


def interval_text(interval, unit=""):
    """Returns "2.1 (1.6 to 2.8)", or the value alone if it has no error."""
    tail = f" {unit}" if unit else ""
    if not interval.is_known or interval.low == interval.high:
        return number_text(interval.middle) + tail
    return f"{number_text(interval.middle)} ({number_text(interval.low)} to {number_text(interval.high)}){tail}"


def list_text(items):
    items = [str(i) for i in items]
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}" if items else "none"
