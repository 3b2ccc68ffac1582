//! Radiant heaters and air curtains: which of them a design has on board, and which of them run.

use crate::Heaters;

/// A set of devices besides the air unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Devices {
    /// Radiant heaters.
    pub radiant_heaters: bool,
    /// Air curtains.
    pub air_curtain: bool,
}

impl Devices {
    /// None of them.
    pub const NONE: Self = Self { radiant_heaters: false, air_curtain: false };
    /// All sets (paper, section 3: the binary choices). Fewer devices come first, so that of equally cheap sets the one
    /// with fewer wins.
    pub const CHOICES: [Self; 4] = [
        Self::NONE,
        Self { radiant_heaters: false, air_curtain: true },
        Self { radiant_heaters: true, air_curtain: false },
        Self { radiant_heaters: true, air_curtain: true },
    ];

    /// The state of the radiant heaters where these run.
    #[must_use]
    pub fn heaters(self) -> Heaters {
        if self.radiant_heaters { Heaters::On } else { Heaters::Off }
    }

    /// Whether every device of `choice` is one of these.
    #[must_use]
    pub fn include(self, choice: Self) -> bool {
        (self.radiant_heaters || !choice.radiant_heaters) && (self.air_curtain || !choice.air_curtain)
    }
}
