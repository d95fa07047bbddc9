"""Numbers as readers see them."""
import math


def number_text(value):
    """Returns three significant digits, with commas between thousands: 0.31, 4.2, 63, 1,940.

    Returns "never" for an infinite value, since a time is infinite if its event never happened.
    Returns "–" for NaN, which was not measured.
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


def quantity_text(value, unit):
    """Returns a number with its unit. "never" and "–" have no unit."""
    return f"{number_text(value)} {unit}" if math.isfinite(value) else number_text(value)


def after_text(ms):
    """Returns "after 4.2 ms"; "never" for an infinite time; "after an unknown time" if it was not
    measured.
    """
    if math.isnan(ms):
        return "after an unknown time"
    return "never" if ms == math.inf else f"after {quantity_text(ms, 'ms')}"


def count_text(value):
    return f"{value:,.0f}" if math.isfinite(value) else number_text(value)


def time_text(ns):
    """Returns a time with its unit."""
    for unit, name in ((1e9, "s"), (1e6, "ms"), (1e3, "µs")):
        if ns >= unit:
            return quantity_text(ns / unit, name)
    return quantity_text(ns, "ns")


def interval_text(interval):
    """Returns "2.1 (1.6 to 2.8)", or the value alone if it has no error."""
    low, middle, high = (number_text(v) for v in (interval.low, interval.middle, interval.high))
    is_alone = math.isnan(interval.low) or math.isnan(interval.high) or interval.low == interval.high
    return middle if is_alone else f"{middle} ({low} to {high})"


def list_text(items):
    items = [str(i) for i in items]
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} and {items[-1]}" if items else "none"
