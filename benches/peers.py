"""busclimate beside other people's programs, each as its own documentation says: python3 benches/peers.py FOLDER PROGRAM

FOLDER holds study.toml and ztbus/*.csv, such as `busclimate demo FOLDER --like metaData.csv` makes; PROGRAM is the release
build. Python has the packages of tests/peers/requirements.txt and the wheel; benchmarks are built with cargo, and their
instructions counted where there is valgrind. Prints a table in Markdown.
"""

import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import casadi
import duckdb
import numpy as np
import pandas as pd
import polars as pl
import pvlib
import pyarrow as pa
import pythermalcomfort
from pythermalcomfort.models import pmv_ppd_iso

import busclimate as bc

folder, program = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
home = pathlib.Path(__file__).resolve().parent.parent
telemetry = str(folder / "ztbus" / "B*.csv")
REPEATS = 3
#: Columns whose first values may all be missing.
NUMBERS = ["itcs_numberOfPassengers", "status_doorIsOpen", "odometry_vehicleSpeed", "electric_powerDemand"]
TYPES = str(dict.fromkeys(NUMBERS, "DOUBLE") | {"itcs_busRoute": "VARCHAR"})


def seconds(work):
    """Median of some times, after one that fills the caches."""
    took = []
    for _ in range(1 + REPEATS):
        begin = time.perf_counter()
        work()
        took.append(time.perf_counter() - begin)
    return statistics.median(took[1:])


def ingest():
    """Files to segments in a new database: hashes, checks and all."""
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run(
            [program, "ingest", "--quiet", "--db", f"{scratch}/study.db"],
            cwd=folder,
            check=True,
            capture_output=True,
        )


def by_polars():
    """Hourly means of the same columns."""
    types = dict.fromkeys(NUMBERS, pl.Float64) | {"itcs_busRoute": pl.String}
    hours = (
        pl.scan_csv(telemetry, include_file_paths="file", null_values="NaN", schema_overrides=types)
        .group_by("file", pl.col("time_unix") // 3600)
        .agg(
            pl.col("itcs_numberOfPassengers").mean(),
            pl.col("status_doorIsOpen").mean(),
            pl.col("odometry_vehicleSpeed").sum(),
            pl.col("electric_powerDemand").mean(),
            pl.col("itcs_busRoute").mode().first(),
        )
    )
    return hours.collect(engine="streaming").height


def by_duckdb():
    """The same."""
    sql = f"""SELECT filename, time_unix // 3600, avg(itcs_numberOfPassengers), avg(status_doorIsOpen),
        sum(odometry_vehicleSpeed), avg(electric_powerDemand), mode(itcs_busRoute)
        FROM read_csv('{telemetry}', filename = true, nullstr = 'NaN', types = {TYPES}) GROUP BY ALL"""
    return len(duckdb.connect().execute(sql).fetchall())


def votes_of_busclimate(air, radiant):
    bc.pmv(air, radiant, clothing_clo=0.8, metabolic_met=1.2, relative_humidity=0.4, air_velocity_m_s=0.1)


def votes_of_pythermalcomfort(air, radiant):
    pmv_ppd_iso(air, radiant, 0.1, 40.0, 1.2, 0.8, limit_inputs=False, round_output=False)


def by_ipopt():
    """Seconds that Ipopt takes a problem, over designs, windows and temperatures."""
    views = "0.0075 0.0120 0.0144 0.0170".split()
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as cases:
        for ambient in (-5.0, 5.0, 15.0, 30.0):
            for design in ("ptc", "ptc+rh", "hp", "hp+rh", "hp+curtain"):
                for limit in (0.5, 1.0):
                    cases.write(f"{ambient + 273.15},200,300,2000,20,0.12,{design},{-limit},{limit}\n")
        cases.flush()
        command = [sys.executable, home / "tests" / "peers" / "optima.py", cases.name, *views]
        last = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()[-1]
    problems, took, _ = last.split(",")
    return float(took) / int(problems), int(problems)


def kernel(package, bench, name):
    """Items a second of one of our benchmarks, and what callgrind counts as instructions of an item."""
    build = ["cargo", "bench", "-p", package, "--bench", bench, "--no-run", "--message-format=json"]
    messages = subprocess.run(build, cwd=home, check=True, capture_output=True, text=True).stdout.splitlines()
    built = [json.loads(message) for message in messages]
    program = next(m["executable"] for m in built if m.get("executable") and m["target"]["name"] == bench)
    shown = subprocess.run([program, "--bench", name], check=True, capture_output=True, text=True).stdout
    # The third of fastest, slowest, median and mean.
    rate, prefix = re.findall(r"([0-9.]+) ([KMG]?)item/s", shown)[2]
    rate = float(rate) * {"": 1, "K": 1e3, "M": 1e6, "G": 1e9}[prefix]
    if shutil.which("valgrind") is None:
        return rate, "no valgrind"
    time, unit = re.findall(r"([0-9.]+) (ns|µs|ms|s) ", shown.split(name)[1])[2]
    items = rate * float(time) * {"ns": 1e-9, "µs": 1e-6, "ms": 1e-3, "s": 1}[unit]
    counts = []
    for times in (1, 2):
        tool = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
        command = [*tool, program, "--bench", name, "--sample-count", "1", "--sample-size", str(times)]
        said = subprocess.run(command, check=True, capture_output=True, text=True).stderr
        counts.append(int(re.search(r"refs:\s+([0-9,]+)", said)[1].replace(",", "")))
    return rate, f"{(counts[1] - counts[0]) / items:.0f} instructions"


def positions_by_pvlib(times):
    pvlib.solarposition.spa_python(times, 47.38, 8.54)


def row(what, program, rate, unit, against=None, note=""):
    ratio = "" if against is None else f"{against / rate:.3g} times"
    print(f"| {what} | {program} | {rate:.3g} {unit} | {ratio} | {note} |", flush=True)


print(f"{os.cpu_count()} cores\n\n| | program | | busclimate is faster | |\n|---|---|---:|---:|---|")
rows = duckdb.sql(f"SELECT count(*) FROM read_csv('{telemetry}', types = {TYPES}, nullstr = 'NaN')")
rows = rows.fetchone()[0]
ours = rows / seconds(ingest)
row("telemetry to hourly means", "busclimate ingest", ours, "rows/s", note="with hashes, checks and database")
row("telemetry to hourly means", f"polars {pl.__version__}", rows / seconds(by_polars), "rows/s", ours, "streaming")
row("telemetry to hourly means", f"DuckDB {duckdb.__version__}", rows / seconds(by_duckdb), "rows/s", ours)

air = np.linspace(5.0, 35.0, 2_000_000)
votes = pa.array(air)
ours = len(air) / seconds(lambda: votes_of_busclimate(votes, votes))
row("predicted mean votes", "busclimate.pmv", ours, "votes/s", note="all cores")
peer = len(air[::20]) / seconds(lambda: votes_of_pythermalcomfort(air[::20], air[::20]))
row("predicted mean votes", f"pythermalcomfort {pythermalcomfort.__version__}", peer, "votes/s", ours)

ours, count = kernel("busclimate-shading", "sun", "year_of_hours")
row("positions of the sun", "busclimate", ours, "positions/s", note=f"one core, {count}")
times = pd.date_range("2022-01-01", periods=87_600, freq="h", tz="UTC")
peer = len(times) / seconds(lambda: positions_by_pvlib(times))
row("positions of the sun", f"pvlib {pvlib.__version__}", peer, "positions/s", ours, "spa_python, all at once")

for what, unit, bench in [
    ("optima", "optima/s", ("busclimate-solve", "optimum", "one_core")),
    ("optima of many buses", "optima/s", ("busclimate-solve", "optimum", "many_buses")),
    ("simulated seconds", "seconds/s", ("busclimate-simulate", "mission", "winter_in_100_variants")),
]:
    rate, count = kernel(*bench)
    row(what, "busclimate", rate, unit, note=f"one core, {count}")

points = 7400 * 85
hours = pa.table({
    "ambient_temperature_c": np.linspace(-8.0, 34.0, 7400),
    "dni_w_m2": np.tile(np.linspace(0.0, 800.0, 37), 200),
    "dhi_w_m2": np.tile(np.linspace(0.0, 250.0, 37), 200),
    "solar_altitude_deg": np.tile(np.linspace(-10.0, 60.0, 37), 200),
    "shadow_fraction": np.tile(np.linspace(1.0, 0.3, 37), 200),
    "passengers": np.tile(np.linspace(0.0, 40.0, 50), 148),
    "door_open_fraction": np.tile(np.linspace(0.02, 0.18, 100), 74),
})
ours = points / seconds(lambda: bc.optimize(hours))
row("optima", "busclimate.optimize", ours, "optima/s", note="all cores, with the table of all columns")
each, problems = by_ipopt()
note = f"{problems} problems, one for each choice of devices; 4 passengers"
row("optima", f"CasADi {casadi.__version__}, Ipopt", 1 / each, "problems/s", ours, note)
