//! One bus under the weather of several places: a table and a figure.

use cabin::ComfortWindow;
use solve::AnnualMean;

use crate::document::DataTable;
use crate::figure::palette::of_designs;
use crate::figure::{Bar, Bars, Form, bars_drawn};
use crate::numbers::{optional, text, window};
use crate::{ReportError, ReportFile, render};

/// The years of one bus under several climates.
#[derive(Debug, Clone, PartialEq)]
pub struct Climates {
    /// Names of the designs.
    pub designs: Vec<String>,
    /// Comfort windows.
    pub windows: Vec<ComfortWindow>,
    /// Place of the window that the figure is of.
    pub shown: usize,
    /// The climates, that of the study first.
    pub all: Vec<Climate>,
}

/// A year of the bus under some weather.
#[derive(Debug, Clone, PartialEq)]
pub struct Climate {
    /// What it is called: the name of the file without its ending, or that of the study.
    pub name: String,
    /// Latitude and longitude in degrees, north and east positive.
    pub place_deg: [f64; 2],
    /// Mean ambient temperature of the operating hours in °C, months by their days.
    pub ambient_temperature_c: f64,
    /// Segments that give no sample under this weather.
    pub excluded: u64,
    /// Why the first of them does not.
    pub exclusion: Option<String>,
    /// The means of the year, design by design, each with its windows in their order.
    pub years: Vec<AnnualMean>,
}

impl Climates {
    /// The mean power of a design in W in the window that is shown.
    #[must_use]
    pub fn power_w(&self, climate: &Climate, design: usize) -> Option<f64> {
        climate.years[design * self.windows.len() + self.shown].hvac_power_w
    }

    /// `climates.csv`, all windows, and `climates.svg`.
    ///
    /// # Errors
    /// [`ReportError`] where template and data do not fit; not for any powers.
    pub fn files(&self) -> Result<Vec<ReportFile>, ReportError> {
        let svg = bars_drawn(&self.figure()).svg(Form::File)?;
        let table = render::csv(&self.table())?;
        Ok(vec![
            ReportFile { name: "climates.csv".to_owned(), bytes: table },
            ReportFile { name: "climates.svg".to_owned(), bytes: svg.into_bytes() },
        ])
    }

    fn figure(&self) -> Bars {
        let names: Vec<&str> = self.designs.iter().map(String::as_str).collect();
        let bar = |climate: &Climate| Bar {
            name: climate.name.clone(),
            note: format!("{:.1} °C", climate.ambient_temperature_c).replace('-', "−"),
            values: (0..names.len()).map(|design| self.power_w(climate, design).map(|w| (w, None))).collect(),
        };
        let shown = window(self.windows[self.shown]);
        Bars {
            title: "The same bus under other weather".to_owned(),
            told: format!(
                "Annual mean power at PMV {shown}, same timetable; below the names the mean outside in service."
            ),
            quantity: "annual mean power in W".to_owned(),
            series: self.designs.iter().cloned().zip(of_designs(&names)).collect(),
            below_each_other: true,
            rows: self.all.iter().map(bar).collect(),
        }
    }

    fn table(&self) -> DataTable {
        let row = |climate: &Climate, point: usize| {
            let (year, of) = (&climate.years[point], self.windows[point % self.windows.len()]);
            vec![
                text(&climate.name),
                climate.place_deg[0].to_string(),
                climate.place_deg[1].to_string(),
                climate.ambient_temperature_c.to_string(),
                text(&self.designs[point / self.windows.len()]),
                of.pmv_min().to_string(),
                of.pmv_max().to_string(),
                optional(year.hvac_power_w),
                optional(year.heating_power_w),
                optional(year.cooling_power_w),
                year.samples.to_string(),
                year.unsolved.to_string(),
                year.limited.to_string(),
                climate.excluded.to_string(),
            ]
        };
        let columns = vec![
            "climate",
            "latitude_deg",
            "longitude_deg",
            "ambient_temperature_c",
            "design",
            "pmv_min",
            "pmv_max",
            "hvac_power_w",
            "heating_power_w",
            "cooling_power_w",
            "sample_count",
            "unsolved_count",
            "limited_count",
            "excluded_count",
        ];
        let of_climate =
            |climate: &Climate| (0..climate.years.len()).map(|point| row(climate, point)).collect::<Vec<_>>();
        let rows = self.all.iter().flat_map(of_climate).collect();
        DataTable { file: "climates.csv".to_owned(), columns, rows }
    }
}
