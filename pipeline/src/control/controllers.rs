//! Which controllers drive the missions of a design: those that follow extracted profiles, published setpoints, and the
//! user's own.

use cabin::kelvin;
use ingest::Content;
use rayon::prelude::*;
use setpoints::{CurtainThreshold, Curve, Own, Setpoints, published};
use simulate::control::{AirCurtain, CausalController};
use std::collections::BTreeMap;
use store::SetpointRow;
use study::Study;

use super::clouds::Clouds;
use crate::PipelineError;
use crate::traces::nearest_window;

/// A controller under its name.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Driven {
    pub name: String,
    /// The window whose profile it follows; `None` for setpoints that no window belongs to, judged by all.
    pub window: Option<usize>,
    /// Whether all windows judge it, or its own alone.
    pub judged_by_all: bool,
    pub controller: CausalController,
}

/// The controllers of the missions of each year, by design.
pub(super) type Controllers = BTreeMap<usize, BTreeMap<i32, Vec<Driven>>>;

/// From which years a profile is that drives a year's missions.
#[derive(Debug, Clone, Copy)]
enum Training {
    /// All of them: what a bus is loaded with.
    All,
    /// All but the year that is driven.
    OtherYears,
    /// The year before alone; for the first one, the last.
    OneYear,
}

impl Training {
    const EACH: [Self; 3] = [Self::All, Self::OtherYears, Self::OneYear];

    fn name(self) -> &'static str {
        match self {
            Self::All => "extracted",
            Self::OtherYears => "extracted-other-years",
            Self::OneYear => "extracted-one-year",
        }
    }

    /// How many years it takes to tell it from the ones before.
    fn least_years(self) -> usize {
        match self {
            Self::All => 1,
            Self::OtherYears => 2,
            Self::OneYear => 3,
        }
    }

    fn takes(self, years: &[i32], driven: i32, year: i32) -> bool {
        let place = |year| years.iter().position(|y| *y == year).unwrap_or(0);
        match self {
            Self::All => true,
            Self::OtherYears => year != driven,
            Self::OneYear => (place(year) + 1) % years.len() == place(driven),
        }
    }
}

/// The controllers of all designs that the study drives. `all` are the setpoints of all designs and windows.
pub(super) fn controllers(
    study: &Study,
    clouds: &Clouds<'_>,
    all: &[SetpointRow],
) -> Result<Controllers, PipelineError> {
    let own = own(study)?;
    let years = clouds.years();
    let mut controllers = Controllers::new();
    for &design in &study.control.designs {
        let windows = study.grid.windows();
        let row = |window: usize| &all[design * windows.len() + window].setpoints;
        let Some(shown) = nearest_window(study, &study.control.windows, 1.0) else { break };
        let devices = Devices::of(row(shown));
        let fixed = |name: &str, controller| Driven {
            name: name.to_owned(),
            window: None,
            judged_by_all: true,
            controller: devices.on(controller),
        };
        let own =
            own.iter().map(|(name, own)| fixed(name, CausalController::new(own.heating.clone(), own.cooling.clone())));
        let published = published().into_iter().map(|p| fixed(p.name, CausalController::published(&p)));
        let fixed: Vec<Driven> = published.chain(own).collect();
        let trainings = Training::EACH.into_iter().filter(|t| t.least_years() <= years.len());
        let wanted: Vec<(i32, Training, usize)> = trainings
            .flat_map(|t| years.iter().map(move |year| (*year, t)))
            .flat_map(|(year, t)| study.control.windows.iter().map(move |window| (year, t, *window)))
            .collect();
        let extracted = |&(year, training, window): &(i32, Training, usize)| {
            let controller = match training {
                Training::All => following(row(window)),
                _ => following(&clouds.of_years(design, window, &|y| training.takes(&years, year, y))),
            };
            let controller = devices.on(controller?);
            let judged_by_all = matches!(training, Training::All);
            Some((year, Driven { name: training.name().to_owned(), window: Some(window), judged_by_all, controller }))
        };
        let extracted: Vec<(i32, Driven)> = wanted.par_iter().filter_map(extracted).collect();
        let mut of_years: BTreeMap<i32, Vec<Driven>> = BTreeMap::new();
        for (year, driven) in extracted {
            of_years.entry(year).or_default().push(driven);
        }
        // Those that all windows judge stand together.
        for year in &years {
            of_years.entry(*year).or_default().extend(fixed.iter().cloned());
        }
        controllers.insert(design, of_years);
    }
    Ok(controllers)
}

/// How many controllers drive a mission of a study with several years.
pub(crate) fn controllers_at_most(study: &Study) -> usize {
    match study.control.windows.len() {
        0 => 0,
        windows => Training::EACH.len() * windows + published().len() + study.control.profiles.len(),
    }
}

/// A controller that follows profiles; `None` without any. A mode without a profile never begins.
fn following(setpoints: &Setpoints) -> Option<CausalController> {
    const NEVER_HEATS_C: f64 = -273.15;
    const NEVER_COOLS_C: f64 = 1000.0;
    if setpoints.heating.is_err() && setpoints.cooling.is_err() {
        return None;
    }
    let heating = setpoints.heating.as_ref().map_or_else(|_| Curve::constant(NEVER_HEATS_C), |p| p.curve.clone());
    let cooling = setpoints.cooling.as_ref().map_or_else(|_| Curve::constant(NEVER_COOLS_C), |p| p.curve.clone());
    Some(CausalController::new(heating, cooling))
}

/// When curtains and heaters run, the same for all controllers of a design (paper: the thresholds hardly depend on the
/// window), to a tenth of a degree.
struct Devices {
    air_curtain: AirCurtain,
    heaters_below_c: Option<f64>,
    radiant_heater_k: f64,
}

impl Devices {
    fn of(setpoints: &Setpoints) -> Self {
        let tenth = |value: f64| (10.0 * value).round() / 10.0;
        // Where curtains always or never run in a mode, no threshold is seen, and the model's serves.
        let above_k = |t: &CurtainThreshold| t.of_optima.map(|t| t.value).or(t.analytic_k).map_or(f64::INFINITY, tenth);
        Self {
            air_curtain: match setpoints.curtains.as_slice() {
                [heating, cooling] => AirCurtain::Above { heating_k: above_k(heating), cooling_k: above_k(cooling) },
                _ => AirCurtain::Off,
            },
            heaters_below_c: setpoints.heaters.map(|t| tenth(t.below_c)),
            radiant_heater_k: setpoints.heaters.map_or(0.0, |t| kelvin(tenth(t.temperature_c))),
        }
    }

    fn on(&self, controller: CausalController) -> CausalController {
        CausalController {
            air_curtain: self.air_curtain,
            heaters_below_c: self.heaters_below_c,
            radiant_heater_k: self.radiant_heater_k,
            ..controller
        }
    }
}

/// The user's own setpoints under their names.
pub(crate) fn own(study: &Study) -> Result<Vec<(String, Own)>, PipelineError> {
    let read = |(name, file): &(String, String)| {
        let path = study.base.join(file);
        let content = Content::read(&path).map_err(|finding| PipelineError::InputFile { path, finding })?;
        let own = Own::read(content.bytes.as_slice());
        Ok((name.clone(), own.map_err(|source| PipelineError::Setpoints { path: file.clone(), source })?))
    };
    study.control.profiles.iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_no_year_is_driven_by_a_profile_of_its_own_but_with_all() {
        let years = [2019, 2020, 2021, 2022];
        let taken = |training: Training, driven: i32| -> Vec<i32> {
            years.into_iter().filter(|year| training.takes(&years, driven, *year)).collect()
        };
        assert_eq!(taken(Training::All, 2020), years);
        assert_eq!(taken(Training::OtherYears, 2020), [2019, 2021, 2022]);
        assert_eq!([2019, 2020, 2022].map(|y| taken(Training::OneYear, y)), [vec![2022], vec![2019], vec![2021]]);
    }
}
