//! The four quantities of the weather.

/// Something of each quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct PerQuantity<T> {
    /// Ambient temperature.
    pub temperature: T,
    /// Global horizontal irradiance.
    pub global: T,
    /// Diffuse horizontal irradiance.
    pub diffuse: T,
    /// Direct normal irradiance.
    pub direct: T,
}

/// Values of one interval: temperature in °C, irradiances in W/m², NaN where missing.
pub(crate) type Values = PerQuantity<f64>;

/// What is missing.
pub(crate) const MISSING: Values =
    PerQuantity { temperature: f64::NAN, global: f64::NAN, diffuse: f64::NAN, direct: f64::NAN };

/// One of the four.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    Temperature,
    Global,
    Diffuse,
    Direct,
}

impl Quantity {
    pub const ALL: [Self; 4] = [Self::Temperature, Self::Global, Self::Diffuse, Self::Direct];
}

impl<T> PerQuantity<T> {
    pub fn get(&self, quantity: Quantity) -> &T {
        match quantity {
            Quantity::Temperature => &self.temperature,
            Quantity::Global => &self.global,
            Quantity::Diffuse => &self.diffuse,
            Quantity::Direct => &self.direct,
        }
    }

    pub fn get_mut(&mut self, quantity: Quantity) -> &mut T {
        match quantity {
            Quantity::Temperature => &mut self.temperature,
            Quantity::Global => &mut self.global,
            Quantity::Diffuse => &mut self.diffuse,
            Quantity::Direct => &mut self.direct,
        }
    }

    pub fn map<U>(&self, f: impl Fn(&T) -> U) -> PerQuantity<U> {
        PerQuantity {
            temperature: f(&self.temperature),
            global: f(&self.global),
            diffuse: f(&self.diffuse),
            direct: f(&self.direct),
        }
    }
}
