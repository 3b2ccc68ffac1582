//! Where a year's energy goes: sums of a month by class, its heat flows, and what a year comes to of them.

use cabin::HeatFlows;
use sqlx::Row;
use sqlx::sqlite::SqliteConnection;

use crate::row::{Insert, pack, put_all, unpack};
use crate::{MonthAverages, Store, StoreError, StoredGrid, Uncertainty};

/// What samples have in common.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Class {
    /// By what samples are sorted: `month`, `route`, ….
    pub sorted_by: String,
    /// Place among the classes of the same kind.
    pub order: i64,
    /// Name.
    pub name: String,
}

/// Sums over the solved samples of a class.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ClassSum {
    /// Samples.
    pub samples: f64,
    /// HVAC power in W.
    pub power_w: f64,
    /// HVAC energy in J of samples with a distance.
    pub driven_energy_j: f64,
    /// Distance in m.
    pub distance_m: f64,
    /// HVAC power in W of samples with a power of the vehicle.
    pub drawn_power_w: f64,
    /// Power of the whole vehicle in W.
    pub vehicle_power_w: f64,
}

/// The sums of a month.
#[derive(Debug, Clone, PartialEq)]
pub struct MonthSums {
    /// Local month, 1 … 12.
    pub month: u8,
    /// The classes, in rising order.
    pub classes: Vec<Class>,
    /// A sum for each class, for every design and within it every window of the study.
    pub cells: Vec<Vec<ClassSum>>,
}

/// How the air unit works while it heats, or while it cools.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirUnitSide {
    /// Mean lift in K.
    pub lift_k: f64,
    /// Heat or cooling for electric energy.
    pub cop: f64,
}

/// Heat flows of a design and window: means over the solved samples of a month.
#[derive(Debug, Clone, PartialEq)]
pub struct MonthFlows {
    /// Local month, 1 … 12.
    pub month: u8,
    /// Place of the design in the study.
    pub design: usize,
    /// Place of the window.
    pub window: usize,
    /// Solved samples.
    pub samples: u64,
    /// Means.
    pub flows: HeatFlows,
    /// The air unit while it heats; `None` where it never does.
    pub heating: Option<AirUnitSide>,
    /// While it cools.
    pub cooling: Option<AirUnitSide>,
    /// Samples that ask for more electric power than the vehicle can give.
    pub over_limit: u64,
    /// Mean heat or cooling in W above the limit.
    pub unmet_heat_w: f64,
}

/// What a class of samples comes to in the year.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassYear {
    /// Place of the design in the study.
    pub design: usize,
    /// Place of the window.
    pub window: usize,
    /// The class.
    pub class: Class,
    /// Share in the year.
    pub weight: f64,
    /// Mean HVAC power in W.
    pub hvac_power_w: f64,
    /// HVAC energy for a distance; `None` where the telemetry has no distances.
    pub kwh_per_km: Option<f64>,
    /// Share of HVAC in what the vehicle drew.
    pub vehicle_power_share: Option<f64>,
    /// Samples.
    pub samples: u64,
}

/// How often a disturbance lies where.
#[derive(Debug, Clone, PartialEq)]
pub struct Bin {
    /// A column of the view `sample`.
    pub quantity: &'static str,
    /// Lower end, which is in it.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Samples.
    pub samples: u64,
    /// Share in the year.
    pub weight: f64,
}

/// What completing the optima writes that is not made of what the database holds.
#[derive(Debug, Clone, Default)]
pub struct Energy {
    /// Months that have changed: their averages.
    pub averages: Vec<MonthAverages>,
    /// Their sums.
    pub sums: Vec<MonthSums>,
    /// Of the same months.
    pub flows: Vec<MonthFlows>,
    /// The year.
    pub classes: Vec<ClassYear>,
    /// The disturbances.
    pub bins: Vec<Bin>,
    /// How sure all that is.
    pub uncertainty: Uncertainty,
}

const SUMS: usize = 6;

impl ClassSum {
    fn values(&self) -> [f64; SUMS] {
        let Self { samples, power_w, driven_energy_j, distance_m, drawn_power_w, vehicle_power_w } = *self;
        [samples, power_w, driven_energy_j, distance_m, drawn_power_w, vehicle_power_w]
    }

    fn of([samples, power_w, driven_energy_j, distance_m, drawn_power_w, vehicle_power_w]: [f64; SUMS]) -> Self {
        Self { samples, power_w, driven_energy_j, distance_m, drawn_power_w, vehicle_power_w }
    }
}

impl Store {
    /// Months whose optima are to be averaged anew, in rising order.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn stale_months(&mut self) -> Result<Vec<u8>, StoreError> {
        self.select("SELECT month FROM stale_month ORDER BY month", |r| r.try_get("month"))
    }

    /// The sums of the months that are not to be averaged anew, in rising order.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn month_sums(&mut self, grid: &StoredGrid) -> Result<Vec<MonthSums>, StoreError> {
        self.drive(async |c| {
            let mut all = Vec::new();
            let sql = "SELECT * FROM class_month WHERE month NOT IN (SELECT month FROM stale_month) ORDER BY month";
            for r in sqlx::query(sql).fetch_all(&mut *c).await? {
                let month: u8 = r.try_get("month")?;
                let classes: Vec<(String, i64, String)> =
                    serde_json::from_str(r.try_get("classes")?).map_err(|e| sqlx::Error::Decode(e.into()))?;
                let class = |(sorted_by, order, name)| Class { sorted_by, order, name };
                let classes: Vec<Class> = classes.into_iter().map(class).collect();
                let mut cells = vec![Vec::new(); grid.designs.len() * grid.windows.len()];
                let sql = "SELECT * FROM class_sum WHERE month = ?";
                for r in sqlx::query(sql).bind(month).fetch_all(&mut *c).await? {
                    let (design, window) =
                        (grid.design(r.try_get("design_id")?)?, grid.window(r.try_get("window_id")?)?);
                    cells[design * grid.windows.len() + window] =
                        unpack::<SUMS>(r.try_get("sums")?).into_iter().map(ClassSum::of).collect();
                }
                cells.iter_mut().for_each(|cell| cell.resize(classes.len(), ClassSum::default()));
                all.push(MonthSums { month, classes, cells });
            }
            Ok(all)
        })
    }
}

/// Replaces the year, and of the months those that have changed.
pub(crate) async fn put(
    c: &mut SqliteConnection,
    run_id: i64,
    grid: &StoredGrid,
    energy: &Energy,
) -> Result<(), StoreError> {
    for table in ["class_month", "class_sum", "heat_flow_monthly"] {
        // The text is built from constants alone.
        let sql = format!("DELETE FROM {table} WHERE month IN (SELECT month FROM stale_month)");
        sqlx::query(sqlx::AssertSqlSafe(sql)).execute(&mut *c).await?;
    }
    for table in ["energy_class", "disturbance_histogram"] {
        sqlx::query(sqlx::AssertSqlSafe(format!("DELETE FROM {table}"))).execute(&mut *c).await?;
    }
    for month in &energy.sums {
        put_month(c, grid, month).await?;
    }
    for flows in &energy.flows {
        put_flows(c, run_id, grid, flows).await?;
    }
    put_all(c, "energy_class", &energy.classes, |insert, class| {
        insert
            .of_point(&grid.designs[class.design].name, grid.windows[class.window])?
            .set("sorted_by", class.class.sorted_by.clone())?
            .set("class", class.class.name.clone())?
            .set("class_order", class.class.order)?
            .set("weight", class.weight)?
            .set("hvac_power_w", class.hvac_power_w)?
            .set("kwh_per_km", class.kwh_per_km)?
            .set("vehicle_power_share", class.vehicle_power_share)?
            .set("sample_count", class.samples.cast_signed())?
            .set("run_id", run_id)
    })
    .await?;
    for bin in &energy.bins {
        let row = Insert::into("disturbance_histogram")
            .set("quantity", bin.quantity)?
            .set("bin_from", bin.from)?
            .set("bin_to", bin.to)?
            .set("sample_count", bin.samples.cast_signed())?
            .set("weight", bin.weight)?
            .set("run_id", run_id)?;
        row.execute(&mut *c).await?;
    }
    Ok(())
}

async fn put_month(c: &mut SqliteConnection, grid: &StoredGrid, month: &MonthSums) -> Result<(), StoreError> {
    let classes: Vec<(&str, i64, &str)> =
        month.classes.iter().map(|c| (c.sorted_by.as_str(), c.order, c.name.as_str())).collect();
    let classes = serde_json::json!(classes).to_string();
    Insert::into("class_month").set("month", month.month)?.set("classes", classes)?.execute(&mut *c).await?;
    for (n, cell) in month.cells.iter().enumerate() {
        let (design, window) = (n / grid.windows.len(), n % grid.windows.len());
        let row = Insert::into("class_sum")
            .set("month", month.month)?
            .set("design_id", grid.design_ids[design])?
            .set("window_id", grid.window_ids[window])?
            .set("sums", pack(cell.iter().flat_map(ClassSum::values)))?;
        row.execute(&mut *c).await?;
    }
    Ok(())
}

async fn put_flows(c: &mut SqliteConnection, run_id: i64, grid: &StoredGrid, m: &MonthFlows) -> Result<(), StoreError> {
    let mut row = Insert::into("heat_flow_monthly")
        .of_point(&grid.designs[m.design].name, grid.windows[m.window])?
        .set("month", m.month)?
        .set("sample_count", m.samples.cast_signed())?;
    for (column, _, flow_w) in m.flows.named_w() {
        row = row.set(column, flow_w)?;
    }
    let row = row
        .set("heating_lift_k", m.heating.map(|side| side.lift_k))?
        .set("heating_cop", m.heating.map(|side| side.cop))?
        .set("cooling_lift_k", m.cooling.map(|side| side.lift_k))?
        .set("cooling_cop", m.cooling.map(|side| side.cop))?
        .set("over_limit_count", m.over_limit.cast_signed())?
        .set("unmet_heat_w", m.unmet_heat_w)?
        .set("run_id", run_id)?;
    row.execute(c).await.map(|_| ())
}
