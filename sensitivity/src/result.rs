//! What a year comes to, as results that depend on inputs.

use solve::{AnnualMean, Grid};

/// A quantity of the year.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Annual mean of the HVAC power in W.
    HvacPower,
    /// Of that, in samples whose air unit heats or rests, in W.
    HeatingPower,
    /// In samples whose air unit cools, in W.
    CoolingPower,
    /// Fraction saved against the first design.
    Reduction,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::HvacPower, Self::HeatingPower, Self::CoolingPower, Self::Reduction];

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::HvacPower => "hvac_power_w",
            Self::HeatingPower => "heating_power_w",
            Self::CoolingPower => "cooling_power_w",
            Self::Reduction => "reduction",
        }
    }

    /// The quantity of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.name() == name)
    }
}

/// A result: a quantity of a design and window, by their places in the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantified {
    /// Place of the design.
    pub design: usize,
    /// Place of the window.
    pub window: usize,
    /// What of it.
    pub quantity: Quantity,
}

impl Quantified {
    /// All results of a grid, design by design. The `reference` is the design that others save against, where there is one.
    #[must_use]
    pub fn all(grid: &Grid, reference: Option<usize>) -> Vec<Self> {
        let mut all = Vec::new();
        for design in 0..grid.designs().len() {
            for window in 0..grid.windows().len() {
                let saves = reference.is_some_and(|reference| reference != design);
                let quantities = Quantity::ALL.into_iter().filter(|q| saves || *q != Quantity::Reduction);
                all.extend(quantities.map(|quantity| Self { design, window, quantity }));
            }
        }
        all
    }

    /// Its value in a year; `None` where no sample has an operation, or the reference takes no power.
    #[must_use]
    pub fn value(&self, means: &[AnnualMean], windows: usize, reference: Option<usize>) -> Option<f64> {
        let mean = |design: usize| &means[design * windows + self.window];
        let own = mean(self.design);
        match self.quantity {
            Quantity::HvacPower => own.hvac_power_w,
            Quantity::HeatingPower => own.heating_power_w,
            Quantity::CoolingPower => own.cooling_power_w,
            Quantity::Reduction => {
                let of_reference = mean(reference?).hvac_power_w.filter(|w| *w > 0.0)?;
                Some(1.0 - own.hvac_power_w? / of_reference)
            }
        }
    }
}
