//! A row of the table of optima, on its way in and out.

use cabin::{Devices, Infeasible, OperatingMode, Operation, Outcome, StandardRange, Temperatures};
use solve::nlp::Effort;
use sqlx::error::BoxDynError;
use sqlx::sqlite::{SqliteArguments, SqliteRow};
use sqlx::{Arguments, Decode, Row, Sqlite};

use crate::StoreError;
use crate::checks::{Damage, RowHash};

/// The columns in the order of the table.
pub(super) const COLUMNS: [&str; 25] = [
    "sample_id",
    "design_id",
    "window_id",
    "status",
    "operating_mode",
    "air_curtain_on",
    "radiant_heaters_on",
    "outside_standard_range",
    "air_unit_power_w",
    "radiant_heater_power_w",
    "air_curtain_power_w",
    "air_unit_heat_w",
    "cabin_k",
    "interior_k",
    "shell_inside_k",
    "shell_outside_k",
    "radiant_heater_k",
    "mean_radiant_k",
    "pmv",
    "runner_up_excess_w",
    "kkt_residual",
    "subproblem_count",
    "backup_heater_power_w",
    "unmet_heat_w",
    "row_check",
];
/// Values of an operation: columns but for keys and status before it and six after it.
const OPERATION_VALUES: usize = COLUMNS.len() - 10;

/// How outcomes are kept in `status`.
const STATUSES: [(i64, Outcome); 3] = [
    (1, Outcome::Infeasible(Infeasible::TooWarm)),
    (2, Outcome::Infeasible(Infeasible::TooCold)),
    (NOT_CONVERGED, Outcome::NotConverged),
];
pub(super) const SOLVED: i64 = 0;
pub(super) const NOT_CONVERGED: i64 = 3;

/// Values of a row, in the order of [`COLUMNS`], on their way into a statement and into the row's check.
pub(super) struct RowValues<'a> {
    pub arguments: &'a mut SqliteArguments,
    pub hash: &'a mut RowHash,
    /// Whether all rows of the statement are usual.
    pub usual: bool,
}

impl RowValues<'_> {
    fn integer(&mut self, value: Option<i64>) -> Result<(), BoxDynError> {
        self.hash.integer(value);
        self.arguments.add(value)
    }

    fn real(&mut self, value: Option<f64>) -> Result<(), BoxDynError> {
        self.hash.real(value);
        self.arguments.add(value)
    }

    /// A value that the statement's text has where all its rows are usual.
    fn usual_integer(&mut self, value: Option<i64>) -> Result<(), BoxDynError> {
        if self.usual {
            self.hash.integer(value);
            return Ok(());
        }
        self.integer(value)
    }

    /// The same of a number.
    fn usual_real(&mut self, value: Option<f64>) -> Result<(), BoxDynError> {
        if self.usual {
            self.hash.real(value);
            return Ok(());
        }
        self.real(value)
    }
}

/// All values behind the keys.
pub(super) fn add_row(
    values: &mut RowValues<'_>,
    outcome: &Outcome,
    effort: Option<Effort>,
) -> Result<(), BoxDynError> {
    let status = STATUSES.iter().find(|(_, other)| other == outcome).map_or(SOLVED, |s| s.0);
    values.usual_integer(Some(status))?;
    let solved = match outcome {
        Outcome::Solved(operation, runner_up_excess_w) => Some((operation, *runner_up_excess_w)),
        _ => None,
    };
    match solved {
        Some((operation, _)) => add_operation(values, operation)?,
        None => {
            for _ in 0..OPERATION_VALUES {
                values.real(None)?;
            }
        }
    }
    values.real(solved.and_then(|(_, runner_up_excess_w)| runner_up_excess_w))?;
    values.usual_real(effort.map(|e| e.kkt_residual))?;
    values.usual_integer(effort.map(|e| i64::from(e.subproblems)))?;
    values.usual_real(solved.map(|(operation, _)| operation.backup_heater_power_w))?;
    values.usual_real(solved.map(|(operation, _)| operation.unmet_heat_w))?;
    let check = values.hash.finish();
    values.arguments.add(check)
}

fn add_operation(values: &mut RowValues<'_>, o: &Operation) -> Result<(), BoxDynError> {
    let outside = o.standard_range == StandardRange::Outside;
    let (curtain, heaters) = (o.devices.air_curtain, o.devices.radiant_heaters);
    for choice in [i64::from(o.mode.number()), i64::from(curtain), i64::from(heaters), i64::from(outside)] {
        values.integer(Some(choice))?;
    }
    let t = o.temperatures;
    for value in [
        o.air_unit_power_w,
        o.radiant_heater_power_w,
        o.air_curtain_power_w,
        o.air_unit_heat_w,
        t.cabin_k,
        t.interior_k,
        t.shell_inside_k,
        t.shell_outside_k,
        t.radiant_heater_k,
        o.mean_radiant_temperature_k,
        o.pmv,
    ] {
        values.real(Some(value))?;
    }
    Ok(())
}

/// A row as it is read.
pub(super) struct StoredRow {
    /// Sample, design and window.
    pub keys: [i64; 3],
    /// `None` where a value that the status asks for is missing.
    pub outcome: Option<Outcome>,
}

/// Values one after the other, on their way out of a row and into its check.
struct Values<'a> {
    row: &'a SqliteRow,
    at: usize,
    hash: &'a mut RowHash,
}

impl<'a> Values<'a> {
    fn next<T: Decode<'a, Sqlite>>(&mut self) -> Result<Option<T>, sqlx::Error> {
        self.at += 1;
        // The table is strict: a value that is there is of its column's type.
        self.row.try_get_unchecked(self.at - 1)
    }

    fn integer(&mut self) -> Result<Option<i64>, sqlx::Error> {
        let value = self.next()?;
        self.hash.integer(value);
        Ok(value)
    }

    fn real(&mut self) -> Result<Option<f64>, sqlx::Error> {
        let value = self.next()?;
        self.hash.real(value);
        Ok(value)
    }
}

/// Reads the optimum of a row that ends with [`COLUMNS`]; refuses one that is not as it was written.
pub(super) fn read(damage: Damage<'_>, row: &SqliteRow, hash: &mut RowHash) -> Result<StoredRow, StoreError> {
    let mut values = Values { row, at: row.len() - COLUMNS.len(), hash };
    let mut key = || Ok::<_, sqlx::Error>(values.integer()?.unwrap_or_default());
    let keys = [key()?, key()?, key()?];
    let status = values.integer()?;
    let operation = operation(&mut values)?;
    let runner_up_excess_w = values.real()?;
    // What an iteration has cost.
    values.real()?;
    values.integer()?;
    let (backup, unmet) = (values.real()?, values.real()?);
    let check = values.next::<i64>()?;
    let outcome = match (status, operation, backup, unmet) {
        (Some(SOLVED), Some(operation), Some(backup_heater_power_w), Some(unmet_heat_w)) => {
            let operation = Operation { backup_heater_power_w, unmet_heat_w, ..operation };
            Some(Outcome::Solved(operation, runner_up_excess_w))
        }
        (Some(status), ..) => STATUSES.iter().find(|(code, _)| *code == status).map(|s| s.1),
        (None, ..) => None,
    };
    let now = hash.finish();
    if check.is_some_and(|then| then != now) {
        damage.of("optimum_point", row)?;
    }
    Ok(StoredRow { keys, outcome })
}

/// The values of an operation but for the two that limits add; `None` where one is missing.
fn operation(values: &mut Values<'_>) -> Result<Option<Operation>, sqlx::Error> {
    let (mode, curtain) = (values.integer()?.and_then(OperatingMode::from_number), values.integer()?);
    let (heaters, outside) = (values.integer()?, values.integer()?);
    let mut complete = mode.is_some() && curtain.is_some() && heaters.is_some() && outside.is_some();
    let mut value = || {
        let stored = values.real()?;
        complete &= stored.is_some();
        Ok::<_, sqlx::Error>(stored.unwrap_or(f64::NAN))
    };
    // In the order of the columns.
    let operation = Operation {
        mode: mode.unwrap_or(OperatingMode::Passive),
        devices: Devices { radiant_heaters: heaters == Some(1), air_curtain: curtain == Some(1) },
        standard_range: if outside == Some(1) { StandardRange::Outside } else { StandardRange::Inside },
        air_unit_power_w: value()?,
        radiant_heater_power_w: value()?,
        air_curtain_power_w: value()?,
        air_unit_heat_w: value()?,
        temperatures: Temperatures {
            cabin_k: value()?,
            interior_k: value()?,
            shell_inside_k: value()?,
            shell_outside_k: value()?,
            radiant_heater_k: value()?,
        },
        mean_radiant_temperature_k: value()?,
        pmv: value()?,
        backup_heater_power_w: 0.0,
        unmet_heat_w: 0.0,
    };
    Ok(complete.then_some(operation))
}
