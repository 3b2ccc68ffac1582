#!/usr/bin/env python3
"""Makes the tables of docs/findings.md, docs/simulation.md and docs/figures.md.

    docs/regenerate.py FOLDER --program target/release/busclimate --metadata metaData.csv --weather WEATHER.csv

FOLDER gets, where it is not there, a year like the paper's (`demo --like`, 5 GB), its study, and a study for everything that the
paper does not publish and that is varied here. Tables stand in the documents between `<!-- table NAME -->` and `<!-- end -->`; what
is between them is replaced. Nothing but Python itself is needed. Some six minutes on two cores.
"""

import argparse
import csv
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys

DOCS = pathlib.Path(__file__).parent
COLDER_K = 1.3  # Zürichberg, the paper's station, below Stampfenbachstrasse

# What is varied: its name, and what the study file says instead of its defaults.
SHADE = {"town": ["--streets", "town"], "open": ["--height-to-width", "0"], "h15": ["--height-to-width", "0.15"], "h25": ["--height-to-width", "0.25"]}
VARIANTS = [
    ("shade of a town (`canyon --streets town`)", {"shadow": "town"}),
    ("no shade (`canyon --height-to-width 0`)", {"shadow": "open"}),
    ("streets 0.15 times as high as wide (`canyon --height-to-width 0.15`)", {"shadow": "h15"}),
    ("streets 0.25 times as high as wide (`canyon --height-to-width 0.25`)", {"shadow": "h25"}),
    ("`door_open_share = 0.54`", {"door_open_share": "0.54"}),
    ("`heating_cop = \"vecto-2stage\"`", {"heating_cop": "vecto-2stage"}),
    ("`heating_cop = \"vecto-r744\"`", {"heating_cop": "vecto-r744"}),
    ("`heating_cop = \"vecto-continuous-rows\"`", {"heating_cop": "vecto-continuous-rows"}),
    ("`heating_cop = \"vecto-continuous-exponential\"`", {"heating_cop": "vecto-continuous-exponential"}),
    ("`panel_rows = 4`, `panel_columns = 4`", {"vehicle": "panel_rows = 4\npanel_columns = 4"}),
    ("`panel_rows = 16`, `panel_columns = 1`", {"vehicle": "panel_rows = 16\npanel_columns = 1"}),
    ("`convection_radiant_heater_w_m2_k = 4.0`", {"vehicle": "convection_radiant_heater_w_m2_k = 4.0"}),
    (f"weather {COLDER_K} K colder", {"weather": "colder"}),
    ("`without_routes = [\"N1\", \"N2\", \"N4\"]`", {"without_routes": '["N1", "N2", "N4"]'}),
    (
        "doors 0.54, weather colder and no night routes together",
        {"door_open_share": "0.54", "weather": "colder", "without_routes": '["N1", "N2", "N4"]'},
    ),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", default="busclimate")
    parser.add_argument("--metadata", type=pathlib.Path)
    parser.add_argument("--weather", type=pathlib.Path)
    parser.add_argument("--only", choices=["findings.md", "simulation.md", "figures.md"], help="a single document")
    given = parser.parse_args()
    folder, run = given.folder, lambda *words: subprocess.run([given.program, *map(str, words)], check=True)
    if not (folder / "study.toml").exists():
        run("demo", folder, "--like", given.metadata, "--weather", given.weather, "--quiet")
    run("run", folder / "study.toml", "--quiet")
    base = folder / "study.db"
    wanted = lambda document: given.only in (None, document)  # noqa: E731
    if wanted("findings.md"):
        rows = [("as above", figures(base))]
        for number, (name, change) in enumerate(VARIANTS, 1):
            print(f"{number} of {len(VARIANTS)}: {name}", file=sys.stderr)
            rows.append((name, figures(varied(folder, number, change, run))))
            (folder / f"varied-{number}.db").unlink()
        put("findings.md", "varied", varied_table(rows))
        put("findings.md", "findings", table_of(folder / "report" / "paper_comparison.csv", FINDINGS))
        put("findings.md", "samples", samples(base))
        put("findings.md", "sure", sure(base))
    if wanted("simulation.md"):
        put("simulation.md", "year", simulated(base))
    if wanted("figures.md"):
        put("figures.md", "numbers", table_of(folder / "report" / "paper_numbers.csv", NUMBERS))


def varied(folder, number, change, run):
    """The database of a study that differs from that of the year in what is varied."""
    text = (folder / "study.toml").read_text()

    def put_in(pattern, new):
        nonlocal text
        text, count = re.subn(pattern, lambda _: new, text, flags=re.M)
        assert count, pattern

    put_in(r"^database = .*", f'database = "varied-{number}.db"')
    put_in(r"^report_dir = .*", 'report_dir = "varied-report"')
    put_in(r"^pmv_limits = \[0\.0, 0\.5, 1\.0, 1\.5, 2\.0\].*", "pmv_limits = []")
    put_in(r"^pmv_limits = \[0\.25, 0\.5.*", "pmv_limits = []")
    if "door_open_share" in change:
        put_in(r"^door_open_share = .*", f"door_open_share = {change['door_open_share']}")
    if "without_routes" in change:
        put_in(r"^keep_partial", f"without_routes = {change['without_routes']}\nkeep_partial")
    if "heating_cop" in change:
        put_in(r'^heating = "hp"', f'heating = "hp"\nheating_cop = "{change["heating_cop"]}"')
    if "vehicle" in change:
        put_in(r"^\[vehicle\].*", f"[vehicle]\n{change['vehicle']}")
    if "weather" in change:
        put_in(r'^path = "weather".*', 'path = "weather-colder"')
        colder(folder)
    shade = change.get("shadow")
    if shade:
        put_in(r'^path = "shadow\.csv".*', f'path = "shadow-{shade}.csv"')
    study = folder / f"varied-{number}.toml"
    study.write_text(text)
    if shade and not (folder / f"shadow-{shade}.csv").exists():
        run("canyon", study, *SHADE[shade])
    shutil.copy(folder / "study.db", folder / f"varied-{number}.db")
    run("run", study, "--quiet")
    return folder / f"varied-{number}.db"


def colder(folder):
    """The weather with every temperature lower by the same difference."""
    (folder / "weather-colder").mkdir(exist_ok=True)
    for source in (folder / "weather").iterdir():
        with source.open(newline="") as f:
            header, *rows = list(csv.reader(f))
        place = header.index("T_degC")
        for row in rows:
            if row[place]:
                row[place] = repr(round(float(row[place]) - COLDER_K, 3))
        with (folder / "weather-colder" / source.name).open("w", newline="") as f:
            csv.writer(f).writerows([header, *rows])


def figures(database):
    """What the findings are made of: ranges over all windows, in percent, and the samples."""
    c = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    power = {(d, w): p for d, w, p in c.execute("SELECT design, pmv_limit, hvac_power_w FROM annual_average")}
    windows = sorted({w for _, w in power})

    def saving(design, other):
        of = [100 * (1 - power[design, w] / power[other, w]) for w in windows]
        return min(of), max(of)

    lower, cooling, solved = c.execute(
        "SELECT lower_count, cooling_count, solved_count FROM limit_share WHERE design = 'hp+curtain' AND pmv_limit = 1"
    ).fetchone()
    return {
        "rh": saving("ptc+rh", "ptc"),
        "hp": saving("hp", "ptc"),
        "curtain": saving("hp+curtain", "hp"),
        "lower": 100 * lower / solved,
        "cooling": 100 * cooling / solved,
        "neutral": power["ptc", 0.0] / 1000,
        "samples": solved,
    }


def varied_table(rows):
    out = [
        "| varied | heaters on PTC | heat pump | air curtain | lower limit | cooling | PTC at PMV 0 | samples |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    span = lambda ends: f"{ends[0]:.1f} … {ends[1]:.1f} %"  # noqa: E731
    for name, f in rows:
        cells = [span(f["rh"]), span(f["hp"]), span(f["curtain"]), f"{f['lower']:.1f} %", f"{f['cooling']:.1f} %"]
        out.append("| " + " | ".join([name, *cells, f"{f['neutral']:.2f} kW", str(f["samples"])]) + " |")
    return out


def table_of(path, columns):
    """Columns of a table of the report, each with what stands above it and how it is aligned."""
    heads, lines, _ = zip(*columns)
    out = [("| " + " | ".join(heads) + " |").replace("|  |", "| |"), "|" + "|".join(lines) + "|"]
    with path.open(newline="") as f:
        out += ["| " + " | ".join(row[column] for _, _, column in columns) + " |" for row in csv.DictReader(f)]
    return out


FINDINGS = [("finding", "---", "finding"), ("paper", "---", "paper"), ("this study", "---", "this_study"), ("", "---", "verdict")]
NUMBERS = [
    ("figure", "---", "figure"),
    ("number", "---", "number"),
    ("paper", "---:", "paper"),
    ("this study", "---:", "this_study"),
    ("", "---", "verdict"),
]


def samples(database):
    c = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    out = ["| month | samples | without N1, N2, N4 | days | independent at ±1 |", "|---|---:|---:|---:|---:|"]
    query = """SELECT s.month, s.n, s.without, m.day_count, m.effective_sample_count FROM (
            SELECT month, count(*) AS n, sum(coalesce(route, '') NOT IN ('N1', 'N2', 'N4')) AS without FROM sample GROUP BY month
        ) AS s JOIN month_spread AS m USING (month) WHERE m.design = 'hp+curtain' AND m.pmv_limit = 1 ORDER BY s.month"""
    rows = c.execute(query).fetchall()
    out += [f"| {m} | {n} | {w} | {d} | {e:.0f} |" for m, n, w, d, e in rows]
    out.append(f"| all | {sum(r[1] for r in rows)} | {sum(r[2] for r in rows)} | | |")
    return out


def sure(database):
    c = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    out = ["| saving at PMV ±1 | | 90 % interval | without one of the years |", "|---|---:|---:|---:|"]
    years = "SELECT hvac_power_w FROM left_out WHERE kind = 'year' AND pmv_limit = 1 AND design = ? ORDER BY name"
    for design, other in [("ptc+rh", "ptc"), ("hp", "ptc"), ("hp+curtain", "hp")]:
        query = "SELECT saving, saving_low, saving_high FROM design_interval WHERE design = ? AND other_design = ? AND pmv_limit = 1"
        saving, low, high = c.execute(query, (design, other)).fetchone()
        pairs = zip(c.execute(years, (design,)).fetchall(), c.execute(years, (other,)).fetchall())
        without = [100 * (1 - a[0] / b[0]) for a, b in pairs]
        ends = f"{100 * low:.1f} … {100 * high:.1f} %"
        out.append(f"| {design} against {other} | {100 * saving:.1f} % | {ends} | {min(without):.1f} … {max(without):.1f} % |")
    return out


def simulated(database):
    c = sqlite3.connect(f"file:{database}?mode=ro", uri=True)
    query = """SELECT design, pmv_limit, controller, mean_hvac_power_w, static_mean_hvac_power_w FROM simulation_annual
        WHERE pmv_limit IN (0, 1, 2) AND design IN ('ptc', 'hp', 'hp+curtain')"""
    power, steady = {}, {}
    for design, limit, controller, simulated_w, static_w in c.execute(query):
        power[design, limit, controller], steady[design, limit] = simulated_w, static_w
    out = [
        "| design | PMV | steady state | simulated | difference | start-up | power limit | hourly modes | averaging |",
        "|---|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    signed = lambda w: f"{w:+.0f}".replace("-", "−") if round(w) else "0"  # noqa: E731
    for design in ["ptc", "hp", "hp+curtain"]:
        for limit in [0.0, 1.0, 2.0]:
            at = lambda controller: power[design, limit, controller]  # noqa: B023, E731
            static = steady[design, limit]
            causes = [
                at("paper") - at("warm-start"),
                at("warm-start") - at("unlimited"),
                at("unlimited") - at("free-mode"),
                at("free-mode") - static,
            ]
            share = f"{100 * (at('paper') / static - 1):+.1f} %".replace("-", "−")
            window = "0" if limit == 0 else f"±{limit:g}"
            cells = [design, window, f"{static:.0f}", f"{at('paper'):.0f}", share, *map(signed, causes)]
            out.append("| " + " | ".join(cells) + " |")
    return out


def put(document, name, table):
    path = DOCS / document
    text = path.read_text()
    begin, end = f"<!-- table {name} -->", "<!-- end -->"
    assert begin in text, f"{document} has no {begin}"
    head, rest = text.split(begin, 1)
    _, tail = rest.split(end, 1)
    path.write_text(f"{head}{begin}\n" + "\n".join(table) + f"\n{end}{tail}")


main()
