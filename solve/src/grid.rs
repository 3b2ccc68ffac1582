//! Which designs and comfort windows a study asks for.

use cabin::{ComfortWindow, Design};

use crate::states::fixed_vote;

/// Designs × windows, with the distinct limits of all windows in rising order.
#[derive(Debug, Clone)]
pub struct Grid {
    designs: Vec<Design>,
    windows: Vec<ComfortWindow>,
    limits: Vec<Limit>,
    /// Indices of each window's lower and upper limit in `limits`.
    window_limits: Vec<(usize, usize)>,
}

/// A limit of the vote, and on which side of windows it stands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limit {
    pub pmv: f64,
    pub lower: bool,
    pub upper: bool,
    /// The first fixed vote that is not before it, by its place from neutral.
    pub fixed: usize,
}

/// A grid that names something twice or nothing at all.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridError {
    /// No designs.
    #[error("no designs: give at least one [designs.\"name\"]")]
    NoDesigns,
    /// No windows.
    #[error("no comfort windows: give pmv_limits or windows in [comfort]")]
    NoWindows,
    /// A design's name stands twice.
    #[error("the design {0:?} stands twice")]
    DesignTwice(String),
    /// A window stands twice.
    #[error("the comfort window [{0}, {1}] stands twice")]
    WindowTwice(f64, f64),
}

impl Grid {
    /// A grid of distinct designs and distinct windows, in the order given.
    ///
    /// # Errors
    /// [`GridError`] where one stands twice or none is given.
    pub fn new(designs: Vec<Design>, windows: Vec<ComfortWindow>) -> Result<Self, GridError> {
        if designs.is_empty() {
            return Err(GridError::NoDesigns);
        }
        if windows.is_empty() {
            return Err(GridError::NoWindows);
        }
        for (i, design) in designs.iter().enumerate() {
            if designs[..i].iter().any(|d| d.name == design.name) {
                return Err(GridError::DesignTwice(design.name.clone()));
            }
        }
        for (i, window) in windows.iter().enumerate() {
            if windows[..i].contains(window) {
                return Err(GridError::WindowTwice(window.pmv_min(), window.pmv_max()));
            }
        }
        Ok(Self::of(designs, windows))
    }

    fn of(designs: Vec<Design>, windows: Vec<ComfortWindow>) -> Self {
        let mut votes: Vec<f64> = windows.iter().flat_map(|w| [w.pmv_min(), w.pmv_max()]).collect();
        votes.sort_by(f64::total_cmp);
        votes.dedup();
        let index = |pmv: f64| votes.partition_point(|&v| v < pmv);
        let limit = |&pmv: &f64| Limit {
            pmv,
            lower: windows.iter().any(|w| w.pmv_min() == pmv),
            upper: windows.iter().any(|w| w.pmv_max() == pmv),
            fixed: fixed_vote(pmv),
        };
        let limits = votes.iter().map(limit).collect();
        let window_limits = windows.iter().map(|w| (index(w.pmv_min()), index(w.pmv_max()))).collect();
        Self { designs, windows, limits, window_limits }
    }

    /// The part of the grid with some of its designs and windows, by their places; at least one of each, none twice.
    #[must_use]
    pub fn part(&self, designs: &[usize], windows: &[usize]) -> Self {
        let designs = designs.iter().map(|&d| self.designs[d].clone()).collect();
        Self::of(designs, windows.iter().map(|&w| self.windows[w]).collect())
    }

    /// The designs in the order given.
    #[must_use]
    pub fn designs(&self) -> &[Design] {
        &self.designs
    }

    /// The windows in the order given.
    #[must_use]
    pub fn windows(&self) -> &[ComfortWindow] {
        &self.windows
    }

    /// Points per sample: designs × windows.
    #[must_use]
    pub fn points(&self) -> usize {
        self.designs.len() * self.windows.len()
    }

    pub(crate) fn limits(&self) -> &[Limit] {
        &self.limits
    }

    pub(crate) fn window_limits(&self) -> &[(usize, usize)] {
        &self.window_limits
    }
}
