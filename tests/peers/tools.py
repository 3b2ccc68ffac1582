"""What analysts' tools read from a database, beside what SQLite says: every value and every type.

    tools.py DATABASE WORDS

Every view, and every table that is documented, goes through DuckDB, pandas and polars; Datasette answers filters over HTTP. WORDS is what
`busclimate dictionary --format json` prints. Printed is a line for each object and tool: name, tool, rows, columns, and the first
difference, empty where there is none.
"""

import csv
import json
import pathlib
import socket
import sqlite3
import subprocess
import sys
import time
import urllib.parse
import urllib.request

import duckdb
import duckdb_extension_sqlite_scanner
import pandas
import polars

KINDS = {int: "BIGINT", float: "DOUBLE", str: "VARCHAR"}


def names(words):
    """Every table and view that others build on."""
    return [r["name"] for r in json.loads(pathlib.Path(words).read_text())["relations"] if not r["internal"]]


def rows_of(cursor):
    """Column names and rows in an order that no tool chooses."""
    columns = [c[0] for c in cursor.description]
    return columns, sorted(cursor.fetchall(), key=repr)


def kinds(rows, place):
    return {type(r[place]) for r in rows if r[place] is not None}


def difference(columns, rows, other_columns, others):
    if columns != other_columns:
        return f"columns {other_columns}"
    if len(rows) != len(others):
        return f"{len(others)} rows instead of {len(rows)}"
    for row, other in zip(rows, sorted(others, key=repr)):
        if repr(row) != repr(other):
            return f"{other} instead of {row}"
    return ""


def by_duckdb(database):
    connection = duckdb.connect()
    extension = next(pathlib.Path(duckdb_extension_sqlite_scanner.__file__).parent.rglob("*.duckdb_extension"))
    connection.execute(f"LOAD '{extension}'")
    connection.execute(f"ATTACH '{database}' AS study (TYPE sqlite, READ_ONLY)")

    def read(name, columns, rows):
        cursor = connection.execute(f"SELECT * FROM study.{name}")
        types = [str(c[1]) for c in cursor.description]
        for place, (column, kind) in enumerate(zip(columns, types)):
            seen = kinds(rows, place)
            if kind not in KINDS.values() or any(KINDS[k] != kind for k in seen):
                return f"{column} is {kind}, SQLite has {seen}"
        return difference(columns, rows, [c[0] for c in cursor.description], cursor.fetchall())

    return read


def plain(value):
    """A cell of a frame as SQLite gives it."""
    if value is None or value != value:
        return None
    return value.item() if hasattr(value, "item") else value


def by_pandas(connection):
    def read(name, columns, rows):
        frame = pandas.read_sql_query(f"SELECT * FROM {name}", connection)
        for place, column in enumerate(columns):
            seen = kinds(rows, place)
            # A column of whole numbers with gaps is one of floating ones to pandas.
            if seen <= {int, float} and seen and frame[column].dtype.kind not in "if":
                return f"{column} is {frame[column].dtype}"
        gaps = [any(r[p] is None for r in rows) and kinds(rows, p) == {int} for p in range(len(columns))]
        cells = [[plain(v) for v in frame[c].tolist()] for c in columns]
        cells = [[int(v) if g and v is not None else v for v in c] for c, g in zip(cells, gaps)]
        return difference(columns, rows, list(frame.columns), list(zip(*cells)))

    return read


def by_polars(connection):
    wanted = {int: polars.Int64, float: polars.Float64, str: polars.String}

    def read(name, columns, rows):
        frame = polars.read_database(f"SELECT * FROM {name}", connection, infer_schema_length=None)
        for place, column in enumerate(columns):
            for kind in kinds(rows, place):
                if frame.schema[column] != wanted[kind]:
                    return f"{column} is {frame.schema[column]}, SQLite has {kind}"
        return difference(columns, rows, frame.columns, frame.rows())

    return read


# What somebody types into a filter of a page: object, column, comparison, value.
FILTERS = [
    ("sample", "ambient_temperature_c", "lt", "-2"),
    ("sample", "ambient_temperature_c", "gt", "19.5"),
    ("sample", "weight", "gt", "0.005"),
    ("sample", "month", "exact", "7"),
    ("optimum", "hvac_power_w", "gte", "6000"),
    ("optimum", "cabin_temperature_c", "lt", "15.5"),
    ("optimum", "status", "exact", "solved"),
    ("optimum", "pmv_limit", "exact", "0.3"),
    ("simulation", "ambient_temperature_c", "lte", "-1.5"),
    ("control", "ambient_temperature_c", "lte", "-1.5"),
    ("month_weight", "days", "exact", "31"),
    ("limit_share", "lower_weight", "gt", "0.3"),
    ("annual_average", "pmv_limit", "exact", "0.3"),
]
SIGNS = {"lt": "<", "gt": ">", "gte": ">=", "lte": "<=", "exact": "="}


def by_datasette(database, connection):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = str(free.getsockname()[1])
    # No proxy stands between a machine and itself.
    urlopen = urllib.request.build_opener(urllib.request.ProxyHandler({})).open
    arguments = [sys.executable, "-m", "datasette", "serve", "-i", database, "--port", port]
    server = subprocess.Popen([*arguments, "--setting", "sql_time_limit_ms", "1000"], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    base = f"http://127.0.0.1:{port}/{pathlib.Path(database).stem}"
    try:
        for _ in range(100):
            try:
                urlopen(f"http://127.0.0.1:{port}/-/versions.json", timeout=5).read()
                break
            except OSError:
                time.sleep(0.1)
        for name, column, comparison, value in FILTERS:
            query = urllib.parse.urlencode({f"{column}__{comparison}": value, "_size": "max", "_nofacet": "1"})
            page = json.load(urlopen(f"{base}/{name}.json?{query}", timeout=20))
            count = page["filtered_table_rows_count"]
            text = repr(value) if value.isalpha() else value
            meant = connection.execute(f"SELECT count(*) FROM {name} WHERE {column} {SIGNS[comparison]} {text}").fetchone()[0]
            wrong = "" if count == meant else f"{count} rows instead of {meant}"
            yield f"{name} where {column} {comparison} {value}", meant, wrong
    finally:
        server.terminate()
        server.wait()


def main():
    database, words = sys.argv[1:]
    connection = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    out = csv.writer(sys.stdout)
    tools = {"duckdb": by_duckdb(database), "pandas": by_pandas(connection), "polars": by_polars(connection)}
    for name in names(words):
        columns, rows = rows_of(connection.execute(f"SELECT * FROM {name}"))
        for tool, read in tools.items():
            try:
                wrong = read(name, columns, rows)
            except Exception as error:  # noqa: BLE001 - whatever a tool says is what its user sees
                wrong = f"{type(error).__name__}: {error}"
            out.writerow([name, tool, len(rows), len(columns), wrong.replace(",", ";").replace("\n", " ")[:300]])
    for question, count, wrong in by_datasette(database, connection):
        out.writerow([question, "datasette", count, 1, wrong])


main()
