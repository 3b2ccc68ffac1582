//! The paper's figure of model approximations: the smooth door law beside the exact one, and the error of the surrogate of the
//! predicted mean vote at an ambient temperature of 10 °C.
//!
//! `cargo run --release -p busclimate-report --example approximations > docs/approximations.svg`

#![expect(clippy::print_stdout, reason = "the figure is the output")]

use cabin::{PmvModel, Vehicle, clothing_insulation_clo, kelvin};
use solve::nlp::Surrogate;
use std::fmt::Write as _;

/// The paper's range of both temperatures in °C, and the size of a cell.
const RANGE_C: (f64, f64) = (0.0, 45.0);
const CELL_K: f64 = 1.0;
/// Error of the darkest colour.
const LARGEST: f64 = 0.02;

fn main() {
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 400\" role=\"img\" \
         font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\">\n\
         <title>Approximations of the paper: door law and predicted mean vote</title>\n\
         <rect width=\"900\" height=\"400\" fill=\"#fff\"/>\n",
    );
    door_law(&mut svg);
    vote_error(&mut svg);
    svg.push_str("</svg>");
    println!("{svg}");
}

/// `sqrt(|x|) x`, and with the smooth root of eq. `sqrt-of-abs-approx`.
fn door_law(svg: &mut String) {
    let x = |k: f64| 60.0 + 300.0 * (k + 1.0) / 2.0;
    let y = |v: f64| 340.0 - 280.0 * (v + 1.0) / 2.0;
    let path = |f: &dyn Fn(f64) -> f64| {
        let point = |i: i32| {
            let k = f64::from(i) / 50.0;
            format!("{}{:.2} {:.2}", if i == -50 { "M" } else { " " }, x(k), y(f(k)))
        };
        (-50..=50).map(point).collect::<String>()
    };
    let exact = path(&|k| k.abs().sqrt() * k);
    let smooth = path(&|k| (k * k + 0.01).sqrt().sqrt() * k);
    for i in -2..=2 {
        let v = f64::from(i) / 2.0;
        let label = format!("{v:.1}").replace('-', "−");
        let _ = writeln!(
            svg,
            "<path d=\"M{0:.1} 60V340M60 {1:.1}H360\" stroke=\"#e4e4e4\"/><text x=\"{0:.1}\" y=\"356\" text-anchor=\"middle\">{label}</text>\
             <text x=\"54\" y=\"{2:.1}\" text-anchor=\"end\">{label}</text>",
            x(v),
            y(v),
            y(v) + 4.0
        );
    }
    let _ = writeln!(
        svg,
        "<rect x=\"60\" y=\"60\" width=\"300\" height=\"280\" fill=\"none\" stroke=\"#666\"/>\n\
         <path d=\"{exact}\" fill=\"none\" stroke=\"#0072b2\" stroke-width=\"1.8\"/>\n\
         <path d=\"{smooth}\" fill=\"none\" stroke=\"#d55e00\" stroke-width=\"1.8\" stroke-dasharray=\"6 4\"/>\n\
         <text x=\"60\" y=\"40\" font-size=\"14\">Door law: root(ΔT) · ΔT in K^1.5</text>\n\
         <path d=\"M80 80H110\" stroke=\"#0072b2\" stroke-width=\"1.8\"/><text x=\"116\" y=\"84\">exact</text>\n\
         <path d=\"M80 98H110\" stroke=\"#d55e00\" stroke-width=\"1.8\" stroke-dasharray=\"6 4\"/><text x=\"116\" y=\"102\">smooth, with 0.01 K²</text>\n\
         <text x=\"210\" y=\"376\" text-anchor=\"middle\">cabin less ambient temperature in K</text>"
    );
}

/// Absolute difference of surrogate and ISO 7730, cell by cell.
fn vote_error(svg: &mut String) {
    let vehicle = Vehicle::default();
    let surrogate = Surrogate::stored();
    let clo = clothing_insulation_clo(kelvin(10.0), vehicle.clothing_floor_clo);
    let model = PmvModel::new(clo, vehicle.metabolic_rate_met, vehicle.relative_humidity, vehicle.air_velocity_m_s);
    let count = ((RANGE_C.1 - RANGE_C.0) / CELL_K) as u32;
    let size = 280.0 / f64::from(count);
    let (mut sum, mut largest) = (0.0, 0.0_f64);
    for i in 0..count {
        for j in 0..count {
            let middle = |n: u32| RANGE_C.0 + CELL_K * (f64::from(n) + 0.5);
            let (air_c, radiant_c) = (middle(i), middle(j));
            let error = (surrogate.vote(clo, air_c, radiant_c) - model.at(air_c, radiant_c).pmv).abs();
            sum += error;
            largest = largest.max(error);
            let _ = writeln!(
                svg,
                "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{}\"/>",
                480.0 + size * f64::from(i),
                340.0 - size * f64::from(j + 1),
                size + 0.1,
                size + 0.1,
                shade(error)
            );
        }
    }
    let mean = sum / f64::from(count * count);
    for k in [0, 15, 30, 45] {
        let place = 280.0 * f64::from(k) / 45.0;
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"356\" text-anchor=\"middle\">{k}</text><text x=\"474\" y=\"{:.1}\" text-anchor=\"end\">{k}</text>",
            480.0 + place,
            344.0 - place
        );
    }
    let _ = writeln!(
        svg,
        "<rect x=\"480\" y=\"60\" width=\"280\" height=\"280\" fill=\"none\" stroke=\"#666\"/>\n\
         <text x=\"480\" y=\"40\" font-size=\"14\">|PMV surrogate − PMV| at 10 °C ambient</text>\n\
         <text x=\"480\" y=\"54\" fill=\"#444\">mean {mean:.4}, largest {largest:.3}</text>\n\
         <text x=\"620\" y=\"376\" text-anchor=\"middle\">cabin temperature in °C</text>\n\
         <text transform=\"translate(446 200) rotate(-90)\" text-anchor=\"middle\">mean radiant temperature in °C</text>"
    );
    for n in 0..=10 {
        let error = LARGEST * f64::from(n) / 10.0;
        let top = 330.0 - 24.0 * f64::from(n);
        let _ = writeln!(
            svg,
            "<rect x=\"790\" y=\"{top:.1}\" width=\"20\" height=\"24\" fill=\"{}\"/>{}",
            shade(error),
            if n % 2 == 0 {
                format!("<text x=\"816\" y=\"{:.1}\">{error:.3}</text>", top + 16.0)
            } else {
                String::new()
            }
        );
    }
}

/// White for none, dark blue for [`LARGEST`] and more.
fn shade(error: f64) -> String {
    let share = (error / LARGEST).clamp(0.0, 1.0);
    let channel = |dark: f64| (255.0 + share * (dark - 255.0)).round() as u8;
    format!("#{:02x}{:02x}{:02x}", channel(8.0), channel(48.0), channel(107.0))
}
