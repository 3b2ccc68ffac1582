//! The PI controller, with its state apart from its parameters.

/// A PI controller that is asked once a second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PiController {
    /// Gain in W/K.
    pub gain_w_k: f64,
    /// Integral time in s.
    pub integral_s: f64,
}

impl PiController {
    /// The command in W for an error in K, within `low … high`, and how far it is held back by them. `integral_w` is the
    /// controller's state; it stands still while the command is at a limit and the error would drive it farther
    /// (anti-windup by conditional integration).
    #[must_use]
    #[inline]
    pub fn command_w(&self, error_k: f64, integral_w: &mut f64, low: f64, high: f64) -> (f64, f64) {
        let next_w = *integral_w + self.gain_w_k * error_k / self.integral_s;
        let wanted_w = self.gain_w_k * error_k + next_w;
        let command_w = wanted_w.clamp(low, high);
        let beyond_w = wanted_w - command_w;
        if beyond_w * error_k <= 0.0 {
            *integral_w = next_w;
        }
        (command_w, beyond_w)
    }
}
