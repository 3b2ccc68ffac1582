//! Where the inputs of a study can be fetched from, and where they belong.

use fetch::Checksum;
use ingest::weather::WeatherFormat;
use std::path::{Path, PathBuf};

use crate::file;

/// The archive of ZTBus in the research collection of ETH Zürich, 1.9 GB.
pub(crate) const ZTBUS: &str =
    "https://www.research-collection.ethz.ch/bitstream/handle/20.500.11850/626723/ZTBus_compressed.zip";
/// Hourly values of a station of MeteoSwiss: the last two decades, and this year.
pub(crate) const METEOSWISS: [&str; 3] = [
    "https://data.geo.admin.ch/ch.meteoschweiz.ogd-smn/{station}/ogd-smn_{station}_h_historical_2010-2019.csv",
    "https://data.geo.admin.ch/ch.meteoschweiz.ogd-smn/{station}/ogd-smn_{station}_h_historical_2020-2029.csv",
    "https://data.geo.admin.ch/ch.meteoschweiz.ogd-smn/{station}/ogd-smn_{station}_h_recent.csv",
];
/// Zürich Fluntern, where the study names no station.
const STATION: &str = "sma";

/// A file that can be fetched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Its address.
    pub url: String,
    /// Where it belongs.
    pub to: PathBuf,
    /// Its size in bytes, where the study says it.
    pub bytes: Option<u64>,
    /// Its checksum, where the study says it.
    pub checksum: Option<Checksum>,
}

/// The sources of missions and of weather; empty where the study names none and there are none for its format.
pub(crate) fn sources(file: &file::StudyFile, base: &Path) -> Result<[Vec<Source>; 2], String> {
    let typed = &file.fetch;
    let checksum = typed.missions_checksum.as_deref().map(str::parse).transpose();
    let checksum = checksum.map_err(|e| format!("[fetch] missions_checksum = {e}"))?;
    let address = typed.missions.clone().unwrap_or_else(|| ZTBUS.to_owned());
    let missions =
        Source { to: place(base, &file.missions.path, &address)?, url: address, bytes: typed.missions_bytes, checksum };
    let station = file.weather.station.as_deref().unwrap_or(STATION).to_lowercase();
    let is_meteoswiss = WeatherFormat::fixed(&file.weather.format) == Some(WeatherFormat::MeteoSwissOgd);
    let weather = match &typed.weather {
        Some(addresses) => addresses.clone(),
        None if is_meteoswiss => METEOSWISS.map(str::to_owned).to_vec(),
        None => Vec::new(),
    };
    let weather = weather.iter().map(|address| {
        let url = address.replace("{station}", &station);
        Ok(Source { to: place(base, &file.weather.path, &url)?, url, bytes: None, checksum: None })
    });
    Ok([vec![missions], weather.collect::<Result<_, String>>()?])
}

/// Where the file of an address belongs: under its own name in the folder that the study names, or above its glob; or as the
/// one file that the study names.
fn place(base: &Path, path: &str, address: &str) -> Result<PathBuf, String> {
    let named = address.split(['?', '#']).next().unwrap_or_default();
    let (_, rest) = named.split_once("://").ok_or_else(|| format!("[fetch] {address:?} is no address: https://…"))?;
    let name = rest.rsplit('/').next().filter(|name| rest.contains('/') && !name.is_empty() && !name.starts_with('.'));
    let name = name.ok_or_else(|| format!("[fetch] {address:?} names no file"))?;
    let at = base.join(path);
    let is_one_file = at.is_file() || (!at.is_dir() && at.extension().is_some() && !path.contains(['*', '?', '[']));
    if is_one_file {
        return Ok(at);
    }
    let glob = path.find(['*', '?', '[']);
    let folder = glob.map_or(path, |at| path[..at].rsplit_once('/').map_or("", |(folder, _)| folder));
    Ok(base.join(folder).join(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_files_go_where_the_study_looks_for_them() {
        let to = |path: &str, address: &str| place(Path::new("/study"), path, address);
        assert_eq!(to("ztbus", "https://a/b/Z.zip?x=1/2"), Ok(PathBuf::from("/study/ztbus/Z.zip")));
        assert_eq!(to("data/ztbus.zip", "https://a/Z.zip"), Ok(PathBuf::from("/study/data/ztbus.zip")));
        assert_eq!(to("weather/ogd-smn_*.csv", "http://a/w.csv"), Ok(PathBuf::from("/study/weather/w.csv")));
        assert_eq!(to("*.csv", "http://a/w.csv"), Ok(PathBuf::from("/study/w.csv")));
        for address in ["w.csv", "https://a", "https://a/", "https://a/..", "https://a/.hidden"] {
            assert!(to("weather", address).is_err(), "{address}");
        }
    }
}
