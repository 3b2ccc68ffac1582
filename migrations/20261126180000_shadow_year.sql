-- The shade of the year that samples were made with.
--
-- Serves: the figure of the shadow fraction (paper, figure shadow-fraction), which reports draw without any input.
-- Cost: 70 kB.

CREATE TABLE shadow_year (
    one       INTEGER PRIMARY KEY CHECK (one = 1),
    hourly    BLOB NOT NULL,  -- 8760 f64, little endian: the full hours of a year of 365 days from 1 January 00:00 UTC
    row_check INTEGER
) STRICT;

-- The next run of `shade` fills it: what it was last done with counts as unknown.
UPDATE source_file SET reading_key = '' WHERE kind = 'shadow';
