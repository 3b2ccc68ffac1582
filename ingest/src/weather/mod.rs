//! Weather: files of several formats, joined to one series that knows its mean over any segment.
//!
//! A format is one file beside this one, which owns everything of it: what its files are known by, columns, stamps, what to
//! say where they do not fit. It is made known in [`WeatherFormat`], and nowhere else. From a file to the series:
//! `rows` (as they stand there) → `intervals` (stamps checked against the layout) → `plausible`, `sunlight` (values
//! checked against nature) → `table` (a station's part of a file) → `stations` (which of them) → `join` → `series`.

mod columns;
mod discover;
mod dwd;
mod epw;
mod format;
mod intervals;
mod join;
mod meteoswiss_ogd;
mod notes;
mod open_meteo;
mod plausible;
mod pvgis;
mod rows;
mod series;
mod sia4028;
mod stations;
mod sunlight;
mod table;
mod ugz;
mod units;
mod values;

use chrono_tz::Tz;
use shading::Site;
use std::path::Path;

use crate::{Content, FileReader, FileRecord, IngestError};
use format::Format;
use join::join;
use table::{Table, read_content, read_file};

pub use crate::stamp::Clock;
pub use columns::ColumnMap;
pub use discover::{WeatherFile, WeatherFiles, discover, looks_like};
pub use format::TimeLabel;
pub use join::IrradianceSplit;
pub use series::{Weather, WeatherMean};
pub use units::{IrradianceUnit, TemperatureUnit};

/// How weather files look.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WeatherFormat {
    /// Open data of the automatic stations of MeteoSwiss, 10-minute or hourly.
    MeteoSwissOgd,
    /// SIA 4028 reference year of MeteoSwiss, or a scenario year SIA 2060.
    Sia4028,
    /// EnergyPlus weather file.
    Epw,
    /// Typical year or hourly series of PVGIS.
    Pvgis,
    /// A download of Open-Meteo.
    OpenMeteo,
    /// The stations of the City of Zürich.
    Ugz,
    /// Hourly values of the German weather service.
    Dwd,
    /// Any file with one row per interval.
    Csv(ColumnMap),
}

impl WeatherFormat {
    /// Their names in study files.
    pub const NAMES: [&'static str; 8] = [
        meteoswiss_ogd::NAME,
        sia4028::NAME,
        epw::NAME,
        pvgis::NAME,
        open_meteo::NAME,
        ugz::NAME,
        dwd::NAME,
        columns::NAME,
    ];
    /// The formats that need no columns named.
    const FIXED: [Self; 7] =
        [Self::MeteoSwissOgd, Self::Sia4028, Self::Epw, Self::Pvgis, Self::OpenMeteo, Self::Ugz, Self::Dwd];

    /// The format of a name that needs no columns named; `None` for CSV, which does, and for other names.
    #[must_use]
    pub fn fixed(name: &str) -> Option<Self> {
        Self::FIXED.into_iter().find(|format| format.name() == name)
    }

    /// The format that needs no columns named and that a file is of, from its text or the beginning of it.
    #[must_use]
    pub fn of_text(text: &str) -> Option<Self> {
        Self::FIXED.into_iter().find(|format| format.reader().fits(text))
    }

    /// The name in study files.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.reader().name()
    }

    /// Whether the study says how the files are laid out.
    fn is_named_by_study(&self) -> bool {
        matches!(self, Self::Csv(_))
    }

    fn reader(&self) -> &dyn Format {
        match self {
            Self::MeteoSwissOgd => &meteoswiss_ogd::MeteoSwissOgd,
            Self::Sia4028 => &sia4028::Sia4028,
            Self::Epw => &epw::Epw,
            Self::Pvgis => &pvgis::Pvgis,
            Self::OpenMeteo => &open_meteo::OpenMeteo,
            Self::Ugz => &ugz::Ugz,
            Self::Dwd => &dwd::Dwd,
            Self::Csv(map) => map,
        }
    }
}

/// Latitude and longitude in degrees of the place that a file of a format is of, from the beginning of its text; `None` where
/// it does not say.
#[must_use]
pub fn place_of(text: &str, format: &WeatherFormat) -> Option<[f64; 2]> {
    format.reader().layout(text).ok().flatten()?.place
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
    /// The clock of the place, which stamps that contradict the sun may mean.
    pub zone: Tz,
}

/// Reads weather files of one station as one series. Where two files have a value of the same interval, that of the lower
/// rank of the format counts (what was checked before what is raw), then that of the first file by name.
///
/// # Errors
/// [`IngestError`] where no file can be used, or where they are of several stations or interval lengths. Refused files
/// beside usable ones are in the records.
pub fn read(files: &WeatherFiles, options: &WeatherOptions) -> Result<(Weather, Vec<FileRecord>), IngestError> {
    let mut reader = FileReader::default();
    let read = files.files.iter().map(|file| read_file(file, options, &mut reader));
    series(&files.place, files.refused.clone(), read, options)
}

/// The same of one file whose content is in memory.
///
/// # Errors
/// [`IngestError`] where it cannot be used.
pub fn read_one(
    label: &str,
    content: &Content,
    options: &WeatherOptions,
) -> Result<(Weather, Vec<FileRecord>), IngestError> {
    series(Path::new(label), Vec::new(), std::iter::once(read_content(label, content, options)), options)
}

fn series(
    place: &Path,
    mut records: Vec<FileRecord>,
    files: impl Iterator<Item = (Vec<Table>, FileRecord)>,
    options: &WeatherOptions,
) -> Result<(Weather, Vec<FileRecord>), IngestError> {
    let mut parts: Vec<(Table, usize)> = Vec::new();
    for (tables, record) in files {
        parts.extend(tables.into_iter().map(|table| (table, records.len())));
        records.push(record);
    }
    let error = |reason: String| IngestError::Weather { path: place.to_owned(), reason };
    stations::choose(&mut parts, &mut records, options.station.as_deref()).map_err(error)?;
    let rank = |record: usize| options.format.reader().rank(&records[record].path);
    parts.sort_by_cached_key(|(_, record)| (rank(*record), records[*record].path.clone()));
    let Some((first, first_record)) = parts.first() else {
        let refused = records.iter().find(|record| !record.accepted).unwrap_or(&records[0]);
        return Err(IngestError::WeatherRefused {
            path: refused.path.clone(),
            message: refused.findings[0].to_string(),
        });
    };
    if let Some((other, record)) = parts.iter().find(|(part, _)| !part.goes_with(first)) {
        let (a, b) = (&records[*first_record].path, &records[*record].path);
        return Err(error(format!(
            "{a} has {} and {b} {}; name one kind only, such as `path = \"weather/ogd-smn_sma_h_*.csv\"`",
            first.kind(),
            other.kind()
        )));
    }
    let weather = join(&parts, &mut records, options).map_err(error)?;
    Ok((weather, records))
}
