"""Real processes: two workers of Apache Spark, one of which is killed while it computes."""

import os
import shutil
import signal
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import polars as pl
import pyarrow as pa
import pytest
from conftest import demo

import busclimate as bc

pyspark = pytest.importorskip("pyspark", reason="pip install 'busclimate[spark]'")
if shutil.which("java") is None:
    pytest.skip("Spark needs Java", allow_module_level=True)

from pyspark.sql import SparkSession  # noqa: E402

import busclimate.spark  # noqa: E402

MISSIONS = 100
WINDOWS = [0.5, 1.0]


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> bc.Study:
    """A hundred missions, solved by the program's own stages."""
    opened = demo(tmp_path_factory.mktemp("large"), MISSIONS)
    opened.run(["ingest", "shade", "solve"])
    return opened


@pytest.fixture(scope="module")
def spark(tmp_path_factory: pytest.TempPathFactory) -> Iterator[SparkSession]:
    """Two executors of their own, a core and a gibibyte each."""
    os.environ |= {"SPARK_HOME": str(Path(pyspark.__file__).parent), "PYSPARK_PYTHON": sys.executable}
    os.environ["SPARK_LOCAL_IP"] = "127.0.0.1"
    builder = SparkSession.builder.master("local-cluster[2,1,1024]").appName("busclimate")
    for key, value in {
        "spark.ui.enabled": "false",
        "spark.driver.bindAddress": "127.0.0.1",
        "spark.driver.host": "127.0.0.1",
        "spark.sql.shuffle.partitions": "4",
        "spark.sql.execution.arrow.maxRecordsPerBatch": "500",
        "spark.local.dir": str(tmp_path_factory.mktemp("spark")),
        "spark.worker.cleanup.enabled": "true",
    }.items():
        builder = builder.config(key, value)
    session = builder.getOrCreate()
    session.sparkContext.setLogLevel("ERROR")
    yield session
    session.stop()


def executors() -> list[int]:
    """Process ids of the executors."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            command = (folder / "cmdline").read_bytes()
        except OSError:
            continue
        if b"CoarseGrainedExecutorBackend" in command and b"java" in command.split(b"\0")[0]:
            found.append(int(folder.name))
    return found


def paths(study: bc.Study) -> list[str]:
    """The mission files."""
    return sorted(str(path) for path in (Path(str(study.database)).parent / "ztbus").glob("B*.csv"))


def equal(found: pa.Table, stored: pa.Table, keys: list[str]) -> int:
    """Every row and every shared column to the last bit; gives how many columns were compared."""
    left, right = pl.DataFrame(found).sort(keys), pl.DataFrame(stored).sort(keys)
    assert left.height == right.height > 300
    shared = [name for name in right.columns if name in left.columns]
    for name in shared:
        assert left[name].cast(right[name].dtype).equals(right[name], null_equal=True), name
    return len(shared)


def test_samples_and_optima_survive_a_killed_executor(spark: SparkSession, large: bc.Study) -> None:
    """One task a mission; an executor dies in the middle; every row is that of the program."""
    files = paths(large)
    assert len(files) == MISSIONS
    missions = spark.createDataFrame([(path,) for path in files], "path string").repartition(MISSIONS)
    found: list[pa.Table] = []
    work = threading.Thread(
        target=lambda: found.append(bc.spark.read_missions(missions, str(large.database.parent / "study.toml")).toArrow())
    )
    work.start()
    tracker = spark.sparkContext.statusTracker()

    def completed() -> int:
        stages = [tracker.getStageInfo(stage) for stage in tracker.getActiveStageIds()]
        return max((stage.numCompletedTasks for stage in stages if stage and stage.numTasks == MISSIONS), default=0)

    deadline = time.monotonic() + 120
    while completed() < 5 and work.is_alive() and time.monotonic() < deadline:
        time.sleep(0.01)
    assert work.is_alive() and completed() < MISSIONS, "the job is in the middle"
    before = executors()
    assert len(before) == 2
    os.kill(before[0], signal.SIGKILL)
    work.join(timeout=180)
    assert not work.is_alive() and len(found) == 1
    samples = found[0].filter(pa.compute.equal(found[0]["outcome"], "sample"))
    assert equal(samples, pa.table(large.samples()), ["sample_id"]) == 12

    rows = spark.createDataFrame(samples).repartition(7)
    optima = bc.spark.optimize(rows, windows=WINDOWS)
    keys = ["sample_id", "design", "pmv_limit"]
    compared = equal(optima.toArrow(), pa.table(large.table("optimum")), keys)
    assert compared == 24
    # By design as Parquet, and back.
    folder = large.database.parent / "optima"
    optima.write.partitionBy("design").parquet(str(folder))
    assert len(list(folder.glob("design=*"))) == 5
    assert equal(spark.read.parquet(str(folder)).toArrow(), pa.table(large.table("optimum")), keys) == compared

    # The same means whatever the partitions, and those of the program to rounding.
    means = bc.spark.annual_means(optima, rows)
    again = bc.spark.annual_means(bc.spark.optimize(rows.repartition(3), windows=WINDOWS), rows)
    assert means.equals(again)
    stored = pl.DataFrame(large.table("annual_average"))
    pair = stored.join(pl.DataFrame(means), on=["design", "pmv_min", "pmv_max"], suffix="_found")
    assert pair.height == 10
    assert (pair["hvac_power_w"] / pair["hvac_power_w_found"] - 1).abs().max() < 1e-12


def test_what_cannot_be_used_is_a_row(spark: SparkSession, large: bc.Study, tmp_path: Path) -> None:
    """Neither a broken mission nor an hour without an operation ends a task."""
    broken = tmp_path / Path(paths(large)[0]).name
    broken.write_text("this is no telemetry\n")
    missions = spark.createDataFrame([(str(broken),), (paths(large)[1],)], "path string").repartition(2)
    rows = bc.spark.read_missions(missions, str(large.database.parent / "study.toml")).toArrow().to_pylist()
    refused = [row for row in rows if row["outcome"] == "refused"]
    assert len(refused) == 1 and refused[0]["path"] == str(broken) and refused[0]["reason"]
    assert any(row["outcome"] == "sample" for row in rows)

    hour = {"sample_id": 1, "ambient_temperature_c": 59.0, "dni_w_m2": 900.0, "dhi_w_m2": 200.0, "solar_altitude_deg": 60.0}
    hour |= {"shadow_fraction": 0.0, "passengers": 400.0, "door_open_fraction": 0.0}
    found = bc.spark.optimize(spark.createDataFrame([hour]), windows=[0.25]).toArrow().to_pylist()
    assert len(found) == 5 and all((row["hvac_power_w"] is None) == (row["status"] != "solved") for row in found)


def test_a_parameter_study_keeps_the_years_alone(spark: SparkSession, large: bc.Study) -> None:
    """The same years whatever the partitions, as without Spark; a set that cannot be is rows with a reason."""
    samples = pa.table(large.samples())
    areas = [100.0 + 0.5 * n for n in range(40)] + [-1.0]
    sets = pa.table({"set_id": list(range(len(areas))), "shell_area_m2": areas})
    here = pa.table(bc.parameter_study(sets, samples, windows=WINDOWS))
    assert here.num_rows == len(areas) * 10
    for partitions in [3, 8]:
        rows = spark.createDataFrame(sets).repartition(partitions)
        there = bc.spark.parameter_study(rows, samples, windows=WINDOWS).toArrow()
        keys = ["set_id", "design", "pmv_limit"]
        assert equal(there, here, keys) == here.num_columns
    refused = here.filter(pa.compute.equal(here["set_id"], len(areas) - 1)).to_pylist()
    assert all(row["hvac_power_w"] is None and "shell_area_m2" in row["status"] for row in refused)


def test_a_worker_with_another_version_is_refused(large: bc.Study) -> None:
    """By its key, with words."""
    task = bc.spark._Optimize(None, WINDOWS, None, "0" * 64)
    with pytest.raises(bc.BusclimateError, match="another busclimate .* model key .* driver 0000000000000000"):
        next(task(iter([])))
    reading = bc.spark._ReadMissions(str(large.database.parent / "study.toml"), "0" * 64)
    with pytest.raises(bc.BusclimateError, match="reading key"):
        next(reading(iter([])))
    keys = {bc.model_key(windows=[1.0]), bc.model_key(windows=[0.5]), bc.model_key({"x": {"heating": "hp"}}, [1.0])}
    keys.add(bc.model_key(windows=[1.0], vehicle={"shell_area_m2": 120.0}))
    assert len(keys) == 4 and bc.model_key(windows=[1.0]) in keys
