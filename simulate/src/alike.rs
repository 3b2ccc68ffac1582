//! Variants of a mission that cannot come out differently, so that one drive serves them all.
//!
//! Designs differ in what a mission may never use: the heat pump on a summer's day, a curtain or heaters that its optima leave
//! off, a limit that nothing comes up to. Wide comfort windows prescribe the same where the unit rests. What a drive has used is
//! known as it ends: variants that are told alike are compared with it then, and those that are not served by it are driven
//! next.

use cabin::{Design, OperatingMode};
use rayon::prelude::*;

use crate::control::Law;
use crate::lanes::{FEW, LANES};
use crate::{Dynamics, Mission, PowerLimits, Start, Summary, Variant, simulate};

/// What a drive has used of its design.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Used {
    /// The air unit heated.
    pub heating: bool,
    /// It cooled.
    pub cooling: bool,
    /// A limit held it back.
    pub limit: bool,
}

/// As [`simulate`](fn@simulate), by the threads of rayon's current pool; variants that cannot come out differently are driven
/// once.
pub fn simulate_distinct(
    mission: &Mission<'_, '_>,
    dynamics: &Dynamics,
    variants: &[Variant<'_>],
) -> Option<Vec<Summary>> {
    let mut summaries: Vec<Option<Summary>> = vec![None; variants.len()];
    loop {
        let chosen = next(variants, &summaries, dynamics);
        if chosen.is_empty() {
            return summaries.into_iter().collect();
        }
        let distinct: Vec<Variant<'_>> = chosen.iter().map(|place| variants[*place]).collect();
        let abreast = |some: &[Variant<'_>]| simulate(mission, dynamics, some);
        let driven: Vec<Vec<Summary>> = distinct.par_chunks(LANES).map(abreast).collect::<Option<_>>()?;
        for (one, summary) in chosen.into_iter().zip(driven.into_iter().flatten()) {
            let drives = |variant: &Variant<'_>| {
                are_told_alike(&variants[one], variant) && serves(&variants[one], summary.used, variant, dynamics)
            };
            for (place, variant) in variants.iter().enumerate() {
                if summaries[place].is_none() && drives(variant) {
                    summaries[place] = Some(summary.beside(variant.segments));
                }
            }
            summaries[one] = Some(summary);
        }
    }
}

/// The variants that are driven next: the first of those that are told alike, and in lanes that would be left over those that
/// differ from them in what the unit does, which may have to be driven besides.
fn next(variants: &[Variant<'_>], summaries: &[Option<Summary>], dynamics: &Dynamics) -> Vec<usize> {
    let open = || (0..variants.len()).filter(|place| summaries[*place].is_none());
    let mut chosen: Vec<usize> = Vec::new();
    for place in open() {
        if !chosen.iter().any(|one| are_told_alike(&variants[*one], &variants[place])) {
            chosen.push(place);
        }
    }
    let lanes = chosen.len().next_multiple_of(FEW);
    let heats_and_cools = Used { heating: true, cooling: true, limit: false };
    for place in open() {
        if chosen.len() == lanes {
            break;
        }
        // By itself as well, where it is chosen already.
        let is_served = |one: &usize| {
            are_told_alike(&variants[*one], &variants[place])
                && serves(&variants[*one], heats_and_cools, &variants[place], dynamics)
        };
        if !chosen.iter().any(is_served) {
            chosen.push(place);
        }
    }
    chosen
}

/// Whether two variants begin alike and are told the same by who controls them, and are judged by the same windows.
fn are_told_alike(one: &Variant<'_>, other: &Variant<'_>) -> bool {
    let told_alike = match (one.law, other.law) {
        (Law::Causal(one), Law::Causal(other)) => one == other,
        (Law::HourlyMode, Law::HourlyMode) | (Law::ComfortBand, Law::ComfortBand) => {
            let told = |variant: &Variant<'_>, segment| {
                // Neither law asks for the ambient temperature.
                let setting = variant.law.setting(segment, f64::NAN);
                (setting, segment.optimum.mode == OperatingMode::Passive, segment.optimum.temperatures.cabin_k)
            };
            one.segments.len() == other.segments.len()
                && one.segments.iter().zip(other.segments).all(|(a, b)| told(one, a) == told(other, b))
        }
        _ => false,
    };
    let begin_alike = one.scenario.start == other.scenario.start
        && match one.scenario.start {
            Start::Depot => true,
            Start::SteadyState => {
                one.segments.first().map(|s| &s.optimum) == other.segments.first().map(|s| &s.optimum)
            }
        };
    begin_alike && one.windows == other.windows && told_alike
}

/// Whether a drive that has used so much of its design would be the same with the other's.
fn serves(one: &Variant<'_>, used: Used, other: &Variant<'_>, dynamics: &Dynamics) -> bool {
    let heats_alike = |a: &Design, b: &Design| a.heating == b.heating && a.heating_cop == b.heating_cop;
    let [limits, other_limits] = [one, other].map(|v| v.scenario.limits.of(v.design, dynamics));
    // A limit that held nothing back might as well be wider.
    let limits_alike = |of: fn(&PowerLimits) -> f64| {
        of(&limits) == of(&other_limits) || !used.limit && of(&limits) < of(&other_limits)
    };
    (!used.heating || heats_alike(one.design, other.design) && limits_alike(|l| l.heating_w))
        && (!used.cooling || one.design.cooling_cop == other.design.cooling_cop && limits_alike(|l| l.cooling_w))
        && limits.radiant_heaters_w == other_limits.radiant_heaters_w
}
