"""Studies of any size on Apache Spark.

Spark schedules, retries and moves data; what a task computes is busclimate's, the same kernels as everywhere, on Arrow batches. A
row depends on its own inputs alone, so that retries and partitions change no bit of it. What cannot be used is a row with a reason,
never a failed task; a worker with another version of busclimate is an error that names both.

    missions = spark.createDataFrame([(path,) for path in paths], "path string").repartition(len(paths))
    samples = busclimate.spark.read_missions(missions, "/shared/study.toml")
    optima = busclimate.spark.optimize(samples.where("outcome = 'sample'"), windows=[0.5, 1.0])
    optima.write.partitionBy("design").parquet("/shared/optima")
    means = busclimate.spark.annual_means(optima, samples)
    years = busclimate.spark.parameter_study(sets, study_samples, windows=[1.0])
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import pyarrow as pa  # type: ignore[import-untyped]

import busclimate

if TYPE_CHECKING:
    from pyspark.sql import DataFrame

#: Days of the months; 29 February counts to none of them (paper, eq. meanPower).
DAYS = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31]
#: Samples that are solved at a time: with five designs and seventeen windows some 60 MB.
SAMPLES = 2048


def _batches(table: busclimate.Table) -> Iterator[pa.RecordBatch]:
    yield from pa.table(table).to_batches()


def _same(what: str, expected: str, found: str) -> None:
    if expected != found:
        raise busclimate.BusclimateError(
            f"this worker has another busclimate ({busclimate.__version__}): its {what} is {found[:16]}, that of the driver"
            f" {expected[:16]}; install the same wheel on all workers"
        )


def _schema(table: busclimate.Table) -> Any:
    from pyspark.sql.pandas.types import from_arrow_schema

    return from_arrow_schema(pa.table(table).schema)


class _ReadMissions:
    """What a task does with paths."""

    def __init__(self, study: str, key: str) -> None:
        self.study, self.key = study, key

    def __call__(self, batches: Iterable[pa.RecordBatch]) -> Iterator[pa.RecordBatch]:
        study = busclimate.Study.open(self.study)
        _same("reading key", self.key, study.reading_key())
        for batch in batches:
            # One at a time: a task holds one mission.
            for path in batch.column("path").to_pylist():
                yield from _batches(study.read_missions([path]))


class _Optimize:
    """What a task does with samples."""

    def __init__(self, designs: Any, windows: Any, vehicle: Any, key: str) -> None:
        self.designs, self.windows, self.vehicle, self.key = designs, windows, vehicle, key

    def __call__(self, batches: Iterable[pa.RecordBatch]) -> Iterator[pa.RecordBatch]:
        _same("model key", self.key, busclimate.model_key(self.designs, self.windows, vehicle=self.vehicle))
        for batch in batches:
            for first in range(0, batch.num_rows, SAMPLES):
                part = batch.slice(first, SAMPLES)
                found = pa.table(busclimate.optimize(part, self.designs, self.windows, vehicle=self.vehicle))
                # The place of a sample in its batch says nothing here.
                yield from found.drop_columns("sample").to_batches()


class _Parameters:
    """What a task does with sets of constants."""

    def __init__(self, samples: bytes, designs: Any, windows: Any, vehicle: Any, key: str) -> None:
        self.samples, self.designs, self.windows, self.vehicle, self.key = samples, designs, windows, vehicle, key

    def __call__(self, batches: Iterable[pa.RecordBatch]) -> Iterator[pa.RecordBatch]:
        _same("model key", self.key, busclimate.model_key(self.designs, self.windows, vehicle=self.vehicle))
        samples = pa.ipc.open_stream(self.samples).read_all()
        for batch in batches:
            yield from _batches(busclimate.parameter_study(batch, samples, self.designs, self.windows, vehicle=self.vehicle))


def read_missions(missions: DataFrame, study: str) -> DataFrame:
    """The samples of mission files: a row for each sample, excluded segment and refused file.

    `missions` has a column `path`; give it as many partitions as there are to be tasks, such as one a mission. `study` is a study
    file that all workers see, with its weather and shade; its missions are not looked at. Columns are those of
    `busclimate.Study.read_missions`.
    """
    opened = busclimate.Study.open(study)
    schema = _schema(opened.read_missions([]))
    return missions.select("path").mapInArrow(_ReadMissions(study, opened.reading_key()), schema)


def optimize(
    samples: DataFrame,
    designs: Mapping[str, Mapping[str, Any]] | None = None,
    windows: Sequence[float] | Sequence[Sequence[float]] | None = None,
    *,
    vehicle: Mapping[str, Any] | None = None,
) -> DataFrame:
    """The cheapest operation of every sample, design and window: `busclimate.optimize` on every partition.

    `samples` has `sample_id` and the columns that `busclimate.optimize` needs. Write the result with `partitionBy("design")`.
    """
    needed = ["sample_id", "dni_w_m2", "dhi_w_m2", "shadow_fraction", "passengers", "door_open_fraction"]
    for model, other in [("ambient_temperature_k", "ambient_temperature_c"), ("solar_altitude_rad", "solar_altitude_deg")]:
        needed.append(model if model in samples.columns else other)
    empty = pa.table({name: pa.array([], pa.int64() if name == "sample_id" else pa.float64()) for name in needed})
    found = pa.table(busclimate.optimize(empty, designs, windows, vehicle=vehicle)).drop_columns("sample")
    key = busclimate.model_key(designs, windows, vehicle=vehicle)
    from pyspark.sql.pandas.types import from_arrow_schema

    task = _Optimize(designs, windows, vehicle, key)
    return samples.select(*needed).mapInArrow(task, from_arrow_schema(found.schema))


def parameter_study(
    sets: DataFrame,
    samples: pa.Table | busclimate.Table,
    designs: Mapping[str, Mapping[str, Any]] | None = None,
    windows: Sequence[float] | Sequence[Sequence[float]] | None = None,
    *,
    vehicle: Mapping[str, Any] | None = None,
) -> DataFrame:
    """Annual means of buses with other constants: `busclimate.parameter_study` on every partition.

    `sets` has `set_id` and a column for each constant that varies. `samples` go to every task whole (a bus has some hundred kilobytes
    a year), so that a set is added up where it is solved, and no partition shows in the result. Of a billion points nothing else is
    kept.
    """
    table = pa.table(samples)
    stream = pa.BufferOutputStream()
    with pa.ipc.new_stream(stream, table.schema) as writer:
        writer.write_table(table)
    key = busclimate.model_key(designs, windows, vehicle=vehicle)
    # No set tells the columns.
    none = pa.table({"set_id": pa.array([], pa.int64())})
    found = busclimate.parameter_study(none, table.slice(0, 0), designs, windows, vehicle=vehicle)
    task = _Parameters(stream.getvalue().to_pybytes(), designs, windows, vehicle, key)
    return sets.mapInArrow(task, _schema(found))


def _sum(group: pa.Table) -> pa.Table:
    """An exact sum, rounded once: it depends on no order."""
    powers = group.column("hvac_power_w").to_pylist()
    keys = {name: [group.column(name)[0].as_py()] for name in ["design", "pmv_min", "pmv_max", "month"]}
    return pa.table(keys | {"power_sum_w": [math.fsum(powers)], "solved_count": [len(powers)]})


def annual_means(optima: DataFrame, samples: DataFrame) -> pa.Table:
    """Annual mean HVAC power in W by design and comfort window: months by their days, within one all solved samples alike.

    Each month of a design and window is summed up exactly by one task and rounded once; the year is made of these on the driver, in
    the order of the keys. No partition shows in the result.
    """
    months = samples.where("month IS NOT NULL").select("sample_id", "month")
    solved = optima.where("hvac_power_w IS NOT NULL").join(months, "sample_id")
    rows = solved.select("design", "pmv_min", "pmv_max", "month", "hvac_power_w")
    schema = "design string, pmv_min double, pmv_max double, month long, power_sum_w double, solved_count long"
    sums = rows.groupBy("design", "pmv_min", "pmv_max", "month").applyInArrow(_sum, schema).toArrow().to_pylist()
    points: dict[tuple[str, float, float], list[dict[str, Any]]] = defaultdict(list)
    for row in sorted(sums, key=lambda r: (r["design"], r["pmv_min"], r["pmv_max"], r["month"])):
        points[row["design"], row["pmv_min"], row["pmv_max"]].append(row)
    means: dict[str, list[Any]] = {"design": [], "pmv_min": [], "pmv_max": [], "hvac_power_w": [], "solved_count": []}
    for key, of in points.items():
        days = sum(DAYS[row["month"] - 1] for row in of)
        mean = math.fsum(DAYS[row["month"] - 1] / days * (row["power_sum_w"] / row["solved_count"]) for row in of)
        values = [*key, mean, sum(row["solved_count"] for row in of)]
        for column, value in zip(means.values(), values, strict=True):
            column.append(value)
    return pa.table(means)
