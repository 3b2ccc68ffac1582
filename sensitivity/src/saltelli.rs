//! Saltelli's design: two independent sets of points, and for each input the first set with that input from the second one.

use sobol_burley::{NUM_DIMENSIONS, sample};

/// Most base points: the sequence has no more.
pub const MOST_POINTS: u32 = 1 << 16;

/// Most inputs: each takes two dimensions of the sequence.
pub const MOST_INPUTS: usize = NUM_DIMENSIONS as usize / 2;

/// The sets of the design for `inputs` inputs, in the order of SALib: for every base point A, then A with one input after the
/// other from B, then B. (Saltelli et al. 2010, DOI 10.1016/j.cpc.2009.09.018.)
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Saltelli {
    /// Base points, 1 … [`MOST_POINTS`].
    pub points: u32,
    /// Inputs, 1 … [`MOST_INPUTS`].
    pub inputs: usize,
    /// Seed of the scrambling.
    pub seed: u32,
}

impl Saltelli {
    /// Sets for each base point.
    #[must_use]
    pub fn sets_a_point(&self) -> usize {
        self.inputs + 2
    }

    /// All sets.
    #[must_use]
    pub fn sets(&self) -> usize {
        self.points as usize * self.sets_a_point()
    }

    /// The inputs of a set, each in 0 … 1, without the ends: a point of Sobol's sequence with Owen's scrambling (Burley 2020,
    /// Journal of Computer Graphics Techniques 9(4)), as far as each of the sets A and B goes.
    pub fn set(&self, set: usize) -> impl Iterator<Item = f64> + use<> {
        let (point, place) = (set / self.sets_a_point(), set % self.sets_a_point());
        let Self { inputs, seed, .. } = *self;
        (0..inputs).map(move |input| {
            let from_b = place == inputs + 1 || place == input + 1;
            let dimension = if from_b { inputs + input } else { input };
            // The sequence goes in steps of 2⁻²³, so that half a step more lies within 0 … 1.
            f64::from(sample(point as u32, dimension as u32, seed)) + f64::from(f32::EPSILON) / 2.0
        })
    }
}
