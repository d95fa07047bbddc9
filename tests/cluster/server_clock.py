"""The wall clock of a server of the test, which can be set off while the server runs.

libfaketime stands between the program and the C library. It reads the difference from a file whenever the
program reads the clock. The clocks that measure durations stay as they are.
"""
import os
import pathlib

OFF_MAX_S = 6 * 3600


def library():
    """Returns the path of libfaketime, or None if it is not installed."""
    found = sorted(pathlib.Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))
    return found[0] if found else None


class ServerClock:
    def __init__(self, file):
        self.file = file
        self.library = library()

    def set_off(self, seconds):
        """Sets the clock to the time of the machine and `seconds`, which may be negative."""
        new = self.file.with_suffix(".new")
        new.write_text(f"{seconds:+.3f}\n")
        os.replace(new, self.file)

    def environment(self):
        """Returns the variables with which a program takes its time from this clock."""
        if self.library is None:
            return dict(os.environ)
        return os.environ | {"LD_PRELOAD": str(self.library), "FAKETIME_TIMESTAMP_FILE": str(self.file),
                             "FAKETIME_NO_CACHE": "1", "FAKETIME_DONT_FAKE_MONOTONIC": "1"}
