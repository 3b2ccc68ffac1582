"""What `busclimate` is made of."""

from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Protocol, final, type_check_only

__version__: str

@type_check_only
class ArrowStream(Protocol):
    """Tables of pyarrow, polars and pandas, and of busclimate itself."""

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@type_check_only
class ArrowBatch(Protocol):
    """A record batch."""

    def __arrow_c_array__(self, requested_schema: object | None = None) -> Any: ...

@type_check_only
class ArrowArray(Protocol):
    """An array."""

    def __arrow_c_array__(self, requested_schema: object | None = None) -> Any: ...

class BusclimateError(Exception):
    """What busclimate cannot do."""

class StudyError(BusclimateError):
    """A study, a design or a comfort window is wrong."""

class InputError(BusclimateError):
    """Data or a database cannot be used."""

@final
class Table:
    """A table of Arrow columns."""

    def __new__(
        cls,
        data: Any,
        *,
        names: Any = None,
        schema: Any = None,
        metadata: Any = None,
    ) -> Table: ...
    @property
    def num_rows(self) -> int: ...
    @property
    def num_columns(self) -> int: ...
    @property
    def column_names(self) -> list[str]: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@final
class Study:
    """A study file, ready to run."""

    @staticmethod
    def open(path: str | PathLike[str], *, database: str | PathLike[str] | None = None) -> Study: ...
    @property
    def name(self) -> str: ...
    @property
    def database(self) -> Path: ...
    @property
    def report_dir(self) -> Path: ...
    def run(self, stages: Sequence[str] | None = None, *, wait_s: float = 0.0) -> list[str]: ...
    def table(self, name: str) -> Table: ...
    def samples(self) -> Table: ...
    def mission(self, name: str) -> dict[str, Any]: ...
    def read_missions(self, paths: Sequence[str | PathLike[str]]) -> Table: ...
    def reading_key(self) -> str: ...

def model_key(
    designs: Mapping[str, Mapping[str, Any]] | None = None,
    windows: Sequence[float] | Sequence[Sequence[float]] | None = None,
    *,
    vehicle: Mapping[str, Any] | None = None,
) -> str: ...
def optimize(
    samples: ArrowStream | ArrowBatch,
    designs: Mapping[str, Mapping[str, Any]] | None = None,
    windows: Sequence[float] | Sequence[Sequence[float]] | None = None,
    *,
    vehicle: Mapping[str, Any] | None = None,
) -> Table: ...
def parameter_study(
    sets: ArrowStream | ArrowBatch,
    samples: ArrowStream | ArrowBatch,
    designs: Mapping[str, Mapping[str, Any]] | None = None,
    windows: Sequence[float] | Sequence[Sequence[float]] | None = None,
    *,
    vehicle: Mapping[str, Any] | None = None,
) -> Table: ...
def pmv(
    air_temperature_c: float | ArrowArray,
    mean_radiant_temperature_c: float | ArrowArray,
    *,
    clothing_clo: float | ArrowArray,
    metabolic_met: float | ArrowArray,
    relative_humidity: float | ArrowArray,
    air_velocity_m_s: float | ArrowArray,
) -> ArrowArray: ...
def read_mission(
    path: str | PathLike[str],
    *,
    segment_s: int = 3600,
    door_open_share: float = 0.6,
    keep_partial: bool = False,
) -> Table: ...
def sensitivity(
    samples: ArrowStream | ArrowBatch,
    inputs: Mapping[str, Sequence[float] | Mapping[str, float]] | None = None,
    designs: Mapping[str, Mapping[str, Any]] | None = None,
    *,
    pmv_limit: float = 1.0,
    points: int = 256,
    seed: int = 1,
    vehicle: Mapping[str, Any] | None = None,
) -> tuple[Table, Table, Table]: ...
def simulate(
    samples: ArrowStream | ArrowBatch,
    minutes: ArrowStream | ArrowBatch,
    loads: ArrowStream | ArrowBatch,
    designs: Mapping[str, Mapping[str, Any]] | None = None,
    windows: Sequence[float] | Sequence[Sequence[float]] | None = None,
    *,
    segment_s: int = 3600,
    door_open_share: float = 0.6,
    vehicle: Mapping[str, Any] | None = None,
    dynamics: Mapping[str, Any] | None = None,
) -> Table: ...
