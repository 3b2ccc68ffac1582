//! Study files to start from.

use cabin::Vehicle;
use simulate::Dynamics;

use crate::schema::SCHEMA_FILE;

/// The parts of a study file that differ between a new study and the demo's.
pub struct Template<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// A line for the top of the report.
    pub note: Option<&'a str>,
    /// Buses; none means all.
    pub buses: &'a [u32],
    /// How the weather files look.
    pub weather: WeatherKeys,
}

/// The keys of `[weather]` that tell how its files are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WeatherKeys {
    /// Open data of MeteoSwiss.
    MeteoSwissOgd,
    /// A SIA 4028 reference year.
    Sia4028,
    /// Hourly, stamped at the start, with the columns of Zürich's own stations.
    HourlyCsv,
}

impl WeatherKeys {
    /// The keys for a file with this header, its first line; `None` for one that no study file describes without being told.
    #[must_use]
    pub fn of_header(header: &str) -> Option<Self> {
        if header.contains("reference_timestamp") {
            Some(Self::MeteoSwissOgd)
        } else if header.contains("rad.global") {
            Some(Self::Sia4028)
        } else if ["interval_start_utc", "T_degC", "StrGlo_Wm2"].iter().all(|c| header.contains(c)) {
            Some(Self::HourlyCsv)
        } else {
            None
        }
    }

    fn lines(self) -> [&'static str; 2] {
        const MAP: &str = "# format = \"csv\" only:\n# time_column = \"interval_start_utc\"\n\
            # time_label = \"start\"            # or \"middle\", \"end\"\n\
            # time_zone = \"Europe/Zurich\"    # of stamps without an offset; without it, or utc_offset = \"+01:00\", UTC\n\
            # interval_s = 3600\n# temperature_column = \"T_degC\"\n\
            # ghi_column = \"StrGlo_Wm2\"       # and/or dhi_column, dni_column\n\
            # temperature_unit = \"C\"          # or \"K\", \"F\", \"0.1C\"\n\
            # irradiance_unit = \"W/m2\"       # or \"J/m2\", \"kJ/m2\", \"MJ/m2\", \"J/cm2\", \"Wh/m2\", \"kWh/m2\"\n";
        const GIVEN: &str = "time_column = \"interval_start_utc\"\ntime_label = \"start\"              # or \"middle\", \"end\"\n\
            interval_s = 3600\ntemperature_column = \"T_degC\"\n\
            ghi_column = \"StrGlo_Wm2\"         # and/or dhi_column, dni_column\n";
        match self {
            Self::MeteoSwissOgd => [
                "format = \"meteoswiss-ogd\"         # or \"sia4028\", \"epw\", \"pvgis\", \"open-meteo\", \"ugz\", \"dwd\", \"csv\"",
                MAP,
            ],
            Self::Sia4028 => [
                "format = \"sia4028\"                # or \"meteoswiss-ogd\", \"epw\", \"pvgis\", \"open-meteo\", \"ugz\", \"dwd\", \"csv\"",
                MAP,
            ],
            Self::HourlyCsv => [
                "format = \"csv\"                    # or \"meteoswiss-ogd\", \"sia4028\", \"epw\", \"pvgis\", \"open-meteo\", \"ugz\", \"dwd\"",
                GIVEN,
            ],
        }
    }
}

/// A commented study file with every default.
#[must_use]
pub fn render(template: &Template) -> String {
    let note = match template.note {
        Some(note) => format!("note = {}\n", quoted(note)),
        None => "# note = \"shown at the top of the report\"\n".to_owned(),
    };
    let vehicle = toml::to_string(&Vehicle::default()).expect("a flat struct of numbers becomes TOML");
    let commented = |text: String| text.lines().map(|line| format!("# {line}\n")).collect::<String>();
    let dynamics = toml::to_string(&Dynamics::default()).expect("a flat struct of numbers becomes TOML");
    let [format, map] = template.weather.lines();
    include_str!("template.toml")
        .replace("@SCHEMA@", SCHEMA_FILE)
        .replace("@FORMAT@", format)
        .replace("@MAP@", map)
        .replace("@ZTBUS@", crate::sources::ZTBUS)
        .replace("@NAME@", &quoted(template.name))
        .replace("@NOTE@", &note)
        .replace("@BUSES@", &format!("{:?}", template.buses))
        .replace("@VEHICLE@", &commented(vehicle))
        .replace("@DYNAMICS@", &commented(dynamics))
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_the_template_is_a_study_with_the_defaults() {
        let text = render(&Template {
            name: "a \"name\"",
            note: Some("a note"),
            buses: &[183],
            weather: WeatherKeys::HourlyCsv,
        });
        let file: crate::file::StudyFile = toml::from_str(&text).unwrap();
        assert_eq!((file.name.as_str(), file.note.as_deref()), ("a \"name\"", Some("a note")));
        assert_eq!(file.missions.buses, [183]);
        // The commented constants are the defaults, written as they would be typed.
        let typed = text.replace("# cabin_length_m", "cabin_length_m").replace("# roof_area_m2", "roof_area_m2");
        let file: crate::file::StudyFile = toml::from_str(&typed).unwrap();
        assert_eq!(file.vehicle, Vehicle::default());
        assert_eq!(file.designs.len(), 5);
    }
}
