//! A weather file of any format as the intervals of its stations, with what is wrong in it.

use chrono::DateTime;

use super::format::{Format, Layout, RowOrder};
use super::intervals::{Interval, intervals};
use super::notes::Notes;
use super::rows::Rows;
use super::sunlight::Sky;
use super::values::{PerQuantity, Quantity};
use super::{WeatherFile, WeatherFormat, WeatherOptions, plausible, sunlight};
use crate::files::check_text;
use crate::{Content, FileKind, FileReader, FileRecord, Finding, FindingKind};

/// A file that lies so far from the study's place is of another one, in degrees.
const OTHER_PLACE_DEG: f64 = 0.5;

/// The usable intervals of one station in a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table {
    /// Abbreviation of the station in lower case, where the file has one.
    pub station: Option<String>,
    /// Length of an interval in s.
    pub interval_s: i64,
    /// Seconds from full intervals since 1970 to its own.
    pub phase_s: i64,
    /// How its intervals make a series.
    pub order: RowOrder,
    /// Which quantities it has values of.
    pub has: PerQuantity<bool>,
    /// Its intervals.
    pub intervals: Vec<Interval>,
}

impl Table {
    /// Whether both make one series.
    pub fn goes_with(&self, other: &Self) -> bool {
        (self.interval_s, self.phase_s, self.order) == (other.interval_s, other.phase_s, other.order)
    }

    /// What intervals it has, for messages.
    pub fn kind(&self) -> String {
        let kind = if self.order == RowOrder::ReferenceYear { "hours of a reference year" } else { "intervals" };
        match self.phase_s {
            0 => format!("{kind} of {} s", self.interval_s),
            phase_s => format!("{kind} of {} s, {phase_s} s beside full ones of UTC", self.interval_s),
        }
    }
}

/// Reads a file; one that cannot be used has no tables.
pub(crate) fn read_file(
    file: &WeatherFile,
    options: &WeatherOptions,
    reader: &mut FileReader,
) -> (Vec<Table>, FileRecord) {
    match file.0.place.read(reader) {
        Ok(content) => {
            let read = read_content(file.path(), &content, options);
            reader.recycle(content);
            read
        }
        Err(finding) => (Vec::new(), FileRecord::refused(file.path(), FileKind::Weather, "", 0, finding)),
    }
}

/// The same of a content that is in memory.
pub(crate) fn read_content(label: &str, content: &Content, options: &WeatherOptions) -> (Vec<Table>, FileRecord) {
    let format = options.format.reader();
    let parsed = decode(&content.bytes, format).and_then(|text| {
        let layout = format.layout(&text)?.ok_or_else(|| other_format(&text, format))?;
        parse(&text, &layout, options)
    });
    match parsed {
        Ok((tables, said)) => (tables, said.of(label, content)),
        Err(mut finding) => {
            if finding.kind == FindingKind::MissingColumn
                && let Some(other) = of_other_format(&content.bytes, format)
            {
                finding.message = format!("{}; it is one of `format = {other:?}`", finding.message);
            }
            let bytes = content.bytes.len() as u64;
            let record = FileRecord::refused(label, FileKind::Weather, &content.blake3, bytes, finding);
            (Vec::new(), record.stamped(content.stamp))
        }
    }
}

fn decode(bytes: &[u8], format: &dyn Format) -> Result<String, Finding> {
    let utf8 = bytes.starts_with(b"\xef\xbb\xbf")
        || !format.may_be_windows_1252()
        || simdutf8::basic::from_utf8(bytes).is_ok();
    check_text(bytes, utf8)?;
    let encoding = if utf8 { encoding_rs::UTF_8 } else { encoding_rs::WINDOWS_1252 };
    Ok(encoding.decode(bytes).0.into_owned())
}

/// The name of the format that a file is of, where it is another one.
fn of_other_format(bytes: &[u8], format: &dyn Format) -> Option<&'static str> {
    let text = decode(bytes, &super::meteoswiss_ogd::MeteoSwissOgd).ok()?;
    WeatherFormat::of_text(&text).map(|other| other.name()).filter(|name| *name != format.name())
}

/// What is said of a file that is not of a format.
fn other_format(text: &str, format: &dyn Format) -> Finding {
    let remedy = match WeatherFormat::of_text(text) {
        Some(other) => format!("it is one of `format = {:?}`", other.name()),
        None => "name its columns with `format = \"csv\"`, or remove it".to_owned(),
    };
    let message =
        format!("not a file of the format {}, which is known by {}; {remedy}", format.name(), format.known_by());
    Finding::whole(FindingKind::OtherFormat, message).at_line(1)
}

/// What is said of a file that is read.
struct Said {
    rows: u64,
    first_s: Option<i64>,
    last_s: Option<i64>,
    findings: Vec<Finding>,
}

impl Said {
    fn of(self, label: &str, content: &Content) -> FileRecord {
        let time = |s: Option<i64>| s.and_then(|s| DateTime::from_timestamp(s, 0));
        FileRecord {
            path: label.to_owned(),
            kind: FileKind::Weather,
            blake3: content.blake3.clone(),
            bytes: content.bytes.len() as u64,
            rows: self.rows,
            first: time(self.first_s),
            last: time(self.last_s),
            stamp: content.stamp,
            accepted: true,
            findings: self.findings,
        }
    }
}

fn parse(text: &str, layout: &Layout, options: &WeatherOptions) -> Result<(Vec<Table>, Said), Finding> {
    let mut notes = Notes::default();
    notes.list.clone_from(&layout.notes);
    let rows = Rows::read(text, options.format.reader(), layout, &mut notes)?;
    if let Some(finding) = notes.refusal(layout) {
        return Err(finding);
    }
    let sky = sky(layout, options, &mut notes);
    let wanted = |station: &Option<String>| match (&options.station, station) {
        (Some(wanted), Some(station)) => *wanted.to_lowercase() == **station,
        _ => true,
    };
    let (count, has_column) = (rows.count, rows.has);
    let is_here = rows.stations.keys().any(wanted);
    let mut tables = Vec::new();
    for (station, rows) in rows.stations {
        let (interval_s, order) = (layout.interval_s, layout.order);
        if !wanted(&station) {
            // Its name is all that is asked for.
            tables.push(Table {
                station,
                interval_s,
                phase_s: 0,
                order,
                has: PerQuantity::default(),
                intervals: Vec::new(),
            });
            continue;
        }
        let (mut intervals, order) = intervals(&rows, layout, &mut notes)?;
        plausible::convert(&mut intervals, layout);
        plausible::check_temperatures(&mut intervals, layout, &mut notes)?;
        sunlight::check(&intervals, layout, &sky, notes.bare_stamps, options.format.is_named_by_study())?;
        plausible::check_irradiances(&mut intervals, layout, &mut notes)?;
        let has = Quantity::ALL.map(|q| intervals.iter().any(|i| !i.values.get(q).is_nan()));
        let [temperature, global, diffuse, direct] = has;
        let has = PerQuantity { temperature, global, diffuse, direct };
        let phase_s = intervals.first().map_or(0, |i| i.start_s.rem_euclid(interval_s));
        tables.push(Table { station, interval_s, phase_s, order, has, intervals });
    }
    if (is_here || tables.is_empty()) && tables.iter().all(|table| table.intervals.is_empty()) {
        let message = "there are no usable rows below the header";
        let first = layout.table.first_line + 1;
        let none = || Finding::whole(FindingKind::Empty, message).at_line(first);
        return Err(notes.list.into_iter().find(|f| f.kind == FindingKind::RefusedRow).unwrap_or_else(none));
    }
    // A column without a single value is one that the station does not measure.
    for quantity in Quantity::ALL.into_iter().filter(|q| *has_column.get(*q) && layout.long.is_none()) {
        if tables.iter().all(|table| !table.has.get(quantity)) {
            let of_column = |f: &Finding| {
                f.kind == FindingKind::MissingValue && f.column.as_deref() == Some(layout.column(quantity))
            };
            notes.list.retain(|f| !of_column(f));
        }
    }
    let starts = || tables.iter().flat_map(|table| table.intervals.iter().map(|i| i.start_s));
    let last_s = starts().max().map(|s| s + layout.interval_s);
    let said = Said { rows: count, first_s: starts().min(), last_s, findings: notes.list };
    Ok((tables, said))
}

/// The sky that a file lies under: that of its own place, where it says one.
fn sky(layout: &Layout, options: &WeatherOptions, notes: &mut Notes) -> Sky {
    let site = [options.site.latitude_deg(), options.site.longitude_deg()];
    let place = layout.place.unwrap_or(site);
    if place.iter().zip(site).any(|(a, b)| (a - b).abs() > OTHER_PLACE_DEG) {
        let [latitude, longitude] = place;
        let message = format!(
            "the file is of the place {latitude}° N, {longitude}° E, the study of {}° N, {}° E; is it meant?",
            site[0], site[1]
        );
        notes.list.push(Finding::whole(FindingKind::OtherPlace, message).at_line(1));
    }
    Sky { latitude_rad: place[0].to_radians(), longitude_rad: place[1].to_radians(), zone: options.zone }
}
