//! What the hours of the study are like (paper, figures `shadow-fraction` and `scenarios-overview`), and what passengers vote in
//! them (figure `yearly-pmv-range-comparison`).

use cabin::ComfortWindow;
use chrono::{NaiveDate, NaiveTime, TimeDelta, TimeZone, Utc};
use shading::hour_of_year;
use store::{DisturbanceBin, VoteBin};

use super::setpoints::nearest_windows;
use crate::StudyReport;
use crate::document::{Block, Section};
use crate::figure::palette::{FROM_COLD_TO_WARM, IN_TIME, Marker, SUN, Style};
use crate::figure::{Axis, Chart, Mark, Panel, Ticks};
use crate::numbers::window;

pub(super) fn section(study: &StudyReport) -> Option<Section> {
    if study.disturbance_bins.is_empty() {
        return None;
    }
    let mut section = Section::new("The hours of the study")
        .asking("What weather, shade and passengers do the hours have that all numbers come from?");
    for (file, caption, chart) in [
        ("shadow_fraction", "Shadow fraction on three days", shadow(study)),
        ("scenarios_overview", "Disturbances of all samples", Some(disturbances(&study.disturbance_bins))),
        ("pmv_range", "Votes at the optima", votes(study)),
    ] {
        if let Some(chart) = chart {
            section = section.with_chart(file, caption, chart);
        }
    }
    Some(
        section
            .with(Block::means(
                "All numbers hold for hours like these. A colder place, fuller buses or doors that open more often give others: the same study\n\
                 file with other inputs says which.",
            ))
            .with(Block::limits(
                "A sample is the mean of its hour. What doors, passengers and sun do within the hour is in the simulation alone.",
            )),
    )
}

/// Three days of the year (paper, figure `shadow-fraction`); none where no shade is stored.
fn shadow(study: &StudyReport) -> Option<Chart> {
    const YEAR: i32 = 2022;
    let days = [
        ("10 December", 12, 10, Marker::Circle),
        ("21 March", 3, 21, Marker::OpenSquare),
        ("24 July", 7, 24, Marker::Triangle),
    ];
    let of = |((name, month, day, marker), style): ((&str, u32, u32, Marker), Style)| {
        let midnight = NaiveDate::from_ymd_opt(YEAR, month, day)?.and_time(NaiveTime::MIN);
        let start = study.zone.from_local_datetime(&midnight).earliest()?.with_timezone(&Utc);
        let at = |hour: u32| {
            let value = study.shadow.get(hour_of_year(start + TimeDelta::hours(hour.into())));
            Some((f64::from(hour), *value?))
        };
        let style = Style { marker: Some(marker), ..style };
        Some(Mark::line(name, style, (0..=24).filter_map(at).collect()))
    };
    (!study.shadow.is_empty()).then(|| Chart {
        title: "Shadow fraction".to_owned(),
        told: "Share of the way that lies in the shade, by local time.".to_owned(),
        columns: 1,
        panels: vec![Panel {
            x: Axis::new(format!("local time ({})", study.zone)).from(0.0).to(24.0).with(Ticks::Clock),
            y: Axis::new("shadow fraction").from(0.0).to(1.0),
            marks: days.into_iter().zip(FROM_COLD_TO_WARM).filter_map(of).collect(),
            ..Panel::default()
        }],
        height: 100.0,
    })
}

/// The outline of bins that follow each other; those that are missing hold nothing.
fn outline(bins: impl Iterator<Item = ([f64; 2], f64)>) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for ([from, to], height) in bins {
        match points.last() {
            Some(&(end, _)) if end < from - 1e-9 => points.extend([(end, 0.0), (from, 0.0)]),
            None => points.push((from, 0.0)),
            _ => {}
        }
        points.extend([(from, height), (to, height)]);
    }
    if let Some(&(end, _)) = points.last() {
        points.push((end, 0.0));
    }
    points
}

fn disturbances(bins: &[DisturbanceBin]) -> Chart {
    let of = |quantity: &str, scale: f64| {
        let rows = bins.iter().filter(|b| b.quantity == quantity);
        outline(rows.map(|b| (b.ends.map(|end| end * scale), b.samples as f64)))
    };
    let filled = |name: &str, style: Style, points: Vec<(f64, f64)>| {
        [Mark::Area { name: name.to_owned(), style, points: points.clone() }, Mark::line(name, style, points)]
    };
    let plain = Style::line(IN_TIME, "", 0.8);
    let panel = |x: Axis, marks: Vec<Mark>| Panel { x, y: Axis::new("samples").from(0.0), marks, ..Panel::default() };
    let one = |quantity: &str, scale, x: Axis| panel(x, filled("", plain, of(quantity, scale)).into());
    let sun = [
        filled("direct normal irradiance", Style::line(SUN, "", 0.9), of("dni_w_m2", 1.0)),
        filled("diffuse horizontal", Style::line(IN_TIME, "2 1.2", 0.9), of("dhi_w_m2", 1.0)),
    ];
    // A month is in the middle of its bin.
    let months =
        outline(bins.iter().filter(|b| b.quantity == "month").map(|b| (b.ends.map(|end| end - 0.5), b.samples as f64)));
    Chart {
        title: "The hours of the study".to_owned(),
        told: "How many samples lie where.".to_owned(),
        columns: 2,
        panels: vec![
            one("ambient_temperature_c", 1.0, Axis::new("ambient temperature in °C")),
            panel(Axis::new("irradiance in W/m²").from(0.0), sun.into_iter().flatten().collect()),
            one("passengers", 1.0, Axis::new("passengers").from(0.0)),
            panel(Axis::new("month").from(0.5).to(12.5).with(Ticks::Months), filled("", plain, months).into()),
            one("door_open_fraction", 100.0, Axis::new("doors open in %").from(0.0)),
            one("local_hour", 1.0, Axis::new("local time").from(0.0).to(24.0).with(Ticks::Clock)),
        ],
        height: 58.0,
    }
}

/// Votes of the best equipped design in the paper's three windows, or those that are nearest; none where no window is solved.
fn votes(study: &StudyReport) -> Option<Chart> {
    let (design, _) = study.cheapest(study.shown_window()?)?;
    let rows: Vec<&VoteBin> = study.vote_bins.iter().filter(|b| b.design == design).collect();
    let mut windows: Vec<ComfortWindow> = Vec::new();
    for row in &rows {
        if !windows.contains(&row.window) {
            windows.push(row.window);
        }
    }
    let mut marks = Vec::new();
    for (of, style) in nearest_windows(&windows).into_iter().zip(FROM_COLD_TO_WARM) {
        let bins = rows.iter().filter(|b| b.window == of).map(|b| (b.ends, 100.0 * b.weight));
        marks.push(Mark::line(format!("PMV {}", window(of)), style, outline(bins)));
    }
    (!marks.is_empty()).then(|| Chart {
        title: format!("What passengers vote at the optima of {design}"),
        told: "Share of the year by predicted mean vote, in bins of a tenth; a vote at a limit counts inside."
            .to_owned(),
        columns: 1,
        panels: vec![Panel {
            x: Axis::new("PMV"),
            y: Axis::new("share of the year in %").from(0.0),
            marks,
            ..Panel::default()
        }],
        height: 120.0,
    })
}
