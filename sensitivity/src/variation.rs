//! A bus that differs from another one, by inputs that have names.

use cabin::{Design, Disturbances, Heating, PassengerViews, Vehicle};
use serde::{Deserialize, Serialize};
use solve::{Bus, CertificateError, certify};
use std::sync::Arc;

use crate::Spread;

/// What differs besides the constants of the bus: its heat pumps, and what acts on it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Factors {
    /// Factor of the COP of heat pumps in heating; resistive heating has no COP to vary.
    pub heating_cop_scale: f64,
    /// What is added to it after that.
    pub heating_cop_shift: f64,
    /// Factor of the COP in cooling.
    pub cooling_cop_scale: f64,
    /// What is added to it after that.
    pub cooling_cop_shift: f64,
    /// How much warmer the ambient air is, in K.
    pub ambient_offset_k: f64,
    /// Factor of the share of time in the shade, which stays at most 1.
    pub shade_scale: f64,
    /// Factor of the passengers on board.
    pub passengers_scale: f64,
    /// Factor of the fraction of the doors that is open, which stays at most 1.
    pub door_open_scale: f64,
}

impl Default for Factors {
    /// No difference.
    fn default() -> Self {
        Self {
            heating_cop_scale: 1.0,
            heating_cop_shift: 0.0,
            cooling_cop_scale: 1.0,
            cooling_cop_shift: 0.0,
            ambient_offset_k: 0.0,
            shade_scale: 1.0,
            passengers_scale: 1.0,
            door_open_scale: 1.0,
        }
    }
}

/// A bus, and what acts on it, as it differs from the samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// Its constants.
    pub vehicle: Vehicle,
    /// The rest.
    pub factors: Factors,
}

/// An input that cannot be, or has a value that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VariationError {
    /// There is no such input.
    #[error("{name} is no input that can vary; {hint}")]
    Unknown {
        /// As it was given.
        name: String,
        /// The nearest that there is, or all.
        hint: String,
    },
    /// A whole number is needed.
    #[error("{name} = {value} must be a whole number")]
    Whole {
        /// Name of the input.
        name: String,
        /// As it was given.
        value: f64,
    },
    /// A factor or an offset out of its range.
    #[error("{name} = {value} must lie between {low} and {high}")]
    Range {
        /// Name of the input.
        name: String,
        /// As it was given.
        value: f64,
        /// Least value.
        low: f64,
        /// Largest value.
        high: f64,
    },
    /// A spread that is none.
    #[error(
        "{name} varies as {spread:?}: give [low, high] with low below high, {{ mean = …, sd = … }} with sd above 0, or {{ low = …, \
         mode = …, high = … }} in this order"
    )]
    Spread {
        /// Name of the input.
        name: String,
        /// As it was given.
        spread: Spread,
    },
    /// The bus cannot be, or its optima would not be proven.
    #[error(transparent)]
    Certificate(#[from] CertificateError),
}

impl Variation {
    /// The bus itself.
    #[must_use]
    pub fn none(vehicle: &Vehicle) -> Self {
        Self { vehicle: vehicle.clone(), factors: Factors::default() }
    }

    /// The names of all inputs: factors and offsets, then the constants of the bus.
    #[must_use]
    pub fn names() -> Vec<String> {
        let mut names = Vec::new();
        for fields in [fields(&Factors::default()), fields(&Vehicle::default())] {
            names.extend(fields.into_iter().map(|(name, _)| name));
        }
        names
    }

    /// The value of an input, where there is one of that name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        let of_factors = fields(&self.factors).remove(name);
        of_factors.or_else(|| fields(&self.vehicle).remove(name)).and_then(|value| value.as_f64())
    }

    /// The same with some inputs set to other values.
    ///
    /// # Errors
    /// [`VariationError::Unknown`], [`VariationError::Whole`], [`VariationError::Range`]; whether the bus can be is checked by
    /// [`Variation::bus`].
    pub fn with<'n>(&self, values: impl IntoIterator<Item = (&'n str, f64)>) -> Result<Self, VariationError> {
        let (mut factors, mut vehicle) = (fields(&self.factors), fields(&self.vehicle));
        for (name, value) in values {
            if !value.is_finite() {
                return Err(VariationError::Range { name: name.to_owned(), value, low: f64::MIN, high: f64::MAX });
            }
            if let Some(old) = factors.get_mut(name) {
                check_factor(name, value)?;
                *old = value.into();
            } else if let Some(old) = vehicle.get_mut(name) {
                *old = match old.is_u64() {
                    false => value.into(),
                    true if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) => {
                        (value as u64).into()
                    }
                    true => return Err(VariationError::Whole { name: name.to_owned(), value }),
                };
            } else {
                return Err(VariationError::Unknown { name: name.to_owned(), hint: hint(name) });
            }
        }
        Ok(Self { vehicle: read(vehicle), factors: read(factors) })
    }

    /// The bus with designs, ready to be solved; `views` are passengers of a vehicle that may stand in the same places.
    ///
    /// # Errors
    /// [`VariationError::Certificate`] where the bus cannot be, or its optima would not be proven.
    pub fn bus(&self, designs: &[Design], views: &Passengers) -> Result<Bus, VariationError> {
        let f = &self.factors;
        let design = |design: &Design| Design {
            heating_cop: match design.heating {
                Heating::HeatPump => design.heating_cop.changed(f.heating_cop_scale, f.heating_cop_shift),
                Heating::Ptc => design.heating_cop.clone(),
            },
            cooling_cop: design.cooling_cop.changed(f.cooling_cop_scale, f.cooling_cop_shift),
            ..design.clone()
        };
        let designs: Vec<Design> = designs.iter().map(design).collect();
        certify(&self.vehicle, &designs)?;
        Ok(Bus { vehicle: self.vehicle.clone(), views: views.of(&self.vehicle), designs })
    }

    /// A sample as it acts on this bus.
    #[must_use]
    #[inline]
    pub fn disturbances(&self, sample: &Disturbances) -> Disturbances {
        let f = &self.factors;
        Disturbances {
            ambient_temperature_k: sample.ambient_temperature_k + f.ambient_offset_k,
            shadow_fraction: (sample.shadow_fraction * f.shade_scale).min(1.0),
            passengers: sample.passengers * f.passengers_scale,
            door_open_fraction: (sample.door_open_fraction * f.door_open_scale).min(1.0),
            ..*sample
        }
    }
}

/// The placed passengers of a vehicle, and what their places depend on.
#[derive(Debug, Clone)]
pub struct Passengers {
    vehicle: Vehicle,
    views: Arc<PassengerViews>,
}

impl Passengers {
    /// Those of a vehicle.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        Self { vehicle: vehicle.clone(), views: Arc::new(PassengerViews::new(vehicle)) }
    }

    /// Those of another vehicle: the same where cabin, panels and placement are.
    fn of(&self, vehicle: &Vehicle) -> Arc<PassengerViews> {
        let own = &self.vehicle;
        // With what view factors do not depend on made alike, the same vehicle.
        let alike = Vehicle {
            cabin_length_m: vehicle.cabin_length_m,
            cabin_width_m: vehicle.cabin_width_m,
            cabin_height_m: vehicle.cabin_height_m,
            passenger_width_m: vehicle.passenger_width_m,
            passenger_height_m: vehicle.passenger_height_m,
            passenger_placements: vehicle.passenger_placements,
            passenger_seed: vehicle.passenger_seed,
            panel_rows: vehicle.panel_rows,
            panel_columns: vehicle.panel_columns,
            panel_length_m: vehicle.panel_length_m,
            panel_width_m: vehicle.panel_width_m,
            ..own.clone()
        };
        if alike == *own { self.views.clone() } else { Arc::new(PassengerViews::new(vehicle)) }
    }
}

fn check_factor(name: &str, value: f64) -> Result<(), VariationError> {
    let (low, high) = match name {
        "ambient_offset_k" => (-30.0, 20.0),
        "heating_cop_shift" | "cooling_cop_shift" => (-5.0, 5.0),
        "heating_cop_scale" | "cooling_cop_scale" => (0.05, 20.0),
        _ => (0.0, 20.0),
    };
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(VariationError::Range { name: name.to_owned(), value, low, high })
}

/// What to take instead of a name that there is not.
fn hint(name: &str) -> String {
    let names = Variation::names();
    let nearest = names.iter().max_by(|a, b| strsim::jaro_winkler(a, name).total_cmp(&strsim::jaro_winkler(b, name)));
    match nearest {
        Some(nearest) if strsim::jaro_winkler(nearest, name) > 0.8 => format!("did you mean {nearest}?"),
        _ => format!("there are {}", names.join(", ")),
    }
}

fn fields(of: &impl Serialize) -> serde_json::Map<String, serde_json::Value> {
    match serde_json::to_value(of) {
        Ok(serde_json::Value::Object(fields)) => fields,
        _ => serde_json::Map::new(),
    }
}

fn read<T: for<'de> Deserialize<'de>>(fields: serde_json::Map<String, serde_json::Value>) -> T {
    serde_json::from_value(fields.into()).expect("the fields are those of the struct, numbers where it has numbers")
}
