"""busclimate beside other people's programs, each as its own documentation says: python3 benches/peers.py FOLDER PROGRAM

FOLDER holds study.toml and ztbus/*.csv, such as `busclimate demo FOLDER --like metaData.csv` makes; PROGRAM is the release
build. Python has the packages of tests/peers/requirements.txt and the wheel. Prints a table in Markdown.
"""

import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import casadi
import duckdb
import numpy as np
import polars as pl
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
