//! Two missions in time for the report: the paper's own, where their files are there, else the coldest and the hottest.

use cabin::{PassengerViews, celsius};
use chrono::{DateTime, Timelike};
use report::{Curve, MissionFigure, Panel, ParetoPoint};
use simulate::{Conduct, Hour, Instant};
use store::{SampleRow, Store};

use super::ingest::weather_of;
use super::shade::read_shadow;
use super::simulate::{Setting, missions, operations};
use crate::failure::Failure;
use crate::study::Study;

/// The missions that the paper shows.
const PAPER: [&str; 2] =
    ["B183_2022-12-10_06-34-55_2022-12-10_23-26-20", "B183_2019-07-24_02-51-19_2019-07-24_17-15-53"];
/// The comfort limits of the paper's two figures.
const PAPER_LIMITS: [f64; 2] = [1.0, 0.5];

const BLUE: &str = "#0072b2";
const ORANGE: &str = "#d55e00";
const GREY: &str = "#777777";
const DASH: &str = "5 3";

/// Figures and Pareto points of the two missions, with the best equipped design; nothing where nothing is simulated.
pub fn figures(study: &Study, store: &mut Store) -> Result<(Vec<MissionFigure>, Vec<ParetoPoint>), Failure> {
    let stored = store.stored_study()?;
    let all = missions(store.samples()?);
    let design = study.grid.designs().len() - 1;
    let name = &study.design_rows[design].name;
    let Some((design_id, ..)) = stored.designs.iter().find(|d| d.1 == *name) else { return Ok(Default::default()) };
    if study.simulated_windows.is_empty() || store.simulation_keys()?.is_empty() {
        return Ok(Default::default());
    }
    let (weather, _) = weather_of(study)?;
    let (shadow, _) = read_shadow(&study.base, &study.shadow_path)?;
    let views = PassengerViews::new(&study.vehicle);
    let (mut figures, mut points) = (Vec::new(), Vec::new());
    for (i, label) in ["cold", "hot"].into_iter().enumerate() {
        let Some(samples) = chosen(&all, i) else { continue };
        let loads = store.loads(&samples[0].source_path)?;
        let Some(setting) = Setting::new(study, &views, &weather, &shadow, samples, &loads) else { continue };
        let solved = operations(store, samples)?;
        let shown = shown_window(study, PAPER_LIMITS[i]);
        for &w in &study.simulated_windows {
            let window = study.grid.windows()[w];
            let bits = [window.pmv_min().to_bits(), window.pmv_max().to_bits()];
            let Some((window_id, _)) = stored.windows.iter().find(|s| s.1 == bits) else { continue };
            let of = |s: &SampleRow| solved.get(&(*design_id, *window_id, s.sample_id)).copied();
            let optima: Vec<_> = samples.iter().map_while(of).collect();
            if optima.len() < samples.len() {
                continue;
            }
            let hours = setting.hours(&optima, window);
            let mission = setting.mission(study, &hours);
            let mut instants = Vec::new();
            let record = |now: &Instant| {
                if w == shown {
                    instants.push(*now);
                }
            };
            let spec = &study.grid.designs()[design];
            let Some(summary) = simulate::simulate(&mission, spec, &study.dynamics, Conduct::Paper, record) else {
                continue;
            };
            let point = |simulated, max_abs_pmv, power_w: f64| ParetoPoint {
                mission: format!("{label} mission"),
                simulated,
                max_abs_pmv,
                power_kw: power_w / 1e3,
            };
            points.push(point(false, summary.static_max_abs_pmv, summary.static_mean_hvac_power_w));
            if let Some(pmv) = summary.max_abs_pmv_15min {
                points.push(point(true, pmv, summary.mean_hvac_power_w));
            }
            if w == shown {
                figures.push(figure(study, name, label, samples, &mission, &hours, &instants, window));
            }
        }
    }
    points.sort_by_key(|p| (p.mission.clone(), p.simulated));
    Ok((figures, points))
}

fn chosen(all: &[Vec<SampleRow>], which: usize) -> Option<&Vec<SampleRow>> {
    if let Some(own) = all.iter().find(|m| m[0].mission == PAPER[which]) {
        return Some(own);
    }
    let mean_k = |m: &[SampleRow]| m.iter().map(|s| s.ambient_temperature_k).sum::<f64>() / m.len() as f64;
    let sign = if which == 0 { 1.0 } else { -1.0 };
    all.iter().min_by(|a, b| (sign * mean_k(a)).total_cmp(&(sign * mean_k(b))))
}

fn shown_window(study: &Study, limit: f64) -> usize {
    let off = |w: &usize| (study.grid.windows()[*w].pmv_limit() - limit).abs();
    let nearest = study.simulated_windows.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.unwrap_or(0)
}

#[expect(clippy::too_many_arguments, reason = "all that a figure of a mission shows")]
fn figure(
    study: &Study,
    design: &str,
    label: &str,
    samples: &[SampleRow],
    mission: &simulate::Mission<'_, '_>,
    hours: &[Hour],
    instants: &[Instant],
    window: cabin::ComfortWindow,
) -> MissionFigure {
    let start = DateTime::parse_from_rfc3339(&samples[0].start_utc).map(|t| t.with_timezone(&study.zone)).ok();
    let first_h = start.map_or(0.0, |t| f64::from(t.num_seconds_from_midnight()) / 3600.0);
    let segment_h = f64::from(mission.segment_s) / 3600.0;
    let end_h = first_h + segment_h * hours.len() as f64;
    // A value a minute: the mean of its seconds.
    let minutes = |value: &dyn Fn(&Instant) -> f64| -> Vec<(f64, f64)> {
        let mean = |(i, part): (usize, &[Instant])| {
            (first_h + (i as f64 + 0.5) / 60.0, part.iter().map(value).sum::<f64>() / part.len() as f64)
        };
        instants.chunks(60).enumerate().map(mean).collect()
    };
    let steps = |value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
        let of = |i: usize| [0.0, 1.0].map(|end| (first_h + segment_h * (i as f64 + end), value(i)));
        (0..hours.len()).flat_map(of).collect()
    };
    let curve = |name: &str, colour, dash, width, points| Curve { name: name.to_owned(), colour, dash, width, points };
    let panel = |label: &str, curves| Panel { label: label.to_owned(), curves };
    let flat = |value: f64| vec![(first_h, value), (end_h, value)];
    let o = |i: usize| &hours[i].optimum;
    let panels = vec![
        panel(
            "ambient °C",
            vec![
                curve("in time", BLUE, "", 1.4, {
                    let minute = |(i, c): (usize, &cabin::Cabin<'_>)| {
                        (first_h + (i as f64 + 0.5) / 60.0, celsius(c.ambient_k()))
                    };
                    mission.minutes.iter().enumerate().map(minute).collect()
                }),
                curve("segment mean", ORANGE, DASH, 1.4, steps(&|i| celsius(samples[i].ambient_temperature_k))),
            ],
        ),
        panel(
            "irradiance W/m²",
            vec![
                curve("direct normal", BLUE, DASH, 1.4, steps(&|i| samples[i].dni_w_m2)),
                curve("diffuse horizontal", ORANGE, DASH, 1.4, steps(&|i| samples[i].dhi_w_m2)),
            ],
        ),
        panel(
            "passengers",
            vec![
                curve("in time", BLUE, "", 1.0, minutes(&|n| n.passengers)),
                curve("segment mean", ORANGE, DASH, 1.4, steps(&|i| samples[i].passengers)),
            ],
        ),
        panel(
            "doors open %",
            vec![
                curve("minute mean", BLUE, "", 0.7, minutes(&|n| 100.0 * n.door_open_fraction)),
                curve("segment mean", ORANGE, DASH, 1.4, steps(&|i| 100.0 * samples[i].door_open_fraction)),
            ],
        ),
        panel(
            "temperature °C",
            vec![
                curve("cabin", BLUE, "", 1.2, minutes(&|n| celsius(n.state.temperatures.cabin_k))),
                curve("shell inside", GREY, "", 1.2, minutes(&|n| celsius(n.state.temperatures.shell_inside_k))),
                curve("steady state", ORANGE, DASH, 1.4, steps(&|i| celsius(o(i).temperatures.cabin_k))),
                curve("", ORANGE, DASH, 1.4, steps(&|i| celsius(o(i).temperatures.shell_inside_k))),
            ],
        ),
        panel(
            "PMV",
            vec![
                curve("minute mean", GREY, "", 0.8, minutes(&|n| n.pmv)),
                curve("15-minute mean", BLUE, "", 1.4, minutes(&|n| n.pmv_15min)),
                curve("steady state", ORANGE, DASH, 1.4, steps(&|i| o(i).pmv)),
                curve("window", GREY, "1 3", 1.2, flat(window.pmv_min())),
                curve("", GREY, "1 3", 1.2, flat(window.pmv_max())),
            ],
        ),
        panel(
            "HVAC power kW",
            vec![
                curve(
                    "simulated",
                    BLUE,
                    "",
                    1.0,
                    minutes(&|n| {
                        let c = &n.commands;
                        (c.air_unit_power_w.abs() + c.radiant_heater_power_w + n.air_curtain_power_w) / 1e3
                    }),
                ),
                curve("steady state", ORANGE, DASH, 1.4, steps(&|i| o(i).hvac_power_w() / 1e3)),
            ],
        ),
    ];
    let own = PAPER.contains(&samples[0].mission.as_str());
    MissionFigure {
        title: format!("A {label} mission with {design} at PMV {} … {}", window.pmv_min(), window.pmv_max()),
        caption: format!(
            "{}; {}",
            samples[0].source_path,
            if own { "named like the mission that the paper shows" } else { "not a mission of the paper" }
        ),
        note: study.note.clone().unwrap_or_default(),
        hours: [first_h, end_h],
        axis: format!("local time in h ({})", study.zone),
        panels,
    }
}
