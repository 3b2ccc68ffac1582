-- What one asks of a year besides its average: when and where power goes, what it is per kilometre, how often what happens.
--
-- Serves: questions by month, local hour, weekday, ambient temperature and route; kWh per km and per year; the paper's
-- figures of disturbances and votes.
-- Cost: 48 bytes for each design, window, class and month, some 6 MB on a year with five designs and seventeen windows. Only
-- months that have changed are added up again.

-- Local time of a sample. SQLite and DuckDB have no common word for a time zone.
CREATE TABLE sample_clock (
    sample_id  INTEGER PRIMARY KEY REFERENCES hourly_sample ON DELETE CASCADE,
    local_hour INTEGER NOT NULL CHECK (local_hour BETWEEN 0 AND 23),  -- in which the sample begins
    weekday    INTEGER NOT NULL CHECK (weekday BETWEEN 1 AND 7),      -- 1 Monday … 7 Sunday
    row_check  INTEGER
) STRICT;
CREATE INDEX sample_clock_unchecked ON sample_clock (sample_id) WHERE row_check IS NULL;

-- The next run of `shade` fills it: what it was last done with counts as unknown.
UPDATE source_file SET reading_key = '' WHERE kind = 'shadow';
INSERT OR IGNORE INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12);
DELETE FROM stage_record WHERE stage = 'solve';

DROP VIEW sample;
CREATE VIEW sample AS
SELECT
    s.sample_id,
    s.mission,
    s.bus,
    s.segment,
    s.start_utc,
    s.month,
    k.local_hour,
    k.weekday,
    s.duration_s,
    w.sample_weight AS weight,
    CAST(s.ambient_temperature_k - 273.15 AS DOUBLE) AS ambient_temperature_c,
    s.dni_w_m2,
    s.dhi_w_m2,
    s.passengers,
    s.door_open_fraction,
    -- degrees() is an optional function of SQLite.
    CAST(s.solar_altitude_rad * 57.29577951308232 AS DOUBLE) AS solar_altitude_deg,
    CAST(s.solar_azimuth_rad * 57.29577951308232 AS DOUBLE) AS solar_azimuth_deg,
    s.shadow_fraction,
    s.interpolated_s,
    f.path AS source_path,
    s.first_line,
    s.last_line,
    g.distance_m,
    g.vehicle_power_w,
    g.route
FROM hourly_sample AS s
JOIN month_weight AS w USING (month)
JOIN source_file AS f USING (source_file_id)
LEFT JOIN sample_clock AS k USING (sample_id)
LEFT JOIN mission_segment AS g ON g.source_file_id = s.source_file_id AND g.segment = s.segment;

-- Coefficients of the bus that the optima were found with: one row. Flow by convection and conduction is the coefficient times
-- the difference of temperatures, by radiation times the difference of their fourth powers.
CREATE TABLE heat_transfer (
    one                             INTEGER PRIMARY KEY CHECK (one = 1),
    convection_shell_inside_w_k     REAL NOT NULL,
    convection_interior_w_k         REAL NOT NULL,
    convection_radiant_heater_w_k   REAL NOT NULL,
    convection_shell_outside_w_k    REAL NOT NULL,
    conduction_shell_w_k            REAL NOT NULL,
    radiation_heater_interior_w_k4  REAL NOT NULL,
    radiation_heater_shell_w_k4     REAL NOT NULL,
    radiation_interior_shell_w_k4   REAL NOT NULL,
    radiation_shell_outside_w_k4    REAL NOT NULL,
    passenger_heat_w                REAL NOT NULL,  -- of one
    other_heat_w                    REAL NOT NULL
) STRICT;

-- Electric power of the air unit that the vehicle can give; the optima know no limit.
CREATE TABLE power_limit (
    design_id       INTEGER PRIMARY KEY REFERENCES hvac_design ON DELETE CASCADE,
    heating_limit_w REAL NOT NULL,
    cooling_limit_w REAL NOT NULL
) STRICT;

-- The classes that the solved samples of a month fall into, and their sums, of which the year is made.
CREATE TABLE class_month (
    month   INTEGER PRIMARY KEY,
    classes TEXT NOT NULL  -- JSON: sorted_by, order, name of each
) STRICT;
CREATE TABLE class_sum (
    month     INTEGER NOT NULL,
    design_id INTEGER NOT NULL REFERENCES hvac_design ON DELETE CASCADE,
    window_id INTEGER NOT NULL REFERENCES comfort_window ON DELETE CASCADE,
    sums      BLOB NOT NULL,  -- for each class of the month six f64, little endian: samples, power, energy of samples with a
                              -- distance, distance, power of samples with a power of the vehicle, that power
    PRIMARY KEY (month, design_id, window_id)
) STRICT, WITHOUT ROWID;

-- Heat flows of the optima: where they go, means over the solved samples of a month, which count alike.
CREATE TABLE heat_flow_monthly (
    design                    TEXT NOT NULL,
    pmv_limit                 REAL NOT NULL,
    pmv_min                   REAL NOT NULL,
    pmv_max                   REAL NOT NULL,
    month                     INTEGER NOT NULL,  -- local, 1 … 12
    sample_count              INTEGER NOT NULL,  -- solved
    cabin_to_shell_w          REAL NOT NULL,
    interior_to_cabin_w       REAL NOT NULL,
    shell_to_ambient_w        REAL NOT NULL,
    heater_to_cabin_w         REAL NOT NULL,
    through_shell_w           REAL NOT NULL,
    shell_radiation_w         REAL NOT NULL,
    heater_to_shell_w         REAL NOT NULL,
    heater_to_interior_w      REAL NOT NULL,
    interior_to_shell_w       REAL NOT NULL,
    door_w                    REAL NOT NULL,
    passengers_w              REAL NOT NULL,
    other_w                   REAL NOT NULL,
    air_unit_heat_w           REAL NOT NULL,     -- negative in cooling
    radiant_heater_power_w    REAL NOT NULL,
    solar_interior_w          REAL NOT NULL,
    solar_shell_inside_w      REAL NOT NULL,
    solar_shell_outside_w     REAL NOT NULL,
    heating_lift_k            REAL,              -- of the samples in which the air unit heats
    heating_cop               REAL,              -- heat over electric energy
    cooling_lift_k            REAL,
    cooling_cop               REAL,
    over_limit_count          INTEGER NOT NULL,  -- samples that ask for more electric power than the vehicle can give
    unmet_heat_w              REAL NOT NULL,     -- heat or cooling above the limit, at the COP of the optimum
    run_id                    INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, month)
) STRICT, WITHOUT ROWID;

-- What the optima ask for above the power limits of the vehicle, over the year.
CREATE TABLE unmet_demand (
    design            TEXT NOT NULL,
    pmv_limit         REAL NOT NULL,
    pmv_min           REAL NOT NULL,
    pmv_max           REAL NOT NULL,
    heating_limit_w   REAL NOT NULL,     -- electric power of the air unit
    cooling_limit_w   REAL NOT NULL,
    over_limit_count  INTEGER NOT NULL,  -- samples
    over_limit_weight REAL NOT NULL,     -- share of the operating hours in a year
    unmet_heat_w      REAL NOT NULL,     -- mean over the year
    infeasible_weight REAL NOT NULL,     -- share of the hours in which no operation meets the window, whatever the power
    run_id            INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;

-- The year by class: months by their days, within a month solved samples alike. Of the last time that all optima were there.
CREATE TABLE energy_class (
    design                TEXT NOT NULL,
    pmv_limit             REAL NOT NULL,
    pmv_min               REAL NOT NULL,
    pmv_max               REAL NOT NULL,
    sorted_by             TEXT NOT NULL,     -- year, month, local hour, weekday, ambient temperature in °C, route, PMV
    class                 TEXT NOT NULL,
    class_order           INTEGER NOT NULL,
    weight                REAL NOT NULL,     -- share in the year
    hvac_power_w          REAL NOT NULL,     -- mean
    kwh_per_km            REAL,              -- where the telemetry gives distances
    vehicle_power_share   REAL,              -- of HVAC in what the vehicle drew as it was measured
    sample_count          INTEGER NOT NULL,
    run_id                INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, sorted_by, class)
) STRICT, WITHOUT ROWID;

-- What a bus comes to in a year, at the hours that the missions show.
CREATE TABLE annual_energy (
    design                    TEXT NOT NULL,
    pmv_limit                 REAL NOT NULL,
    pmv_min                   REAL NOT NULL,
    pmv_max                   REAL NOT NULL,
    kwh_per_operating_hour    REAL NOT NULL,
    kwh_per_km                REAL,
    operating_hours_per_bus_year REAL NOT NULL,  -- of the segments of all missions, over the months in which a bus has one
    kwh_per_bus_year          REAL NOT NULL,
    vehicle_power_share       REAL,
    run_id                    INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;

-- How often disturbances lie where (paper, figure scenarios-overview).
CREATE TABLE disturbance_histogram (
    quantity     TEXT NOT NULL,     -- a column of sample
    bin_from     REAL NOT NULL,     -- included; to bin_to, not included
    bin_to       REAL NOT NULL,
    sample_count INTEGER NOT NULL,
    weight       REAL NOT NULL,     -- share in the year
    run_id       INTEGER NOT NULL,
    PRIMARY KEY (quantity, bin_from)
) STRICT, WITHOUT ROWID;

-- How often passengers vote what (paper, figure yearly-pmv-range-comparison): bins of 0.1.
CREATE VIEW pmv_histogram AS
SELECT
    design,
    pmv_limit,
    pmv_min,
    pmv_max,
    CAST(class_order / 10.0 AS DOUBLE) AS bin_from,
    CAST((class_order + 1) / 10.0 AS DOUBLE) AS bin_to,
    sample_count,
    weight
FROM energy_class
WHERE sorted_by = 'PMV';

-- What a tenth of a PMV more costs at each window: the power that the next narrower symmetric window takes more.
CREATE VIEW marginal_cost AS
SELECT
    design,
    pmv_limit,
    hvac_power_w,
    CAST((lead(hvac_power_w) OVER (PARTITION BY design ORDER BY pmv_limit DESC) - hvac_power_w)
        / (pmv_limit - lead(pmv_limit) OVER (PARTITION BY design ORDER BY pmv_limit DESC)) / 10.0 AS DOUBLE) AS w_per_tenth_pmv
FROM annual_average
WHERE pmv_min = -pmv_max;

-- How much more one design takes than another, by class.
CREATE VIEW design_difference AS
SELECT
    a.design,
    b.design AS other_design,
    a.pmv_limit,
    a.pmv_min,
    a.pmv_max,
    a.sorted_by,
    a.class,
    a.class_order,
    a.weight,
    CAST(b.hvac_power_w - a.hvac_power_w AS DOUBLE) AS other_takes_more_w
FROM energy_class AS a
JOIN energy_class AS b
    ON b.pmv_min = a.pmv_min AND b.pmv_max = a.pmv_max AND b.sorted_by = a.sorted_by AND b.class = a.class
WHERE a.design <> b.design AND a.sorted_by <> 'PMV';

-- Where heat goes at each optimum, from its stored state and the coefficients of the bus. Doors and sun are what is left of the
-- balances of the cabin and of the surfaces, which an optimum meets (paper, eq. odes with all derivatives zero).
CREATE VIEW heat_flow AS
WITH flow AS (
    SELECT
        p.sample_id,
        p.design_id,
        p.window_id,
        (p.cabin_k - p.shell_inside_k) * h.convection_shell_inside_w_k AS cabin_to_shell_w,
        (p.interior_k - p.cabin_k) * h.convection_interior_w_k AS interior_to_cabin_w,
        (p.shell_outside_k - s.ambient_temperature_k) * h.convection_shell_outside_w_k AS shell_to_ambient_w,
        (p.radiant_heater_k - p.cabin_k) * h.convection_radiant_heater_w_k AS heater_to_cabin_w,
        (p.shell_inside_k - p.shell_outside_k) * h.conduction_shell_w_k AS through_shell_w,
        (p.shell_outside_k * p.shell_outside_k * p.shell_outside_k * p.shell_outside_k
            - s.ambient_temperature_k * s.ambient_temperature_k * s.ambient_temperature_k * s.ambient_temperature_k)
            * h.radiation_shell_outside_w_k4 AS shell_radiation_w,
        (p.radiant_heater_k * p.radiant_heater_k * p.radiant_heater_k * p.radiant_heater_k
            - p.shell_inside_k * p.shell_inside_k * p.shell_inside_k * p.shell_inside_k)
            * h.radiation_heater_shell_w_k4 AS heater_to_shell_w,
        (p.radiant_heater_k * p.radiant_heater_k * p.radiant_heater_k * p.radiant_heater_k
            - p.interior_k * p.interior_k * p.interior_k * p.interior_k)
            * h.radiation_heater_interior_w_k4 AS heater_to_interior_w,
        (p.interior_k * p.interior_k * p.interior_k * p.interior_k
            - p.shell_inside_k * p.shell_inside_k * p.shell_inside_k * p.shell_inside_k)
            * h.radiation_interior_shell_w_k4 AS interior_to_shell_w,
        s.passengers * h.passenger_heat_w AS passengers_w,
        h.other_heat_w AS other_w,
        p.air_unit_heat_w,
        p.radiant_heater_power_w,
        CASE p.operating_mode
            WHEN 1 THEN p.cabin_k - s.ambient_temperature_k
            WHEN -1 THEN s.ambient_temperature_k - p.cabin_k
        END AS lift_k,
        CASE WHEN p.air_unit_power_w > 0.0 THEN abs(p.air_unit_heat_w) / p.air_unit_power_w END AS cop
    FROM optimum_point AS p
    JOIN hourly_sample AS s ON s.sample_id = p.sample_id
    JOIN heat_transfer AS h ON h.one = 1
    WHERE p.status = 0
)
SELECT
    f.sample_id,
    d.name AS design,
    w.pmv_limit,
    w.pmv_min,
    w.pmv_max,
    CAST(f.cabin_to_shell_w AS DOUBLE) AS cabin_to_shell_w,
    CAST(f.interior_to_cabin_w AS DOUBLE) AS interior_to_cabin_w,
    CAST(f.shell_to_ambient_w AS DOUBLE) AS shell_to_ambient_w,
    CAST(f.heater_to_cabin_w AS DOUBLE) AS heater_to_cabin_w,
    CAST(f.through_shell_w AS DOUBLE) AS through_shell_w,
    CAST(f.shell_radiation_w AS DOUBLE) AS shell_radiation_w,
    CAST(f.heater_to_shell_w AS DOUBLE) AS heater_to_shell_w,
    CAST(f.heater_to_interior_w AS DOUBLE) AS heater_to_interior_w,
    CAST(f.interior_to_shell_w AS DOUBLE) AS interior_to_shell_w,
    CAST(f.air_unit_heat_w + (f.passengers_w + f.other_w) + f.heater_to_cabin_w + f.interior_to_cabin_w
        - f.cabin_to_shell_w AS DOUBLE) AS door_w,
    CAST(f.passengers_w AS DOUBLE) AS passengers_w,
    CAST(f.other_w AS DOUBLE) AS other_w,
    f.air_unit_heat_w,
    f.radiant_heater_power_w,
    CAST(f.interior_to_cabin_w + f.interior_to_shell_w - f.heater_to_interior_w AS DOUBLE) AS solar_interior_w,
    CAST(f.through_shell_w - f.cabin_to_shell_w - f.heater_to_shell_w - f.interior_to_shell_w AS DOUBLE)
        AS solar_shell_inside_w,
    CAST(f.shell_to_ambient_w + f.shell_radiation_w - f.through_shell_w AS DOUBLE) AS solar_shell_outside_w,
    CAST(f.lift_k AS DOUBLE) AS lift_k,
    CAST(f.cop AS DOUBLE) AS cop
FROM flow AS f
JOIN hvac_design AS d ON d.design_id = f.design_id
JOIN comfort_window AS w ON w.window_id = f.window_id;
