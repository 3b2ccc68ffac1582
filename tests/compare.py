"""Compares two databases of the same study, row by row and bit by bit: python3 tests/compare.py BEFORE.db AFTER.db

Reads the views and tables of the contract, so that the databases may be of different versions; columns that only one of
them has are left out and named. Averages may differ by rounding: in early versions they are views, which the SQLite of
whoever reads them sums in its own way. Exits with 1 where a row differs.
"""

import sqlite3
import sys

VIEWS = {
    "sample": "sample_id",
    "optimum": "sample_id, design, pmv_min, pmv_max",
    "annual_average": "design, pmv_min, pmv_max",
    "monthly_average": "design, pmv_min, pmv_max, month",
    "simulation": "mission, design, pmv_min, pmv_max, controller",
    "simulation_annual": "design, pmv_min, pmv_max, controller",
    "excluded_segment": "mission, segment",
}
# Ids that a database gives as it likes.
OWN = {"design_id", "window_id", "run_id", "row_check"}


AVERAGES = {"annual_average", "monthly_average", "simulation_annual"}


def same(view, before, after):
    if view not in AVERAGES:
        return before == after
    close = lambda a, b: isinstance(a, float) and isinstance(b, float) and abs(a - b) <= 1e-12 * max(1.0, abs(a))
    return all(a == b or close(a, b) for a, b in zip(before, after))


def columns(database, view):
    return [row[1] for row in database.execute(f"PRAGMA table_info({view})") if row[1] not in OWN]


def main():
    databases = [sqlite3.connect(f"file:{path}?mode=ro", uri=True) for path in sys.argv[1:3]]
    different = 0
    for view, order in VIEWS.items():
        names = [columns(database, view) for database in databases]
        shared = [name for name in names[0] if name in names[1]]
        sql = f"SELECT {', '.join(shared)} FROM {view} ORDER BY {order}"
        before, after = (database.execute(sql).fetchall() for database in databases)
        differing = [pair for pair in zip(before, after) if not same(view, *pair)]
        count = len(differing) + abs(len(before) - len(after))
        different += count
        alone = sorted(set(names[0]) ^ set(names[1]))
        note = f", in one of them only: {', '.join(alone)}" if alone else ""
        print(f"{view}: {len(before)} and {len(after)} rows, {count} differ{note}")
        for pair in differing[:1]:
            print(f"  {pair[0]}\n  {pair[1]}")
    sys.exit(1 if different else 0)


main()
