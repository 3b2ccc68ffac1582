-- Excluded segments go with the segments that they are.
--
-- Serves: a mission that is withdrawn, whose excluded segments stayed.
-- Cost: nothing.

DELETE FROM excluded_segment
WHERE NOT EXISTS (SELECT 1 FROM mission_segment AS g
    WHERE g.mission = excluded_segment.mission AND g.segment = excluded_segment.segment);
CREATE TRIGGER segment_gone AFTER DELETE ON mission_segment
BEGIN DELETE FROM excluded_segment WHERE mission = OLD.mission AND segment = OLD.segment; END;
