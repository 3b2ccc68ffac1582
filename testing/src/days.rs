//! The gallery: disturbances with a name, each for something that the model has to get right.

use cabin::{Disturbances, kelvin};

/// A cold day without sun: much heating.
#[must_use]
pub fn winter_day() -> Disturbances {
    day(-5.0, 0.0, 20.0, 0.15)
}

/// A mild day: a little heating.
#[must_use]
pub fn spring_day() -> Disturbances {
    day(8.0, 100.0, 5.0, 0.1)
}

/// A hot day with sun: cooling.
#[must_use]
pub fn summer_day() -> Disturbances {
    day(33.0, 800.0, 16.0, 0.14)
}

/// A cold night, the sun below the horizon, hardly anybody on board.
#[must_use]
pub fn night() -> Disturbances {
    Disturbances { solar_altitude_rad: -0.4, shadow_fraction: 1.0, ..day(-10.0, 0.0, 1.0, 0.05) }
}

/// A full bus on a mild day with sun: passengers heat more than is lost.
#[must_use]
pub fn full_load() -> Disturbances {
    day(18.0, 200.0, 120.0, 0.2)
}

/// All doors open in the cold: the door loss outweighs everything.
#[must_use]
pub fn doors_open() -> Disturbances {
    day(-5.0, 0.0, 20.0, 1.0)
}

/// The sun as high as it gets in Zürich, no shade, an empty bus.
#[must_use]
pub fn sun_highest() -> Disturbances {
    Disturbances { solar_altitude_rad: 1.15, shadow_fraction: 0.0, ..day(28.0, 900.0, 0.0, 0.0) }
}

/// Ambient air as warm as a comfortable cabin: no heat through doors, where their square root has its kink.
#[must_use]
pub fn cabin_equal_to_ambient() -> Disturbances {
    Disturbances { dni_w_m2: 0.0, dhi_w_m2: 0.0, ..day(22.0, 0.0, 2.0, 0.3) }
}

/// All of them with their names.
#[must_use]
pub fn gallery() -> [(&'static str, Disturbances); 8] {
    [
        ("winter day", winter_day()),
        ("spring day", spring_day()),
        ("summer day", summer_day()),
        ("night", night()),
        ("full load", full_load()),
        ("doors open", doors_open()),
        ("sun highest", sun_highest()),
        ("cabin equal to ambient", cabin_equal_to_ambient()),
    ]
}

/// A day with the sun in the south, a third of the way in the shade.
#[must_use]
pub fn day(ambient_c: f64, dni_w_m2: f64, passengers: f64, door_open_fraction: f64) -> Disturbances {
    Disturbances {
        ambient_temperature_k: kelvin(ambient_c),
        dni_w_m2,
        dhi_w_m2: 0.2 * dni_w_m2,
        solar_altitude_rad: 0.9,
        shadow_fraction: 0.3,
        passengers,
        door_open_fraction,
    }
}
