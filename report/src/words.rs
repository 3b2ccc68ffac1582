//! Designs and comfort in words that need no glossary.

use cabin::{ComfortWindow, Heating};
use store::DesignRow;

/// What a design is, as it stands within a sentence: `a heat pump with air curtains at the doors`. Of designs that are alike in
/// this, each has its name behind it.
pub(crate) fn equipment(designs: &[DesignRow], name: &str) -> String {
    let Some(design) = designs.iter().find(|d| d.name == name) else { return name.to_owned() };
    let words = of_design(design);
    let alike = designs.iter().filter(|other| of_design(other) == words).count();
    if alike > 1 { format!("{words} (“{name}”)") } else { words }
}

fn of_design(design: &DesignRow) -> String {
    let heating = match design.heating {
        Heating::Ptc => "electric resistance heating",
        Heating::HeatPump => "a heat pump",
    };
    let devices = match (design.devices.radiant_heaters, design.devices.air_curtain) {
        (false, false) => "",
        (true, false) => " with radiant heating panels",
        (false, true) => " with air curtains at the doors",
        (true, true) => " with radiant heating panels and air curtains at the doors",
    };
    format!("{heating}{devices}")
}

/// At the start of a line.
pub(crate) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The votes that a window lets passengers come to, by the words of ISO 7730 where it has some for both of its ends.
pub(crate) fn comfort(window: ComfortWindow) -> String {
    let (low, high) = (window.pmv_min(), window.pmv_max());
    if low == 0.0 && high == 0.0 {
        return "at 0, neither too cold nor too warm".to_owned();
    }
    let word = |vote: f64| match vote.to_string().as_str() {
        "-3" => Some("cold"),
        "-2" => Some("cool"),
        "-1" => Some("slightly cool"),
        "1" => Some("slightly warm"),
        "2" => Some("warm"),
        "3" => Some("hot"),
        _ => None,
    };
    match word(low).zip(word(high)) {
        Some((cold, warm)) => format!("between {low} ({cold}) and {high} ({warm})").replace('-', "−"),
        None => format!("between {low} and {high}").replace('-', "−"),
    }
}
