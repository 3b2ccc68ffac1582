//! All that a run reads, as plain data that can be changed, changed back and written out.

use super::Scratch;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

pub const WEATHER: &str = "ogd-smn_sma_h_historical_2020-2029.csv";

/// A study and the files that it names.
#[derive(Clone, PartialEq)]
pub struct World {
    /// Name, heating, COP, radiant heaters, air curtain.
    pub designs: Vec<(String, &'static str, &'static str, bool, bool)>,
    pub limits: Vec<f64>,
    pub simulated: Vec<f64>,
    pub time_zone: &'static str,
    pub segment_s: u32,
    pub keep_partial: bool,
    pub door_open_share: f64,
    pub max_gap_s: u32,
    pub air_velocity_m_s: f64,
    /// Where missions lie: a folder, or an archive.
    pub missions_path: &'static str,
    pub shadow_path: &'static str,
    /// Mission files by name; `None` is one that is away.
    pub missions: BTreeMap<String, Option<String>>,
    /// Weather files by name.
    pub weather: BTreeMap<String, String>,
    pub shadow: String,
}

impl World {
    /// What the demo has made in a folder, with two designs and windows.
    pub fn of_demo(scratch: &Scratch) -> Self {
        let missions = scratch.missions().into_iter().map(|n| (n.clone(), Some(scratch.read(&format!("ztbus/{n}")))));
        Self {
            designs: vec![
                ("ptc".to_owned(), "ptc", "vecto-continuous", false, false),
                ("hp+curtain".to_owned(), "hp", "vecto-continuous", false, true),
            ],
            limits: vec![0.5, 1.0],
            simulated: vec![1.0],
            time_zone: "Europe/Zurich",
            segment_s: 3600,
            keep_partial: false,
            door_open_share: 0.6,
            max_gap_s: 10_800,
            air_velocity_m_s: 0.1,
            missions_path: "ztbus",
            shadow_path: "shadow.csv",
            missions: missions.collect(),
            weather: BTreeMap::from([(WEATHER.to_owned(), scratch.read(&format!("weather/{WEATHER}")))]),
            shadow: scratch.read("shadow.csv"),
        }
    }

    fn study(&self) -> String {
        let designs: String = self
            .designs
            .iter()
            .map(|(name, heating, cop, heaters, curtain)| {
                format!(
                    "[designs.\"{name}\"]\nheating = \"{heating}\"\nheating_cop = \"{cop}\"\nradiant_heaters = {heaters}\n\
                     air_curtain = {curtain}\n\n"
                )
            })
            .collect();
        format!(
            "schema_version = 1\nname = \"world\"\ndatabase = \"study.db\"\nreport_dir = \"report\"\n\n\
             [location]\nlatitude_deg = 47.3779\nlongitude_deg = 8.5657\naltitude_m = 556.0\ntime_zone = \"{}\"\n\n\
             [missions]\npath = \"{}\"\nbuses = [183]\nsegment_s = {}\ndoor_open_share = {:?}\nkeep_partial = {}\nforget_missing = true\n\n\
             [weather]\nformat = \"meteoswiss-ogd\"\npath = \"weather\"\nmax_gap_s = {}\n\n\
             [shadow]\npath = \"{}\"\n\n[comfort]\npmv_limits = {:?}\n\n{designs}\
             [vehicle]\nair_velocity_m_s = {:?}\n\n[simulation]\npmv_limits = {:?}\n",
            self.time_zone,
            self.missions_path,
            self.segment_s,
            self.door_open_share,
            self.keep_partial,
            self.max_gap_s,
            self.shadow_path,
            self.limits,
            self.air_velocity_m_s,
            self.simulated,
        )
    }

    /// Makes the folder hold exactly this; files that hold it already are left alone.
    pub fn write(&self, scratch: &Scratch) {
        let mut files: BTreeMap<String, Vec<u8>> = BTreeMap::new();
        files.insert("study.toml".to_owned(), self.study().into_bytes());
        files.insert(self.shadow_path.to_owned(), self.shadow.clone().into_bytes());
        for (name, text) in &self.weather {
            files.insert(format!("weather/{name}"), text.clone().into_bytes());
        }
        let present = self.missions.iter().filter_map(|(name, text)| Some((name, text.as_ref()?)));
        if self.missions_path.ends_with(".zip") {
            let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
            for (name, text) in present {
                zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
                zip.write_all(text.as_bytes()).unwrap();
            }
            files.insert(self.missions_path.to_owned(), zip.finish().unwrap().into_inner());
        } else {
            files.extend(present.map(|(n, text)| (format!("{}/{n}", self.missions_path), text.clone().into_bytes())));
        }
        for there in listed(scratch.folder.path(), "") {
            let kept = there.starts_with("study.db") || there.starts_with("report") || there.ends_with("metaData.csv");
            if !kept && !files.contains_key(&there) {
                std::fs::remove_file(scratch.path(&there)).unwrap();
            }
        }
        for (name, bytes) in files {
            let path = scratch.path(&name);
            if std::fs::read(&path).ok().as_ref() != Some(&bytes) {
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                std::fs::write(path, bytes).unwrap();
            }
        }
    }
}

/// All files below a folder, by their paths from there.
fn listed(folder: &Path, label: &str) -> Vec<String> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let label = format!("{label}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            found.extend(listed(&entry.path(), &format!("{label}/")));
        } else {
            found.push(label);
        }
    }
    found
}
