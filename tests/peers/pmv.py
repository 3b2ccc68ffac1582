"""PMV and PPD by pythermalcomfort over a grid, as CSV: air and radiant temperature, air speed, humidity, met, clo, PMV, PPD."""

import csv
import itertools
import sys

from pythermalcomfort.models import pmv_ppd_iso

out = csv.writer(sys.stdout)
grid = itertools.product(
    (0.0, 5.0, 10.0, 16.0, 20.0, 24.0, 30.0, 35.0),
    (-5.0, 5.0, 10.0, 18.0, 25.0, 32.0, 40.0, 45.0),
    (0.05, 0.1, 0.3, 1.0),
    (20.0, 40.0, 80.0),
    (0.8, 1.2, 2.0, 4.0),
    (0.0, 0.3, 0.5, 1.13, 2.0),
)
for air, radiant, speed, humidity, met, clo in grid:
    found = pmv_ppd_iso(air, radiant, speed, humidity, met, clo, limit_inputs=False, round_output=False)
    out.writerow([air, radiant, speed, humidity, met, clo, repr(float(found.pmv)), repr(float(found.ppd))])
