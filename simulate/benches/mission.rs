//! Simulated seconds per second on one core, of a day in 100 variants: `cargo bench -p busclimate-simulate`; and beside it the
//! reference of the tests with a step a second, one variant at a time.

use cabin::{PassengerViews, Vehicle};
use divan::{Bencher, counter::ItemsCount};
use simulate::{Dynamics, Mission, Variant, simulate, simulate_distinct};
use testing::{TestMission, paper_designs, simulate_finely};

const HOURS: usize = 10;
/// Hours of the year with which a day of the season begins.
const WINTER: usize = 30;
const SPRING: usize = 2100;
const SUMMER: usize = 3700;

fn main() {
    divan::main();
}

/// Calls `work` with a day of the year in its variants: five designs, five windows, four ways to drive.
fn with_day(first: usize, work: impl FnOnce(&Mission<'_, '_>, &[Variant<'_>])) {
    let vehicle = Vehicle::default();
    let views = PassengerViews::new(&vehicle);
    let designs = paper_designs();
    let mission = TestMission::new(&vehicle, &views, &designs, first, HOURS);
    work(&mission.mission(), &mission.variants(&designs));
}

fn all(bencher: Bencher, first: usize) {
    with_day(first, |mission, variants| {
        bencher
            .counter(ItemsCount::new(3600 * HOURS * variants.len()))
            .bench_local(|| simulate(divan::black_box(mission), &Dynamics::default(), variants));
    });
}

#[divan::bench(sample_count = 10)]
fn winter_in_100_variants(bencher: Bencher) {
    all(bencher, WINTER);
}

#[divan::bench(sample_count = 10)]
fn summer_in_100_variants(bencher: Bencher) {
    all(bencher, SUMMER);
}

/// The same on all cores, those driven once that cannot come out differently.
#[divan::bench(sample_count = 10, args = [("winter", WINTER), ("spring", SPRING), ("summer", SUMMER)])]
fn distinct_of_100_variants(bencher: Bencher, (_, first): (&str, usize)) {
    with_day(first, |mission, variants| {
        bencher
            .counter(ItemsCount::new(3600 * HOURS * variants.len()))
            .bench_local(|| simulate_distinct(divan::black_box(mission), &Dynamics::default(), variants));
    });
}

#[divan::bench(sample_count = 3)]
fn winter_one_by_one_with_settled_votes(bencher: Bencher) {
    with_day(WINTER, |mission, variants| {
        bencher
            .counter(ItemsCount::new(3600 * HOURS))
            .bench_local(|| simulate_finely(divan::black_box(mission), &Dynamics::default(), &variants[0], 1, |_| ()));
    });
}
