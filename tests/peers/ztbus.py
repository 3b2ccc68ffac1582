"""Missions of ZTBus, with Python's standard library alone."""

import csv


def telemetry(path):
    """Passengers and open doors of every second; a missing value is the one before."""
    seconds, passengers, door = [], 0.0, 0.0
    with open(path, encoding="utf-8", newline="") as f:
        for row in csv.DictReader(f):
            if row["itcs_numberOfPassengers"] != "NaN":
                passengers = float(row["itcs_numberOfPassengers"])
            if row["status_doorIsOpen"] != "NaN":
                door = float(row["status_doorIsOpen"])
            seconds.append((passengers, door))
    return seconds
