"""Hours in the layouts of PVGIS series, Open-Meteo, DWD and UGZ as pvlib reads them, and as pandas does where pvlib has no reader.

Arguments: the folder of the files. Prints a line for each hour: kind, month, day, hour of UTC, temperature in °C, an empty field,
and diffuse horizontal irradiance in W/m² (empty where the file has none)."""

import sys

import numpy as np
import pandas as pd
import pvlib

folder = sys.argv[1]


def show(kind, starts, temperature, diffuse=None):
    if diffuse is not None:
        # Around sunrise and sunset the sun is up for a part of the hour only, and all irradiance counts as diffuse.
        times = pd.DatetimeIndex(starts).tz_localize(None)
        elevation = [pvlib.solarposition.get_solarposition(times + pd.Timedelta(minutes=m), 45.0, 8.0).elevation.to_numpy() for m in (-35, 0, 60, 95)]
        diffuse = np.where(np.min(elevation, axis=0) > 0.0, diffuse, float("nan"))
    for n, start in enumerate(starts):
        values = ["" if v is None or v[n] != v[n] else repr(float(v[n])) for v in (temperature, diffuse)]
        print(kind, start.month, start.day, start.hour, values[0], "", values[1], sep=",")


data, _ = pvlib.iotools.read_pvgis_hourly(f"{folder}/series.csv", map_variables=True)
show("series", data.index, data.temp_air.to_numpy(), data.poa_sky_diffuse.to_numpy())

data = pd.read_csv(f"{folder}/meteo.csv", skiprows=3, parse_dates=["time"])
starts = data["time"] - pd.Timedelta(hours=2)
show("meteo", starts, data["temperature_2m (°C)"].to_numpy(), data["diffuse_radiation (W/m²)"].to_numpy())


def product(kind, form):
    data = pd.read_csv(f"{folder}/produkt_{kind}_stunde_20210101_20211231_00183.txt", sep=";", skipinitialspace=True, na_values=-999)
    return pd.to_datetime(data["MESS_DATUM"].astype(str), format=form), data


ends, data = product("tu", "%Y%m%d%H")
# Without the last hour, whose radiation ends 20 minutes early.
show("dwd", (ends - pd.Timedelta(hours=1))[:-1], data["TT_TU"].to_numpy()[:-1])
# Sums end 40 minutes after the hour: a clock hour has 40 minutes of one and 20 of the next.
ends, data = product("st", "%Y%m%d%H:%M")
w_m2 = data["FD_LBERG"] / 0.36
mean = (2.0 * w_m2 + w_m2.shift(-1)) / 3.0
show("dwd", (ends - pd.Timedelta(minutes=40))[:-1], None, mean.to_numpy()[:-1])

data = pd.read_csv(f"{folder}/city.csv")
data = data[data["Parameter"] == "T"]
show("ugz", pd.to_datetime(data["Datum"], utc=True), data["Wert"].to_numpy())
