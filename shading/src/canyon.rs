//! Shade in street canyons, where no measured or modelled shadow series is to be had.

use chrono::{Duration, TimeZone, Utc};
use std::f64::consts::PI;

use crate::{ShadowYear, Site, SunPosition};

/// Streets of one kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Street {
    /// Direction of the street from north in rad.
    pub azimuth_rad: f64,
    /// Height of the walls over the width of the street, not negative; 0 is open country.
    pub height_to_width: f64,
    /// Share of the way that leads through such streets; the shares are taken relative to their sum.
    pub share: f64,
}

/// Directions of named streets, evenly spread over half a turn.
const DIRECTIONS: u32 = 8;
/// Height over width at which evenly spread streets have the shade of the one hour whose solar heat the paper prints: 24 July
/// 2019, 15:50 to 16:50 in Zürich, with a shadow fraction of 0.12 to 0.16 (docs/findings.md).
const CALIBRATED: [(f64, f64); 1] = [(0.22, 1.0)];
/// Height-to-width ratios of a town with the share of each; a fifth of the way is open.
const TOWN: [(f64, f64); 4] = [(0.0, 0.20), (0.5, 0.20), (1.0, 0.35), (1.5, 0.25)];

/// Streets that have a name.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Streets {
    /// Wide ones whose shade is that of the hour that the paper shows.
    #[default]
    Calibrated,
    /// A mixture of narrow and wide ones, as an assumption and no survey: three times as much shade in that hour.
    Town,
}

impl Streets {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Calibrated, Self::Town];

    /// Heights over widths, each with its share.
    #[must_use]
    pub fn kinds(self) -> &'static [(f64, f64)] {
        match self {
            Self::Calibrated => &CALIBRATED,
            Self::Town => &TOWN,
        }
    }

    /// The streets in evenly spread directions.
    #[must_use]
    pub fn evenly_spread(self) -> Vec<Street> {
        in_directions(&even_azimuths_rad(), self.kinds())
    }

    /// What they are, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Calibrated => {
                "street canyons 0.22 times as high as wide, in all directions: the shade that the solar heat means which the \
                 paper prints for 24 July 2019, 15:50"
            }
            Self::Town => {
                "street canyons of a town, 0 to 1.5 times as high as wide, in all directions: three times the shade that the \
                 paper's hour of 24 July 2019, 15:50 has"
            }
        }
    }
}

/// Streets of each kind, a height over width with its share, in each direction.
#[must_use]
pub fn in_directions(azimuths_rad: &[f64], kinds: &[(f64, f64)]) -> Vec<Street> {
    let street = |&azimuth_rad: &f64| {
        kinds.iter().map(move |&(height_to_width, share)| Street { azimuth_rad, height_to_width, share })
    };
    azimuths_rad.iter().flat_map(street).collect()
}

/// Evenly spread directions, in rad from north.
#[must_use]
pub fn even_azimuths_rad() -> Vec<f64> {
    (0..DIRECTIONS).map(|i| PI * f64::from(i) / f64::from(DIRECTIONS)).collect()
}

/// The mean shadow fraction of streets at every full hour of a year; at least one street with a share above 0.
#[must_use]
pub fn canyon_year(site: &Site, streets: &[Street]) -> ShadowYear {
    let start = Utc.with_ymd_and_hms(2022, 1, 1, 0, 0, 0).single().expect("1 January 2022 exists");
    let total: f64 = streets.iter().map(|s| s.share).sum();
    ShadowYear::from_fn(|hour| {
        let sun = site.sun(start + Duration::hours(hour as i64));
        let shade = |s: &Street| s.share * canyon_shadow_fraction(sun, s.azimuth_rad, s.height_to_width);
        streets.iter().map(shade).sum::<f64>() / total
    })
}

/// Shaded share of the floor of a street canyon of infinite length, under direct sun.
///
/// With the sun below the horizon the street is in the shade. Else the wall on the sunny side throws a shadow of width
/// `height · cos(altitude) / sin(altitude) · |sin(azimuth − street)|` across the street (Johnson and Watson 1984,
/// doi 10.1175/1520-0450(1984)023<0329:TDOVFI>2.0.CO;2).
///
/// `height_to_width` is dimensionless and not negative, `street_azimuth_rad` the direction of the street from north.
#[must_use]
pub fn canyon_shadow_fraction(sun: SunPosition, street_azimuth_rad: f64, height_to_width: f64) -> f64 {
    if sun.altitude_rad <= 0.0 {
        return 1.0;
    }
    let across = (sun.azimuth_rad - street_azimuth_rad).sin().abs();
    (height_to_width * across / sun.altitude_rad.tan()).min(1.0)
}
