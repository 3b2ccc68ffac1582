-- How sure the annual means of driven missions are, and how far they are from steady state.
--
-- Serves: whoever compares a simulated or controlled year with that of the optima.
-- Cost: 90 bytes for each design, window and controller. They are made anew whenever missions are driven.

CREATE TABLE simulation_interval (
    design                   TEXT NOT NULL,
    pmv_limit                REAL NOT NULL,
    pmv_min                  REAL NOT NULL,
    pmv_max                  REAL NOT NULL,
    controller               TEXT NOT NULL,
    mean_hvac_power_low_w    REAL,
    mean_hvac_power_high_w   REAL,
    relative_difference_low  REAL,           -- of simulated and steady power, drawn together
    relative_difference_high REAL,
    run_id                   INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, controller)
) STRICT, WITHOUT ROWID;

CREATE TABLE control_interval (
    design                   TEXT NOT NULL,
    pmv_limit                REAL NOT NULL,
    pmv_min                  REAL NOT NULL,
    pmv_max                  REAL NOT NULL,
    controller               TEXT NOT NULL,
    mean_hvac_power_low_w    REAL,
    mean_hvac_power_high_w   REAL,
    relative_difference_low  REAL,           -- of controlled and steady power, drawn together
    relative_difference_high REAL,
    run_id                   INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, controller)
) STRICT, WITHOUT ROWID;

-- The stages look once more at what is stored.
DELETE FROM stage_record WHERE stage IN ('simulate', 'control');
