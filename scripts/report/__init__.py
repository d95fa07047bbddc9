"""The evaluation report: runs the benchmarks, draws figures, and writes one page (docs/reproduce.md)."""
