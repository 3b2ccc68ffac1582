"""The package as its users meet it: numbers of the program, data of other tools, errors that say what to do."""

import math
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import polars as pl
import pyarrow as pa
import pytest

import busclimate as bc

def one(**changes: float) -> pa.Table:
    """A cold hour."""
    hour = {
        "ambient_temperature_c": -5.0,
        "dni_w_m2": 0.0,
        "dhi_w_m2": 50.0,
        "solar_altitude_deg": 10.0,
        "shadow_fraction": 0.5,
        "passengers": 20.0,
        "door_open_fraction": 0.1,
    }
    return pa.table({name: [float(value)] for name, value in (hour | changes).items()})


def test_optima_are_those_of_the_program_bit_for_bit(study: bc.Study) -> None:
    """`optimize` on the study's samples gives every row of the view `optimum`."""
    found = pl.DataFrame(bc.optimize(study.samples(), windows=[0.5, 1.0]))
    stored = pl.DataFrame(study.table("optimum"))
    keys = ["sample_id", "design", "pmv_limit"]
    pair = stored.join(found, on=keys, suffix="_found")
    assert pair.height == stored.height == found.height > 900
    shared = [name for name in stored.columns if name in found.columns and name not in keys]
    assert len(shared) == 21
    for name in shared:
        ours, theirs = pair[f"{name}_found"], pair[name]
        assert ours.cast(theirs.dtype).equals(theirs, null_equal=True), name


def test_missions_are_read_as_the_program_reads_them(study: bc.Study) -> None:
    """`read_mission` gives the segments of the view `sample`."""
    stored = pl.DataFrame(study.table("sample"))
    path = Path(str(study.database)).parent / stored["source_path"][0]
    found = pl.DataFrame(bc.read_mission(path))
    pair = stored.filter(pl.col("mission") == stored["mission"][0]).join(found, on="sample_id", suffix="_found")
    assert pair.height > 0
    for name in ["passengers", "door_open_fraction", "start_utc", "first_line", "last_line", "distance_m"]:
        assert pair[f"{name}_found"].equals(pair[name], null_equal=True), name


def test_simulations_are_those_of_the_program_bit_for_bit(study: bc.Study) -> None:
    """`simulate` on a mission of the study gives its rows of the view `simulation`."""
    stored = pl.DataFrame(study.table("simulation"))
    missions = stored["mission"].unique().sort()
    for name in [missions[0], missions[-1]]:
        inputs = study.mission(name)
        found = pl.DataFrame(bc.simulate(**inputs, windows=[1.0]))
        keys = ["design", "pmv_limit", "controller"]
        pair = stored.filter(pl.col("mission") == name).join(found, on=keys, suffix="_found")
        assert pair.height == found.height == 20 and set(found["status"]) == {"simulated"}
        for column in [
            "mean_hvac_power_w",
            "static_mean_hvac_power_w",
            "max_abs_pmv_15min",
            "static_max_abs_pmv",
            "saturated_fraction",
            "tracking_error_k",
            "seconds",
        ]:
            assert pair[f"{column}_found"].equals(pair[column], null_equal=True), column
    slow = pl.DataFrame(bc.simulate(**inputs, windows=[1.0], dynamics={"air_unit_time_constant_s": 200.0}))
    assert not slow["mean_hvac_power_w"].equals(found["mean_hvac_power_w"])
    with pytest.raises(bc.InputError, match="minutes: there are"):
        bc.simulate(**(inputs | {"minutes": pa.table(inputs["minutes"]).slice(0, 59)}))
    with pytest.raises(bc.InputError, match="loads: row 1: .*second is whole and rises"):
        loads = pa.table({"second": [5, 5], "passengers": [1.0, 2.0], "door_open": [0.0, 1.0]})
        bc.simulate(**(inputs | {"loads": loads}))
    with pytest.raises(bc.InputError, match="there is no mission"):
        study.mission("B1")


def test_a_parameter_study_gives_the_years_of_the_program(study: bc.Study) -> None:
    """The set that changes nothing has the annual means of the study; a set depends on itself alone."""
    samples = study.samples()
    sets = pa.table({"set_id": [7, 8], "conduction_shell_w_m2_k": [6.86, 2.0]})
    base = pl.DataFrame(bc.parameter_study(pa.table({"set_id": [1]}), samples, windows=[0.5, 1.0]))
    stored = pl.DataFrame(study.table("annual_average"))
    pair = stored.join(base, on=["design", "pmv_limit"], suffix="_found")
    assert pair.height == base.height == 10
    for name in ["hvac_power_w", "heating_power_w", "cooling_power_w"]:
        assert ((pair[name] - pair[f"{name}_found"]).abs() <= 1e-12 * pair["hvac_power_w"]).all(), name
    assert pair["sample_count"].equals(pair["sample_count_found"])
    found = pl.DataFrame(bc.parameter_study(sets, samples, windows=[0.5, 1.0]))
    alone = pl.DataFrame(bc.parameter_study(sets.slice(1), samples, windows=[0.5, 1.0]))
    assert found.filter(pl.col("set_id") == 8).equals(alone)
    assert found.filter(pl.col("set_id") == 7).drop("set_id").equals(base.drop("set_id"))
    vehicle = {"conduction_shell_w_m2_k": 2.0}
    given = bc.parameter_study(pa.table({"set_id": [8]}), samples, windows=[0.5, 1.0], vehicle=vehicle)
    assert pl.DataFrame(given).equals(alone)
    better = found.filter(pl.col("set_id") == 8)["heating_power_w"] < found.filter(pl.col("set_id") == 7)["heating_power_w"]
    assert better.all()
    with pytest.raises(bc.InputError, match="samples: column month is missing"):
        bc.parameter_study(sets, one())
    with pytest.raises(bc.InputError, match="sets: column set_id: row 1: 1.5 is no whole number"):
        bc.parameter_study(pa.table({"set_id": [1.0, 1.5]}), samples)
    with pytest.raises(bc.StudyError, match="sets: shell_aera_m2 is no constant of the bus; there are .*shell_area_m2"):
        bc.parameter_study(pa.table({"set_id": [1], "shell_aera_m2": [3.0]}), samples)
    wrong = pl.DataFrame(bc.parameter_study(pa.table({"set_id": [1], "shell_area_m2": [-3.0]}), samples, windows=[1.0]))
    assert wrong["status"].str.contains("shell_area_m2").all() and wrong["hvac_power_w"].is_null().all()


def test_what_the_year_depends_on_is_that_of_the_years(study: bc.Study) -> None:
    """A set of inputs is the year of a bus with those constants; indices are those of the values of the sets."""
    samples = study.samples()
    inputs = {"conduction_shell_w_m2_k": [4.0, 8.0], "heating_cop_scale": {"mean": 1.0, "sd": 0.05}}
    swings, indices, sets = (pl.DataFrame(t) for t in bc.sensitivity(samples, inputs, points=32, seed=3))
    assert (swings.height, indices.height, sets.height) == (19 * 2, 19 * 2, 32 * 4)
    given = sets.select("set_id", "conduction_shell_w_m2_k").filter(pl.col("set_id") < 8)
    years = pl.DataFrame(bc.parameter_study(given, samples, windows=[1.0])).filter(pl.col("design") == "ptc")
    found = sets.filter(pl.col("set_id") < 8)["ptc hvac_power_w"]
    assert ((years["hvac_power_w"] / found - 1.0).abs() < 1e-9).all()
    of_ptc = indices.filter((pl.col("design") == "ptc") & (pl.col("quantity") == "hvac_power_w"))
    assert of_ptc["total_order"].to_list()[1] == 0.0 and of_ptc["first_order"][0] > 0.8
    base = swings.filter((pl.col("design") == "hp") & (pl.col("quantity") == "hvac_power_w"))
    assert (base["low_value"] != base["high_value"]).all() and base["base_value"].n_unique() == 1
    with pytest.raises(bc.StudyError, match="conduction_shell is no input that can vary; did you mean conduction_shell_w_m2_k"):
        bc.sensitivity(samples, {"conduction_shell": [1.0, 2.0]})
    with pytest.raises(bc.StudyError, match="inputs: relative_humidity = -2"):
        bc.sensitivity(samples, {"relative_humidity": [-2.0, 0.4]})


def test_tables_are_those_of_the_dictionary(study: bc.Study) -> None:
    """Every tool takes a table without more."""
    table = study.table("annual_average")
    as_pyarrow, as_polars = pa.table(table), pl.DataFrame(table)
    as_pandas = pd.DataFrame.from_arrow(table)
    assert as_pyarrow.num_rows == as_polars.height == len(as_pandas) == 10
    assert as_pyarrow["hvac_power_w"].to_pylist() == as_polars["hvac_power_w"].to_list() == list(as_pandas["hvac_power_w"])
    empty = pa.table(study.table("verification"))
    assert empty.num_rows == 0 and "verification_id" in empty.column_names


@pytest.mark.parametrize("make", [lambda t: t, pl.from_arrow, lambda t: t.to_pandas(), lambda t: t.to_batches()[0]])
def test_any_arrow_data_will_do(make) -> None:  # noqa: ANN001
    """pyarrow, polars, pandas, a batch: the same optimum."""
    expected = pa.table(bc.optimize(one(), windows=[1.0]))
    assert pa.table(bc.optimize(make(one()), windows=[1.0])).equals(expected)
    assert expected.num_rows == 5 and expected["status"].to_pylist() == ["solved"] * 5
    assert expected["design"].to_pylist() == ["ptc", "ptc+rh", "hp", "hp+rh", "hp+curtain"]


def test_designs_windows_and_constants_are_those_of_a_study_file() -> None:
    """What is given has the meaning that it has in a study file."""
    own = {"own": {"heating": "hp", "air_curtain": True}}
    rows = pa.table(bc.optimize(one(), own, [[-0.5, 0.7], [-1.0, 1.0]])).to_pylist()
    assert [(r["design"], r["pmv_min"], r["pmv_max"]) for r in rows] == [("own", -0.5, 0.7), ("own", -1.0, 1.0)]
    assert all(r["pmv_min"] - 1e-9 <= r["pmv"] <= r["pmv_max"] + 1e-9 for r in rows)
    larger = pa.table(bc.optimize(one(), own, [[-1.0, 1.0]], vehicle={"shell_area_m2": 200.0})).to_pylist()
    assert larger[0]["hvac_power_w"] > rows[1]["hvac_power_w"]
    hot = pa.table(bc.optimize(one(ambient_temperature_c=59.0, passengers=400), own, [0.25])).to_pylist()
    assert all((r["hvac_power_w"] is None) == (r["status"] != "solved") for r in hot)


def test_a_limited_design_comes_as_near_as_it_can() -> None:
    """A limit that binds gives the status `limited`, with the heat that is missing and a vote outside the window."""
    pump = {"heating": "hp", "limits_are": "thermal", "heating_limit_w": [[-20.0, 2e3], [0.0, 3e3]]}
    designs = {"limited": pump, "helped": {**pump, "backup_heater_w": 30e3}}
    rows = pa.table(bc.optimize(one(ambient_temperature_c=-8.0, passengers=5), designs, [1.0])).to_pylist()
    limited, helped = rows
    assert limited["status"] == "limited" and limited["unmet_heat_w"] > 0 and limited["pmv"] < -1
    assert helped["status"] == "solved" and helped["unmet_heat_w"] == 0 and helped["backup_heater_power_w"] > 0


def test_a_table_without_rows_has_the_same_columns() -> None:
    """Whoever asks for the schema gets it."""
    hours = one().append_column("sample_id", pa.array([7]))
    full, none = pa.table(bc.optimize(hours, windows=[1.0])), pa.table(bc.optimize(hours.slice(0, 0), windows=[1.0]))
    assert none.schema == full.schema and none.num_rows == 0 and full["sample_id"].to_pylist() == [7] * 5


def test_votes_are_those_of_the_standard() -> None:
    """ISO 7730:2005, table D.1, rows 1 to 4."""
    air, radiant = [22.0, 27.0, 27.0, 23.5], [22.0, 27.0, 27.0, 25.5]
    speed, humidity = [0.1, 0.1, 0.3, 0.1], [0.6, 0.6, 0.6, 0.6]
    votes = bc.pmv(
        pa.array(air),
        pa.array(radiant),
        clothing_clo=0.5,
        metabolic_met=1.2,
        relative_humidity=pa.array(humidity),
        air_velocity_m_s=pa.array(speed),
    )
    for vote, printed in zip(pa.array(votes).to_pylist(), [-0.75, 0.77, 0.44, -0.01]):
        assert math.isclose(vote, printed, abs_tol=0.01)


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: bc.optimize(one().drop_columns("passengers")), bc.InputError, "samples: column passengers is missing"),
        (lambda: bc.optimize(one(shadow_fraction=1.5)), bc.InputError, "samples: row 0: shadow_fraction = 1.5 is outside 0 … 1"),
        (lambda: bc.optimize(one(), {"x": {"heatin": "hp"}}), bc.StudyError, "did you mean"),
        (lambda: bc.optimize(one(), windows=1.0), bc.StudyError, "windows: give"),
        (lambda: bc.optimize(one(), designs=["hp"]), bc.StudyError, "designs: give a dict"),
        (lambda: bc.optimize(one(), vehicle={"shell_area_m2": -1.0}), bc.StudyError, "shell_area_m2"),
        (lambda: bc.read_mission("x.csv"), bc.InputError, "is not named like a mission"),
        (lambda: bc.read_mission("x.csv", segment_s=0), bc.StudyError, "segment_s: is 0"),
        (lambda: bc.Study.open("nowhere/study.toml"), bc.StudyError, "nowhere/study.toml"),
        (
            lambda: bc.pmv(20.0, pa.array([20.0, 21.0]), clothing_clo=pa.array([1.0, 1.0, 1.0]), metabolic_met=1.0,
                           relative_humidity=0.5, air_velocity_m_s=0.1),
            bc.InputError,
            "mean_radiant_temperature_c: has 2 values where another argument has 3",
        ),
        (
            lambda: bc.pmv(20.0, 20.0, clothing_clo=1.0, metabolic_met=1.0, relative_humidity=50.0, air_velocity_m_s=0.1),
            bc.InputError,
            "relative_humidity: value 0 is 50, outside 0 … 1",
        ),
    ],
)
def test_errors_name_the_argument_and_what_to_do(call, error: type[Exception], words: str) -> None:  # noqa: ANN001
    """Nobody has to guess."""
    with pytest.raises(error) as raised:
        call()
    assert words in str(raised.value)


def test_stages_and_tables_that_are_not_there_are_named(study: bc.Study) -> None:
    """With those that are."""
    with pytest.raises(bc.StudyError, match='there is no stage "solv"; there are ingest'):
        study.run(["solv"])
    with pytest.raises(bc.StudyError, match='there is no table "optima"; there are'):
        study.table("optima")


def test_other_threads_run_meanwhile() -> None:
    """Python's lock is free while the kernels compute."""
    code = """
import threading, time, pyarrow as pa, busclimate as bc
n = 20000
t = pa.table({k: [v] * n for k, v in dict(ambient_temperature_c=-5.0, dni_w_m2=0.0, dhi_w_m2=50.0, solar_altitude_deg=10.0,
    shadow_fraction=0.5, passengers=20.0, door_open_fraction=0.1).items()})
ticks, over = [], threading.Event()
def tick():
    while not over.is_set():
        ticks.append(time.monotonic()); time.sleep(0.001)
thread = threading.Thread(target=tick, daemon=True); thread.start()
begin = time.monotonic(); bc.optimize(t); end = time.monotonic()
over.set(); thread.join()
print(sum(begin < at < end for at in ticks))
"""
    seen = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=120)
    assert int(seen.stdout) > 2


def test_the_example_does_what_it_says(study: bc.Study) -> None:
    """A reader can run it."""
    example = Path(__file__).parent.parent / "examples" / "year.py"
    folder = Path(str(study.database)).parent
    told = subprocess.run([sys.executable, example, folder], check=True, capture_output=True, text=True, timeout=120)
    assert "hvac_power_w_insulated" in told.stdout and "month" in told.stdout


def test_annual_means_from_optima_are_those_of_the_program(study: bc.Study) -> None:
    """Weighted by hand, to rounding."""
    optima = pl.DataFrame(bc.optimize(study.samples(), windows=[1.0]))
    weights = pl.DataFrame(study.table("sample")).select("sample_id", "weight")
    power = (pl.col("hvac_power_w") * pl.col("weight")).sum() / pl.col("weight").sum()
    means = optima.join(weights, on="sample_id").group_by("design").agg(power.alias("mean"))
    stored = pl.DataFrame(study.table("annual_average")).filter(pl.col("pmv_limit") == 1.0)
    for row in stored.join(means, on="design").iter_rows(named=True):
        assert math.isclose(row["mean"], row["hvac_power_w"], rel_tol=1e-12), row["design"]


def test_refused_inputs_are_warnings(study: bc.Study, tmp_path: Path) -> None:
    """Nothing is left out in silence."""
    folder = tmp_path / "demo"
    shutil.copytree(study.database.parent, folder)
    (sorted((folder / "ztbus").glob("B*.csv"))[0]).write_text("this is no telemetry\n")
    with pytest.warns(UserWarning, match="refused"):
        bc.Study.open(folder).run(["ingest"])


def test_words_say_arguments_and_units() -> None:
    """`help` is enough to begin."""
    for function, words in [(bc.optimize, "door_open_fraction"), (bc.pmv, "clo"), (bc.read_mission, "segment_s")]:
        assert words in (function.__doc__ or "") and "Raises" in (function.__doc__ or "")
