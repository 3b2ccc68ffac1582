//! Optima apart from a database: the rows of some samples as Parquet.

use cabin::{ComfortWindow, Devices, Infeasible, OperatingMode, Operation, Outcome, StandardRange, Temperatures};
use polars::prelude::{
    Column, DataFrame, NamedFrom, ParquetReader, ParquetWriter, PolarsError, PolarsResult, SerReader, Series,
};
use std::io::Cursor;

/// An optimum, and what it was found for.
#[derive(Debug, Clone, PartialEq)]
pub struct ChunkRow {
    /// Sample.
    pub sample_id: i64,
    /// Hash of what the sample was made from.
    pub sample_key: String,
    /// Hash of design, constants of the bus and version of the method.
    pub design_key: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// How it ended.
    pub outcome: Outcome,
}

/// The numbers of an operation, in the order of [`numbers`].
const NUMBERS: [&str; 14] = [
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
    "backup_heater_power_w",
    "unmet_heat_w",
    "runner_up_excess_w",
];

/// The rows as the bytes of a Parquet file, every bit of them.
///
/// # Errors
/// [`PolarsError`]; not for any rows.
pub fn chunk_bytes(rows: &[ChunkRow]) -> Result<Vec<u8>, PolarsError> {
    let mut bytes = Vec::new();
    ParquetWriter::new(&mut bytes).finish(&mut frame(rows)?)?;
    Ok(bytes)
}

/// The rows of such bytes.
///
/// # Errors
/// What is wrong with them.
pub fn chunk_rows(bytes: Vec<u8>) -> Result<Vec<ChunkRow>, String> {
    ParquetReader::new(Cursor::new(bytes)).finish().and_then(|frame| rows(&frame)).map_err(|e| e.to_string())?
}

fn frame(rows: &[ChunkRow]) -> PolarsResult<DataFrame> {
    let text = |name: &str, of: fn(&ChunkRow) -> &str| {
        Column::from(Series::new(name.into(), rows.iter().map(of).collect::<Vec<&str>>()))
    };
    let real = |name: &str, of: &dyn Fn(&ChunkRow) -> Option<f64>| {
        Column::from(Series::new(name.into(), rows.iter().map(of).collect::<Vec<Option<f64>>>()))
    };
    let whole = |name: &str, of: &dyn Fn(&ChunkRow) -> Option<i64>| {
        Column::from(Series::new(name.into(), rows.iter().map(of).collect::<Vec<Option<i64>>>()))
    };
    let operation = |row: &ChunkRow| row.outcome.operation().copied();
    let mut columns = vec![
        whole("sample_id", &|r| Some(r.sample_id)),
        text("sample_key", |r| &r.sample_key),
        text("design_key", |r| &r.design_key),
        real("pmv_min", &|r| Some(r.window.pmv_min())),
        real("pmv_max", &|r| Some(r.window.pmv_max())),
        text("status", |r| r.outcome.words()),
        whole("operating_mode", &|r| operation(r).map(|o| o.mode.number().into())),
        whole("air_curtain_on", &|r| operation(r).map(|o| o.devices.air_curtain.into())),
        whole("radiant_heaters_on", &|r| operation(r).map(|o| o.devices.radiant_heaters.into())),
        whole("outside_standard_range", &|r| {
            operation(r).map(|o| i64::from(o.standard_range == StandardRange::Outside))
        }),
    ];
    for (n, name) in NUMBERS.iter().enumerate() {
        columns.push(real(name, &|r| numbers(&r.outcome)[n]));
    }
    DataFrame::new_infer_height(columns)
}

fn numbers(outcome: &Outcome) -> [Option<f64>; NUMBERS.len()] {
    let Outcome::Solved(o, excess_w) = outcome else { return [None; NUMBERS.len()] };
    let t = &o.temperatures;
    [
        Some(o.air_unit_power_w),
        Some(o.radiant_heater_power_w),
        Some(o.air_curtain_power_w),
        Some(o.air_unit_heat_w),
        Some(t.cabin_k),
        Some(t.interior_k),
        Some(t.shell_inside_k),
        Some(t.shell_outside_k),
        Some(t.radiant_heater_k),
        Some(o.mean_radiant_temperature_k),
        Some(o.pmv),
        Some(o.backup_heater_power_w),
        Some(o.unmet_heat_w),
        *excess_w,
    ]
}

/// The outer error is polars', the inner one says what no chunk has.
fn rows(frame: &DataFrame) -> PolarsResult<Result<Vec<ChunkRow>, String>> {
    let text = |name: &str| frame.column(name)?.str().cloned();
    let whole = |name: &str| frame.column(name)?.i64().cloned();
    let real = |name: &str| frame.column(name)?.f64().cloned();
    let (ids, low, high) = (whole("sample_id")?, real("pmv_min")?, real("pmv_max")?);
    let (sample_keys, design_keys, statuses) = (text("sample_key")?, text("design_key")?, text("status")?);
    let flags = ["operating_mode", "air_curtain_on", "radiant_heaters_on", "outside_standard_range"];
    let flags = flags.map(whole).into_iter().collect::<PolarsResult<Vec<_>>>()?;
    let values = NUMBERS.map(real).into_iter().collect::<PolarsResult<Vec<_>>>()?;
    let row = |i: usize| -> Option<ChunkRow> {
        let value = |n: usize| values[n].get(i);
        let outcome = match statuses.get(i)? {
            "solved" | "limited" => Outcome::Solved(
                Operation {
                    mode: OperatingMode::from_number(flags[0].get(i)?)?,
                    devices: Devices { air_curtain: flags[1].get(i)? == 1, radiant_heaters: flags[2].get(i)? == 1 },
                    standard_range: if flags[3].get(i)? == 1 { StandardRange::Outside } else { StandardRange::Inside },
                    air_unit_power_w: value(0)?,
                    radiant_heater_power_w: value(1)?,
                    air_curtain_power_w: value(2)?,
                    air_unit_heat_w: value(3)?,
                    temperatures: Temperatures {
                        cabin_k: value(4)?,
                        interior_k: value(5)?,
                        shell_inside_k: value(6)?,
                        shell_outside_k: value(7)?,
                        radiant_heater_k: value(8)?,
                    },
                    mean_radiant_temperature_k: value(9)?,
                    pmv: value(10)?,
                    backup_heater_power_w: value(11)?,
                    unmet_heat_w: value(12)?,
                },
                value(13),
            ),
            words => [Infeasible::TooWarm, Infeasible::TooCold]
                .map(Outcome::Infeasible)
                .into_iter()
                .chain([Outcome::NotConverged])
                .find(|outcome| outcome.words() == words)?,
        };
        Some(ChunkRow {
            sample_id: ids.get(i)?,
            sample_key: sample_keys.get(i)?.to_owned(),
            design_key: design_keys.get(i)?.to_owned(),
            window: ComfortWindow::new(low.get(i)?, high.get(i)?).ok()?,
            outcome,
        })
    };
    let all: Option<Vec<ChunkRow>> = (0..frame.height()).map(row).collect();
    Ok(all.ok_or_else(|| "a row lacks a value that its status asks for".to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cabin::{Disturbances, PassengerViews, Vehicle, kelvin};
    use solve::{Grid, SampleSolver};

    #[test]
    fn prop_a_chunk_gives_its_rows_back_to_the_bit() {
        let vehicle = Vehicle::default();
        let views = PassengerViews::new(&vehicle);
        let windows = vec![ComfortWindow::symmetric(0.25).unwrap(), ComfortWindow::new(-0.5, 0.7).unwrap()];
        let grid = Grid::new(testing::paper_designs(), windows).unwrap();
        let mut rows = Vec::new();
        for (n, ambient_c) in [-15.0, 5.0, 18.0, 33.0, 59.0].into_iter().enumerate() {
            let mut optima = vec![cabin::Optimum::UNSOLVED; grid.points()];
            let d = Disturbances {
                ambient_temperature_k: kelvin(ambient_c),
                dni_w_m2: 10.0 * n as f64,
                dhi_w_m2: 60.0,
                solar_altitude_rad: 0.4,
                shadow_fraction: 0.3,
                passengers: 100.0 * n as f64,
                door_open_fraction: 0.1,
            };
            SampleSolver::new(&vehicle, &views, &grid).solve(&d, &mut optima);
            rows.extend(optima.iter().map(|o| ChunkRow {
                sample_id: n as i64,
                sample_key: format!("sample {n}"),
                design_key: grid.designs()[o.design].name.clone(),
                window: grid.windows()[o.window],
                outcome: o.outcome,
            }));
        }
        rows.push(ChunkRow { outcome: Outcome::NotConverged, ..rows[0].clone() });
        rows.push(ChunkRow { outcome: Outcome::Infeasible(Infeasible::TooCold), ..rows[0].clone() });
        let bytes = chunk_bytes(&rows).unwrap();
        assert_eq!(bytes, chunk_bytes(&rows).unwrap(), "the same bytes");
        assert_eq!(chunk_rows(bytes.clone()).unwrap(), rows);
        assert!(chunk_rows(bytes[..bytes.len() / 2].to_vec()).is_err());
    }
}
