-- In how many hours a variant, or the bus in other conditions, lacks power.
--
-- Serves: whoever compares designs with limits, and must not take one that leaves passengers cold for the cheaper one.
-- Cost: two numbers for each variant, design and window. Variants and the sensitivity study are solved anew once.

ALTER TABLE variant_annual ADD COLUMN limited_count INTEGER NOT NULL DEFAULT 0;
ALTER TABLE variant_annual ADD COLUMN base_limited_count INTEGER NOT NULL DEFAULT 0;
ALTER TABLE sensitivity_result ADD COLUMN limited_count INTEGER NOT NULL DEFAULT 0;

-- It was not counted before, and the tables are not what was sealed.
DELETE FROM table_check WHERE table_name IN ('variant_annual', 'sensitivity_result');
DELETE FROM stage_record WHERE stage IN ('solve', 'sensitivity');
