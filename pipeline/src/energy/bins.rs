//! How often disturbances lie where (paper, figure scenarios-overview).

use cabin::celsius;
use ingest::sample::Sample;
use std::collections::BTreeMap;
use store::{Bin, MonthRow};

/// Columns of the view `sample` with the width of a bin.
const QUANTITIES: [(&str, f64); 8] = [
    ("ambient_temperature_c", 2.0),
    ("dni_w_m2", 100.0),
    ("dhi_w_m2", 50.0),
    ("passengers", 5.0),
    ("door_open_fraction", 0.05),
    ("shadow_fraction", 0.1),
    ("month", 1.0),
    ("local_hour", 1.0),
];

/// All disturbances in bins, those without samples left out.
pub fn bins(samples: &[&Sample], months: &[MonthRow]) -> Vec<Bin> {
    let mut counts: BTreeMap<(usize, i64), [u64; 12]> = BTreeMap::new();
    for sample in samples {
        let d = &sample.disturbances;
        let values = [
            Some(celsius(d.ambient_temperature_k)),
            Some(d.dni_w_m2),
            Some(d.dhi_w_m2),
            Some(d.passengers),
            Some(d.door_open_fraction),
            Some(d.shadow_fraction),
            Some(f64::from(sample.month)),
            sample.clock.map(|clock| f64::from(clock.hour)),
        ];
        for (quantity, value) in values.into_iter().enumerate() {
            if let Some(value) = value {
                let bin = (value / QUANTITIES[quantity].1).floor() as i64;
                counts.entry((quantity, bin)).or_default()[usize::from(sample.month) - 1] += 1;
            }
        }
    }
    let weight = |of_months: &[u64; 12]| {
        let in_month = |m: &MonthRow| of_months[usize::from(m.month) - 1] as f64 * m.sample_weight;
        months.iter().map(in_month).sum()
    };
    let bin = |((quantity, bin), of_months): ((usize, i64), [u64; 12])| {
        let (name, width) = QUANTITIES[quantity];
        Bin {
            quantity: name,
            from: bin as f64 * width,
            to: (bin + 1) as f64 * width,
            samples: of_months.iter().sum(),
            weight: weight(&of_months),
        }
    };
    counts.into_iter().map(bin).collect()
}
