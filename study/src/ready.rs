//! From what was typed to what is meant: names looked up, ranges checked, lists expanded.

use cabin::{
    ComfortWindow, Cop, Design, Devices, Heating, LimitOf, PowerLimit, named_cooling_cops, named_heating_cops,
};
use ingest::mission::{Door, MissionFormat, MissionOptions, RouteChoice, TelemetryMap, Vehicle};
use ingest::weather::{Clock, ColumnMap, IrradianceUnit, TemperatureUnit, TimeLabel, WeatherFormat};
use setpoints::published;
use solve::{Grid, Method};
use store::DesignRow;

use crate::Control;
use crate::file;
use crate::keys::canonical;

/// More limits than this are a slip of the step.
const MOST_LIMITS: f64 = 1000.0;

pub(crate) fn mission_options(missions: &file::Missions) -> Result<MissionOptions, String> {
    if !(60..=86_400).contains(&missions.segment_s) {
        return Err(format!("[missions] segment_s = {} must lie between 60 and 86400", missions.segment_s));
    }
    if !(0.0..=1.0).contains(&missions.door_open_share) {
        return Err(format!("[missions] door_open_share = {} must lie between 0 and 1", missions.door_open_share));
    }
    Ok(MissionOptions {
        segment_s: missions.segment_s,
        // A share of the doors is one of all doors.
        door_open_share: if missions.door_share_column.is_some() { 1.0 } else { missions.door_open_share },
        keep_partial: missions.keep_partial,
        routes: route_choice(missions)?,
    })
}

fn route_choice(missions: &file::Missions) -> Result<RouteChoice, String> {
    // The order in which routes are listed, and how often, says nothing.
    let sorted = |routes: &[String]| {
        let routes: std::collections::BTreeSet<&String> = routes.iter().collect();
        routes.into_iter().cloned().collect::<Vec<_>>()
    };
    match (missions.routes.as_slice(), missions.without_routes.as_slice()) {
        ([], []) => Ok(RouteChoice::All),
        (only, []) => Ok(RouteChoice::Only(sorted(only))),
        ([], without) => Ok(RouteChoice::Without(sorted(without))),
        _ => Err("[missions] has both routes and without_routes; remove one of them".to_owned()),
    }
}

/// How mission files look.
pub(crate) fn mission_format(missions: &file::Missions) -> Result<MissionFormat, String> {
    let m = missions;
    let columns = [
        ("time_column", m.time_column.is_some()),
        ("time_zone", m.time_zone.is_some()),
        ("utc_offset", m.utc_offset.is_some()),
        ("vehicle_column", m.vehicle_column.is_some()),
        ("vehicle", m.vehicle.is_some()),
        ("passengers_column", m.passengers_column.is_some()),
        ("door_column", m.door_column.is_some()),
        ("door_share_column", m.door_share_column.is_some()),
        ("speed_column", m.speed_column.is_some()),
        ("speed_unit", m.speed_unit.is_some()),
        ("power_column", m.power_column.is_some()),
        ("power_unit", m.power_unit.is_some()),
        ("route_column", m.route_column.is_some()),
        ("hold_s", m.hold_s.is_some()),
        ("cut_gap_s", m.cut_gap_s.is_some()),
    ];
    if m.format == file::Telemetry::ZtBus {
        return match columns.iter().find(|(_, given)| *given) {
            Some((name, _)) => Err(format!("[missions] {name} belongs to format = \"csv\" only; remove it")),
            None => Ok(MissionFormat::ZtBus),
        };
    }
    let needed = |name: &str| format!("[missions] format = \"csv\" needs {name}");
    let not_both = |a: &str, b: &str| format!("[missions] has both {a} and {b}; remove one of them");
    let (hold_s, cut_gap_s) = (m.hold_s.unwrap_or(60), m.cut_gap_s.unwrap_or(900));
    for (name, value) in [("hold_s", hold_s), ("cut_gap_s", cut_gap_s)] {
        if !(1..=86_400).contains(&value) {
            return Err(format!("[missions] {name} = {value} must lie between 1 and 86400"));
        }
    }
    Ok(MissionFormat::Csv(std::sync::Arc::new(TelemetryMap {
        time_column: m.time_column.clone().ok_or_else(|| needed("time_column"))?,
        clock: clock("missions", m.time_zone.as_deref(), m.utc_offset.as_deref())?,
        vehicle: match (&m.vehicle_column, m.vehicle) {
            (Some(column), None) => Vehicle::Column(column.clone()),
            (None, Some(number)) => Vehicle::Number(number),
            (None, None) => return Err(needed("vehicle_column, or vehicle = NUMBER")),
            (Some(_), Some(_)) => return Err(not_both("vehicle_column", "vehicle")),
        },
        passengers_column: m.passengers_column.clone().ok_or_else(|| needed("passengers_column"))?,
        door: match (&m.door_column, &m.door_share_column) {
            (Some(column), None) => Door::Flag(column.clone()),
            (None, Some(column)) => Door::Share(column.clone()),
            (None, None) => return Err(needed("door_column or door_share_column")),
            (Some(_), Some(_)) => return Err(not_both("door_column", "door_share_column")),
        },
        speed_column: m.speed_column.clone(),
        speed_unit_m_s: factor("speed_unit", m.speed_unit.as_deref(), &[("m/s", 1.0), ("km/h", 1.0 / 3.6)])?,
        power_column: m.power_column.clone(),
        power_unit_w: factor("power_unit", m.power_unit.as_deref(), &[("W", 1.0), ("kW", 1000.0)])?,
        route_column: m.route_column.clone(),
        hold_s,
        cut_gap_s,
    })))
}

/// What one of a unit is; the first of all without a name.
fn factor(key: &str, given: Option<&str>, units: &[(&str, f64)]) -> Result<f64, String> {
    let found = given.map_or(units.first(), |given| units.iter().find(|(name, _)| *name == given));
    let known: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
    let error =
        || format!("[missions] {key} = {:?} is not known; known are: {}", given.unwrap_or_default(), known.join(", "));
    found.map(|(_, factor)| *factor).ok_or_else(error)
}

pub(crate) fn weather_format(weather: &file::Weather) -> Result<WeatherFormat, String> {
    let columns = [
        ("time_column", weather.time_column.is_some()),
        ("time_label", weather.time_label.is_some()),
        ("interval_s", weather.interval_s.is_some()),
        ("temperature_column", weather.temperature_column.is_some()),
        ("time_zone", weather.time_zone.is_some()),
        ("utc_offset", weather.utc_offset.is_some()),
        ("reference_year", weather.reference_year.is_some()),
        ("temperature_unit", weather.temperature_unit.is_some()),
        ("irradiance_unit", weather.irradiance_unit.is_some()),
        ("ghi_column", weather.ghi_column.is_some()),
        ("dhi_column", weather.dhi_column.is_some()),
        ("dni_column", weather.dni_column.is_some()),
    ];
    let known = match WeatherFormat::fixed(&weather.format) {
        Some(format) => format,
        None => {
            let needed = |name: &str| format!("[weather] format = \"csv\" needs {name}");
            let interval_s = weather.interval_s.ok_or_else(|| needed("interval_s"))?;
            if !(60..=86_400).contains(&interval_s) {
                return Err(format!("[weather] interval_s = {interval_s} must lie between 60 and 86400"));
            }
            if weather.ghi_column.is_none() && (weather.dhi_column.is_none() || weather.dni_column.is_none()) {
                return Err(needed("ghi_column, or dhi_column and dni_column"));
            }
            return Ok(WeatherFormat::Csv(ColumnMap {
                time_column: weather.time_column.clone().ok_or_else(|| needed("time_column"))?,
                time_label: match weather
                    .time_label
                    .ok_or_else(|| needed("time_label = \"start\", \"middle\" or \"end\""))?
                {
                    file::TimeLabel::Start => TimeLabel::Start,
                    file::TimeLabel::Middle => TimeLabel::Middle,
                    file::TimeLabel::End => TimeLabel::End,
                },
                clock: clock("weather", weather.time_zone.as_deref(), weather.utc_offset.as_deref())?,
                interval_s,
                reference_year: weather.reference_year,
                temperature_unit: unit(
                    "temperature_unit",
                    &weather.temperature_unit,
                    &TemperatureUnit::ALL,
                    TemperatureUnit::name,
                )?,
                irradiance_unit: unit(
                    "irradiance_unit",
                    &weather.irradiance_unit,
                    &IrradianceUnit::ALL,
                    IrradianceUnit::name,
                )?,
                temperature_column: weather.temperature_column.clone().ok_or_else(|| needed("temperature_column"))?,
                ghi_column: weather.ghi_column.clone(),
                dhi_column: weather.dhi_column.clone(),
                dni_column: weather.dni_column.clone(),
            }));
        }
    };
    match columns.iter().find(|(_, given)| *given) {
        Some((name, _)) => Err(format!("[weather] {name} belongs to format = \"csv\" only; remove it")),
        None => Ok(known),
    }
}

/// What stamps without an offset mean.
fn clock(section: &str, zone: Option<&str>, offset: Option<&str>) -> Result<Clock, String> {
    match (zone, offset) {
        (None, None) => Ok(Clock::Utc),
        (Some(zone), None) => match zone.parse() {
            Ok(zone) => Ok(Clock::Zone(zone)),
            Err(_) => Err(format!("[{section}] time_zone = {zone:?} is not known; take one such as \"Europe/Zurich\"")),
        },
        (None, Some(offset)) => Clock::of_offset(offset)
            .ok_or_else(|| format!("[{section}] utc_offset = {offset:?} is no offset; write one such as \"+01:00\"")),
        (Some(_), Some(_)) => Err(format!("[{section}] has both time_zone and utc_offset; remove one of them")),
    }
}

/// The unit of a name; the first of all without one.
fn unit<U: Copy>(key: &str, given: &Option<String>, all: &[U], name: fn(U) -> &'static str) -> Result<U, String> {
    let Some(given) = given else { return all.first().copied().ok_or_else(|| format!("{key} has no units")) };
    let error = || {
        let known: Vec<&str> = all.iter().map(|unit| name(*unit)).collect();
        format!("[weather] {key} = {given:?} is not known; known are: {}", known.join(", "))
    };
    all.iter().copied().find(|unit| name(*unit) == given).ok_or_else(error)
}

pub(crate) fn design((name, typed): &(String, file::Design)) -> Result<(Design, DesignRow), String> {
    let error = |e: String| format!("[designs.{name:?}] {e}");
    let heating = match typed.heating {
        file::Heating::Ptc => Heating::Ptc,
        file::Heating::Hp => Heating::HeatPump,
    };
    let devices = Devices { radiant_heaters: typed.radiant_heaters, air_curtain: typed.air_curtain };
    let (heating_cop, heating_text) = match (typed.heating, &typed.heating_cop) {
        (file::Heating::Ptc, None) => (Cop::Constant(1.0), "1".to_owned()),
        (_, given) => cop("heating_cop", given.as_ref(), named_heating_cops()).map_err(error)?,
    };
    let (cooling_cop, cooling_text) =
        cop("cooling_cop", typed.cooling_cop.as_ref(), named_cooling_cops()).map_err(error)?;
    let row = DesignRow {
        name: name.clone(),
        heating,
        heating_cop: heating_text,
        cooling_cop: cooling_text,
        devices,
        method: Method::Fast,
        design_key: String::new(),
    };
    let limit = |key: &str, given: &Option<file::Limit>| {
        let Some(given) = given else { return Ok(None) };
        let of = match typed.limits_are {
            Some(file::LimitOf::Electric) => LimitOf::Electric,
            Some(file::LimitOf::Thermal) => LimitOf::Thermal,
            None => return Err(format!("{key} needs limits_are = \"electric\" or \"thermal\" beside it")),
        };
        let limit = match given {
            file::Limit::Constant(limit_w) => PowerLimit::constant(of, *limit_w),
            file::Limit::Table(rows) => {
                PowerLimit::table(of, &rows.iter().map(|row| (row.0, row.1)).collect::<Vec<_>>())
            }
        };
        limit.map(Some).map_err(|e| format!("{key}: {e}"))
    };
    let heating_limit = limit("heating_limit_w", &typed.heating_limit_w).map_err(error)?;
    let cooling_limit = limit("cooling_limit_w", &typed.cooling_limit_w).map_err(error)?;
    if typed.limits_are.is_some() && heating_limit.is_none() && cooling_limit.is_none() {
        return Err(error("limits_are says what no limit is; give heating_limit_w or cooling_limit_w".to_owned()));
    }
    let backup_heater_w = typed.backup_heater_w.unwrap_or(0.0);
    if !(0.0..=1e6).contains(&backup_heater_w) {
        return Err(error(format!("backup_heater_w = {backup_heater_w} must lie between 0 and 1000000")));
    }
    let name = name.clone();
    let design =
        Design { name, heating, heating_cop, cooling_cop, devices, heating_limit, cooling_limit, backup_heater_w };
    Ok((design, row))
}

/// A curve with its name or table as text; without one, the first of the named.
fn cop(
    key: &str,
    given: Option<&file::Cop>,
    named: Vec<(&'static str, Cop, &'static str)>,
) -> Result<(Cop, String), String> {
    match given {
        Some(file::Cop::Table(rows)) => {
            let pairs = rows.iter().map(|row| (row.0, row.1)).collect();
            let curve = Cop::table(pairs).map_err(|e| format!("{key}: {e}"))?;
            Ok((curve, canonical(rows)))
        }
        Some(file::Cop::Name(name)) => {
            let known: Vec<&str> = named.iter().map(|n| n.0).collect();
            let error = || format!("{key} = {name:?} is not known; known are: {}", known.join(", "));
            let (name, curve, _) = named.iter().find(|n| n.0 == name).ok_or_else(error)?;
            Ok((curve.clone(), (*name).to_owned()))
        }
        None => {
            let (name, curve, _) = named.into_iter().next().ok_or("there are no named curves")?;
            Ok((curve, name.to_owned()))
        }
    }
}

/// Which controllers drive every mission.
pub(crate) fn control(typed: &file::Control, grid: &Grid) -> Result<Control, String> {
    if !(0.5..=1.0).contains(&typed.coverage) {
        return Err(format!("[control] coverage = {} must lie between 0.5 and 1", typed.coverage));
    }
    let place = |name: &String| {
        let names: Vec<&str> = grid.designs().iter().map(|d| d.name.as_str()).collect();
        let error = || format!("[control] designs: {name:?} is not one of the study's: {}", names.join(", "));
        names.iter().position(|known| known == name).ok_or_else(error)
    };
    let designs = match &typed.designs {
        Some(names) => names.iter().map(place).collect::<Result<Vec<_>, _>>()?,
        None => vec![grid.designs().len() - 1],
    };
    for (name, _) in &typed.profiles {
        let known = published();
        if name.is_empty() || name.starts_with("extracted") || known.iter().any(|p| p.name == name) {
            return Err(format!("[control] profiles: {name:?} is the name of other setpoints; take another one"));
        }
    }
    let is_driven = |i: &usize| typed.pmv_limits.contains(&grid.windows()[*i].pmv_limit());
    Ok(Control {
        windows: (0..grid.windows().len()).filter(is_driven).collect(),
        designs,
        coverage: typed.coverage,
        profiles: typed.profiles.clone(),
    })
}

/// How old the newest file of a section may be.
pub(crate) fn expected_h(section: &str, hours: Option<f64>) -> Result<Option<f64>, String> {
    match hours {
        Some(h) if !(h.is_finite() && h > 0.0) => {
            Err(format!("{section} expect_newest_within_hours = {h} must be a number of hours above 0"))
        }
        hours => Ok(hours),
    }
}

/// The windows of the study; without any, the paper's seventeen.
pub(crate) fn windows(comfort: &file::Comfort) -> Result<Vec<ComfortWindow>, String> {
    let default = file::Steps { from: 0.0, to: 2.0, step: 0.125 };
    let limits = match (&comfort.pmv_limits, &comfort.windows) {
        (Some(file::Limits::List(list)), _) => list.clone(),
        (Some(file::Limits::Steps(steps)), _) => expand(steps)?,
        (None, None) => expand(&default)?,
        (None, Some(_)) => Vec::new(),
    };
    let symmetric = limits.iter().map(|&limit| ComfortWindow::symmetric(limit));
    let unequal = comfort.windows.iter().flatten().map(|of| ComfortWindow::new(of.0, of.1));
    symmetric.chain(unequal).collect::<Result<_, _>>().map_err(|e| format!("[comfort] {e}"))
}

fn expand(steps: &file::Steps) -> Result<Vec<f64>, String> {
    let file::Steps { from, to, step } = *steps;
    let count = (to - from) / step;
    if !(step > 0.0 && (0.0..=MOST_LIMITS).contains(&count)) {
        return Err(format!(
            "[comfort] pmv_limits from {from} to {to} by {step}: step must be above 0 and lead from `from` to `to` in at \
             most {MOST_LIMITS} steps"
        ));
    }
    // A rounding error of the division must not lose the last limit.
    // Three steps of 0.1 are 0.3 to whoever typed them.
    let typed = |limit: f64| (limit * 1e9).round() / 1e9;
    Ok((0..=(count + 1e-9).floor() as u32).map(|i| typed(from + f64::from(i) * step)).collect())
}
