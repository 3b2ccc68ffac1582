"""The sun of the Astronomical Almanac (Michalsky 1988, good to 0.01 degrees), with Python's standard library alone."""

import math
from datetime import datetime, timezone


def utc(text):
    return datetime.fromisoformat(text.replace("Z", "+00:00"))


def sun(moment, latitude, longitude):
    """Altitude and azimuth in degrees."""
    n = (moment - datetime(2000, 1, 1, 12, tzinfo=timezone.utc)).total_seconds() / 86400
    mean_longitude = 280.460 + 0.9856474 * n
    anomaly = math.radians(357.528 + 0.9856003 * n)
    ecliptic = math.radians(mean_longitude + 1.915 * math.sin(anomaly) + 0.020 * math.sin(2 * anomaly))
    obliquity = math.radians(23.439 - 0.0000004 * n)
    ascension = math.atan2(math.cos(obliquity) * math.sin(ecliptic), math.cos(ecliptic))
    declination = math.asin(math.sin(obliquity) * math.sin(ecliptic))
    hour = moment.hour + moment.minute / 60 + moment.second / 3600
    sidereal = 6.697375 + 0.0657098242 * n + hour + longitude / 15
    angle = math.radians(sidereal * 15) - ascension
    phi = math.radians(latitude)
    sine = math.sin(declination) * math.sin(phi) + math.cos(declination) * math.cos(phi) * math.cos(angle)
    east = -math.cos(declination) * math.sin(angle)
    north = math.sin(declination) * math.cos(phi) - math.cos(declination) * math.sin(phi) * math.cos(angle)
    return math.degrees(math.asin(sine)), math.degrees(math.atan2(east, north)) % 360
