//! What was checked, how often, and how far off it was.

use solve::Method;
use store::CheckRow;

/// What the approximations of the paper do to the power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approximation {
    /// Points that were compared.
    pub points: u64,
    /// Mean change in W.
    pub mean_w: f64,
    /// Largest change in W.
    pub largest_w: f64,
}

/// One kind of check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Power,
    Choices,
    Window,
    Vote,
    Balances,
    Parts,
    Devices,
    Complete,
    Weights,
    Monthly,
    Annual,
}

const KINDS: [Kind; 11] = [
    Kind::Power,
    Kind::Choices,
    Kind::Window,
    Kind::Vote,
    Kind::Balances,
    Kind::Parts,
    Kind::Devices,
    Kind::Complete,
    Kind::Weights,
    Kind::Monthly,
    Kind::Annual,
];

impl Kind {
    /// Name, unit and tolerance.
    fn words(self, method: Method) -> [&'static str; 3] {
        match self {
            Self::Power => ["power by the other method", "W", "1e-6 of the power, or 0.01 W"],
            Self::Choices => ["status, mode, curtain and heaters", "", "the same, unless they tie"],
            Self::Window => ["comfort window kept", "vote", "1e-6"],
            Self::Vote if method == Method::NlpSurrogate => ["mean vote of the passengers", "vote", "0.1"],
            Self::Vote => ["mean vote of the passengers", "vote", "1e-6"],
            Self::Balances if method == Method::Fast => ["five balances of the exact model", "W", "1e-6 W"],
            Self::Balances => ["five balances of the exact model", "W", "20 W, the smooth door law's"],
            Self::Parts => ["parts of the power from heat and COP", "W", "1e-3 W"],
            Self::Devices => ["signs, and devices that are on board", "", "sound"],
            Self::Complete => ["all points of a sample there", "", "complete"],
            Self::Weights => ["weights of the samples", "", "1e-12 relative"],
            Self::Monthly => ["monthly averages from their rows", "W", "1e-9 relative"],
            Self::Annual => ["annual averages from their rows", "W", "1e-9 relative"],
        }
    }
}

/// The count of one kind.
#[derive(Debug, Clone, Default)]
pub struct Check {
    checked: u64,
    violations: u64,
    largest: f64,
    first: Option<String>,
}

/// All counts, and what the approximations of the paper do.
#[derive(Debug, Clone)]
pub struct Table {
    method: Method,
    checks: [Check; KINDS.len()],
    points: u64,
    approximated: u64,
    sum_w: f64,
    largest_w: f64,
}

impl Table {
    pub fn new(method: Method) -> Self {
        Self { method, checks: Default::default(), points: 0, approximated: 0, sum_w: 0.0, largest_w: 0.0 }
    }

    /// Counts a check; `violation` says where and what, and is asked only if it failed.
    pub fn check(&mut self, kind: Kind, passed: bool, deviation: f64, violation: impl FnOnce() -> String) {
        let check = &mut self.checks[kind as usize];
        check.checked += 1;
        // A deviation that is no number is as large as can be.
        check.largest = if deviation.is_nan() { f64::INFINITY } else { check.largest.max(deviation) };
        if !passed {
            check.violations += 1;
            check.first.get_or_insert_with(violation);
        }
    }

    pub fn point(&mut self) {
        self.points += 1;
    }

    /// The power with and without the approximations of the paper.
    pub fn approximate(&mut self, with_w: Option<f64>, without_w: Option<f64>) {
        if let (Some(with_w), Some(without_w)) = (with_w, without_w) {
            self.approximated += 1;
            self.sum_w += with_w - without_w;
            self.largest_w = self.largest_w.max((with_w - without_w).abs());
        }
    }

    pub fn merge(&mut self, other: &Self) {
        for (check, more) in self.checks.iter_mut().zip(&other.checks) {
            check.checked += more.checked;
            check.violations += more.violations;
            check.largest = check.largest.max(more.largest);
            if check.first.is_none() {
                check.first.clone_from(&more.first);
            }
        }
        self.points += other.points;
        self.approximated += other.approximated;
        self.sum_w += other.sum_w;
        self.largest_w = self.largest_w.max(other.largest_w);
    }

    pub fn points(&self) -> u64 {
        self.points
    }

    /// Points, mean and largest change of the power in W by the approximations.
    pub fn approximation(&self) -> Option<Approximation> {
        let (points, mean_w) = (self.approximated, self.sum_w / self.approximated as f64);
        (points > 0).then_some(Approximation { points, mean_w, largest_w: self.largest_w })
    }

    pub fn rows(&self) -> Vec<CheckRow> {
        let row = |(kind, check): (&Kind, &Check)| {
            let [name, unit, tolerance] = kind.words(self.method);
            CheckRow {
                name: name.to_owned(),
                checked: check.checked,
                violations: check.violations,
                largest: check.largest,
                unit: unit.to_owned(),
                tolerance: tolerance.to_owned(),
                first_violation: check.first.clone(),
            }
        };
        KINDS.iter().zip(&self.checks).map(row).collect()
    }
}
