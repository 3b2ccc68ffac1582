//! What comes before a run: study files and demo data sets.

use anyhow::{Context, anyhow};
use demo::MissionPlan;
use pipeline::{Progress, write_whole};
use std::path::{Path, PathBuf};

use crate::STUDY_FILE;
use crate::args::DemoArgs;
use crate::console::{Console, say};
use crate::failure::Failure;
use study::template::{self, Template, WeatherKeys};

/// Where a run without a study file makes its demo.
const DEMO_FOLDER: &str = "busclimate-demo";
/// The bus of the paper.
const PAPER_BUS: u32 = 183;
/// Format of the synthetic weather.
const SYNTHETIC: WeatherKeys = WeatherKeys::MeteoSwissOgd;

pub fn init(dir: &Path) -> Result<(), Failure> {
    let name = dir.file_name().map_or_else(|| "study".to_owned(), |n| n.to_string_lossy().into_owned());
    let text = template::render(&Template { name: &name, note: None, buses: &[PAPER_BUS], weather: SYNTHETIC });
    let path = dir.join(STUDY_FILE);
    if path.exists() {
        return Err(Failure::Usage(anyhow!("{} is there already; it is left as it is", path.display())));
    }
    std::fs::create_dir_all(dir)
        .and_then(|()| std::fs::write(dir.join(study::SCHEMA_FILE), schema_text()))
        .and_then(|()| std::fs::write(&path, text))
        .with_context(|| format!("cannot write {}; check permissions and free space", path.display()))
        .map_err(Failure::Usage)?;
    say(format_args!("{} is written; put the missions, the weather and shadow.csv where it says", path.display()))
}

/// What editors check a study file by.
fn schema_text() -> String {
    format!("{}\n", study::schema())
}

/// The demo of a run without a study file, made once.
pub fn demo_study(console: &Console) -> Result<PathBuf, Failure> {
    let dir = PathBuf::from(DEMO_FOLDER);
    let study = dir.join(STUDY_FILE);
    if !study.exists() {
        console.info(&format!("no study file here: making the demo in ./{DEMO_FOLDER}"));
        demo(&DemoArgs { dir, missions: 48, seed: 1, like: None, weather: None, buses: Vec::new() }, console)?;
    }
    Ok(study)
}

pub fn demo(args: &DemoArgs, console: &Console) -> Result<(), Failure> {
    let plans = match &args.like {
        None => demo::default_plan(args.missions, args.seed).map_err(|e| Failure::Usage(e.into()))?,
        Some(path) => {
            let file = std::fs::File::open(path)
                .with_context(|| format!("cannot read {}; give the metaData.csv of ZTBus", path.display()))
                .map_err(Failure::Inputs)?;
            let plans =
                demo::read_meta_data(file).with_context(|| path.display().to_string()).map_err(Failure::Inputs)?;
            let wanted = if args.buses.is_empty() { &[PAPER_BUS][..] } else { &args.buses };
            plans.into_iter().filter(|p| wanted.contains(&p.bus)).collect()
        }
    };
    let mut buses: Vec<u32> = plans.iter().map(|p| p.bus).collect();
    buses.sort_unstable();
    buses.dedup();

    let real = args.weather.as_deref().map(real_weather).transpose()?;
    let weather = real.as_ref().map(|w| (w.name.as_str(), w.bytes.as_slice()));
    let note = "Synthetic data, made by busclimate: it shows how the program works and says nothing about Zürich.";
    let format = real.as_ref().map_or(SYNTHETIC, |w| w.format);
    let study = template::render(&Template { name: "demo", note: Some(note), buses: &buses, weather: format });
    let path = args.dir.join(STUDY_FILE);
    let study = format!("{study}\n{}\n", origin(args, &plans, weather));
    if path.exists() && std::fs::read(&path).ok().as_deref() != Some(study.as_bytes()) {
        return Err(Failure::Usage(anyhow!(
            "{} is there already, and not one of a demo with these arguments; it is left as it is: name another folder",
            path.display()
        )));
    }
    console.begin("demo missions", plans.len() as u64);
    let summary = demo::write(&args.dir, args.seed, &plans, weather, &|_, _| console.advance(1))
        .map_err(|e| Failure::Inputs(e.into()))?;
    console.end();
    write_whole(&args.dir.join(study::SCHEMA_FILE), schema_text().as_bytes())?;
    // Written last: a study file that is there has all its data.
    write_whole(&path, study.as_bytes())?;
    say(format_args!(
        "{} missions, {} rows, {} MB of synthetic telemetry; study file {}",
        summary.missions,
        summary.rows,
        summary.bytes / 1_000_000,
        path.display()
    ))
}

/// What a demo is made of, as the last line of its study file.
fn origin(args: &DemoArgs, plans: &[MissionPlan], weather: Option<(&str, &[u8])>) -> String {
    let span = match (plans.first(), plans.last()) {
        (Some(first), Some(last)) => format!(", {} to {}", first.name(), last.name()),
        _ => String::new(),
    };
    let weather =
        weather.map_or_else(|| "synthetic".to_owned(), |(name, bytes)| format!("{name:?}, {} bytes", bytes.len()));
    format!("# Made by `busclimate demo`: {} missions{span}; seed {}; weather: {weather}", plans.len(), args.seed)
}

/// A file of real weather for a demo, and how a study file describes it.
struct RealWeather {
    name: String,
    bytes: Vec<u8>,
    format: WeatherKeys,
}

/// Reads a weather file; its header tells the format.
fn real_weather(path: &Path) -> Result<RealWeather, Failure> {
    let bytes = std::fs::read(path)
        .with_context(|| format!("cannot read {}; give a weather file", path.display()))
        .map_err(Failure::Inputs)?;
    let header = String::from_utf8_lossy(bytes.split(|&b| b == b'\n').next().unwrap_or_default()).into_owned();
    let format = WeatherKeys::of_header(&header).ok_or_else(|| {
        Failure::Inputs(anyhow!(
            "{}: line 1: not the header of a weather file that a demo can take; give MeteoSwiss' open data, a SIA 4028 year, \
             or hourly CSV with interval_start_utc, T_degC and StrGlo_Wm2",
            path.display()
        ))
    })?;
    let name = path.file_name().map_or_else(|| "weather.csv".to_owned(), |n| n.to_string_lossy().into_owned());
    Ok(RealWeather { name, bytes, format })
}
