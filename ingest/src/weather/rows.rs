//! The rows of a weather file of any format as they stand in it, with what cannot be read.

use std::collections::BTreeMap;

use super::format::{Column, Format, Layout};
use super::notes::Notes;
use super::values::{MISSING, PerQuantity, Quantity, Values};
use crate::files::{check_lines, find_columns};
use crate::parse::number;
use crate::{Finding, FindingKind};

/// Sixty years of intervals of ten minutes.
const MOST_ROWS: usize = 60 * 366 * 144;
/// Stations of one file at most.
const MOST_STATIONS: usize = 1000;

/// A row as it stands in the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Row {
    /// Its stamp in s since 1970.
    pub second: i64,
    /// What the clock showed then, as seconds since 1970 of a clock in UTC.
    pub wall_s: i64,
    pub line: u64,
    /// In the file's units; NaN where missing or unreadable.
    pub values: Values,
}

/// The rows of a file.
pub(crate) struct Rows {
    /// By station; a file without stations has one without a name.
    pub stations: BTreeMap<Option<String>, Vec<Row>>,
    /// How many rows there are, with those that cannot be used.
    pub count: u64,
    /// Which quantities the file has a column for.
    pub has: PerQuantity<bool>,
}

impl Rows {
    pub fn read(text: &str, format: &dyn Format, layout: &Layout, notes: &mut Notes) -> Result<Self, Finding> {
        let body = text.get(layout.table.bytes.clone()).unwrap_or_default();
        let at_line = |finding: Finding| match finding.line {
            Some(line) => finding.at_line(line + layout.table.first_line - 1),
            None => finding,
        };
        check_lines(body.as_bytes(), layout.separator as u8, MOST_ROWS).map_err(at_line)?;
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(layout.separator as u8)
            .flexible(true)
            .has_headers(layout.table.names.is_none())
            // Lines end at \n, so that they count right in files with \r\n; trimming removes the \r.
            .terminator(csv::Terminator::Any(b'\n'))
            .trim(csv::Trim::All)
            .from_reader(body.as_bytes());
        let header = match layout.table.names {
            Some(names) => csv::StringRecord::from(names.to_vec()),
            None => reader.headers().map_err(|e| not_csv(&e))?.clone(),
        };
        let places = Places::find(layout, &header).map_err(at_line)?;
        let mut rows = Self { stations: BTreeMap::new(), count: 0, has: places.has(layout) };
        let mut record = csv::StringRecord::new();
        while reader.read_record(&mut record).map_err(|e| not_csv(&e))? {
            let line = record.position().map_or(0, csv::Position::line) + layout.table.first_line - 1;
            rows.take(&record, line, &places, format, layout, notes)?;
        }
        Ok(rows)
    }

    fn take(
        &mut self,
        record: &csv::StringRecord,
        line: u64,
        places: &Places,
        format: &dyn Format,
        layout: &Layout,
        notes: &mut Notes,
    ) -> Result<(), Finding> {
        let field = |position: usize| record.get(position).unwrap_or("");
        let long = places.long.as_ref();
        let named = long.and_then(|long| long.quantity(field(long.name), layout));
        if long.is_some_and(|long| field(long.only.0) != long.only.1) || (long.is_some() && named.is_none()) {
            return Ok(());
        }
        self.count += 1;
        let station = places.station.map(|position| field(position).to_lowercase());
        if !self.stations.contains_key(&station) && self.stations.len() == MOST_STATIONS {
            let message = format!("more than {MOST_STATIONS} stations; the column holds something else");
            return Err(Finding::whole(FindingKind::RefusedRow, message).at_line(line));
        }
        let of_station = self.stations.entry(station).or_default();
        let fields: Vec<&str> = places.time.iter().map(|&place| field(place)).collect();
        let last_s = of_station.last().map_or(i64::MIN, |row| row.second);
        let Some(stamp) = format.stamp(&fields) else {
            let message = || format!("{:?}: {}", fields.join(","), format.stamp_form());
            notes.add(FindingKind::RefusedRow, &layout.time[0], line, message);
            return Ok(());
        };
        let Some(second) = layout.clock.resolve(stamp, last_s) else {
            let message = || format!("{:?}: no such time of day in the zone of the stamps", fields.join(","));
            notes.add(FindingKind::RefusedRow, &layout.time[0], line, message);
            return Ok(());
        };
        notes.bare_stamps |= stamp.offset_s.is_none();
        let mut values = MISSING;
        for quantity in Quantity::ALL {
            let (name, place) = match (long, places.columns.get(quantity)) {
                (Some(long), _) if named == Some(quantity) => (&long.value.0, long.value.1),
                (None, Some((name, place))) => (name, *place),
                _ => continue,
            };
            *values.get_mut(quantity) = value(field(place), quantity, name, line, layout, notes);
        }
        match of_station.last_mut() {
            Some(row) if long.is_some() && row.second == second => row.merge(&values),
            _ => of_station.push(Row { second, wall_s: stamp.wall.and_utc().timestamp(), line, values }),
        }
        Ok(())
    }
}

impl Row {
    /// Takes what is missing.
    fn merge(&mut self, values: &Values) {
        for quantity in Quantity::ALL {
            let value = self.values.get_mut(quantity);
            if value.is_nan() {
                *value = *values.get(quantity);
            }
        }
    }
}

/// A value in the file's unit, NaN where there is none that can be read.
fn value(text: &str, quantity: Quantity, column: &str, line: u64, layout: &Layout, notes: &mut Notes) -> f64 {
    let Some(value) = number(text) else {
        notes.unreadable(quantity, column, line, text);
        return f64::NAN;
    };
    if value.is_nan() || layout.missing.contains(&value) {
        notes.add(FindingKind::MissingValue, column, line, || "no value".to_owned());
        return f64::NAN;
    }
    *notes.values.get_mut(quantity) += 1;
    value
}

/// Where the columns of a layout stand in a file.
struct Places {
    time: Vec<usize>,
    station: Option<usize>,
    columns: PerQuantity<Option<(String, usize)>>,
    long: Option<LongPlaces>,
}

struct LongPlaces {
    name: usize,
    value: (String, usize),
    only: (usize, &'static str),
}

impl LongPlaces {
    fn quantity(&self, name: &str, layout: &Layout) -> Option<Quantity> {
        Quantity::ALL.into_iter().find(|quantity| layout.columns.get(*quantity).name() == Some(name))
    }
}

impl Places {
    fn find(layout: &Layout, header: &csv::StringRecord) -> Result<Self, Finding> {
        let place = |name: &str| Ok::<_, Finding>(find_columns(header, &[name], layout.separator)?[0]);
        let time = layout.time.iter().map(|name| place(name)).collect::<Result<_, _>>()?;
        let station = layout.station.as_deref().map(place).transpose()?;
        let mut places = Self { time, station, columns: PerQuantity::default(), long: None };
        if let Some(long) = &layout.long {
            let value = (long.value.to_owned(), place(long.value)?);
            places.long = Some(LongPlaces { name: place(long.name)?, value, only: (place(long.only.0)?, long.only.1) });
            return Ok(places);
        }
        for quantity in Quantity::ALL {
            *places.columns.get_mut(quantity) = match layout.columns.get(quantity) {
                Column::None => None,
                Column::Optional(name) if !header.iter().any(|h| h == name) => None,
                Column::Needed(name) | Column::Optional(name) => Some((name.clone(), place(name)?)),
            };
        }
        Ok(places)
    }

    fn has(&self, layout: &Layout) -> PerQuantity<bool> {
        match self.long {
            Some(_) => layout.columns.map(|column| column.name().is_some()),
            None => self.columns.map(Option::is_some),
        }
    }
}

fn not_csv(error: &csv::Error) -> Finding {
    Finding::whole(FindingKind::Unreadable, format!("the file cannot be read as a table: {error}; fetch it again"))
}
