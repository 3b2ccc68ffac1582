//! What a controller on board can learn from the optima (paper, figures `temperature-setpoints` and `aircurtain-setpoint`).

use cabin::OperatingMode;
use setpoints::{CurtainThreshold, Profile, published};
use store::{Cloud, CloudPoint, SetpointRow};

use crate::document::{Block, DataTable, Figure, Section, Table};
use crate::figure::{CloudFigure, CloudPanel, Curve, PointCloud, clouds_svg};
use crate::numbers::{optional, percent, text, window};
use crate::{ReportError, StudyReport};

const WARM: &str = "#d55e00";
const COLD: &str = "#0072b2";
const GREY: &str = "#999999";
const BLACK: &str = "#000000";
const DASH: &str = "6 3";
/// Published setpoints beside the clouds: name, colours of heating and cooling. The paper's second is not public.
const SHOWN: [(&str, &str); 3] = [("vdv-comfort", "#785ef0"), ("vbz-18", "#009e73"), ("vecto", "#b8860b")];

pub(super) fn section(study: &StudyReport) -> Result<Option<Section>, ReportError> {
    if study.setpoints.is_empty() {
        return Ok(None);
    }
    let mut section = Section { tables: data(study), ..Section::new("Setpoints for a controller on board") }.with(
        Block::words(
            "What a controller that knows the temperatures of now can learn from the optima: a heating profile along the upper edge of the hours that\n\
             heat, a cooling profile along the lower edge of those that cool, thresholds of the air curtains. All designs and windows are in\n\
             setpoint_profile.csv and curtain_threshold.csv; `busclimate control` writes them as files that a bus can load.",
        ),
    );
    let Some(design) = study.clouds.first().map(|c| &c.design) else { return Ok(Some(section)) };
    let (file, caption) = ("temperature_setpoints.svg", "Optima with the extracted setpoints, and published ones");
    section.figures.push(Figure { file, svg: clouds_svg(&profiles(study, design))? });
    section = section.with(Block::Figure { file, caption });
    if let Some(figure) = curtains(study, design) {
        let (file, caption) = ("aircurtain_setpoint.svg", "When the air curtains run, with their thresholds");
        section.figures.push(Figure { file, svg: clouds_svg(&figure)? });
        section = section.with(Block::Figure { file, caption });
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
    Ok(Some(section.with(Block::Table(Table::new(&["PMV"], &columns, rows)))))
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
fn profiles(study: &StudyReport, design: &str) -> CloudFigure {
    let ambient = || study.clouds.iter().flat_map(|c| c.points.iter()).map(|p| p.ambient_temperature_c);
    let from_c = ambient().fold(f64::INFINITY, f64::min).floor();
    let to_c = ambient().fold(f64::NEG_INFINITY, f64::max).ceil();
    let curve = |name: &str, colour, dash, of: &setpoints::Curve, [from_c, to_c]: [f64; 2]| {
        let points = (0..=((to_c - from_c).max(0.0) * 4.0) as i64).map(|i| from_c + i as f64 / 4.0);
        let points = points.map(|t| (t, of.at(t))).collect();
        Curve { name: name.to_owned(), colour, dash, width: 1.8, points }
    };
    let panel = |cloud: &Cloud| {
        let row = study.setpoints.iter().find(|row| row.design == design && row.window == cloud.window);
        let profile = |name, dash, profile: &Result<Profile, String>| {
            profile.as_ref().ok().map(|p| curve(name, BLACK, dash, &p.curve, p.curve.valid_c))
        };
        let curves = row.map(|row| {
            let heating = profile("heating profile", "", &row.setpoints.heating);
            [heating, profile("cooling profile", DASH, &row.setpoints.cooling)].into_iter().flatten().collect()
        });
        let temperatures = |p: &CloudPoint| (p.ambient_temperature_c, p.cabin_temperature_c);
        CloudPanel {
            title: format!("PMV {}", window(cloud.window)),
            clouds: by_mode(cloud, temperatures),
            curves: curves.unwrap_or_default(),
        }
    };
    let mut panels: Vec<CloudPanel> = study.clouds.iter().map(panel).collect();
    let known = published();
    let of = |(name, colour): &(&str, &'static str)| {
        let found = known.iter().find(|p| p.name == *name);
        found.map_or_else(Vec::new, |p| {
            let mut curves = vec![curve(name, *colour, "", &p.heating, [from_c, to_c])];
            if !p.is_single() {
                curves.push(curve("", *colour, DASH, &p.cooling, [p.cooling.valid_c[0].max(from_c), to_c]));
            }
            curves
        })
    };
    panels.push(CloudPanel {
        title: "published".to_owned(),
        clouds: Vec::new(),
        curves: SHOWN.iter().flat_map(of).collect(),
    });
    CloudFigure {
        title: format!("Optimal cabin temperatures of {design} and setpoints"),
        caption: "Each dot is a sample; profiles are solid for heating, dashed for cooling.".to_owned(),
        axes: ["ambient temperature in °C", "cabin temperature in °C"],
        panels,
        size: [205.0, 240.0],
    }
}

fn by_mode(cloud: &Cloud, place: fn(&CloudPoint) -> (f64, f64)) -> Vec<PointCloud> {
    let of = |(name, colour, mode): (&'static str, &'static str, OperatingMode)| PointCloud {
        name,
        colour,
        points: cloud.points.iter().filter(|p| p.mode == mode).map(place).collect(),
    };
    let passive = ("at rest", GREY, OperatingMode::Passive);
    [passive, ("heats", WARM, OperatingMode::Heating), ("cools", COLD, OperatingMode::Cooling)].map(of).to_vec()
}

/// Optima by heat of the air unit and temperature difference, with the thresholds; `None` for a design without curtains.
fn curtains(study: &StudyReport, design: &str) -> Option<CloudFigure> {
    let cloud = study.clouds.last()?;
    let row = study.setpoints.iter().find(|row| row.design == design && row.window == cloud.window)?;
    if row.setpoints.curtains.is_empty() {
        return None;
    }
    let place = |p: &CloudPoint| (p.air_unit_heat_w / 1e3, p.cabin_temperature_c - p.ambient_temperature_c);
    let of = |name, colour, runs: bool| {
        let active = cloud.points.iter().filter(|p| p.mode != OperatingMode::Passive && p.air_curtain == runs);
        PointCloud { name, colour, points: active.map(place).collect() }
    };
    let heat = || cloud.points.iter().map(|p| p.air_unit_heat_w / 1e3);
    let ends = [heat().fold(0.0, f64::min), heat().fold(0.0, f64::max)];
    let line = |t: &CurtainThreshold| {
        let (sign, end) = if t.mode == OperatingMode::Cooling { (-1.0, ends[0]) } else { (1.0, ends[1]) };
        let threshold_k = sign * t.of_optima?.value;
        let points = vec![(0.0, threshold_k), (end, threshold_k)];
        Some(Curve { name: "threshold".to_owned(), colour: BLACK, dash: DASH, width: 1.6, points })
    };
    Some(CloudFigure {
        title: format!("Air curtains of {design} at PMV {}", window(cloud.window)),
        caption: "Each dot is a sample in which the air unit heats or cools.".to_owned(),
        axes: ["heat of the air unit in kW", "cabin over ambient temperature in K"],
        panels: vec![CloudPanel {
            title: String::new(),
            clouds: vec![of("curtains off", GREY, false), of("curtains on", "#009e73", true)],
            curves: row.setpoints.curtains.iter().filter_map(line).collect(),
        }],
        size: [560.0, 300.0],
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
