"""The hours of real weather files as pvlib reads them, and as pandas does where pvlib has no reader.

Arguments: the folder of the files. Prints a line for each hour: kind, month, day, hour of UTC, temperature in °C, direct normal
and diffuse horizontal irradiance in W/m² (empty where the file has none)."""

import sys

import pandas as pd
import pvlib

folder = sys.argv[1]


def show(kind, times, temperature, direct=None, diffuse=None):
    for n, time in enumerate(times):
        values = [temperature[n]] + [float("nan") if v is None else v[n] for v in (direct, diffuse)]
        print(kind, time.month, time.day, time.hour, *("" if v != v else repr(float(v)) for v in values), sep=",")


data, _ = pvlib.iotools.read_pvgis_tmy(f"{folder}/pvgis_tmy_45.000_8.000_2005_2023.csv")
show("pvgis", data.index, data.temp_air.to_numpy(), data.dni.to_numpy(), data.dhi.to_numpy())

# The hours of PVGIS' EPW are those of UTC, whatever time zone its first line says: its n-th row is the n-th hour.
data, _ = pvlib.iotools.read_epw(f"{folder}/pvgis_tmy_45.000_8.000_2005_2023.epw")
hours = pd.date_range("2023-01-01", periods=len(data), freq="h", tz="UTC")
show("epw", hours, data.temp_air.to_numpy(), data.dni.to_numpy(), data.dhi.to_numpy())

# Months from 2018 on are stamped at the end of the hour.
data = pd.read_csv(f"{folder}/sia4028_SMA_2023_DRY.csv")
names = {"time.yy": "year", "time.mm": "month", "time.dd": "day", "time.hh": "hour"}
stamps = pd.to_datetime(data[list(names)].rename(columns=names))
starts = stamps.where(data["time.yy"] < 2018, stamps - pd.Timedelta(hours=1))
whole = ~starts.dt.strftime("%m%d%H").duplicated(keep="first")
part = data[whole]
show("sia4028", starts[whole], part["temp"].to_numpy(), part["rad.direct"].to_numpy(), part["rad.diffus"].to_numpy())

data = pd.read_csv(f"{folder}/ugz_stampfenbachstrasse_h1_2019-2022.csv")
times = pd.to_datetime(data["interval_start_utc"], utc=True)
data = data[times.dt.year == 2021]
show("csv", times[times.dt.year == 2021], data["T_degC"].to_numpy())
