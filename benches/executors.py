"""The same kernels on one and two executors of Apache Spark, a core each: python3 benches/executors.py FOLDER

FOLDER holds a study that is run, such as a demo. Python has the wheel with its part for Spark; Java 17 is there. Prints seconds of
each map; every one runs twice, the first time to start its workers.
"""

import os
import pathlib
import sys
import time

import pyarrow as pa
import pyspark
from pyspark.sql import SparkSession

import busclimate as bc
import busclimate.spark

folder = pathlib.Path(sys.argv[1]).resolve()
COPIES = 40
SETS = 400

study = bc.Study.open(folder)
files = sorted(str(path) for path in (folder / "ztbus").glob("B*.csv"))
samples = pa.table(study.samples())
os.environ |= {"SPARK_HOME": str(pathlib.Path(pyspark.__file__).parent), "PYSPARK_PYTHON": sys.executable}
os.environ["SPARK_LOCAL_IP"] = "127.0.0.1"


def timed(what, size, unit, work):
    work()
    begin = time.perf_counter()
    work()
    took = time.perf_counter() - begin
    print(f"  {what}: {took:.2f} s, {size / took:.3g} {unit}/s", flush=True)


for executors in (1, 2):
    print(f"{executors} executor{'s' * (executors > 1)}")
    builder = SparkSession.builder.master(f"local-cluster[{executors},1,1024]").appName("busclimate")
    for key, value in {
        "spark.ui.enabled": "false",
        "spark.driver.bindAddress": "127.0.0.1",
        "spark.driver.host": "127.0.0.1",
        "spark.sql.shuffle.partitions": "4",
        "spark.sql.execution.arrow.maxRecordsPerBatch": "2000",
    }.items():
        builder = builder.config(key, value)
    spark = builder.getOrCreate()
    spark.sparkContext.setLogLevel("ERROR")
    missions = spark.createDataFrame([(path,) for path in files], "path string").repartition(len(files))
    timed("missions to samples", len(files), "missions", lambda: bc.spark.read_missions(missions, str(folder / "study.toml")).count())
    many = spark.createDataFrame(pa.concat_tables([samples] * COPIES)).repartition(2 * executors).cache()
    points = many.count() * 85

    def optima():
        bc.spark.optimize(many).write.mode("overwrite").partitionBy("design").parquet(str(folder / "optima"))

    timed("samples to optima as Parquet by design", points, "optima", optima)
    sets = spark.createDataFrame([(n, 150.0 + 0.2 * n) for n in range(SETS)], "set_id long, shell_area_m2 double")
    sets = sets.repartition(8 * executors)
    timed(
        "sets to years",
        SETS * samples.num_rows * 85,
        "optima",
        lambda: bc.spark.parameter_study(sets, samples).agg({"hvac_power_w": "sum"}).collect(),
    )
    spark.stop()
