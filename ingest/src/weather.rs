//! Weather as a series of intervals, and its mean over any segment.

use chrono::{DateTime, Datelike, TimeZone, Timelike, Utc};
use shading::Site;
use std::path::PathBuf;

use crate::files::{label, list};
use crate::irradiance::{closure, erbs};
use crate::weather_files::{Quantities, read_file};
use crate::{ExclusionReason, FileRecord, Finding, FindingKind, IngestError};

/// Longest span of a series: beyond it a stamp is wrong.
const MAX_YEARS: i64 = 60;
const YEAR_HOURS: usize = 8760;

/// How weather files look.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WeatherFormat {
    /// Open data of the automatic stations of MeteoSwiss, 10-minute or hourly.
    MeteoSwissOgd,
    /// SIA 4028 reference year of MeteoSwiss.
    Sia4028,
    /// Any file with one row per interval.
    Csv(ColumnMap),
}

/// Which column of a weather file is what.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnMap {
    /// Stamps in RFC 3339; without an offset they are UTC.
    pub time_column: String,
    /// Which end of its interval a stamp names.
    pub time_label: TimeLabel,
    /// Length of an interval in s.
    pub interval_s: u32,
    /// Ambient temperature in °C.
    pub temperature_column: String,
    /// Global horizontal irradiance in W/m².
    pub ghi_column: Option<String>,
    /// Diffuse horizontal irradiance in W/m².
    pub dhi_column: Option<String>,
    /// Direct normal irradiance in W/m².
    pub dni_column: Option<String>,
}

/// Which end of its interval a stamp names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeLabel {
    /// The start.
    Start,
    /// The end.
    End,
}

/// How global irradiance is split where the diffuse one is not measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IrradianceSplit {
    /// [`erbs`].
    Erbs,
}

/// How weather becomes a series.
#[derive(Debug, Clone, PartialEq)]
pub struct WeatherOptions {
    /// How the files look.
    pub format: WeatherFormat,
    /// Abbreviation of the station, needed where files of several stations lie together.
    pub station: Option<String>,
    /// Longest gap that is interpolated, in s.
    pub max_gap_s: u32,
    /// How global irradiance is split.
    pub split: IrradianceSplit,
    /// Where the sun is looked up for the split.
    pub site: Site,
}

/// Intervals of equal length, from the first to the last one in the files.
#[derive(Debug, Clone, PartialEq)]
pub struct Weather {
    calendar: Calendar,
    interval_s: i64,
    max_gap_s: u32,
    temperature_k: Vec<f64>,
    dni_w_m2: Vec<f64>,
    dhi_w_m2: Vec<f64>,
    /// Whether any quantity of the interval is interpolated.
    interpolated: Vec<bool>,
}

/// Which interval an instant belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Calendar {
    /// Intervals counted from this second since 1970.
    Series { start_s: i64 },
    /// Hours of one reference year, repeated by calendar date; 29 February takes the 28th.
    Year,
}

/// Weather of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeatherMean {
    /// Ambient temperature in K.
    pub ambient_temperature_k: f64,
    /// Direct normal irradiance in W/m².
    pub dni_w_m2: f64,
    /// Diffuse horizontal irradiance in W/m².
    pub dhi_w_m2: f64,
    /// Seconds whose weather is interpolated.
    pub interpolated_s: f64,
}

/// The weather files that a path of the study names, relative to `base`: (path as the study names it, path).
///
/// # Errors
/// [`IngestError`] where the path does not exist or holds no file of the format.
pub fn discover(
    base: &std::path::Path,
    pattern: &str,
    format: &WeatherFormat,
) -> Result<Vec<(String, PathBuf)>, IngestError> {
    let fits = |name: &str| match format {
        WeatherFormat::MeteoSwissOgd => {
            name.starts_with("ogd-smn_") && !name.starts_with("ogd-smn_meta_") && name.ends_with(".csv")
        }
        WeatherFormat::Sia4028 => name.starts_with("sia4028") && name.ends_with(".csv"),
        WeatherFormat::Csv(_) => name.ends_with(".csv"),
    };
    let files = list(base, pattern)?;
    // One file named by the study is taken as it is called.
    let single = base.join(pattern).is_file();
    let name = |p: &PathBuf| p.file_name().map(|n| n.to_string_lossy().to_lowercase()).unwrap_or_default();
    let found: Vec<_> = files.into_iter().filter(|p| single || fits(&name(p))).map(|p| (label(base, &p), p)).collect();
    if found.is_empty() {
        let wanted = match format {
            WeatherFormat::MeteoSwissOgd => "ogd-smn_<station>_t_….csv or ogd-smn_<station>_h_….csv",
            WeatherFormat::Sia4028 => "sia4028….csv",
            WeatherFormat::Csv(_) => "….csv",
        };
        let reason = format!("no weather files named {wanted} there");
        return Err(IngestError::Weather { path: base.join(pattern), reason });
    }
    Ok(found)
}

/// Reads weather files of one station as one series. Where two files have the same interval, the first file's counts.
///
/// # Errors
/// [`IngestError`] where no file can be used, or where they are of several stations or interval lengths. Refused files
/// beside usable ones are in the records.
pub fn read(files: &[(String, PathBuf)], options: &WeatherOptions) -> Result<(Weather, Vec<FileRecord>), IngestError> {
    let mut records = Vec::new();
    let mut parts: Vec<(Quantities, usize)> = Vec::new();
    for (label, path) in files {
        let (quantities, record) = read_file(label, path, &options.format);
        if let Some(quantities) = quantities {
            parts.push((quantities, records.len()));
        }
        records.push(record);
    }
    let path = files.first().map(|(_, p)| p.parent().unwrap_or(p).to_owned()).unwrap_or_default();
    let error = |reason: String| IngestError::Weather { path: path.clone(), reason };

    let mut stations: Vec<&str> = parts.iter().filter_map(|(q, _)| q.station.as_deref()).collect();
    stations.sort_unstable();
    stations.dedup();
    match &options.station {
        Some(wanted) => {
            let wanted = wanted.to_lowercase();
            if !stations.contains(&wanted.as_str()) {
                return Err(error(format!("no files of the station {wanted:?}; there are {stations:?}")));
            }
            let other: Vec<usize> =
                parts.iter().filter(|(q, _)| q.station.as_ref() != Some(&wanted)).map(|(_, r)| *r).collect();
            parts.retain(|(q, _)| q.station.as_ref() == Some(&wanted));
            let mut position = 0..;
            records.retain(|_| position.next().is_some_and(|p| !other.contains(&p)));
            for (_, record) in &mut parts {
                *record -= other.iter().filter(|o| *o < record).count();
            }
        }
        None if stations.len() > 1 => {
            return Err(error(format!(
                "files of the stations {stations:?} lie together; choose one: `station = \"…\"`"
            )));
        }
        None => {}
    }
    let Some((first, first_record)) = parts.first() else {
        let refused = &records[0];
        return Err(IngestError::WeatherRefused {
            path: refused.path.clone(),
            message: refused.findings[0].to_string(),
        });
    };
    if let Some((other, record)) = parts.iter().find(|(q, _)| q.interval_s != first.interval_s || q.year != first.year)
    {
        let (a, b) = (&records[*first_record].path, &records[*record].path);
        let reason = format!(
            "{a} has intervals of {} s and {b} of {} s; name one kind only, such as `path = \"weather/ogd-smn_sma_h_*.csv\"`",
            first.interval_s, other.interval_s
        );
        return Err(error(reason));
    }
    let weather = join(&parts, &mut records, options).map_err(error)?;
    Ok((weather, records))
}

/// Joins the files on one axis, fills short gaps, and splits the irradiance.
fn join(
    parts: &[(Quantities, usize)],
    records: &mut [FileRecord],
    options: &WeatherOptions,
) -> Result<Weather, String> {
    let interval_s = parts[0].0.interval_s;
    let starts = || parts.iter().flat_map(|(q, _)| q.rows.iter().map(|r| r.start_s));
    let (calendar, length) = if parts[0].0.year {
        (Calendar::Year, YEAR_HOURS)
    } else {
        let (first, last) = (starts().min().unwrap_or(0), starts().max().unwrap_or(0));
        if last - first > MAX_YEARS * 366 * 86_400 {
            return Err(format!("the stamps span more than {MAX_YEARS} years; one of them is wrong"));
        }
        (Calendar::Series { start_s: first }, ((last - first) / interval_s + 1) as usize)
    };
    // [temperature, global, diffuse, direct]
    let mut values = vec![[f64::NAN; 4]; length];
    let mut taken = vec![0_u8; length];
    for (quantities, record) in parts {
        let mut twice = 0;
        for row in &quantities.rows {
            let Some(slot) = calendar.slot(row.start_s, interval_s, length) else { continue };
            if taken[slot] > 0 {
                twice += 1;
                continue;
            }
            taken[slot] = 1;
            values[slot] = row.values;
        }
        if twice > 0 {
            let message = "the same interval again; the first one counts";
            records[*record].findings.push(Finding::whole(FindingKind::DuplicateRow, message).times(twice));
        }
    }
    let used = parts[0].0.used;
    let max_run = (i64::from(options.max_gap_s) / interval_s) as usize;
    let cyclic = calendar == Calendar::Year;
    let mut interpolated = vec![false; length];
    for quantity in (0..4).filter(|&q| used[q]) {
        fill_gaps(&mut values, quantity, max_run, cyclic, &mut interpolated);
    }
    let (filled, missing) = values.iter().zip(&interpolated).fold((0, 0), |(filled, missing), (v, &i)| {
        let whole = (0..4).all(|q| !used[q] || !v[q].is_nan());
        (filled + u64::from(i && whole), missing + u64::from(!whole))
    });
    let record = &mut records[parts[0].1];
    if filled > 0 {
        let message = format!("intervals in gaps of up to {} s, interpolated linearly", options.max_gap_s);
        record.findings.push(Finding::whole(FindingKind::Interpolated, message).times(filled));
    }
    if missing > 0 {
        let message = format!(
            "intervals in gaps longer than {} s within all files; samples there are excluded",
            options.max_gap_s
        );
        record.findings.push(Finding::whole(FindingKind::TimeGap, message).times(missing));
    }

    let mut weather = Weather {
        calendar,
        interval_s,
        max_gap_s: options.max_gap_s,
        temperature_k: Vec::with_capacity(length),
        dni_w_m2: Vec::with_capacity(length),
        dhi_w_m2: Vec::with_capacity(length),
        interpolated,
    };
    for (slot, &[celsius, global, diffuse, direct]) in values.iter().enumerate() {
        let middle = calendar.start(slot, interval_s) + interval_s / 2;
        let (dni, dhi) = match used {
            [_, _, true, true] => (direct, diffuse),
            _ if global.is_nan() || (used[2] && diffuse.is_nan()) => (f64::NAN, f64::NAN),
            _ => {
                let middle = DateTime::from_timestamp(middle, 0).ok_or("a stamp is out of range")?;
                let altitude = options.site.sun(middle).altitude_rad;
                let IrradianceSplit::Erbs = options.split;
                let split = if used[2] {
                    closure(global, diffuse, altitude, middle.ordinal())
                } else {
                    erbs(global, altitude, middle.ordinal())
                };
                (split.dni_w_m2, split.dhi_w_m2)
            }
        };
        weather.temperature_k.push(celsius + 273.15);
        weather.dni_w_m2.push(dni);
        weather.dhi_w_m2.push(dhi);
    }
    Ok(weather)
}

/// Fills runs of up to `max_run` missing values linearly from their neighbours.
fn fill_gaps(values: &mut [[f64; 4]], quantity: usize, max_run: usize, cyclic: bool, filled: &mut [bool]) {
    let n = values.len();
    let known: Vec<usize> = (0..n).filter(|&i| !values[i][quantity].is_nan()).collect();
    let inner = known.windows(2).map(|w| (w[0], w[1]));
    let around = match (cyclic, known.first(), known.last()) {
        (true, Some(&first), Some(&last)) => Some((last, first + n)),
        _ => None,
    };
    for (before, after) in inner.chain(around) {
        let run = after - before - 1;
        if run == 0 || run > max_run {
            continue;
        }
        let (from, to) = (values[before][quantity], values[after % n][quantity]);
        for i in before + 1..after {
            let share = (i - before) as f64 / (after - before) as f64;
            values[i % n][quantity] = from + share * (to - from);
            filled[i % n] = true;
        }
    }
}

impl Calendar {
    /// The interval that starts at, or holds, a second since 1970.
    fn slot(self, second: i64, interval_s: i64, length: usize) -> Option<usize> {
        match self {
            Self::Series { start_s } => {
                usize::try_from((second - start_s).div_euclid(interval_s)).ok().filter(|&slot| slot < length)
            }
            Self::Year => hour_of_year(DateTime::from_timestamp(second, 0)?),
        }
    }

    /// Start of an interval; hours of a reference year are those of 2023, which is no leap year.
    fn start(self, slot: usize, interval_s: i64) -> i64 {
        let origin = match self {
            Self::Series { start_s } => start_s,
            Self::Year => Utc.with_ymd_and_hms(2023, 1, 1, 0, 0, 0).single().map_or(0, |t| t.timestamp()),
        };
        origin + slot as i64 * interval_s
    }
}

/// Hour number in a year of 365 days; 29 February counts as the 28th.
fn hour_of_year(instant: DateTime<Utc>) -> Option<usize> {
    let leap_day = instant.month() == 2 && instant.day() == 29;
    let after_leap_day = instant.date_naive().leap_year() && instant.month() > 2;
    let day = instant.ordinal0() as usize - usize::from(leap_day || after_leap_day);
    Some(day * 24 + instant.hour() as usize)
}

impl Weather {
    /// Mean weather from `start` to `end`, each interval weighted by its overlap.
    ///
    /// # Errors
    /// Why there is none.
    pub fn mean(&self, start: DateTime<Utc>, end: DateTime<Utc>) -> Result<WeatherMean, ExclusionReason> {
        let (from, to) = (start.timestamp(), end.timestamp().max(start.timestamp() + 1));
        let origin = self.calendar.start(0, self.interval_s);
        let mut at = from;
        let mut sums = [0.0; 4];
        while at < to {
            let slot = self.calendar.slot(at, self.interval_s, self.temperature_k.len());
            let slot = slot.ok_or(ExclusionReason::OutsideWeather)?;
            let next = at + self.interval_s - (at - origin).rem_euclid(self.interval_s);
            let until = next.min(to);
            let seconds = (until - at) as f64;
            sums[0] += self.temperature_k[slot] * seconds;
            sums[1] += self.dni_w_m2[slot] * seconds;
            sums[2] += self.dhi_w_m2[slot] * seconds;
            sums[3] += if self.interpolated[slot] { seconds } else { 0.0 };
            at = until;
        }
        if sums.iter().any(|s| s.is_nan()) {
            return Err(ExclusionReason::WeatherGap { max_gap_s: self.max_gap_s });
        }
        let [temperature, dni, dhi, _] = sums.map(|s| s / (to - from) as f64);
        Ok(WeatherMean { ambient_temperature_k: temperature, dni_w_m2: dni, dhi_w_m2: dhi, interpolated_s: sums[3] })
    }

    /// Weather at an instant: linear between the middles of the intervals; beyond the first and the last middle, and beside
    /// a gap, that of the interval itself.
    ///
    /// # Errors
    /// Why there is none.
    pub fn at(&self, instant: DateTime<Utc>) -> Result<WeatherMean, ExclusionReason> {
        let second = instant.timestamp();
        let slot_at = |s: i64| self.calendar.slot(s, self.interval_s, self.temperature_k.len());
        let here = slot_at(second).ok_or(ExclusionReason::OutsideWeather)?;
        let into_s = (second - self.calendar.start(0, self.interval_s)).rem_euclid(self.interval_s);
        let from_middle = into_s as f64 / self.interval_s as f64 - 0.5;
        let beside =
            slot_at(second + if from_middle < 0.0 { -self.interval_s } else { self.interval_s }).unwrap_or(here);
        let value = |values: &[f64]| {
            let (a, b) = (values[here], values[beside]);
            if b.is_nan() { a } else { a + (b - a) * from_middle.abs() }
        };
        let found = WeatherMean {
            ambient_temperature_k: value(&self.temperature_k),
            dni_w_m2: value(&self.dni_w_m2),
            dhi_w_m2: value(&self.dhi_w_m2),
            interpolated_s: 0.0,
        };
        if [found.ambient_temperature_k, found.dni_w_m2, found.dhi_w_m2].iter().any(|v| v.is_nan()) {
            return Err(ExclusionReason::WeatherGap { max_gap_s: self.max_gap_s });
        }
        Ok(found)
    }
}
