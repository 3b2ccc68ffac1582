//! The paper's own method (section 3): a nonlinear program for each choice of heaters and curtain, solved by sequential
//! quadratic programming; the cheapest of the four wins.
//!
//! Nothing here uses the eliminations of the fast solver, nor its equations: its `problem` writes the balances down from
//! eq. `odes` once more, so that agreement of the two methods says something. The program has the eight variables of
//! [`Variable`], the five balances and one vanishing constraint as equations, the comfort window, and the signs of the two
//! heats as inequalities.

mod iso7730;
mod problem;
mod quadratic;
mod solver;
mod sqp;
pub mod surrogate;
mod vote;

pub use problem::{DoorLaw, Variable};
pub use solver::{Effort, NlpSolver, nlp_blocks};
pub use sqp::{Ended, KKT_TOLERANCE};
pub use surrogate::{SURROGATE_VERSION, Surrogate};
pub use vote::VoteForm;

/// Version of the method: it changes whenever a bit of a stored optimum would come out differently.
pub const NLP_VERSION: u32 = 2;
