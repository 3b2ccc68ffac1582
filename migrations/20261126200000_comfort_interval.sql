-- What more or less comfort costs, and how sure that is.
--
-- Serves: whoever says what a closer comfort window costs of the power at PMV ±1.
-- Cost: 24 bytes for each design and window. The averages are added up once more.

-- Power over that of the same design at PMV ±1, less 1, with an interval of 90 % from years drawn for both together; null where
-- the study has no such window.
ALTER TABLE annual_interval ADD COLUMN change_vs_pmv_1 REAL;
ALTER TABLE annual_interval ADD COLUMN change_vs_pmv_1_low REAL;
ALTER TABLE annual_interval ADD COLUMN change_vs_pmv_1_high REAL;

-- They were not drawn before, and the table is not what was sealed.
DELETE FROM table_check WHERE table_name = 'annual_interval';
INSERT OR IGNORE INTO stale_month VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12);
DELETE FROM stage_record WHERE stage = 'solve';
