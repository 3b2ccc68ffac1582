//! What a controller on board can learn from the optima (paper, figures `temperature-setpoints` and `aircurtain-setpoint`).

use cabin::{ComfortWindow, OperatingMode};
use setpoints::{CurtainThreshold, Profile, published};
use store::{Cloud, CloudPoint, SetpointRow};

use crate::StudyReport;
use crate::document::{Block, DataTable, Section, Table};
use crate::figure::palette::{BLACK, COOLING, DASHED, HEATING, REST, Style};
use crate::figure::{Axis, Chart, Mark, Panel};
use crate::numbers::{optional, percent, signed, text, window};

/// Published setpoints beside the clouds: name, colour and dashes. The paper's second is not public.
const SHOWN: [(&str, &str, &str); 3] =
    [("vdv-comfort", "#cc79a7", ""), ("vbz-18", "#009e73", DASHED), ("vecto", "#8a6d00", "1.5 1.5")];

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    if study.setpoints.is_empty() {
        return None;
    }
    let mut section = Section { tables: data(study), ..Section::new("Setpoints for a controller on board") }
        .asking("Which temperatures should a control aim at that knows no more than the temperatures of now?")
        .with(
        Block::words(
            "What a controller that knows the temperatures of now can learn from the optima: a heating profile along the upper edge of the hours that\n\
             heat, a cooling profile along the lower edge of those that cool, thresholds of the air curtains. All designs and windows are in\n\
             setpoint_profile.csv and curtain_threshold.csv; `busclimate control` writes them as files that a bus can load.",
        ),
    );
    let Some(design) = study.clouds.first().map(|c| &c.design) else { return Some(section) };
    let (file, caption) = ("temperature_setpoints", "Optima with the extracted setpoints, and published ones");
    section = section.with_chart(file, caption, profiles(study, design));
    if let Some(figure) = curtains(study, design) {
        let (file, caption) = ("aircurtain_setpoint", "When the air curtains run, with their thresholds");
        section = section.with_chart(file, caption, figure);
    }
    let columns = [
        "heats to °C (outside)",
        "… warmest",
        "covers",
        "cools to °C (outside)",
        "… warmest",
        "covers",
        "curtains heating K",
        "model K",
        "curtains cooling K",
        "model K",
    ];
    let rows = study.setpoints.iter().filter(|row| row.design == *design).map(row).collect();
    Some(
        section
            .with(Block::Table(Table::new("setpoint_profile.csv", &["PMV"], &columns, rows)))
            .with(Block::means(
                "A bus that heats to the heating profile is at least as warm as the optimum of its hour in the share of hours under “covers”, and\n\
                 as cool or cooler with the cooling profile. Curtains pay where the air inside and outside differ by more than the threshold.",
            ))
            .with(Block::limits(
                "A profile knows the ambient temperature alone: in sun, or with many passengers, it asks for more than the optimum of the hour\n\
                 does. Beyond the temperatures in brackets it has seen no hour.",
            )),
    )
}

/// The paper's three windows of its figure `temperature-setpoints`, or those among these that are nearest.
#[must_use]
pub fn nearest_windows(windows: &[ComfortWindow]) -> Vec<ComfortWindow> {
    let mut nearest = Vec::new();
    for limit in [0.25, 0.625, 1.0] {
        let off = |w: &ComfortWindow| (w.pmv_limit() - limit).abs();
        let found = windows.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.extend(found.filter(|w| !nearest.contains(w)));
    }
    nearest
}

fn row(of: &SetpointRow) -> Vec<String> {
    let none = || "–".to_owned();
    let end = |profile: &Result<Profile, String>, end: usize| {
        let at = |p: &Profile| {
            let ambient_c = p.curve.valid_c[end];
            format!("{:.1} ({:.0})", p.curve.at(ambient_c), ambient_c + 0.0).replace('-', "−")
        };
        profile.as_ref().map_or_else(|_| none(), at)
    };
    let covered = |profile: &Result<Profile, String>| percent(profile.as_ref().ok().map(|p| p.coverage));
    let kelvin = |value: Option<f64>| value.map_or_else(none, |k| format!("{k:.1}"));
    let curtain = |mode| of.setpoints.curtains.iter().find(|c| c.mode == mode);
    let both = |c: Option<&CurtainThreshold>| {
        [kelvin(c.and_then(|c| c.of_optima).map(|t| t.value)), kelvin(c.and_then(|c| c.analytic_k))]
    };
    let (heating, cooling) = (&of.setpoints.heating, &of.setpoints.cooling);
    let [on_heating, model_heating] = both(curtain(OperatingMode::Heating));
    let [on_cooling, model_cooling] = both(curtain(OperatingMode::Cooling));
    vec![
        window(of.window),
        end(heating, 0),
        end(heating, 1),
        covered(heating),
        end(cooling, 0),
        end(cooling, 1),
        covered(cooling),
        on_heating,
        model_heating,
        on_cooling,
        model_cooling,
    ]
}

/// Clouds with their profiles, and published setpoints in a panel of their own.
fn profiles(study: &StudyReport, design: &str) -> Chart {
    let ambient = || study.clouds.iter().flat_map(|c| c.points.iter()).map(|p| p.ambient_temperature_c);
    let from_c = ambient().fold(f64::INFINITY, f64::min).floor();
    let to_c = ambient().fold(f64::NEG_INFINITY, f64::max).ceil();
    let cabin = || study.clouds.iter().flat_map(|c| c.points.iter()).map(|p| p.cabin_temperature_c);
    let [low_c, high_c] = [(f64::min as fn(f64, f64) -> f64, f64::INFINITY), (f64::max, f64::NEG_INFINITY)]
        .map(|(f, e)| cabin().fold(e, f));
    let (low_c, high_c) = ((low_c / 5.0).floor() * 5.0, (high_c / 5.0).ceil() * 5.0);
    let line = |name: &str, style: Style, of: &setpoints::Curve, [from_c, to_c]: [f64; 2]| {
        let points = (0..=((to_c - from_c).max(0.0) * 4.0) as i64).map(|i| from_c + i as f64 / 4.0);
        // What lies beyond the axes is left out.
        let shown = |setpoint_c: f64| if (low_c..=high_c).contains(&setpoint_c) { setpoint_c } else { f64::NAN };
        Mark::line(name, style, points.map(|t| (t, shown(of.at(t)))).collect())
    };
    // The same axes on all panels.
    let panel = |title: String, marks| Panel {
        title,
        x: Axis::new("ambient °C").from(from_c).to(to_c),
        y: Axis::new("cabin °C").from(low_c).to(high_c),
        marks,
    };
    let of_cloud = |cloud: &Cloud| {
        let row = study.setpoints.iter().find(|row| row.design == design && row.window == cloud.window);
        let profile = |name, dash, profile: &Result<Profile, String>| {
            let style = Style::line(BLACK, dash, 1.2);
            profile.as_ref().ok().map(|p| line(name, style, &p.curve, p.curve.valid_c))
        };
        let mut marks = by_mode(cloud, |p| (p.ambient_temperature_c, p.cabin_temperature_c));
        if let Some(row) = row {
            marks.extend(profile("heating profile", "", &row.setpoints.heating));
            marks.extend(profile("cooling profile", DASHED, &row.setpoints.cooling));
        }
        panel(format!("PMV {}", window(cloud.window)), marks)
    };
    let mut panels: Vec<Panel> = study.clouds.iter().map(of_cloud).collect();
    let known = published();
    let of = |(name, colour, dash): &(&str, &'static str, &'static str)| {
        let style = Style::line(colour, dash, 1.2);
        let found = known.iter().find(|p| p.name == *name);
        found.map_or_else(Vec::new, |p| {
            let mut lines = vec![line(name, style, &p.heating, [from_c, to_c])];
            if !p.is_single() {
                let mut cooling = line(name, style, &p.cooling, [p.cooling.valid_c[0].max(from_c), to_c]);
                if let Mark::Line { what, .. } = &mut cooling {
                    *what = "cooling";
                }
                lines.push(cooling);
            }
            lines
        })
    };
    panels.push(panel("published".to_owned(), SHOWN.iter().flat_map(of).collect()));
    Chart {
        title: format!("Optimal cabin temperatures of {design} and setpoints"),
        told: "Each dot is a sample, by what the air unit does.".to_owned(),
        columns: 2,
        panels,
        height: 92.0,
    }
}

fn by_mode(cloud: &Cloud, place: fn(&CloudPoint) -> (f64, f64)) -> Vec<Mark> {
    let of = |(name, colour, mode): (&str, &'static str, OperatingMode)| Mark::Dots {
        name: name.to_owned(),
        colour,
        points: cloud.points.iter().filter(|p| p.mode == mode).map(place).collect(),
    };
    let passive = ("at rest", REST, OperatingMode::Passive);
    [passive, ("heating", HEATING, OperatingMode::Heating), ("cooling", COOLING, OperatingMode::Cooling)].map(of).into()
}

/// Optima by heat of the air unit and temperature difference, with the thresholds; `None` for a design without curtains.
fn curtains(study: &StudyReport, design: &str) -> Option<Chart> {
    let cloud = study.clouds.last()?;
    let row = study.setpoints.iter().find(|row| row.design == design && row.window == cloud.window)?;
    if row.setpoints.curtains.is_empty() {
        return None;
    }
    let place = |p: &CloudPoint| (p.air_unit_heat_w / 1e3, p.cabin_temperature_c - p.ambient_temperature_c);
    let of = |name: &str, colour, runs: bool| {
        let active = cloud.points.iter().filter(|p| p.mode != OperatingMode::Passive && p.air_curtain == runs);
        Mark::Dots { name: name.to_owned(), colour, points: active.map(place).collect() }
    };
    let limit = |t: &CurtainThreshold| {
        let (sign, mode) = if t.mode == OperatingMode::Cooling { (-1.0, "cooling") } else { (1.0, "heating") };
        let at = sign * t.of_optima?.value;
        Some(Mark::Limit { at, name: format!("{mode}: {} K", signed(at, 1)) })
    };
    let mut marks = vec![of("curtains off", "#bbbbbb", false), of("curtains on", COOLING, true)];
    marks.extend(row.setpoints.curtains.iter().filter_map(limit));
    Some(Chart {
        title: format!("Air curtains of {design} at PMV {}", window(cloud.window)),
        told: "Each dot is a sample in which the air unit heats or cools; dotted: thresholds.".to_owned(),
        columns: 1,
        panels: vec![Panel {
            x: Axis::new("heat of the air unit in kW"),
            y: Axis::new("cabin over ambient temperature in K"),
            marks,
            ..Panel::default()
        }],
        height: 140.0,
    })
}

fn data(study: &StudyReport) -> Vec<DataTable> {
    let modes = |of: fn(&SetpointRow) -> &Result<Profile, String>, mode: &'static str| {
        study.setpoints.iter().map(move |row| (row, mode, of(row)))
    };
    let profiles: Vec<(&SetpointRow, &str, &Result<Profile, String>)> =
        modes(|r| &r.setpoints.heating, "heating").chain(modes(|r| &r.setpoints.cooling, "cooling")).collect();
    let setting = |p: &Result<Profile, String>, of: fn(&Profile) -> String| p.as_ref().map(of).unwrap_or_default();
    let thresholds: Vec<(&SetpointRow, &CurtainThreshold)> =
        study.setpoints.iter().flat_map(|row| row.setpoints.curtains.iter().map(move |c| (row, c))).collect();
    vec![
        DataTable::of(
            "setpoint_profile.csv",
            &profiles,
            &[
                ("design", &|(row, ..)| text(&row.design)),
                ("pmv_min", &|(row, ..)| row.window.pmv_min().to_string()),
                ("pmv_max", &|(row, ..)| row.window.pmv_max().to_string()),
                ("mode", &|(_, mode, _)| (*mode).to_owned()),
                ("kind", &|(_, _, p)| setting(p, |p| p.curve.shape.kind().to_owned())),
                ("parameters", &|(_, _, p)| setting(p, |p| p.curve.shape.parameters())),
                ("valid_from_ambient_c", &|(_, _, p)| setting(p, |p| p.curve.valid_c[0].to_string())),
                ("valid_to_ambient_c", &|(_, _, p)| setting(p, |p| p.curve.valid_c[1].to_string())),
                ("coverage", &|(_, _, p)| setting(p, |p| p.coverage.to_string())),
                ("hour_count", &|(_, _, p)| setting(p, |p| p.points.to_string())),
                ("reason", &|(_, _, p)| p.as_ref().err().cloned().unwrap_or_default()),
            ],
        ),
        DataTable::of(
            "curtain_threshold.csv",
            &thresholds,
            &[
                ("design", &|(row, _)| text(&row.design)),
                ("pmv_min", &|(row, _)| row.window.pmv_min().to_string()),
                ("pmv_max", &|(row, _)| row.window.pmv_max().to_string()),
                ("mode", &|(_, c)| if c.mode == OperatingMode::Cooling { "cooling" } else { "heating" }.to_owned()),
                ("threshold_k", &|(_, c)| optional(c.of_optima.map(|t| t.value))),
                ("analytic_threshold_k", &|(_, c)| optional(c.analytic_k)),
                ("misclassified_weight", &|(_, c)| optional(c.of_optima.map(|t| t.misclassified))),
            ],
        ),
    ]
}
