//! The units of weather files.

/// Unit of a temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TemperatureUnit {
    /// °C.
    #[default]
    Celsius,
    /// K.
    Kelvin,
    /// °F.
    Fahrenheit,
    /// 0.1 °C.
    TenthCelsius,
}

/// Unit of an irradiance: its mean over an interval, or what arrives in the interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum IrradianceUnit {
    /// W/m².
    #[default]
    WattPerM2,
    /// J/m².
    JoulePerM2,
    /// kJ/m².
    KilojoulePerM2,
    /// MJ/m².
    MegajoulePerM2,
    /// J/cm².
    JoulePerCm2,
    /// Wh/m².
    WattHourPerM2,
    /// kWh/m².
    KilowattHourPerM2,
}

impl TemperatureUnit {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Celsius, Self::Kelvin, Self::Fahrenheit, Self::TenthCelsius];

    /// The name in study files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Celsius => "C",
            Self::Kelvin => "K",
            Self::Fahrenheit => "F",
            Self::TenthCelsius => "0.1C",
        }
    }

    /// A value of the unit in °C.
    #[must_use]
    pub fn celsius(self, value: f64) -> f64 {
        match self {
            Self::Celsius => value,
            Self::Kelvin => value - 273.15,
            Self::Fahrenheit => (value - 32.0) / 1.8,
            Self::TenthCelsius => value / 10.0,
        }
    }
}

impl IrradianceUnit {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::WattPerM2,
        Self::JoulePerM2,
        Self::KilojoulePerM2,
        Self::MegajoulePerM2,
        Self::JoulePerCm2,
        Self::WattHourPerM2,
        Self::KilowattHourPerM2,
    ];

    /// The name in study files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::WattPerM2 => "W/m2",
            Self::JoulePerM2 => "J/m2",
            Self::KilojoulePerM2 => "kJ/m2",
            Self::MegajoulePerM2 => "MJ/m2",
            Self::JoulePerCm2 => "J/cm2",
            Self::WattHourPerM2 => "Wh/m2",
            Self::KilowattHourPerM2 => "kWh/m2",
        }
    }

    /// Mean irradiance in W/m² that one of the unit is, over an interval.
    #[must_use]
    pub fn watts(self, interval_s: i64) -> f64 {
        let joules = match self {
            Self::WattPerM2 => return 1.0,
            Self::JoulePerM2 => 1.0,
            Self::KilojoulePerM2 => 1e3,
            Self::MegajoulePerM2 => 1e6,
            Self::JoulePerCm2 => 1e4,
            Self::WattHourPerM2 => 3600.0,
            Self::KilowattHourPerM2 => 3.6e6,
        };
        joules / interval_s as f64
    }
}

/// The units of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Units {
    pub temperature: TemperatureUnit,
    pub irradiance: IrradianceUnit,
}
