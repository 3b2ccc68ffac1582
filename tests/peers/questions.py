"""The answers to the questions of docs/questions.md, once more in pandas from the raw rows.

    questions.py DATABASE WORDS

WORDS is what `busclimate dictionary --format json` prints. Printed is a line for each question and tool that answers its query: name, tool,
rows, and the first difference from pandas, empty where there is none.
"""

import csv
import json
import math
import pathlib
import sqlite3
import sys

import duckdb
import duckdb_extension_sqlite_scanner
import numpy
import pandas

DAYS = pandas.Series([31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31], index=range(1, 13))
POINT = ["design", "pmv_limit"]


class Raw:
    """Rows as they were stored, with what follows from one row alone."""

    def __init__(self, connection):
        table = lambda name: pandas.read_sql_query(f"SELECT * FROM {name}", connection)  # noqa: E731
        samples = table("hourly_sample").merge(
            table("mission_segment")[["source_file_id", "segment", "distance_m", "vehicle_power_w", "route"]],
            on=["source_file_id", "segment"],
        )
        samples = samples.merge(table("source_file")[["source_file_id", "path"]], on="source_file_id")
        local = pandas.to_datetime(samples.start_utc, utc=True).dt.tz_convert("Europe/Zurich")
        assert (samples.month == local.dt.month).all()
        samples["local_hour"], samples["weekday"] = local.dt.hour, local.dt.day_name()
        samples["ambient_c"] = samples.ambient_temperature_k - 273.15
        # A sample weighs what its month has in days, among the months there are, over the samples of the month.
        counts = samples.groupby("month").size()
        share = DAYS[counts.index] / DAYS[counts.index].sum()
        samples["weight"] = (share / counts)[samples.month].values
        self.samples, self.share = samples, share
        designs = table("hvac_design")[["design_id", "name", "heating"]].rename(columns={"name": "design"})
        windows = table("comfort_window")[["window_id", "pmv_min", "pmv_max", "pmv_limit"]]
        points = table("optimum_point").merge(designs, on="design_id").merge(windows, on="window_id")
        points = points.merge(samples, on="sample_id")
        self.infeasible = points[points.status != 0]
        solved = points[points.status == 0].copy()
        solved["power"] = solved.air_unit_power_w + solved.radiant_heater_power_w + solved.air_curtain_power_w
        # Over solved samples, months without any left out.
        per_month = solved.groupby(POINT + ["month"]).size().rename("solved").reset_index()
        per_month["days"] = DAYS[per_month.month].values
        per_month["all_days"] = per_month.groupby(POINT).days.transform("sum")
        solved = solved.merge(per_month, on=POINT + ["month"])
        solved["w"] = solved.days / solved.all_days / solved.solved
        self.solved, self.table, self.designs, self.windows = solved, table, designs, windows

    def at(self, design, limit=1.0):
        return self.solved[(self.solved.design == design) & (self.solved.pmv_limit == limit)]


def rows(frame):
    return [tuple(r) for r in frame.itertuples(index=False, name=None)]


def sums(frame, by):
    """Weighted means and energies of groups, as a frame with the groups as columns."""
    f = frame.assign(
        wp=frame.w * frame.power,
        moved=numpy.where(frame.distance_m.notna(), frame.w * frame.power * frame.duration_s, 0.0),
        way=frame.w * frame.distance_m.fillna(0.0),
        drawn=numpy.where(frame.vehicle_power_w.notna(), frame.w * frame.power, 0.0),
        vehicle=frame.w * frame.vehicle_power_w.fillna(0.0),
    )
    g = f.groupby(by, sort=True)[["w", "wp", "moved", "way", "drawn", "vehicle"]].sum()
    g["count"] = f.groupby(by).size()
    g["power"], g["km"], g["share"] = g.wp / g.w, g.moved / g.way / 3600.0, g.drawn / g.vehicle
    return g.reset_index()


def cost_of_comfort(raw):
    s = raw.solved
    s = s.assign(all=s.w * s.power, heating=s.w * s.power * (s.operating_mode >= 0), cooling=s.w * s.power * (s.operating_mode < 0))
    g = s.groupby(POINT)[["all", "heating", "cooling"]].sum().reset_index()
    ptc = g[g.design == "ptc"].set_index("pmv_limit")["all"]
    g["saved"] = 1.0 - g["all"] / ptc[g.pmv_limit].values
    return rows(g)


class Near:
    """A number that was drawn by others: as good as equal within a tolerance."""

    def __init__(self, value, tolerance):
        self.value, self.tolerance = value, tolerance

    def __eq__(self, other):
        return isinstance(other, float) and abs(other - self.value) <= self.tolerance

    def __repr__(self):
        return ""


def with_days(raw):
    """Solved samples with the local day on which their mission begins."""
    s = raw.solved
    start = pandas.to_datetime(s.start_utc, utc=True) - pandas.to_timedelta(s.segment * s.duration_s, unit="s")
    local = start.dt.tz_convert("Europe/Zurich")
    return s.assign(day=local.dt.date, day_month=local.dt.month, day_year=local.dt.year.astype(str))


def how_sure(raw):
    s = with_days(raw)
    days = s[["day", "day_month"]].drop_duplicates().sort_values("day").reset_index(drop=True)
    dice, draws = numpy.random.default_rng(1), 8000
    counts = numpy.zeros((draws, len(days)))
    for _, of_month in days.groupby("day_month"):
        n = len(of_month)
        assert n > 1
        counts[:, of_month.index] = dice.multinomial(n - 1, [1 / n] * n, size=draws)
    drawn = {}
    for point, of_point in s.groupby(POINT):
        total, weight = numpy.zeros(draws), numpy.zeros(draws)
        for month, of_month in of_point.groupby("month"):
            g = of_month.groupby("day").power.agg(["sum", "size"]).reindex(days.day, fill_value=0)
            power, samples = counts @ g["sum"].values, counts @ g["size"].values
            total += numpy.where(samples > 0, DAYS[month] * power / numpy.maximum(samples, 1), 0.0)
            weight += numpy.where(samples > 0, DAYS[month], 0.0)
        drawn[point] = total / weight
    power = {(r.design, r.pmv_limit): r.power for r in sums(raw.solved, POINT).itertuples()}

    def ends(values):
        # An end that both draw lies within a fifth of the half-width: some four standard errors of the two of them.
        low, high = numpy.quantile(values, [0.05, 0.95])
        tolerance = max(0.1 * (high - low), 1e-12)
        return Near(low, tolerance), Near(high, tolerance)

    out = []
    for limit in sorted({limit for _, limit in power}):
        low, high = ends(drawn["hp+curtain", limit])
        for other in {design for design, _ in power} - {"hp+curtain"}:
            own = ("hp+curtain", limit)
            saving_low, saving_high = ends(1 - drawn[own] / drawn[other, limit])
            saving = 1 - power[own] / power[other, limit]
            out.append((limit, low, power[own], high, other, saving_low, saving, saving_high))
    return out


def one_winter(raw):
    s = with_days(raw)
    s = s[s.pmv_limit == 1.0].assign(route=s.route.fillna("none"), month_name=s.month.map("{:02d}".format))

    def mean(frame, design):
        g = frame[frame.design == design].groupby("month").power.mean()
        return (g * DAYS[g.index]).sum() / DAYS[g.index].sum()

    whole, out = mean(s, "hp"), []
    for kind, column in {"route": "route", "year": "day_year", "month": "month_name"}.items():
        for name in s[column].unique():
            rest = s[s[column] != name]
            if len(rest):
                hp, ptc = mean(rest, "hp"), mean(rest, "ptc")
                out.append((kind, name, int((rest.design == "hp").sum()), hp, hp / whole - 1, 1 - hp / ptc))
    return out


def energy_of_a_bus(raw):
    segments = raw.table("mission_segment")
    months = (segments.bus.astype(str) + segments.start_utc.str[:7]).nunique()
    hours = segments.duration_s.sum() / 3600.0 / (months / 12.0)
    g = sums(raw.solved, POINT)
    return [(r.design, r.pmv_limit, r.km, r.power / 1000.0, hours, r.power / 1000.0 * hours) for r in g.itertuples()]


def share_of_the_vehicle(raw):
    g = sums(raw.solved, POINT + ["month"])
    return [(r.design, r.pmv_limit, f"{r.month:02d}", r.share) for r in g.itertuples()]


def power_limit(raw):
    s = raw.solved
    limits = {"ptc": 60_000.0, "hp": 12_000.0}
    limit = numpy.where(s.operating_mode == 1, s.heating.map(limits), 12_000.0)
    over = (s.operating_mode != 0) & (s.air_unit_power_w > limit)
    s = s.assign(over=over, ow=over * s.weight, unmet=numpy.where(over, s.w * s.air_unit_heat_w.abs() * (1 - limit / s.air_unit_power_w.clip(lower=1e-9)), 0.0))
    g = s.groupby(POINT + ["heating"])[["over", "ow", "unmet"]].sum().reset_index()
    return [(r.design, r.pmv_limit, limits[r.heating], 12_000.0, int(r.over), r.ow, r.unmet) for r in g.itertuples()]


def next_tenth(raw):
    g = sums(raw.solved, POINT)
    answers = []
    for design, of in g.groupby("design"):
        of = of.sort_values("pmv_limit", ascending=False)
        for (limit, power), (narrower, more) in zip(of[["pmv_limit", "power"]].values, of[["pmv_limit", "power"]].values[1:]):
            answers.append((design, limit, (more - power) / (limit - narrower) / 10.0))
    return answers


def curtain_pays(raw):
    s = raw.at("hp+curtain")
    difference = ((s.cabin_k - s.ambient_temperature_k) / 5.0).round() * 5.0
    g = s.groupby(difference.astype(int)).air_curtain_on.agg(["count", "sum"]).reset_index()
    return rows(g)


def warmth(frame):
    low = numpy.floor(frame.ambient_c / 5.0).astype(int) * 5
    return [f"{v} … {v + 5}" for v in low]


def heat_pump_saves(raw):
    ptc, hp = (sums(s.assign(warmth=warmth(s)), ["warmth"]) for s in (raw.at("ptc"), raw.at("hp")))
    both = ptc.merge(hp, on="warmth")
    return [(r.warmth, r.w_x, r.power_x - r.power_y) for r in both.itertuples()]


def dearest_route(raw):
    s = raw.at("hp")
    g = sums(s.assign(route=s.route.fillna("none")), ["route"])
    return [(r.route, r.km, r.count) for r in g.rename(columns={"count": "count"}).itertuples(name="R", index=False)]


def hour_of_the_day(raw):
    g = sums(raw.at("hp"), ["local_hour"])
    return [(f"{h:02d}", p, n) for h, p, n in zip(g.local_hour, g.power, g["count"])]


def weekdays(raw):
    g = sums(raw.at("hp"), ["weekday"])
    return list(zip(g.weekday, g.w, g.power, g.km))


def by_temperature(raw):
    s = raw.solved[raw.solved.pmv_limit == 1.0]
    g = sums(s.assign(warmth=warmth(s)), ["design", "warmth"])
    return list(zip(g.design, g.warmth, g.power, g.km, g["count"]))


def dearest_hours(raw):
    s = raw.at("hp").nlargest(10, "power")
    return rows(s[["start_utc", "ambient_c", "passengers", "power", "path", "first_line", "last_line"]])


def in_months(raw, frame, value, by):
    """Months by their days, within a month as the values are."""
    g = frame.assign(share=raw.share[frame.month].values)
    g = g[g[value].notna()]
    g = g.assign(sv=g.share * g[value]).groupby(by)[["sv", "share"]].sum()
    return g.sv / g.share


def driven(raw, name, by):
    r = raw.table(name).merge(raw.designs, on="design_id").merge(raw.windows, on="window_id")
    r = r.assign(ws=r.mean_hvac_power_w * r.seconds, static=r.static_mean_hvac_power_w * r.seconds)
    return r, by + ["month"]


def controllers(raw):
    by = ["controller"] + POINT
    r, monthly = driven(raw, "controlled_mission", by)
    m = r.groupby(monthly)[["ws", "static", "seconds", "passenger_hours", "passenger_hours_outside"]].sum().reset_index()
    m["power"], m["static_power"] = m.ws / m.seconds, m.static / m.seconds
    m["outside"] = m.passenger_hours_outside / m.passenger_hours.where(m.passenger_hours > 0)
    columns = [in_months(raw, m, value, by) for value in ("power", "static_power", "outside")]
    return rows(pandas.concat(columns, axis=1).reset_index())


def steady_state(raw):
    r, monthly = driven(raw, "simulated_mission", POINT)
    m = r[r.controller == "paper"].groupby(monthly)[["ws", "static", "seconds"]].sum().reset_index()
    m["power"], m["static_power"] = m.ws / m.seconds, m.static / m.seconds
    g = pandas.concat([in_months(raw, m, value, POINT) for value in ("power", "static_power")], axis=1).reset_index()
    g.columns = [*POINT, "power", "static_power"]
    g["more"] = g.power / g.static_power - 1.0
    return rows(g)


def excluded(raw):
    return [(reason, int(n)) for reason, n in raw.table("excluded_segment").reason.value_counts().items()]


def heat_in_january(raw):
    k = raw.table("heat_transfer").iloc[0]
    s = raw.solved[(raw.solved.pmv_limit == 1.0) & (raw.solved.month == 1)]
    to_interior = k.radiation_heater_interior_w_k4 * (s.radiant_heater_k**4 - s.interior_k**4)
    interior_to_shell = k.radiation_interior_shell_w_k4 * (s.interior_k**4 - s.shell_inside_k**4)
    to_cabin = k.convection_interior_w_k * (s.interior_k - s.cabin_k)
    to_shell = k.convection_shell_inside_w_k * (s.cabin_k - s.shell_inside_k)
    heaters = k.convection_radiant_heater_w_k * (s.radiant_heater_k - s.cabin_k)
    people, other = s.passengers * k.passenger_heat_w, k.other_heat_w
    s = s.assign(
        people=people,
        other=other,
        sun=to_cabin + interior_to_shell - to_interior,
        door=s.air_unit_heat_w + people + other + heaters + to_cabin - to_shell,
        to_shell=to_shell,
        air=k.convection_shell_outside_w_k * (s.shell_outside_k - s.ambient_temperature_k),
        radiation=k.radiation_shell_outside_w_k4 * (s.shell_outside_k**4 - s.ambient_temperature_k**4),
    )
    columns = ["air_unit_heat_w", "radiant_heater_power_w", "people", "other", "sun", "door", "to_shell", "air", "radiation"]
    return rows(s.groupby("design")[columns].mean().reset_index())


def cop_by_month(raw):
    answers = []
    for month, of in raw.at("hp").groupby("month"):
        row = [month]
        for mode in (1, -1):
            s = of[of.operating_mode == mode]
            lift = mode * (s.cabin_k - s.ambient_temperature_k)
            runs = s.air_unit_power_w.sum() > 0.0
            row += [lift.mean(), s.air_unit_heat_w.abs().sum() / s.air_unit_power_w.sum()] if runs else [None, None]
        answers.append(tuple(row))
    return answers


def binding_limits(raw):
    s = raw.solved
    low, high = s.pmv < s.pmv_min + 1e-6, s.pmv > s.pmv_max - 1e-6
    s = s.assign(one=1, low=low.astype(int), high=high.astype(int), lw=low * s.weight, cw=(s.operating_mode == -1) * s.weight)
    g = s.groupby(POINT)[["one", "low", "high", "lw", "cw", "weight"]].sum().reset_index()
    return [(r.design, r.pmv_limit, r.one, r.low, r.high, r.lw / r.weight, r.cw / r.weight) for r in g.itertuples()]


def votes(raw):
    s = raw.solved[raw.solved.design == "hp+curtain"]
    tenths = s.pmv * 10.0
    bins = numpy.where(s.pmv < 0, numpy.floor(tenths + 1e-5), numpy.maximum(numpy.ceil(tenths - 1e-5) - 1, 0)).astype(int)
    g = s.assign(bin=bins).groupby(["pmv_limit", "bin"]).w.agg(["count", "sum"]).reset_index()
    return [(l, b / 10.0, (b + 1) / 10.0, n, w) for l, b, n, w in rows(g)]


def disturbances(raw):
    widths = {"ambient_c": 2.0, "dni_w_m2": 100.0, "dhi_w_m2": 50.0, "passengers": 5.0, "door_open_fraction": 0.05, "shadow_fraction": 0.1, "month": 1.0, "local_hour": 1.0}
    answers = []
    for quantity, width in widths.items():
        name = "ambient_temperature_c" if quantity == "ambient_c" else quantity
        g = raw.samples.groupby(numpy.floor(raw.samples[quantity] / width).astype(int)).weight.agg(["count", "sum"]).reset_index()
        answers += [(name, b * width, (b + 1) * width, n, w) for b, n, w in rows(g)]
    return answers


def plain(value):
    value = value.item() if hasattr(value, "item") else value
    return None if value is None or (value != value and not isinstance(value, Near)) else value


def place(row):
    return [f"{v:.6g}" if isinstance(v, float) else str(v) for v in row]


def difference(answers, meant):
    if len(answers) != len(meant):
        return f"{len(answers)} rows instead of {len(meant)}"
    for a, b in zip(sorted(answers, key=place), sorted(meant, key=place)):
        for x, y in zip(a, b, strict=True):
            alike = x == y
            if isinstance(y, (int, float)) and isinstance(x, (int, float)):
                alike = math.isclose(x, y, rel_tol=1e-9, abs_tol=1e-9)
            if not alike:
                return f"{a} instead of {b}"
    return ""


def main():
    database, words = sys.argv[1:]
    connection = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    duck = duckdb.connect()
    extension = next(pathlib.Path(duckdb_extension_sqlite_scanner.__file__).parent.rglob("*.duckdb_extension"))
    duck.execute(f"LOAD '{extension}'")
    duck.execute(f"ATTACH '{database}' AS study (TYPE sqlite, READ_ONLY)")
    duck.execute("USE study")
    raw = Raw(connection)
    out = csv.writer(sys.stdout)
    for question in json.loads(pathlib.Path(words).read_text())["questions"]:
        meant = [tuple(plain(v) for v in row) for row in globals()[question["name"].replace("-", "_")](raw)]
        for tool, asked in {"sqlite": connection, "duckdb": duck}.items():
            answers = [tuple(row) for row in asked.execute(question["sql"]).fetchall()]
            wrong = difference(answers, meant)
            out.writerow([question["name"], tool, len(answers), wrong.replace(",", ";").replace("\n", " ")[:300]])


main()
