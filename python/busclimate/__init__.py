"""busclimate: what thermal comfort in an electric city bus costs over a year.

The kernels of the program on Arrow data, and whole studies. Numbers are those of the program, bit for bit. Tables come out as
Arrow: `pyarrow.table(t)`, `polars.DataFrame(t)`, `pandas.DataFrame.from_arrow(t)` take them without a copy.
"""

from ._busclimate import (
    BusclimateError,
    InputError,
    Study,
    StudyError,
    Table,
    __version__,
    model_key,
    optimize,
    parameter_study,
    pmv,
    read_mission,
    sensitivity,
    simulate,
)

__all__ = [
    "BusclimateError",
    "InputError",
    "Study",
    "StudyError",
    "Table",
    "__version__",
    "model_key",
    "optimize",
    "parameter_study",
    "pmv",
    "read_mission",
    "sensitivity",
    "simulate",
]
