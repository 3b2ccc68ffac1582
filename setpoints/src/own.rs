//! Setpoints of one's own, from a table.

use std::io::Read;

use crate::Curve;

const COLUMNS: [&str; 3] = ["ambient_temperature_c", "heating_setpoint_c", "cooling_setpoint_c"];
/// Temperatures that a bus can meet, in °C.
const USUAL_C: std::ops::RangeInclusive<f64> = -60.0..=60.0;

/// A pair of setpoints over the ambient temperature, linear between the rows of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Own {
    /// Setpoint while heating.
    pub heating: Curve,
    /// Setpoint while cooling, nowhere below that of heating; the same curve where one is meant for both modes.
    pub cooling: Curve,
}

/// Why a table of setpoints cannot be used. Lines count from 1, the header included.
#[derive(Debug, thiserror::Error)]
pub enum OwnError {
    /// The file cannot be read as CSV.
    #[error("{0}; the file needs the comma-separated columns {columns} in UTF-8", columns = COLUMNS.join(","))]
    Csv(#[from] csv::Error),
    /// A column is missing.
    #[error("line 1: the column {0} is missing; the file needs {columns}, separated by commas", columns = COLUMNS.join(","))]
    Column(&'static str),
    /// No temperature that a bus can meet.
    #[error("line {line}, column {column}: {text:?} is not a temperature from -60 to 60 °C")]
    Temperature {
        /// Line of the file.
        line: u64,
        /// Column of the file.
        column: &'static str,
        /// What stands there.
        text: String,
    },
    /// Ambient temperatures do not rise.
    #[error("line {line}, column ambient_temperature_c: {text} is not above that of the line before; sort the rows")]
    NotRising {
        /// Line of the file.
        line: u64,
        /// What stands there.
        text: String,
    },
    /// Cooling begins below where heating ends.
    #[error(
        "line {line}, column cooling_setpoint_c: {text} is below heating_setpoint_c; the two modes would work against each other"
    )]
    Crossed {
        /// Line of the file.
        line: u64,
        /// What stands there.
        text: String,
    },
    /// No rows.
    #[error("there are no rows; give at least one")]
    Empty,
}

impl Own {
    /// Reads a table of ambient temperature and setpoints in °C; further columns are ignored.
    ///
    /// # Errors
    /// [`OwnError`] names line and column, and what belongs there.
    pub fn read(source: impl Read) -> Result<Self, OwnError> {
        // Lines end at \n, so that they count right in files with \r\n; trimming removes the \r.
        let mut reader =
            csv::ReaderBuilder::new().terminator(csv::Terminator::Any(b'\n')).trim(csv::Trim::All).from_reader(source);
        let header = reader.headers()?.clone();
        let place = |name: &'static str| {
            let found = header.iter().position(|h| h.trim_start_matches('\u{feff}') == name);
            found.map(|place| (name, place)).ok_or(OwnError::Column(name))
        };
        let places = [place(COLUMNS[0])?, place(COLUMNS[1])?, place(COLUMNS[2])?];
        let [mut heating, mut cooling]: [Vec<(f64, f64)>; 2] = Default::default();
        let mut record = csv::StringRecord::new();
        while reader.read_record(&mut record)? {
            let line = record.position().map_or(0, csv::Position::line);
            let text = |place: usize| record[places[place].1].to_owned();
            let celsius = |n: usize| {
                let (column, place) = places[n];
                let value = record[place].parse().ok().filter(|c| USUAL_C.contains(c));
                value.ok_or_else(|| OwnError::Temperature { line, column, text: text(n) })
            };
            let [ambient_c, heating_c, cooling_c] = [celsius(0)?, celsius(1)?, celsius(2)?];
            if heating.last().is_some_and(|(before_c, _)| ambient_c <= *before_c) {
                return Err(OwnError::NotRising { line, text: text(0) });
            }
            if cooling_c < heating_c {
                return Err(OwnError::Crossed { line, text: text(2) });
            }
            heating.push((ambient_c, heating_c));
            cooling.push((ambient_c, cooling_c));
        }
        let curve = |pairs: &[(f64, f64)]| Curve::through(pairs).ok_or(OwnError::Empty);
        Ok(Self { heating: curve(&heating)?, cooling: curve(&cooling)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ambient_temperature_c,heating_setpoint_c,cooling_setpoint_c\n";

    fn read(rows: &str) -> Result<Own, String> {
        Own::read(format!("{HEADER}{rows}").as_bytes()).map_err(|e| e.to_string())
    }

    #[test]
    fn prop_setpoints_lie_on_lines_between_the_rows() {
        let own = read("-10,16,24\r\n20,19,24\r\n").unwrap();
        assert_eq!([-20.0, -10.0, 5.0, 30.0].map(|t| own.heating.at(t)), [16.0, 16.0, 17.5, 19.0]);
        assert_eq!(own.cooling.at(3.0), 24.0);
    }

    #[test]
    fn prop_a_table_that_no_controller_can_follow_is_refused_by_line_and_column() {
        for (rows, said) in [
            ("", "no rows"),
            ("0,20,25\n0,20,25\n", "line 3, column ambient_temperature_c: 0 is not above"),
            ("0,20,25\n5,20,19.5\n", "line 3, column cooling_setpoint_c: 19.5 is below"),
            ("0,warm,25\n", "line 2, column heating_setpoint_c: \"warm\" is not a temperature"),
            ("0,293.15,298.15\n", "column heating_setpoint_c: \"293.15\" is not a temperature from -60 to 60"),
            ("0,nan,25\n", "\"nan\" is not a temperature"),
            ("0,20\n", "needs the comma-separated columns"),
        ] {
            let error = read(rows).unwrap_err();
            assert!(error.contains(said), "{rows:?}: {error}");
        }
        let error = Own::read("ambient_temperature_c;heating_setpoint_c\n0;20\n".as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with("line 1: the column ambient_temperature_c is missing"), "{error}");
    }
}
