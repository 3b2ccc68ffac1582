//! Colours with a fixed meaning. They are those of Okabe and Ito (2008), which stay apart for colour-blind eyes; in grey, where
//! some are alike, dashes and markers tell lines apart.

/// Heating, and what is warm.
pub(crate) const HEATING: &str = "#d55e00";
/// Cooling, and what is cold.
pub(crate) const COOLING: &str = "#0072b2";
/// Neither.
pub(crate) const REST: &str = "#999999";
/// What was simulated or recorded in time.
pub(crate) const IN_TIME: &str = "#0072b2";
/// What the steady state says.
pub(crate) const STEADY: &str = "#d55e00";
/// Limits, boxes, axes of reference.
pub(crate) const LIMIT: &str = "#555555";
/// Sun.
pub(crate) const SUN: &str = "#e69f00";
pub(crate) const BLACK: &str = "#000000";
/// What lies between cold and warm.
const BETWEEN: &str = "#009e73";

/// Dashes as in SVG.
pub(crate) const DASHED: &str = "3 1.5";
pub(crate) const DOTTED: &str = "1.2 1.2";

/// Three of a kind, from cold to warm: by colour, and in grey by their dashes.
pub(crate) const FROM_COLD_TO_WARM: [Style; 3] = [
    Style { colour: COOLING, dash: "", width: 1.1, marker: None },
    Style { colour: BETWEEN, dash: DASHED, width: 1.1, marker: None },
    Style { colour: HEATING, dash: DOTTED, width: 1.1, marker: None },
];

/// Colours of designs in the order in which they are given to names that have none of their own.
const COLOURS: [&str; 8] = ["#d55e00", "#e69f00", "#0072b2", "#56b4e9", "#009e73", "#cc79a7", "#000000", "#8a6d00"];
const DASHES: [&str; 5] = ["", "5 2", "1.5 1.5", "6 2 1.5 2", "3 1.5"];
const MARKERS: [Marker; 7] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::OpenCircle,
    Marker::OpenSquare,
    Marker::Cross,
];
/// The designs of the paper, which keep their looks whatever else a study has.
const KNOWN: [(&str, usize); 5] = [("ptc", 0), ("ptc+rh", 1), ("hp", 2), ("hp+rh", 3), ("hp+curtain", 4)];

/// Words in the colour of a line: as dark as words on white must be (WCAG 2.2, 1.4.3).
pub(crate) fn ink_of(colour: &'static str) -> &'static str {
    const DARKER: [(&str, &str); 5] = [
        ("#d55e00", "#b04d00"),
        ("#e69f00", "#8a5f00"),
        ("#56b4e9", "#1f6f9f"),
        ("#009e73", "#00714f"),
        ("#cc79a7", "#9c4a78"),
    ];
    DARKER.iter().find(|(of, _)| *of == colour).map_or(colour, |(_, ink)| ink)
}

/// What a point of a line looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    OpenCircle,
    OpenSquare,
    Cross,
}

/// How a series looks: of 280 in a row no two are alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Style {
    pub colour: &'static str,
    /// Dashes as in SVG; empty for a solid line.
    pub dash: &'static str,
    pub width: f64,
    pub marker: Option<Marker>,
}

impl Style {
    /// A line without markers.
    pub fn line(colour: &'static str, dash: &'static str, width: f64) -> Self {
        Self { colour, dash, width, marker: None }
    }

    /// The look of the series at a place.
    pub fn of_place(place: usize) -> Self {
        Self {
            colour: COLOURS[place % COLOURS.len()],
            dash: DASHES[place % DASHES.len()],
            width: 1.1,
            marker: Some(MARKERS[place % MARKERS.len()]),
        }
    }

    pub fn without_marker(self) -> Self {
        Self { marker: None, ..self }
    }
}

/// The looks of the designs of a study, each of them the same in every figure.
pub(crate) fn of_designs(names: &[&str]) -> Vec<Style> {
    let known = |name: &str| KNOWN.iter().find(|(known, _)| *known == name).map(|(_, place)| *place);
    let mut next = KNOWN.len();
    let mut place = |name: &&str| {
        known(name).unwrap_or_else(|| {
            next += 1;
            next - 1
        })
    };
    names.iter().map(|name| Style::of_place(place(name))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_no_two_series_look_alike_and_designs_keep_their_looks() {
        let styles: Vec<Style> = (0..280).map(Style::of_place).collect();
        for (i, style) in styles.iter().enumerate() {
            assert!(!styles[..i].contains(style), "{i}");
        }
        let (few, more) = (of_designs(&["hp", "own"]), of_designs(&["own", "ptc", "hp", "other"]));
        assert_eq!((few[0], few[1]), (more[2], more[0]));
        assert_ne!(more[0], more[3]);
    }
}
