//! Look-up tables for fleet planners: what HVAC takes at a temperature, load and speed.
//!
//! Every value is an optimum of its own at disturbances on a grid, found by the fast method whatever the study's. It is HVAC alone: a
//! planner adds it to what driving takes. The plain tables have the columns that SimBA and eFLIPS read
//! (<https://github.com/rl-institut/simba>, `ConsumptionLut` of <https://github.com/mpm-tu-berlin/eflips-model>), with doors and sun as the
//! study has them at each temperature; the rich one has doors and sun as columns.

use cabin::{ComfortWindow, Disturbances, Optimum, PassengerViews, celsius, kelvin, roof_irradiance_w_m2};
use serde_json::json;
use solve::SampleSolver;
use std::path::Path;
use store::Store;
use study::Study;

use crate::{ExportError, PACKAGE, Provenance, make_folder_of, write_synced};

/// The folder of the plain tables, and the rich one.
pub(crate) const CONSUMPTION: &str = "consumption";
pub(crate) const HVAC_POWER: &str = "hvac_power.csv";

const AMBIENT_C: [f64; 13] = [-20.0, -15.0, -10.0, -5.0, 0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0];
const LOADING: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// HVAC knows no slope; readers interpolate in one.
const INCLINES: [f64; 3] = [-0.1, 0.0, 0.1];
const SPEEDS_KM_H: [f64; 7] = [5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 60.0];
const DOORS: [f64; 3] = [0.0, 0.15, 0.3];
const IRRADIANCE_W_M2: [f64; 4] = [0.0, 250.0, 500.0, 750.0];
/// Samples that lie so near to a temperature say what the sun does there.
const NEAR_K: f64 = 2.5;

/// What a full bus is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loading {
    /// People at a level of loading of 1.
    pub capacity: f64,
}

/// What doors and sun are on average.
#[derive(Debug, Clone, Copy, Default)]
struct Typical {
    weight: f64,
    door_open_fraction: f64,
    dhi_w_m2: f64,
    global_w_m2: f64,
    shadow_fraction: f64,
    /// Altitudes count by the irradiance that comes from there.
    altitude_rad: f64,
}

/// Writes the look-up tables of all designs and comfort windows into an empty folder.
///
/// # Errors
/// [`ExportError`].
pub fn look_up_tables(
    store: &mut Store,
    study: &Study,
    loading: Loading,
    provenance: &Provenance,
    folder: &Path,
) -> Result<(), ExportError> {
    let typical = typical_by_temperature(store)?;
    let mean = overall(&typical).ok_or(ExportError::NoSamples)?;
    let at: Vec<Typical> = AMBIENT_C.iter().map(|t| nearest(&typical, *t).unwrap_or(mean)).collect();
    let views = PassengerViews::new(&study.vehicle);
    let mut solver = SampleSolver::new(&study.vehicle, &views, &study.grid);
    let mut solve = |d: &Disturbances| {
        let mut optima = vec![Optimum::UNSOLVED; study.grid.points()];
        solver.solve(d, &mut optima);
        optima
    };

    let mut plain: Vec<Vec<Optimum>> = Vec::new();
    for (ambient_c, typical) in AMBIENT_C.iter().zip(&at) {
        let at = |level: &f64| typical.at(*ambient_c, level * loading.capacity, typical.global_w_m2);
        plain.extend(LOADING.iter().map(|level| solve(&at(level))));
    }
    let mut left_out = 0;
    for (design, spec) in study.grid.designs().iter().enumerate() {
        for (window, comfort) in study.grid.windows().iter().enumerate() {
            let path = folder.join(file_name(&spec.name, comfort));
            let of_point: Vec<&Optimum> =
                plain.iter().map(|optima| &optima[design * study.grid.windows().len() + window]).collect();
            left_out += write(&path, |csv| plain_table(csv, &of_point))?;
        }
    }
    let rich = |csv: &mut csv::Writer<std::fs::File>| rich_table(csv, study, loading, &mean, &mut solve);
    let unsolved = write(&folder.join(HVAC_POWER), rich)?;
    let about = json!({
        "profile": "data-package", "name": provenance.name(),
        "title": "HVAC share of the consumption of an electric bus",
        "description": "consumption/: kWh/km of HVAC alone, to be added to what driving takes, in the columns of SimBA and eFLIPS; doors and sun are means of the study's hours within 2.5 K, or of the nearest temperature that has some. hvac_power.csv: the same as power, with doors and sun as columns; global irradiance at the study's mean altitude of the sun and share of diffuse light. A point without an operation that meets the window has no row in the first and no power in the second.",
        "level_of_loading_1_is_passengers": loading.capacity, "rows_left_out": left_out, "rows_without_power": unsolved,
        "door_open_fraction": mean.door_open_fraction, "solar_altitude_deg": mean.altitude_rad.to_degrees(),
        "shadow_fraction": mean.shadow_fraction, "study": provenance.study, "study_hash": provenance.study_hash,
        "input_hash": provenance.input_hash, "program_version": provenance.program_version,
    });
    write_synced(&folder.join(PACKAGE), &format!("{about:#}\n"))
}

/// Writes a table; gives how many points had no operation.
fn write(
    path: &Path,
    table: impl FnOnce(&mut csv::Writer<std::fs::File>) -> csv::Result<usize>,
) -> Result<usize, ExportError> {
    make_folder_of(path)?;
    let mut writer = csv::Writer::from_path(path).map_err(|e| ExportError::Csv(path.to_owned(), e))?;
    let missing = table(&mut writer).map_err(|e| ExportError::Csv(path.to_owned(), e))?;
    let file = writer.into_inner().map_err(|e| ExportError::Write(path.to_owned(), e.into_error()))?;
    file.sync_all().map_err(|e| ExportError::Write(path.to_owned(), e))?;
    Ok(missing)
}

fn file_name(design: &str, window: &ComfortWindow) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_.+".contains(c) { c } else { '_' };
    let design: String = design.chars().map(plain).collect();
    format!("{CONSUMPTION}/{design}_pmv_{}_{}.csv", window.pmv_min(), window.pmv_max())
}

fn plain_table(csv: &mut csv::Writer<std::fs::File>, optima: &[&Optimum]) -> csv::Result<usize> {
    csv.write_record(["t_amb", "level_of_loading", "incline", "mean_speed_kmh", "consumption_kwh_per_km"])?;
    let mut missing = 0;
    let places = AMBIENT_C.iter().flat_map(|t| LOADING.iter().map(move |level| (t, level)));
    for ((ambient_c, level), optimum) in places.zip(optima) {
        let Some(operation) = optimum.outcome.operation() else {
            missing += INCLINES.len() * SPEEDS_KM_H.len();
            continue;
        };
        for incline in INCLINES {
            for speed_km_h in SPEEDS_KM_H {
                let kwh_per_km = operation.hvac_power_w() / 1000.0 / speed_km_h;
                csv.write_record([*ambient_c, *level, incline, speed_km_h, kwh_per_km].map(|v| v.to_string()))?;
            }
        }
    }
    Ok(missing)
}

fn rich_table(
    csv: &mut csv::Writer<std::fs::File>,
    study: &Study,
    loading: Loading,
    mean: &Typical,
    solve: &mut impl FnMut(&Disturbances) -> Vec<Optimum>,
) -> csv::Result<usize> {
    csv.write_record([
        "design",
        "pmv_min",
        "pmv_max",
        "t_amb",
        "level_of_loading",
        "door_open_fraction",
        "global_irradiance_w_m2",
        "hvac_power_w",
    ])?;
    let mut missing = 0;
    for ambient_c in AMBIENT_C {
        for level in LOADING {
            for door_open_fraction in DOORS {
                for global_w_m2 in IRRADIANCE_W_M2 {
                    let typical = mean.at(ambient_c, level * loading.capacity, global_w_m2);
                    let d = Disturbances { door_open_fraction, ..typical };
                    for optimum in solve(&d) {
                        let window = study.grid.windows()[optimum.window];
                        let power_w = optimum.outcome.operation().map(|o| o.hvac_power_w().to_string());
                        missing += usize::from(power_w.is_none());
                        csv.write_record([
                            study.grid.designs()[optimum.design].name.clone(),
                            window.pmv_min().to_string(),
                            window.pmv_max().to_string(),
                            ambient_c.to_string(),
                            level.to_string(),
                            door_open_fraction.to_string(),
                            global_w_m2.to_string(),
                            power_w.unwrap_or_default(),
                        ])?;
                    }
                }
            }
        }
    }
    Ok(missing)
}

/// Weighted sums over the samples near each temperature of the grid, and at the end over all.
fn typical_by_temperature(store: &mut Store) -> Result<Vec<Typical>, ExportError> {
    let months = store.months()?;
    let mut sums = vec![Typical::default(); AMBIENT_C.len() + 1];
    for sample in store.samples()? {
        let weight = months.iter().find(|m| m.month == sample.month).map_or(0.0, |m| m.sample_weight);
        let d = &sample.disturbances;
        let near = AMBIENT_C.iter().position(|t| (celsius(d.ambient_temperature_k) - t).abs() <= NEAR_K);
        for place in near.into_iter().chain([AMBIENT_C.len()]) {
            sums[place].add(weight, d);
        }
    }
    Ok(sums)
}

fn overall(sums: &[Typical]) -> Option<Typical> {
    sums.last().filter(|s| s.weight > 0.0).map(Typical::mean)
}

fn nearest(sums: &[Typical], ambient_c: f64) -> Option<Typical> {
    let with_samples = AMBIENT_C.iter().zip(sums).filter(|(_, sum)| sum.weight > 0.0);
    let distance = |place: &(&f64, &Typical)| (place.0 - ambient_c).abs();
    with_samples.min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|(_, sum)| sum.mean())
}

impl Typical {
    fn add(&mut self, weight: f64, d: &Disturbances) {
        let global_w_m2 = roof_irradiance_w_m2(d);
        self.weight += weight;
        self.door_open_fraction += weight * d.door_open_fraction;
        self.dhi_w_m2 += weight * d.dhi_w_m2;
        self.global_w_m2 += weight * global_w_m2;
        self.shadow_fraction += weight * d.shadow_fraction;
        self.altitude_rad += weight * global_w_m2 * d.solar_altitude_rad.max(0.0);
    }

    fn mean(&self) -> Self {
        let w = self.weight;
        let altitude_rad = if self.global_w_m2 > 0.0 { self.altitude_rad / self.global_w_m2 } else { 0.0 };
        Self {
            weight: 1.0,
            door_open_fraction: self.door_open_fraction / w,
            dhi_w_m2: self.dhi_w_m2 / w,
            global_w_m2: self.global_w_m2 / w,
            shadow_fraction: self.shadow_fraction / w,
            altitude_rad,
        }
    }

    /// Disturbances in the same mixture of light, as strong as wanted on the ground; the beam comes from the mean altitude.
    fn at(&self, ambient_c: f64, passengers: f64, global_w_m2: f64) -> Disturbances {
        let factor = if self.global_w_m2 > 0.0 { global_w_m2 / self.global_w_m2 } else { 0.0 };
        let up = self.altitude_rad.sin();
        let beam_w_m2 = (self.global_w_m2 - self.dhi_w_m2) * factor;
        Disturbances {
            ambient_temperature_k: kelvin(ambient_c),
            dni_w_m2: if up > 0.0 { beam_w_m2 / up } else { 0.0 },
            dhi_w_m2: self.dhi_w_m2 * factor,
            solar_altitude_rad: self.altitude_rad,
            shadow_fraction: self.shadow_fraction,
            passengers,
            door_open_fraction: self.door_open_fraction,
        }
    }
}
