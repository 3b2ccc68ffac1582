"""Solar altitude and the split of global irradiance by pvlib, hour by hour, as CSV.

    sun.py LATITUDE LONGITUDE YEAR

Columns: time, altitude and azimuth in degrees (geometric, NREL's SPA), global irradiance given, DNI and DHI by Erbs, DNI by closure
from that global irradiance and a diffuse share of 40 %.
"""

import csv
import sys

import numpy as np
import pandas as pd
from pvlib import irradiance, solarposition

latitude, longitude, year = float(sys.argv[1]), float(sys.argv[2]), sys.argv[3]
times = pd.date_range(f"{year}-01-01T00:30", f"{year}-12-31T23:30", freq="1h", tz="UTC")
sun = solarposition.get_solarposition(times, latitude, longitude, method="nrel_numpy")
out = csv.writer(sys.stdout)
for i, time in enumerate(times):
    altitude = float(sun["elevation"].iloc[i])
    sine = np.sin(np.radians(altitude))
    day = time.dayofyear
    # Every share of the irradiance outside the atmosphere, from overcast to clear.
    share = 0.05 + 0.7 * ((i * 37) % 100) / 100
    ghi = round(float(max(irradiance.get_extra_radiation(day) * sine * share, 0.0)), 3)
    split = irradiance.erbs(ghi, 90.0 - altitude, day)
    closure = (ghi - 0.4 * ghi) / sine if sine > 0 else 0.0
    row = [time.strftime("%Y-%m-%dT%H:%M:%SZ"), altitude, float(sun["azimuth"].iloc[i]), ghi]
    out.writerow(row + [float(split["dni"]), float(split["dhi"]), float(closure)])
