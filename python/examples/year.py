"""What comfort costs in each month, and what a better insulated bus would change.

Usage: python year.py STUDY_FOLDER. Runs the study where it has not been run, and prints two tables.
"""

import sys

import polars as pl

import busclimate


def months(study: busclimate.Study) -> pl.DataFrame:
    """Mean HVAC power in W by month and design at PMV ±1."""
    monthly = pl.DataFrame(study.table("monthly_average")).filter(pl.col("pmv_limit") == 1.0)
    return monthly.pivot(on="design", index="month", values="hvac_power_w").sort("month")


def annual_w(study: busclimate.Study, vehicle: dict[str, float]) -> pl.DataFrame:
    """Annual mean HVAC power in W by design at PMV ±1, of a bus with other constants."""
    samples = study.samples()
    optima = pl.DataFrame(busclimate.optimize(samples, windows=[1.0], vehicle=vehicle))
    weights = pl.DataFrame(study.table("sample")).select("sample_id", "weight")
    weighted = optima.join(weights, on="sample_id").filter(pl.col("status") == "solved")
    power = (pl.col("hvac_power_w") * pl.col("weight")).sum() / pl.col("weight").sum()
    return weighted.group_by("design", maintain_order=True).agg(power.alias("hvac_power_w"))


def main(folder: str) -> None:
    study = busclimate.Study.open(folder)
    study.run(["ingest", "shade", "solve"])
    print(months(study))
    base = annual_w(study, {})
    insulated = annual_w(study, {"conduction_shell_w_m2_k": 2.0})
    print(base.join(insulated, on="design", suffix="_insulated"))


if __name__ == "__main__":
    main(sys.argv[1])
