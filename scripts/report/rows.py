"""Rows: flat rows of a result, selected by the values of their fields."""
import math


def number_of(value):
    """Returns a number; NaN for null and for a text other than "inf"."""
    if isinstance(value, bool) or value is None:
        return math.nan
    if isinstance(value, (int, float)):
        return float(value)
    return math.inf if value == "inf" else math.nan


class Rows:
    def __init__(self, rows=()):
        self._rows = list(rows)

    def __len__(self):
        return len(self._rows)

    def __iter__(self):
        return iter(self._rows)

    def __add__(self, other):
        return Rows([*self._rows, *other])

    def where(self, **wanted):
        """Returns the rows whose fields have these values."""
        return Rows(r for r in self._rows if all(r.get(k) == v for k, v in wanted.items()))

    def number(self, field):
        """Returns a number of the first row; NaN if there is no row or no number."""
        return number_of(self._rows[0].get(field)) if self._rows else math.nan

    def numbers(self, field):
        return [number_of(r.get(field)) for r in self._rows]

    def kinds(self, field):
        """Returns the different values of a field in order of appearance."""
        return list(dict.fromkeys(r.get(field) for r in self._rows))
