//! Setpoints that others have published.

use crate::Curve;

/// A published pair of setpoints over the ambient temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// Its name.
    pub name: &'static str,
    /// Where it stands.
    pub source: &'static str,
    /// Setpoint while heating.
    pub heating: Curve,
    /// Setpoint while cooling, from the ambient temperature on with which its source begins.
    pub cooling: Curve,
    /// Below this ambient temperature in °C its source does not cool; minus infinity where it does not say so.
    pub cools_above_c: f64,
}

const VDV: &str = "VDV 236 (2015), as eFLIPS (TU Berlin) has it in vehicle.py, one curve for heating and cooling";
const VBZ: &str = "VBZ, Cobra tram: data of the operator in the project p-trahces, default.json";
const VECTO: &str =
    "VECTO 5.1.3 (EU declaration), low-floor bus: heating to 18 °C, cooling to 23 °C or 3 K below ambient";

const EFLIPS: &str = "eFLIPS (TU Berlin), its single value for all ambient temperatures; VBZ's as well";
const ALWAYS: f64 = f64::NEG_INFINITY;

impl Published {
    /// Whether one curve is meant for heating and cooling.
    #[must_use]
    pub fn is_single(&self) -> bool {
        self.heating == self.cooling
    }
}

/// All of them. The profile of Hambraeus and Minotta, which the paper shows as well, is not public.
#[must_use]
pub fn published() -> Vec<Published> {
    let curve = |pairs: &[(f64, f64)]| Curve::through(pairs).expect("every curve has pairs");
    let vdv = |name, pairs: [(f64, f64); 4]| {
        let curve = curve(&pairs);
        Published { name, source: VDV, heating: curve.clone(), cooling: curve, cools_above_c: ALWAYS }
    };
    let vbz = |name, setpoint_c| Published {
        name,
        source: VBZ,
        heating: curve(&[(-22.0, 9.0), (-10.0, setpoint_c), (setpoint_c, setpoint_c)]),
        cooling: curve(&[(18.0, 23.0), (20.0, 23.0), (25.0, 25.0), (28.0, 28.0)]),
        cools_above_c: ALWAYS,
    };
    vec![
        vdv("vdv-comfort", [(-13.0, 16.0), (-10.0, 20.0), (22.0, 21.0), (35.0, 30.0)]),
        vdv("vdv-economy", [(-13.0, 14.0), (-10.0, 18.0), (22.0, 19.0), (35.0, 31.0)]),
        vdv("vdv-max", [(-13.0, 17.0), (-10.0, 22.0), (22.0, 22.0), (35.0, 32.0)]),
        vdv("vdv-min", [(-13.0, 12.0), (-10.0, 17.0), (22.0, 17.0), (35.0, 27.0)]),
        vbz("vbz-16", 16.0),
        vbz("vbz-18", 18.0),
        vbz("vbz-20", 20.0),
        Published {
            name: "vecto",
            source: VECTO,
            heating: curve(&[(0.0, 18.0)]),
            cooling: curve(&[(17.0, 23.0), (26.0, 23.0), (50.0, 47.0)]),
            cools_above_c: 17.0,
        },
        Published {
            name: "constant-20",
            source: EFLIPS,
            heating: curve(&[(0.0, 20.0)]),
            cooling: curve(&[(0.0, 20.0)]),
            cools_above_c: ALWAYS,
        },
    ]
}
