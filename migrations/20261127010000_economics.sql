-- What comfort costs in money and emissions, by the user's own figures.
--
-- Serves: whoever weighs the price of a heat pump against what it saves.
-- Cost: 150 bytes for each design and window of a study that has a section economics.

-- What the study says of each design, and what a yearly payment of 1 is worth over its life.
CREATE TABLE economic_input (
    design               TEXT PRIMARY KEY,
    design_order         INTEGER NOT NULL,
    currency             TEXT NOT NULL,
    price_per_kwh        REAL NOT NULL,
    carbon_kg_per_kwh    REAL,
    interest             REAL NOT NULL,
    investment           REAL NOT NULL,
    maintenance_per_year REAL NOT NULL,
    life_years           REAL NOT NULL,
    present_value_factor REAL NOT NULL,
    run_id               INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

-- The cost of each design in each window over its life, and against the first design that has figures.
CREATE TABLE economics (
    design                    TEXT NOT NULL,
    pmv_limit                 REAL NOT NULL,
    pmv_min                   REAL NOT NULL,
    pmv_max                   REAL NOT NULL,
    currency                  TEXT NOT NULL,
    kwh_per_bus_year          REAL,
    energy_cost_per_year      REAL,
    annual_cost               REAL,
    net_present_cost          REAL,
    emissions_kg_per_year     REAL,
    reference_design          TEXT NOT NULL,
    saved_kwh_per_year        REAL,
    saved_emissions_kg_per_year REAL,
    extra_cost_per_year       REAL,
    cost_per_saved_kwh        REAL,
    break_even_price_per_kwh  REAL,
    run_id                    INTEGER NOT NULL,
    PRIMARY KEY (design, pmv_min, pmv_max)
) STRICT, WITHOUT ROWID;
