"""A study in pandas: what comfort costs, by design, temperature and month.

    python analysis.py study.db FOLDER
"""

# %% Open the database; it is only read.
import pathlib
import sqlite3
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import pandas

database, folder = sys.argv[1], pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
connection = sqlite3.connect(f"file:{database}?mode=ro", uri=True)


def read(sql):
    return pandas.read_sql_query(sql, connection)


def save(figure, name):
    figure.tight_layout()
    figure.savefig(folder / name, dpi=150)


def curves(frame, x, y, x_label, y_label, name):
    """A line for each design."""
    figure, axes = plt.subplots(figsize=(7, 4.5))
    for design, of in frame.groupby("design"):
        axes.plot(of[x], of[y], marker="o", markersize=3, label=design)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.set_ylim(bottom=0.0)
    axes.legend()
    save(figure, name)


# %% What does comfort cost over the year?
annual = read("SELECT design, pmv_limit, hvac_power_w, reduction_vs_ptc FROM annual_average ORDER BY pmv_limit")
at_one = annual[annual.pmv_limit == 1.0].set_index("design")
print("Annual mean power within PMV ±1:")
print(at_one[["hvac_power_w", "reduction_vs_ptc"]].round(3).to_string())

annual["hvac_power_kw"] = annual.hvac_power_w / 1000.0
curves(annual, "pmv_limit", "hvac_power_kw", "limit of comfort, PMV", "annual mean HVAC power in kW", "comfort.png")

# %% What is to be expected at which temperature?
classes = read(
    """SELECT design, class, class_order, kwh_per_km FROM energy_class
       WHERE sorted_by = 'ambient temperature in °C' AND pmv_limit = 1 ORDER BY class_order"""
)
classes["ambient_c"] = 5.0 * classes.class_order + 2.5
curves(classes, "ambient_c", "kwh_per_km", "ambient temperature in °C", "HVAC energy in kWh/km", "temperature.png")

# %% Where does the heat come from and go to?
flows = read(
    """SELECT month, air_unit_heat_w, radiant_heater_power_w, passengers_w, other_w,
              solar_interior_w + solar_shell_inside_w + solar_shell_outside_w AS sun_w,
              -door_w AS door_w, -shell_to_ambient_w - shell_radiation_w AS shell_w
       FROM heat_flow_monthly WHERE design = 'hp' AND pmv_limit = 1 ORDER BY month"""
).set_index("month")
imbalance = flows.sum(axis=1).abs().max()
print(f"\nHeat balance of the whole bus closes to {imbalance:.1e} W")
assert imbalance < 1e-3, "heat is missing"
ax = (flows / 1000.0).plot.bar(stacked=True, figsize=(7, 4.5), width=0.8)
ax.axhline(0.0, color="black", linewidth=0.8)
ax.set_ylabel("mean heat flow in kW, into the bus")
names = [c.removesuffix("_w").replace("_", " ") for c in flows.columns]
ax.legend(ax.containers, names, fontsize=8, bbox_to_anchor=(1.0, 1.0), loc="upper left")
save(ax.figure, "heat.png")
print(f"\n{folder} has comfort.png, temperature.png and heat.png")
