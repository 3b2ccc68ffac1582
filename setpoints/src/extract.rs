//! Everything that a controller learns from the optima of a design in a comfort window.

use cabin::{Design, OperatingMode, Vehicle, celsius};

use crate::{Edge, Point, Profile, Switch, Threshold, curtain_threshold_k, fit, threshold};

/// The optimum of an hour, as a controller sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hour {
    /// What the air unit does.
    pub mode: OperatingMode,
    /// Ambient temperature in K.
    pub ambient_k: f64,
    /// Cabin temperature in K.
    pub cabin_k: f64,
    /// Whether the air curtains run.
    pub curtain: bool,
    /// Temperature of the radiant heaters in K; `None` while they are off.
    pub heaters_k: Option<f64>,
    /// Share in the year, above 0.
    pub weight: f64,
}

/// The setpoints of a design in a comfort window.
#[derive(Debug, Clone, PartialEq)]
pub struct Setpoints {
    /// Setpoint while heating, or why there is none.
    pub heating: Result<Profile, String>,
    /// Setpoint while cooling, or why there is none.
    pub cooling: Result<Profile, String>,
    /// From which difference on the air curtains run, while heating and while cooling; nothing for a design without them.
    pub curtains: Vec<CurtainThreshold>,
    /// When the radiant heaters run; `None` for a design without them, and where they never do.
    pub heaters: Option<HeaterThreshold>,
}

/// From which difference of temperatures on air curtains run in a mode: of cabin over ambient while heating, of ambient over
/// cabin while cooling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurtainThreshold {
    /// Heating or cooling.
    pub mode: OperatingMode,
    /// That of the optima, in K; `None` where they always or never run.
    pub of_optima: Option<Threshold>,
    /// That of the model at the mean ambient temperature of the mode, in K; `None` where curtains never pay.
    pub analytic_k: Option<f64>,
}

/// When radiant heaters run, and how warm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeaterThreshold {
    /// Below which ambient temperature in °C.
    pub below_c: f64,
    /// Weighted share of the hours that lie on the wrong side.
    pub misclassified: f64,
    /// Their mean temperature in °C while they run.
    pub temperature_c: f64,
}

/// Extracts the setpoints of a design from the hours of a year in one comfort window; `coverage` as in [`fit`].
#[must_use]
pub fn extract(vehicle: &Vehicle, design: &Design, hours: &[Hour], coverage: f64) -> Setpoints {
    let in_mode = |mode| hours.iter().filter(move |h| h.mode == mode);
    let profile = |mode, edge| {
        let point = |h: &Hour| Point { ambient_c: celsius(h.ambient_k), cabin_c: celsius(h.cabin_k), weight: h.weight };
        fit(&in_mode(mode).map(point).collect::<Vec<_>>(), edge, coverage).map_err(|reason| reason.to_string())
    };
    let curtain = |mode| {
        // A cabin that is cooled while it is colder outside is better off with open doors.
        let sign = if mode == OperatingMode::Cooling { -1.0 } else { 1.0 };
        let switch = |h: &Hour| Switch { value: sign * (h.cabin_k - h.ambient_k), is_on: h.curtain, weight: h.weight };
        let switches: Vec<Switch> = in_mode(mode).map(switch).collect();
        let cop = if mode == OperatingMode::Cooling { &design.cooling_cop } else { &design.heating_cop };
        let ambient_k = mean(in_mode(mode).map(|h| (h.ambient_k, h.weight)));
        let analytic_k = ambient_k.and_then(|ambient_k| curtain_threshold_k(vehicle, cop, ambient_k));
        CurtainThreshold { mode, of_optima: threshold(&switches), analytic_k }
    };
    Setpoints {
        heating: profile(OperatingMode::Heating, Edge::Upper),
        cooling: profile(OperatingMode::Cooling, Edge::Lower),
        curtains: if design.devices.air_curtain {
            [OperatingMode::Heating, OperatingMode::Cooling].map(curtain).to_vec()
        } else {
            Vec::new()
        },
        heaters: if design.devices.radiant_heaters { heaters(hours) } else { None },
    }
}

/// Heaters run where it is cold: their threshold is one of the negative temperature.
fn heaters(hours: &[Hour]) -> Option<HeaterThreshold> {
    let switch = |h: &Hour| Switch { value: -celsius(h.ambient_k), is_on: h.heaters_k.is_some(), weight: h.weight };
    let switches: Vec<Switch> = hours.iter().map(switch).collect();
    // Where they always run, there is no hour as warm as the threshold.
    let always = || {
        let warmest = switches.iter().map(|s| s.value).fold(f64::INFINITY, f64::min);
        Threshold { value: warmest.ceil() - 1.0, misclassified: 0.0 }
    };
    let found = threshold(&switches).or_else(|| switches.iter().all(|s| s.is_on).then(always))?;
    let temperature_k = mean(hours.iter().filter_map(|h| h.heaters_k.map(|t| (t, h.weight))))?;
    Some(HeaterThreshold {
        below_c: -found.value,
        misclassified: found.misclassified,
        temperature_c: celsius(temperature_k),
    })
}

/// The mean of values with weights; `None` where nothing weighs.
fn mean(values: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let (sum, weight) = values.fold((0.0, 0.0), |(s, w), (value, weight)| (s + weight * value, w + weight));
    (weight > 0.0).then(|| sum / weight)
}
