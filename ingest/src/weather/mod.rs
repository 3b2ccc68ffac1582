//! Weather: files of several formats, joined to one series that knows its mean over any segment.
//!
//! A format is one file beside this one, which owns everything of it: names of files, columns, stamps, what to say where
//! they do not fit. It is made known in [`WeatherFormat`], and nowhere else.

mod columns;
mod format;
mod join;
mod meteoswiss_ogd;
mod series;
mod sia4028;
mod table;
mod values;

use shading::Site;
use std::path::PathBuf;

use crate::files::{label, list};
use crate::{FileRecord, IngestError};
use format::Format;
use join::{JoinOptions, join};
use meteoswiss_ogd::MeteoSwissOgd;
use sia4028::Sia4028;
use table::{Table, read_file};

pub use columns::{ColumnMap, TimeLabel};
pub use join::IrradianceSplit;
pub use series::{Weather, WeatherMean};

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

impl WeatherFormat {
    /// Their names in study files.
    pub const NAMES: [&'static str; 3] = [meteoswiss_ogd::NAME, sia4028::NAME, columns::NAME];
    /// The formats that need no columns named.
    const FIXED: [Self; 2] = [Self::MeteoSwissOgd, Self::Sia4028];

    /// The format of a name that needs no columns named; `None` for CSV, which does, and for other names.
    #[must_use]
    pub fn fixed(name: &str) -> Option<Self> {
        Self::FIXED.into_iter().find(|format| format.name() == name)
    }

    /// The name in study files.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.reader().name()
    }

    fn reader(&self) -> &dyn Format {
        match self {
            Self::MeteoSwissOgd => &MeteoSwissOgd,
            Self::Sia4028 => &Sia4028,
            Self::Csv(map) => map,
        }
    }
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

/// The weather files that a path of the study names, relative to `base`: (path as the study names it, path).
///
/// # Errors
/// [`IngestError`] where the path does not exist or holds no file of the format.
pub fn discover(
    base: &std::path::Path,
    pattern: &str,
    format: &WeatherFormat,
) -> Result<Vec<(String, PathBuf)>, IngestError> {
    let format = format.reader();
    let mut files = list(base, pattern)?;
    files.retain(|f| f.is_file());
    // One file named by the study is taken as it is called.
    let single = base.join(pattern).is_file();
    let name = |p: &PathBuf| p.file_name().map(|n| n.to_string_lossy().to_lowercase()).unwrap_or_default();
    let found: Vec<_> =
        files.into_iter().filter(|p| single || format.fits(&name(p))).map(|p| (label(base, &p), p)).collect();
    if found.is_empty() {
        let reason = format!("no weather files named {} there", format.file_names());
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
    let mut parts: Vec<(Table, usize)> = Vec::new();
    for (label, path) in files {
        let (table, record) = read_file(label, path, options.format.reader());
        if let Some(table) = table {
            parts.push((table, records.len()));
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
    if let Some((other, record)) =
        parts.iter().find(|(q, _)| q.interval_s != first.interval_s || q.calendar != first.calendar)
    {
        let (a, b) = (&records[*first_record].path, &records[*record].path);
        let reason = format!(
            "{a} has intervals of {} s and {b} of {} s; name one kind only, such as `path = \"weather/ogd-smn_sma_h_*.csv\"`",
            first.interval_s, other.interval_s
        );
        return Err(error(reason));
    }
    let join_options = JoinOptions { max_gap_s: options.max_gap_s, split: options.split, site: options.site };
    let weather = join(&parts, &mut records, &join_options).map_err(error)?;
    Ok((weather, records))
}
