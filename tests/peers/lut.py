"""Look-up tables as eFLIPS takes them: every table becomes a ConsumptionLut.

    lut.py FOLDER

Printed is a line for each table: its name and how many points the look-up table has.
"""

import csv
import pathlib
import sys

import pandas
from eflips.model import ConsumptionLut

out = csv.writer(sys.stdout)
for path in sorted((pathlib.Path(sys.argv[1]) / "consumption").glob("*.csv")):
    lut = ConsumptionLut.df_to_consumption_obj(pandas.read_csv(path), 1, 1)
    expected = [ConsumptionLut.INCLINE, ConsumptionLut.T_AMB, ConsumptionLut.LEVEL_OF_LOADING, ConsumptionLut.SPEED]
    assert lut.columns == expected and all(value >= 0.0 for value in lut.values), path
    axes = [sorted({point[n] for point in lut.data_points}) for n in range(4)]
    full = len(lut.data_points) == len(lut.values) == len(axes[0]) * len(axes[1]) * len(axes[2]) * len(axes[3])
    out.writerow([path.name, len(lut.values) if full else "a grid with holes"])
