//! View factors against values computed elsewhere: closed form checked by a double contour integral and Monte Carlo.

use cabin::view_factor::{parallel, perpendicular};
use cabin::{PassengerViews, Vehicle, ceiling_panels, panel_view_factor, place_passengers};

type Span = [f64; 2];

type Parallel = (&'static str, Span, Span, Span, Span, f64, f64, f64);

/// name, x, y, xi, eta, height, view factor, the same by contour integral.
const PARALLEL: &[Parallel] = &[
    (
        "opposed_unit_squares_h1",
        [0.0, 1.0],
        [0.0, 1.0],
        [0.0, 1.0],
        [0.0, 1.0],
        1.0,
        0.19982489569838732,
        0.19982489569838757,
    ),
    (
        "opposed_squares_0.1_gap_0.05",
        [0.1, 0.2],
        [0.1, 0.2],
        [0.1, 0.2],
        [0.1, 0.2],
        0.05,
        0.41525328357714664,
        0.41525328357714797,
    ),
    (
        "opposed_rect_2x1_h1",
        [0.0, 2.0],
        [0.0, 1.0],
        [0.0, 2.0],
        [0.0, 1.0],
        1.0,
        0.28587538485071473,
        0.2858753848507151,
    ),
    (
        "opposed_rect_10x10_h1",
        [0.0, 10.0],
        [0.0, 10.0],
        [0.0, 10.0],
        [0.0, 10.0],
        1.0,
        0.8269945223972566,
        0.8269945223972586,
    ),
    ("opposed_unit_h0.1", [0.0, 1.0], [0.0, 1.0], [0.0, 1.0], [0.0, 1.0], 0.1, 0.8269945223972567, 0.8269945223972591),
    (
        "offset_x_adjacent_unit_h1",
        [0.0, 1.0],
        [0.0, 1.0],
        [1.0, 2.0],
        [0.0, 1.0],
        1.0,
        0.08605048915232738,
        0.08605048915232737,
    ),
    (
        "offset_diag_unit_h1",
        [0.0, 1.0],
        [0.0, 1.0],
        [1.0, 2.0],
        [1.0, 2.0],
        1.0,
        0.043327409574104664,
        0.04332740957410462,
    ),
    (
        "offset_far_h1",
        [0.0, 1.0],
        [0.0, 1.0],
        [5.0, 6.0],
        [3.0, 4.0],
        1.0,
        0.00026969086412931276,
        0.00026969086412606053,
    ),
    (
        "partial_overlap",
        [0.0, 2.0],
        [0.0, 1.0],
        [0.5, 1.25],
        [-0.4, 0.7],
        0.8,
        0.14446108382906958,
        0.14446108382906983,
    ),
    (
        "contained_small_to_large",
        [0.4, 0.6],
        [0.4, 0.6],
        [0.0, 1.0],
        [0.0, 1.0],
        0.3,
        0.7678837394870509,
        0.7678837394870521,
    ),
    (
        "unequal_arbitrary",
        [-1.3, 0.4],
        [0.2, 2.9],
        [0.1, 3.3],
        [-2.0, -0.5],
        1.7,
        0.026704488415810922,
        0.0267044884158107,
    ),
    (
        "bus_top_to_panel_directly_above",
        [-0.125, 0.125],
        [-0.125, 0.125],
        [-0.25, 0.25],
        [-0.25, 0.25],
        0.7,
        0.1347220340078758,
        0.13472203400787588,
    ),
    (
        "bus_top_to_panel_offset_1.0",
        [-0.125, 0.125],
        [-0.125, 0.125],
        [0.75, 1.25],
        [-0.25, 0.25],
        0.7,
        0.018777987236503924,
        0.018777987236503268,
    ),
    (
        "bus_top_to_panel_offset_1.1_0.65",
        [-0.125, 0.125],
        [-0.125, 0.125],
        [0.85, 1.35],
        [0.4, 0.9],
        0.7,
        0.009236370692379925,
        0.009236370692381162,
    ),
    (
        "bus_top_to_panel_offset_5",
        [-0.125, 0.125],
        [-0.125, 0.125],
        [4.75, 5.25],
        [-0.25, 0.25],
        0.7,
        6.0491864619649505e-05,
        6.0491864629061396e-05,
    ),
    (
        "bus_floor_to_ceiling",
        [0.0, 18.7],
        [0.0, 2.6],
        [0.0, 18.7],
        [0.0, 2.6],
        2.4,
        0.39991154659329153,
        0.3999115465932927,
    ),
];

type Perpendicular = (&'static str, Span, Span, Span, Span, f64, f64);

/// name, x, y, xi, eta, view factor, the same by contour integral.
const PERPENDICULAR: &[Perpendicular] = &[
    ("perp_unit_common_edge", [0.0, 1.0], [0.0, 1.0], [0.0, 1.0], [0.0, 1.0], 0.20004377607540316, 0.200043776075403),
    ("perp_2_common_len_1x1", [0.0, 2.0], [0.0, 1.0], [0.0, 2.0], [0.0, 1.0], 0.2406360061769618, 0.24063600617696104),
    ("perp_gap_both", [0.0, 1.0], [0.5, 1.5], [0.0, 1.0], [0.25, 1.0], 0.0653698006128797, 0.06536980061287989),
    ("perp_shifted", [0.0, 1.0], [0.0, 1.0], [1.0, 2.0], [0.0, 1.0], 0.04059223010155859, 0.04059223006432158),
    ("perp_arbitrary_1", [-1.3, 0.4], [0.2, 2.9], [0.1, 3.3], [0.3, 1.1], 0.029404576946572752, 0.02940457694657251),
    ("perp_arbitrary_2", [0.0, 0.5], [0.1, 0.4], [2.0, 2.6], [1.5, 3.0], 0.0018980203981092123, 0.0018980203981076706),
    (
        "perp_one_touching_line",
        [0.0, 1.0],
        [0.0, 0.5],
        [0.2, 0.7],
        [0.3, 0.9],
        0.05526512265957838,
        0.05526512265957847,
    ),
    (
        "bus_side_to_panel_0.2_ahead",
        [-0.125, 0.125],
        [0.7, 2.4],
        [-0.25, 0.25],
        [0.2, 0.7],
        0.012156384580832439,
        0.012156384580831767,
    ),
    (
        "bus_side_to_panel_2_ahead_off_1",
        [-0.125, 0.125],
        [0.7, 2.4],
        [0.75, 1.25],
        [2.0, 2.5],
        0.0035889637911079575,
        0.0035889637911082823,
    ),
    (
        "bus_side_to_panel_5_ahead",
        [-0.125, 0.125],
        [0.7, 2.4],
        [-0.25, 0.25],
        [5.0, 5.5],
        0.0006938705344966218,
        0.0006938705345002317,
    ),
    (
        "bus_side_to_panel_clipped",
        [-0.125, 0.125],
        [0.7, 2.4],
        [-0.25, 0.25],
        [0.0, 0.1],
        0.00041003988859161463,
        0.00041003988859163783,
    ),
];

/// Passenger centre along and across the bus in m, its view factor to the 8 x 2 panels of 0.5 m.
const PASSENGERS: &[(f64, f64, f64)] = &[
    (9.35, 1.3, 0.016445974339723637),
    (1.16875, 0.65, 0.011522496050189098),
    (9.35, 0.65, 0.014447540514395694),
    (3.0, 2.2, 0.013553186354890489),
    (0.2, 0.2, 0.00774732944696137),
    (18.0, 1.3, 0.012578647662604409),
];

/// Doubles cancel in the sums of 16 terms; the reference agrees with its contour integral to 4e-11.
const TOLERANCE: f64 = 1e-9;

#[test]
fn xval_python_parallel_rectangles() {
    for &(name, x, y, xi, eta, height, exact, contour) in PARALLEL {
        let view = parallel(x, y, xi, eta, height);
        assert!((view - exact).abs() < TOLERANCE, "{name}: {view} instead of {exact}");
        assert!((view - contour).abs() < TOLERANCE, "{name}: {view} instead of {contour} by contour integral");
    }
}

#[test]
fn xval_python_perpendicular_rectangles() {
    for &(name, x, y, xi, eta, exact, contour) in PERPENDICULAR {
        let view = perpendicular(x, y, xi, eta);
        assert!((view - exact).abs() < TOLERANCE, "{name}: {view} instead of {exact}");
        // Where edges touch, the reference's contour integral itself is good to 1e-8 only.
        assert!((view - contour).abs() < 1e-8, "{name}: {view} instead of {contour} by contour integral");
    }
}

#[test]
fn xval_python_passengers_in_the_default_grid() {
    let vehicle = Vehicle::default();
    let panels = ceiling_panels(&vehicle);
    for &(along_m, across_m, exact) in PASSENGERS {
        let view = panel_view_factor(&vehicle, &panels, along_m, across_m);
        assert!((view - exact).abs() < TOLERANCE, "({along_m}, {across_m}): {view} instead of {exact}");
    }
}

#[test]
fn xval_python_mean_over_the_floor() {
    // The reference's mean over a grid of 75 x 21 positions is 0.01416; a sample of n passengers scatters around it.
    let vehicle = Vehicle { passenger_placements: 4000, ..Vehicle::default() };
    let views = place_passengers(&vehicle);
    let mean = PassengerViews::from_view_factors(&views).mean();
    let deviation = (views.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / views.len() as f64).sqrt();
    let standard_error = deviation / (views.len() as f64).sqrt();
    assert!((mean - 0.014_160_236_770_6).abs() < 3.5 * standard_error, "{mean} ± {standard_error}");
    // Its 5th and 95th percentiles are 0.010432 and 0.016671.
    let share_below = |view| views.iter().filter(|&&v| v < view).count() as f64 / views.len() as f64;
    let share_error = 3.5 * (0.05 * 0.95 / views.len() as f64).sqrt();
    assert!((share_below(0.010_432) - 0.05).abs() < share_error);
    assert!((share_below(0.016_671) - 0.95).abs() < share_error);
}

#[test]
fn prop_an_enclosure_is_closed() {
    let (along, across, up) = ([0.0, 18.7], [0.0, 2.6], [0.0, 2.4]);
    let ceiling = parallel(along, across, along, across, up[1]);
    let long_wall = perpendicular(along, across, along, up);
    let end_wall = perpendicular(across, along, across, up);
    let sum = ceiling + 2.0 * long_wall + 2.0 * end_wall;
    assert!((sum - 1.0).abs() < 1e-12, "{sum}");
}

#[test]
fn prop_reciprocity() {
    for &(name, x, y, xi, eta, height, ..) in PARALLEL {
        let area = |a: Span, b: Span| (a[1] - a[0]) * (b[1] - b[0]);
        let there = area(x, y) * parallel(x, y, xi, eta, height);
        let back = area(xi, eta) * parallel(xi, eta, x, y, height);
        assert!((there - back).abs() < 1e-10 * area(x, y).max(area(xi, eta)), "{name}: {there} and {back}");
    }
}

#[test]
fn prop_two_nodes_have_the_moments_of_all_passengers() {
    let views = place_passengers(&Vehicle::default());
    let quadrature = PassengerViews::from_view_factors(&views);
    for power in 0..=3 {
        let full = views.iter().map(|v| v.powi(power)).sum::<f64>() / views.len() as f64;
        let nodes: f64 = quadrature.nodes().iter().map(|(view, weight)| weight * view.powi(power)).sum();
        assert!((full - nodes).abs() < 1e-12 * full, "moment {power}: {nodes} instead of {full}");
    }
}
