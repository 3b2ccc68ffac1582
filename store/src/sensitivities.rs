//! What the year depends on: results where inputs vary, one at a time and all together.

use cabin::ComfortWindow;
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};

use crate::averages::last_run;
use crate::checks::{commit, seal_averages};
use crate::row::{Insert, begin, count, put_all, window};
use crate::stages::record_stage;
use crate::{RecordedStage, StageRecord, Store, StoreError};

/// A result: a quantity of a design and window.
#[derive(Debug, Clone, PartialEq)]
pub struct ResultOf {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// The quantity by its name: `hvac_power_w`, `heating_power_w`, `cooling_power_w`, `reduction`.
    pub quantity: String,
}

/// A row of `sensitivity_result`.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivityResult {
    /// The result.
    pub of: ResultOf,
    /// Its value for the bus itself.
    pub base_value: Option<f64>,
    /// Mean over independent sets.
    pub mean_value: f64,
    /// Standard deviation there.
    pub sd_value: f64,
    /// Between which values nine tenths of them lie.
    pub ends: [f64; 2],
    /// Sets that were solved.
    pub sets: u64,
    /// Points of all of them without an operation.
    pub unsolved: u64,
    /// Points of all of them in which the design misses the window, for want of power.
    pub limited: u64,
    /// Seed.
    pub seed: u64,
}

/// An input in a table of the sensitivity study.
#[derive(Debug, Clone, PartialEq)]
pub struct InputRow {
    /// Its name.
    pub name: String,
    /// Its place in the study.
    pub order: u64,
}

/// A row of `sensitivity_swing`.
#[derive(Debug, Clone, PartialEq)]
pub struct SwingRow {
    /// The result.
    pub of: ResultOf,
    /// The input.
    pub input: InputRow,
    /// Its value in the bus, the low and the high one.
    pub inputs: [f64; 3],
    /// The result at these values.
    pub values: [Option<f64>; 3],
}

impl SwingRow {
    /// How far the result goes between the low value and the high one; 0 where it has none at one of them.
    #[must_use]
    pub fn width(&self) -> f64 {
        let [_, low, high] = self.values;
        low.zip(high).map_or(0.0, |(low, high)| (high - low).abs())
    }

    /// What the low and the high value change of the result in the bus.
    #[must_use]
    pub fn changes(&self) -> [Option<f64>; 2] {
        let [base, low, high] = self.values;
        [low, high].map(|value| Some(value? - base?))
    }
}

/// A row of `sensitivity_index`.
#[derive(Debug, Clone, PartialEq)]
pub struct IndexRow {
    /// The result.
    pub of: ResultOf,
    /// The input.
    pub input: InputRow,
    /// Index of first order with the ends of its interval of 90 %.
    pub first: [f64; 3],
    /// Total index with the ends of its interval.
    pub total: [f64; 3],
}

/// All that a sensitivity study says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sensitivities {
    /// Results where all inputs vary.
    pub results: Vec<SensitivityResult>,
    /// Results where one input varies.
    pub swings: Vec<SwingRow>,
    /// Indices of the inputs.
    pub indices: Vec<IndexRow>,
}

const RESULTS: &str = "SELECT t.* FROM sensitivity_result AS t JOIN hvac_design AS d ON d.name = t.design
    ORDER BY d.position, t.quantity";
const SWINGS: &str = "SELECT t.* FROM sensitivity_swing AS t JOIN hvac_design AS d ON d.name = t.design
    ORDER BY d.position, t.quantity, t.input_order";
const INDICES: &str = "SELECT t.* FROM sensitivity_index AS t JOIN hvac_design AS d ON d.name = t.design
    ORDER BY d.position, t.quantity, t.input_order";

impl Store {
    /// Replaces the sensitivity study, and records the stage.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn complete_sensitivities(&mut self, record: &StageRecord, all: &Sensitivities) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            let run_id = last_run(&mut tx).await?;
            put(&mut tx, run_id, all).await?;
            seal_averages(&mut tx).await?;
            record_stage(&mut tx, RecordedStage::Sensitivity, record).await?;
            commit(tx).await
        })
    }

    /// The last sensitivity study; nothing where there was none.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn sensitivities(&mut self) -> Result<Sensitivities, StoreError> {
        let results = self.select(RESULTS, |r: &SqliteRow| {
            Ok(SensitivityResult {
                of: result_of(r)?,
                base_value: r.try_get("base_value")?,
                mean_value: r.try_get("mean_value")?,
                sd_value: r.try_get("sd_value")?,
                ends: [r.try_get("low_value")?, r.try_get("high_value")?],
                sets: count(r, "set_count")?,
                unsolved: count(r, "unsolved_count")?,
                limited: count(r, "limited_count")?,
                seed: count(r, "seed")?,
            })
        })?;
        let swings = self.select(SWINGS, |r: &SqliteRow| {
            Ok(SwingRow {
                of: result_of(r)?,
                input: input(r)?,
                inputs: [r.try_get("input_base")?, r.try_get("input_low")?, r.try_get("input_high")?],
                values: [r.try_get("base_value")?, r.try_get("low_value")?, r.try_get("high_value")?],
            })
        })?;
        let indices = self.select(INDICES, |r: &SqliteRow| {
            let of = |order: &str| -> Result<[f64; 3], sqlx::Error> {
                let [low, high] = ["low", "high"].map(|end| format!("{order}_{end}"));
                Ok([r.try_get(order)?, r.try_get(low.as_str())?, r.try_get(high.as_str())?])
            };
            Ok(IndexRow { of: result_of(r)?, input: input(r)?, first: of("first_order")?, total: of("total_order")? })
        })?;
        Ok(Sensitivities { results, swings, indices })
    }
}

fn result_of(r: &SqliteRow) -> Result<ResultOf, sqlx::Error> {
    Ok(ResultOf { design: r.try_get("design")?, window: window(r)?, quantity: r.try_get("quantity")? })
}

fn input(r: &SqliteRow) -> Result<InputRow, sqlx::Error> {
    Ok(InputRow { name: r.try_get("input")?, order: count(r, "input_order")? })
}

async fn put(c: &mut SqliteConnection, run_id: i64, all: &Sensitivities) -> Result<(), StoreError> {
    for sql in ["DELETE FROM sensitivity_result", "DELETE FROM sensitivity_swing", "DELETE FROM sensitivity_index"] {
        sqlx::query(sql).execute(&mut *c).await?;
    }
    let of_result = |insert: Insert, of: &ResultOf| {
        insert.of_point(&of.design, of.window)?.set("quantity", of.quantity.clone())?.set("run_id", run_id)
    };
    let of_input = |insert: Insert, input: &InputRow| {
        insert.set("input", input.name.clone())?.set("input_order", input.order.cast_signed())
    };
    put_all(c, "sensitivity_result", &all.results, |insert, row| {
        of_result(insert, &row.of)?
            .set("base_value", row.base_value)?
            .set("mean_value", row.mean_value)?
            .set("sd_value", row.sd_value)?
            .set("low_value", row.ends[0])?
            .set("high_value", row.ends[1])?
            .set("set_count", row.sets.cast_signed())?
            .set("unsolved_count", row.unsolved.cast_signed())?
            .set("limited_count", row.limited.cast_signed())?
            .set("seed", row.seed.cast_signed())
    })
    .await?;
    put_all(c, "sensitivity_swing", &all.swings, |insert, row| {
        let [base, low, high] = row.inputs;
        of_input(of_result(insert, &row.of)?, &row.input)?
            .set("input_base", base)?
            .set("input_low", low)?
            .set("input_high", high)?
            .set("base_value", row.values[0])?
            .set("low_value", row.values[1])?
            .set("high_value", row.values[2])
    })
    .await?;
    put_all(c, "sensitivity_index", &all.indices, |insert, row| {
        of_input(of_result(insert, &row.of)?, &row.input)?
            .set("first_order", row.first[0])?
            .set("first_order_low", row.first[1])?
            .set("first_order_high", row.first[2])?
            .set("total_order", row.total[0])?
            .set("total_order_low", row.total[1])?
            .set("total_order_high", row.total[2])
    })
    .await
}
