"""What an export holds, beside what SQLite says: every value of every table, by DuckDB, pandas, polars and PyArrow.

    exports.py DATABASE PARQUET_FOLDER CSV_FOLDER

Printed is a line for each table and tool: table, tool, rows, and the first difference, empty where there is none.
"""

import csv
import json
import pathlib
import sqlite3
import sys

import duckdb
import pandas
import polars
import pyarrow.parquet

TYPES = {"integer": "BIGINT", "number": "DOUBLE", "string": "VARCHAR"}
FRAMES = {"integer": "Int64", "number": "float64", "string": "string"}
SERIES = {"integer": polars.Int64, "number": polars.Float64, "string": polars.String}


def plain(value):
    return None if value is None or value is pandas.NA or value != value else value


def difference(rows, others):
    if len(rows) != len(others):
        return f"{len(others)} rows instead of {len(rows)}"
    for row, other in zip(sorted(rows, key=repr), sorted(others, key=repr)):
        if repr(row) != repr(other):
            return f"{other} instead of {row}"
    return ""


def kinds(schema, found):
    """The first column that is of another type than the package says."""
    for field in schema:
        if not field["partition"] and found[field["name"]] != field["expected"]:
            return f"{field['name']} is {found[field['name']]}"
    return ""


def by_duckdb(folder, resource, schema, names, text):
    files = [str(folder / path) for path in resource["path"]]
    if resource["format"] == "parquet":
        source = f"read_parquet({files}, hive_partitioning=true, hive_types_autocast=false)"
    else:
        columns = {f["name"]: TYPES[f["type"]] for f in schema if not f["partition"]}
        source = f"read_csv({files}, hive_partitioning=true, hive_types_autocast=false, header=true, columns={columns}, nullstr='', allow_quoted_nulls=false)"
    cursor = duckdb.connect().execute(f"SELECT {names} FROM {source}")
    found = {c[0]: str(c[1]) for c in cursor.description}
    wrong = kinds([{**f, "expected": TYPES[f["type"]]} for f in schema], found)
    return wrong or difference(text, cursor.fetchall())


def by_polars(folder, resource, schema, names, text):
    top = folder / resource["name"]
    if resource["format"] == "parquet":
        frame = polars.scan_parquet(top, hive_partitioning=True).collect()
        wrong = kinds([{**f, "expected": SERIES[f["type"]]} for f in schema], frame.schema)
        if wrong:
            return wrong
    else:
        kept = {f["name"]: SERIES[f["type"]] for f in schema if not f["partition"]}
        parts = []
        for path in resource["path"]:
            part = polars.read_csv(folder / path, schema=kept)
            for folded in [p for p in path.split("/") if "=" in p]:
                name, value = folded.split("=")
                part = part.with_columns(polars.lit(value).alias(name))
            parts.append(part)
        frame = polars.concat(parts)
    return difference(text, frame.select([f["name"] for f in schema]).rows())


def by_pandas(folder, resource, schema, names, text):
    order = [f["name"] for f in schema]
    if resource["format"] == "parquet":
        frame = pandas.read_parquet(folder / resource["name"])
    else:
        kept = {f["name"]: FRAMES[f["type"]] for f in schema if not f["partition"]}
        parts = []
        for path in resource["path"]:
            part = pandas.read_csv(folder / path, dtype=kept, keep_default_na=False, na_values=[""], float_precision="round_trip")
            for folded in [p for p in path.split("/") if "=" in p]:
                name, value = folded.split("=")
                part[name] = value
            parts.append(part)
        frame = pandas.concat(parts)
    whole = [f["type"] == "integer" for f in schema]
    if resource["format"] == "csv":
        # An empty text is quoted, what is missing is not; pandas takes both for missing.
        text = [[None if v == "" else v for v in row] for row in text]
        text = [tuple(row) for row in text]
    cells = []
    for name, is_whole in zip(order, whole):
        values = [plain(v) for v in frame[name].tolist()]
        cells.append([int(v) if is_whole and v is not None else v for v in values])
    return difference(text, list(zip(*cells)))


def words(folder, resource, schema):
    """What the fields of a file say, as PyArrow reads it."""
    if resource["format"] != "parquet":
        return ""
    path = folder / resource["path"][0]
    read, about = pyarrow.parquet.read_schema(path), pyarrow.parquet.read_metadata(path).metadata
    if about[b"busclimate:table"].decode() != resource["name"] or len(about[b"busclimate:study_hash"]) != 64:
        return f"{about}"
    for field in schema:
        if field["partition"]:
            continue
        said = {k.decode(): v.decode() for k, v in (read.field(field["name"]).metadata or {}).items()}
        if (said.get("unit"), said.get("description")) != (field["unit"], field["description"]):
            return f"{field['name']} says {said}"
    return ""


def main():
    database, *folders = sys.argv[1:]
    connection = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    out = csv.writer(sys.stdout)
    for folder in map(pathlib.Path, folders):
        package = json.loads((folder / "datapackage.json").read_text())
        for resource in package["resources"]:
            schema = resource["schema"]["fields"]
            names = ", ".join(f["name"] for f in schema)
            text = connection.execute(f"SELECT {names} FROM {resource['name']}").fetchall()
            for tool, read in {"duckdb": by_duckdb, "polars": by_polars, "pandas": by_pandas}.items():
                try:
                    wrong = read(folder, resource, schema, names, text)
                except Exception as error:  # noqa: BLE001 - whatever a tool says is what its user sees
                    wrong = f"{type(error).__name__}: {error}"
                out.writerow([f"{resource['format']} {resource['name']}", tool, len(text), wrong.replace(",", ";").replace("\n", " ")[:300]])
            out.writerow([f"{resource['format']} {resource['name']}", "words", len(text), words(folder, resource, schema)])


main()
