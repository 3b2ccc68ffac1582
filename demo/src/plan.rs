//! Which missions there are.

use chrono::{DateTime, TimeDelta, TimeZone, Utc};
use std::io::Read;

use crate::SyntheticWeather;
use crate::random::Random;

/// Year of the first 365 missions; further ones fill the years before it.
const YEAR: i32 = 2022;
const MISSIONS_A_YEAR: usize = 365;
/// Most missions of a default plan: 50 years.
const MOST: usize = 50 * MISSIONS_A_YEAR;
const BUS: u32 = 183;
/// Longest mission that is believed.
const LONGEST: TimeDelta = TimeDelta::hours(48);
/// Routes of bus 183 with their number of missions.
const ROUTES: [(&str, f64); 6] =
    [("83", 441.0), ("33", 130.0), ("72", 114.0), ("46", 104.0), ("N2", 19.0), ("32", 12.0)];

/// What a mission should look like.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionPlan {
    /// Number of the bus.
    pub bus: u32,
    /// First second.
    pub start: DateTime<Utc>,
    /// Last second.
    pub end: DateTime<Utc>,
    /// Route, `-` where there is none.
    pub route: String,
    /// Mean of the recorded passenger counts.
    pub passengers_mean: f64,
    /// Largest recorded passenger count.
    pub passengers_max: f64,
    /// Mean, least and largest ambient temperature in K.
    pub ambient_k: [f64; 3],
}

impl MissionPlan {
    /// The name of the mission as ZTBus forms it.
    #[must_use]
    pub fn name(&self) -> String {
        let stamp = |t: DateTime<Utc>| t.format("%Y-%m-%d_%H-%M-%S").to_string();
        format!("B{}_{}_{}", self.bus, stamp(self.start), stamp(self.end))
    }
}

/// No plan can be made.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// The metadata is no CSV.
    #[error("{0}; give the metaData.csv of ZTBus: comma-separated, UTF-8")]
    Csv(#[from] csv::Error),
    /// A column is missing.
    #[error("line 1: the column {0} is missing; give the metaData.csv of ZTBus, separated by commas")]
    Column(&'static str),
    /// A value is not what belongs there.
    #[error("line {line}, column {column}: {text:?} is not {wanted}")]
    Value {
        /// Line of the file.
        line: u64,
        /// Column.
        column: &'static str,
        /// What stands there.
        text: String,
        /// What belongs there.
        wanted: &'static str,
    },
    /// More missions than there are days.
    #[error("{0} missions are too many; at most {MOST}")]
    TooMany(usize),
}

/// Missions of 3–6 h spread over the year, so that every month has some: one a day at most.
///
/// # Errors
/// [`PlanError::TooMany`].
pub fn default_plan(missions: usize, seed: u64) -> Result<Vec<MissionPlan>, PlanError> {
    if missions > MOST {
        return Err(PlanError::TooMany(missions));
    }
    let mut plans = Vec::with_capacity(missions);
    let years = missions.div_ceil(MISSIONS_A_YEAR).max(1);
    let first_year = YEAR + 1 - years as i32;
    let instant = |year, day: u64| {
        let start = Utc.with_ymd_and_hms(year, 1, 1, 0, 0, 0).single().expect("every year begins once");
        start + TimeDelta::days(day as i64)
    };
    let weather = SyntheticWeather::new(seed, instant(first_year, 0), instant(YEAR, 0));
    let mut random = Random::new(seed, u64::MAX - 1);
    for year in 0..years {
        let in_year = (missions * (year + 1) / years) - (missions * year / years);
        for i in 0..in_year {
            let day = ((i as f64 + 0.5) * 365.0 / in_year as f64) as u64;
            let hour = match random.between(0.0, 1.0) {
                u if u < 0.4 => random.between(2.0, 6.0),
                u if u < 0.6 => random.between(9.0, 12.0),
                _ => random.between(13.0, 15.0),
            };
            let start = instant(first_year + year as i32, day) + TimeDelta::seconds((hour * 3600.0) as i64);
            let end = start + TimeDelta::seconds(random.between(3.0 * 3600.0, 6.0 * 3600.0) as i64);
            let passengers_mean = random.between(10.0, 25.0);
            plans.push(MissionPlan {
                bus: BUS,
                start,
                end,
                route: route(&mut random).to_owned(),
                passengers_mean,
                passengers_max: (passengers_mean * random.between(2.5, 4.0)).round(),
                ambient_k: weather.temperature_k(start, end),
            });
        }
    }
    Ok(plans)
}

fn route(random: &mut Random) -> &'static str {
    let total: f64 = ROUTES.iter().map(|(_, n)| n).sum();
    let mut left = random.between(0.0, total);
    for (route, count) in ROUTES {
        left -= count;
        if left < 0.0 {
            return route;
        }
    }
    ROUTES[0].0
}

/// The missions of a published `metaData.csv`, of all its buses.
///
/// # Errors
/// [`PlanError`] names line, column and what belongs there.
pub fn read_meta_data(source: impl Read) -> Result<Vec<MissionPlan>, PlanError> {
    // Lines end at \n, so that they count right in files with \r\n; trimming removes the \r.
    let mut reader =
        csv::ReaderBuilder::new().terminator(csv::Terminator::Any(b'\n')).trim(csv::Trim::All).from_reader(source);
    let header = reader.headers()?.clone();
    let column = |name: &'static str| {
        let found = header.iter().position(|h| h.trim_start_matches('\u{feff}') == name);
        found.map(|position| (name, position)).ok_or(PlanError::Column(name))
    };
    let (bus, route) = (column("busNumber")?, column("busRoute")?);
    let (start, end) = (column("startTime_unix")?, column("endTime_unix")?);
    let load = [column("itcs_numberOfPassengers_mean")?, column("itcs_numberOfPassengers_max")?];
    let ambient =
        [column("temperature_ambient_mean")?, column("temperature_ambient_min")?, column("temperature_ambient_max")?];
    let mut plans = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record)? {
        let line = record.position().map_or(0, csv::Position::line);
        let error = |(name, position): (&'static str, usize), wanted| PlanError::Value {
            line,
            column: name,
            text: record[position].to_owned(),
            wanted,
        };
        let instant = |column: (&'static str, usize)| {
            let seconds = record[column.1].parse().ok();
            let time = seconds.and_then(|s| DateTime::from_timestamp(s, 0));
            time.ok_or_else(|| error(column, "a time in seconds since 1970"))
        };
        let number = |column: (&'static str, usize), low: f64, high: f64, wanted| {
            let value = record[column.1].parse::<f64>().ok();
            value.filter(|v| (low..=high).contains(v)).ok_or_else(|| error(column, wanted))
        };
        let (from, to) = (instant(start)?, instant(end)?);
        if to <= from || to - from > LONGEST {
            return Err(error(end, "within 48 h after the start of the mission"));
        }
        let kelvin = |column| number(column, 200.0, 350.0, "a temperature in K");
        let passengers = |column| number(column, 0.0, 500.0, "a number of passengers");
        plans.push(MissionPlan {
            bus: number(bus, 0.0, 1e6, "a bus number")? as u32,
            start: from,
            end: to,
            route: record[route.1].to_owned(),
            passengers_mean: passengers(load[0])?,
            passengers_max: passengers(load[1])?,
            ambient_k: [kelvin(ambient[0])?, kelvin(ambient[1])?, kelvin(ambient[2])?],
        });
    }
    Ok(plans)
}
