-- Which study a database belongs to.
--
-- Serves: a run of another study file with the same database, which is refused instead of taking the first one's results away.
-- Cost: one row.

CREATE TABLE study (
    one  INTEGER PRIMARY KEY CHECK (one = 1),
    name TEXT NOT NULL
) STRICT;
