//! Where passengers stand, and how much of the radiant heaters they see.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::Vehicle;
use crate::random::unit_interval;
use crate::view_factor::{parallel, perpendicular};

/// A radiant heater on the ceiling: its extent along and across the bus in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Panel {
    /// From and to along the bus.
    pub along_m: [f64; 2],
    /// From and to across the bus.
    pub across_m: [f64; 2],
}

/// The view factors to all radiant heaters of passengers who are spread over the cabin.
///
/// For a smooth function f of the view factor, the mean over the passengers is `Σ weight · f(node)` with the two nodes of
/// Gauss' quadrature for the distribution of the view factors: exact where f is a cubic, and for the vote good to 1e-9.
/// Where the vote has its kink between the passengers, those on each side of it have a quadrature of their own.
#[derive(Debug, Clone, PartialEq)]
pub struct PassengerViews {
    all: Vec<f64>,
    /// In rising order.
    sorted: Vec<f64>,
    /// Of the first passengers in that order: sums of the first, second and third power of view − mean.
    sums: Vec<[f64; 3]>,
    nodes: [(f64, f64); 2],
    mean: f64,
}

/// The panels of a vehicle: centred in a grid of equal fields on the ceiling.
#[must_use]
pub fn ceiling_panels(vehicle: &Vehicle) -> Vec<Panel> {
    let field_along_m = vehicle.cabin_length_m / f64::from(vehicle.panel_rows);
    let field_across_m = vehicle.cabin_width_m / f64::from(vehicle.panel_columns);
    let span = |index: u32, field_m: f64, extent_m: f64| {
        let centre_m = (f64::from(index) + 0.5) * field_m;
        [centre_m - extent_m / 2.0, centre_m + extent_m / 2.0]
    };
    let row = |r| {
        (0..vehicle.panel_columns).map(move |c| Panel {
            along_m: span(r, field_along_m, vehicle.panel_length_m),
            across_m: span(c, field_across_m, vehicle.panel_width_m),
        })
    };
    (0..vehicle.panel_rows).flat_map(row).collect()
}

/// Area-weighted view factor of one passenger's five faces to all panels.
///
/// The passenger is an upright cuboid (paper, section 2.2) centred at `along_m`, `across_m` on the floor; passengers do
/// not hide the panels from each other. Parts of a panel behind a face's plane do not count for that face.
#[must_use]
pub fn panel_view_factor(vehicle: &Vehicle, panels: &[Panel], along_m: f64, across_m: f64) -> f64 {
    let (half, height) = (vehicle.passenger_width_m / 2.0, vehicle.passenger_height_m);
    let top_gap_m = vehicle.cabin_height_m - height;
    let (x, y) = ([along_m - half, along_m + half], [across_m - half, across_m + half]);
    // Distance of a side face's lower and upper edge from the ceiling, where its plane meets the panels' plane.
    let below_m = [top_gap_m, vehicle.cabin_height_m];

    let (side_area, top_area) = (vehicle.passenger_width_m * height, vehicle.passenger_width_m.powi(2));
    let mut sum = 0.0;
    for panel in panels {
        sum += top_area * parallel(x, y, panel.along_m, panel.across_m, top_gap_m);
        let mut side = |common, panel_common, ahead: [f64; 2]| {
            let ahead = [ahead[0].max(0.0), ahead[1].max(0.0)];
            if ahead[1] > ahead[0] {
                sum += side_area * perpendicular(common, below_m, panel_common, ahead);
            }
        };
        side(y, panel.across_m, [panel.along_m[0] - x[1], panel.along_m[1] - x[1]]);
        side(y, panel.across_m, [x[0] - panel.along_m[1], x[0] - panel.along_m[0]]);
        side(x, panel.along_m, [panel.across_m[0] - y[1], panel.across_m[1] - y[1]]);
        side(x, panel.along_m, [y[0] - panel.across_m[1], y[0] - panel.across_m[0]]);
    }
    sum / (4.0 * side_area + top_area)
}

/// View factors of the passengers, in the order of their placement.
#[must_use]
pub fn place_passengers(vehicle: &Vehicle) -> Vec<f64> {
    let panels = ceiling_panels(vehicle);
    let view = |[along_m, across_m]: [f64; 2]| panel_view_factor(vehicle, &panels, along_m, across_m);
    passenger_positions_m(vehicle).into_iter().map(view).collect()
}

/// Where passengers stand, along and across the bus in m: anywhere on the floor with equal probability, in the order of their
/// placement.
#[must_use]
pub fn passenger_positions_m(vehicle: &Vehicle) -> Vec<[f64; 2]> {
    let mut random = ChaCha8Rng::seed_from_u64(vehicle.passenger_seed);
    let half = vehicle.passenger_width_m / 2.0;
    let mut within = |extent_m: f64| {
        let unit = unit_interval(random.next_u64());
        half + unit * (extent_m - 2.0 * half)
    };
    (0..vehicle.passenger_placements).map(|_| [within(vehicle.cabin_length_m), within(vehicle.cabin_width_m)]).collect()
}

impl PassengerViews {
    /// The quadrature for a vehicle's placed passengers.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        Self::from_view_factors(&place_passengers(vehicle))
    }

    /// Equally weighted passengers with the given view factors, at least one.
    #[must_use]
    pub fn from_view_factors(views: &[f64]) -> Self {
        let mean = views.iter().sum::<f64>() / views.len() as f64;
        let mut sorted = views.to_vec();
        sorted.sort_by(f64::total_cmp);
        let mut sums = vec![[0.0; 3]];
        let mut sum = [0.0; 3];
        for view in &sorted {
            let d = view - mean;
            sum = [sum[0] + d, sum[1] + d * d, sum[2] + d * d * d];
            sums.push(sum);
        }
        let nodes = gauss(views.len() as f64, sum).map(|(offset, weight)| (mean + offset, weight));
        Self { all: views.to_vec(), sorted, sums, nodes, mean }
    }

    /// The nodes `(view factor, weight)` of two quadratures: of the passengers who see less than `view` of the heaters,
    /// and of the others. All four weights sum to 1.
    pub(crate) fn split_nodes(&self, view: f64) -> [(f64, f64); 4] {
        let count = self.sorted.partition_point(|&v| v < view);
        let (below, all) = (self.sums[count], self.sums[self.sorted.len()]);
        let above = std::array::from_fn(|i| all[i] - below[i]);
        let total = self.sorted.len() as f64;
        let group = |n: f64, sums| gauss(n, sums).map(|(offset, weight)| (self.mean + offset, weight * n / total));
        let ([a, b], [c, d]) = (group(count as f64, below), group(total - count as f64, above));
        [a, b, c, d]
    }

    /// Least and largest view factor.
    pub(crate) fn range(&self) -> [f64; 2] {
        [self.sorted[0], self.sorted[self.sorted.len() - 1]]
    }

    /// The view factor of every passenger, in the order of their placement.
    #[must_use]
    pub fn all(&self) -> &[f64] {
        &self.all
    }

    /// The two nodes `(view factor, weight)` of the quadrature; the weights sum to 1.
    #[must_use]
    pub fn nodes(&self) -> [(f64, f64); 2] {
        self.nodes
    }

    /// Mean view factor: that of the average passenger.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.mean
    }
}

/// Two nodes `(offset, weight)` that keep mean, variance and third central moment of `n` equally weighted numbers, from
/// the sums of their first three powers; the weights sum to 1.
fn gauss(n: f64, [first, second, third]: [f64; 3]) -> [(f64, f64); 2] {
    if n == 0.0 {
        return [(0.0, 0.5); 2];
    }
    let mean = first / n;
    let variance = (second / n - mean * mean).max(0.0);
    // View factors closer than this are one.
    if variance < 1e-18 {
        return [(mean, 0.5); 2];
    }
    let skew = third / n - 3.0 * mean * second / n + 2.0 * mean * mean * mean;
    let half = skew / (2.0 * variance);
    let spread = half.hypot(variance.sqrt());
    let high_weight = (spread - half) / (2.0 * spread);
    [(mean + half - spread, 1.0 - high_weight), (mean + half + spread, high_weight)]
}
