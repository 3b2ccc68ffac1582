-- Buses that differ from the study's, and what the year depends on.
--
-- Serves: whoever asks what insulation, glazing or another heat pump would change, and which input matters most.
-- Cost: some 120 bytes for each variant, design and window; for each design, quantity and input; nothing by sample.

-- What each variant overrides.
CREATE TABLE variant_setting (
    variant    TEXT NOT NULL,
    name       TEXT NOT NULL,     -- as in the study file
    value      REAL NOT NULL,
    base_value REAL,
    run_id     INTEGER NOT NULL,
    PRIMARY KEY (variant, name)
) STRICT, WITHOUT ROWID;

-- Annual means of the variants beside those of the bus, over the same samples.
CREATE TABLE variant_annual (
    variant              TEXT NOT NULL,
    variant_order        INTEGER NOT NULL,  -- in the study file
    design               TEXT NOT NULL,
    pmv_limit            REAL NOT NULL,
    pmv_min              REAL NOT NULL,
    pmv_max              REAL NOT NULL,
    hvac_power_w         REAL,
    heating_power_w      REAL,
    cooling_power_w      REAL,
    base_hvac_power_w    REAL,
    base_heating_power_w REAL,
    base_cooling_power_w REAL,
    difference_w         REAL,
    relative_change      REAL,
    sample_count         INTEGER NOT NULL,
    unsolved_count       INTEGER NOT NULL,
    run_id               INTEGER NOT NULL,
    PRIMARY KEY (variant, design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;

-- What results come to where all inputs vary.
CREATE TABLE sensitivity_result (
    design         TEXT NOT NULL,
    pmv_limit      REAL NOT NULL,
    pmv_min        REAL NOT NULL,
    pmv_max        REAL NOT NULL,
    quantity       TEXT NOT NULL,
    base_value     REAL,
    mean_value     REAL NOT NULL,
    sd_value       REAL NOT NULL,
    low_value      REAL NOT NULL,  -- nine tenths of the sets lie between
    high_value     REAL NOT NULL,
    set_count      INTEGER NOT NULL,
    unsolved_count INTEGER NOT NULL,
    seed           INTEGER NOT NULL,
    run_id         INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, quantity)
) STRICT, WITHOUT ROWID;

-- One input at a time at its low and its high value.
CREATE TABLE sensitivity_swing (
    design      TEXT NOT NULL,
    pmv_limit   REAL NOT NULL,
    pmv_min     REAL NOT NULL,
    pmv_max     REAL NOT NULL,
    quantity    TEXT NOT NULL,
    input       TEXT NOT NULL,
    input_order INTEGER NOT NULL,
    input_base  REAL NOT NULL,
    input_low   REAL NOT NULL,
    input_high  REAL NOT NULL,
    base_value  REAL,
    low_value   REAL,
    high_value  REAL,
    run_id      INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, quantity, input)
) STRICT, WITHOUT ROWID;

-- Which share of the variance of a result each input explains.
CREATE TABLE sensitivity_index (
    design           TEXT NOT NULL,
    pmv_limit        REAL NOT NULL,
    pmv_min          REAL NOT NULL,
    pmv_max          REAL NOT NULL,
    quantity         TEXT NOT NULL,
    input            TEXT NOT NULL,
    input_order      INTEGER NOT NULL,
    first_order      REAL NOT NULL,
    first_order_low  REAL NOT NULL,
    first_order_high REAL NOT NULL,
    total_order      REAL NOT NULL,
    total_order_low  REAL NOT NULL,
    total_order_high REAL NOT NULL,
    run_id           INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max, quantity, input)
) STRICT, WITHOUT ROWID;
