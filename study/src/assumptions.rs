//! What the numbers of a report rest on, with sources.

use cabin::{Heating, named_cooling_cops, named_heating_cops};
use ingest::weather::WeatherFormat;
use serde::Serialize;

use crate::Study;

/// Something that the numbers rest on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assumption {
    /// What it is about.
    pub what: String,
    /// What is assumed.
    pub value: String,
    /// Where it comes from.
    pub source: String,
    /// Whether it stands in for something that the paper does not publish.
    pub substitute: bool,
}

/// All assumptions of a study, in the order of the report; `shade` says what the shadow file is, where it is known.
#[must_use]
pub fn assumptions(study: &Study, shade: Option<&str>) -> Vec<Assumption> {
    let mut list = Vec::new();
    let mut add = |what: &str, value: String, source: &str, substitute: bool| {
        let item = Assumption { what: what.to_owned(), value, source: source.to_owned(), substitute };
        if !list.contains(&item) {
            list.push(item);
        }
    };
    for design in &study.design_rows {
        if design.heating == Heating::Ptc {
            add("COP of PTC heating", design.heating_cop.clone(), "paper, section 2.3", false);
        } else {
            let (value, source) = cop(&design.heating_cop, &named_heating_cops());
            add("COP of heat pump heating", value, source, true);
        }
        let (value, source) = cop(&design.cooling_cop, &named_cooling_cops());
        add("COP of cooling", value, source, true);
    }
    let v = &study.vehicle;
    add(
        "heat of electric components Q_other",
        format!("{} W", v.other_heat_w),
        "label of the paper's heat flow figures",
        true,
    );
    add(
        "clothing insulation",
        format!("Havenith's cubic of the ambient temperature, at least {} clo", v.clothing_floor_clo),
        "Havenith et al. 2012, doi 10.1007/s00484-011-0451-4; floor: the paper's clothing figure",
        true,
    );
    add(
        "passengers for the mean comfort",
        format!("{} placed with seed {}", v.passenger_placements, v.passenger_seed),
        "the paper places passengers at random; number and seed are not published",
        true,
    );
    add(
        "radiant ceiling panels",
        format!("{} × {} of {} m × {} m", v.panel_rows, v.panel_columns, v.panel_length_m, v.panel_width_m),
        "16 panels in the paper; their arrangement is not published",
        true,
    );
    add(
        "share of the doors that open",
        study.missions.door_open_share.to_string(),
        "paper, section on the doors",
        false,
    );
    let split = match &study.weather.format {
        WeatherFormat::Sia4028 | WeatherFormat::Epw | WeatherFormat::Pvgis => {
            "direct and diffuse irradiance as in the file; direct from global and diffuse by closure where it lacks"
        }
        WeatherFormat::Csv(map) if map.dhi_column.is_some() && map.dni_column.is_some() => {
            "direct and diffuse irradiance as in the file"
        }
        WeatherFormat::Csv(map) if map.dhi_column.is_some() => "direct irradiance from global and diffuse by closure",
        _ => "direct and diffuse irradiance from global by Erbs where diffuse is not measured",
    };
    add("irradiance", split.to_owned(), "Erbs et al. 1982, doi 10.1016/0038-092X(82)90302-4", false);
    add(
        "shadow fractions",
        shade.map_or_else(|| study.shadow_path.clone(), |words| format!("{}: {words}", study.shadow_path)),
        "the study's own file; the paper computes them from a city model that is not published",
        true,
    );
    if !study.simulated_windows.is_empty() {
        let d = &study.dynamics;
        let (gain, integral_s) = (d.controller_gain_w_k, d.controller_integral_s);
        add("cabin controller", format!("PI, {gain} W/K, {integral_s} s"), "paper, section on the validation", false);
        add(
            "anti-windup",
            "at a limit the integral stands still where it would wind up".to_owned(),
            "the paper does not name its own",
            true,
        );
        add("power limit of a heat pump", format!("{} W", d.heat_pump_limit_w), "paper, model constants", false);
        add(
            "power limits of PTC, air conditioning and radiant heaters",
            format!("{} W, {} W, {} W", d.ptc_limit_w, d.cooling_limit_w, d.heater_limit_w),
            "the paper states none; air conditioning as the heat pump, which is the same machine",
            true,
        );
        add(
            "controller of the radiant heaters",
            format!("PI, {} W/K, {} s", d.heater_gain_w_k, d.heater_integral_s),
            "the paper does not say how they hold their temperature",
            true,
        );
        add(
            "lag of the air unit",
            format!("{} s for heat pump and air conditioning; PTC gives its heat at once", d.air_unit_time_constant_s),
            "paper, eq. vcc-ode",
            false,
        );
    }
    if !study.control.windows.is_empty() {
        let coverage = format!("at least {} of the hours in a mode", study.control.coverage);
        add("coverage of setpoint profiles", coverage, "the paper does not say how far its fits lie at the edge", true);
        add(
            "one setpoint for heating and cooling",
            "a mode begins 2 K on its wrong side".to_owned(),
            "the sources of published setpoints do not say how they keep the modes apart; varied in docs/control.md",
            true,
        );
        add(
            "air curtains of causal controllers",
            "off while the air unit is at rest".to_owned(),
            "the paper gives thresholds for heating and cooling only",
            true,
        );
    }
    let changed = [changed_constants(v), changed_constants(&study.dynamics)].concat();
    if !changed.is_empty() {
        let what = "constants that differ from the paper's bus".to_owned();
        let value = changed.join(", ");
        // What everything else is to be read with comes first.
        list.insert(0, Assumption { what, value, source: "the study file".to_owned(), substitute: false });
    }
    list
}

fn cop(text: &str, named: &[(&'static str, cabin::Cop, &'static str)]) -> (String, &'static str) {
    let source = named.iter().find(|n| n.0 == text).map_or("the study file", |n| n.2);
    (text.to_owned(), source)
}

fn changed_constants<T: Serialize + Default>(constants: &T) -> Vec<String> {
    let fields = |v: &T| match serde_json::to_value(v) {
        Ok(serde_json::Value::Object(map)) => map.into_iter().collect::<Vec<_>>(),
        _ => Vec::new(),
    };
    let paper = fields(&T::default());
    let differs = |(name, value): &(String, serde_json::Value)| !paper.contains(&(name.clone(), value.clone()));
    fields(constants).into_iter().filter(differs).map(|(name, value)| format!("{name} = {value}")).collect()
}
