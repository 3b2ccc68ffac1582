"""Hourly samples of one ZTBus mission, computed independently with Python's standard library alone.

    samples.py MISSION.csv WEATHER.csv SHADOW.csv LATITUDE LONGITUDE

The weather file has hourly rows, stamped at the start: interval_start_utc, T_degC, StrGlo_Wm2.
The sun is that of the Astronomical Almanac (Michalsky 1988, good to 0.01 degrees).
"""

import csv
import math
import sys
from datetime import datetime, timedelta, timezone

from almanac import sun, utc
from ztbus import telemetry


def erbs(ghi, altitude, day):
    """Direct normal and diffuse irradiance; below 3 degrees all is diffuse."""
    b = 2 * math.pi * (day - 1) / 365
    outside = 1366.1 * (
        1.00011 + 0.034221 * math.cos(b) + 0.00128 * math.sin(b) + 0.000719 * math.cos(2 * b) + 0.000077 * math.sin(2 * b)
    )
    sine = math.sin(math.radians(altitude))
    if altitude < 3:
        return 0.0, ghi
    kt = min(ghi / (outside * max(sine, 0.065)), 1.0)
    if kt <= 0.22:
        share = 1 - 0.09 * kt
    elif kt <= 0.8:
        share = 0.9511 - 0.1604 * kt + 4.388 * kt**2 - 16.638 * kt**3 + 12.336 * kt**4
    else:
        share = 0.165
    dni = min((1 - share) * ghi / sine, outside)
    return dni, ghi - dni * sine


def main():
    mission, weather_file, shadow_file = sys.argv[1:4]
    latitude, longitude = float(sys.argv[4]), float(sys.argv[5])
    with open(weather_file, encoding="utf-8") as f:
        weather = {utc(r["interval_start_utc"]): r for r in csv.DictReader(f)}
    with open(shadow_file, encoding="utf-8") as f:
        shadow = {utc(r["time_utc"]).strftime("%m-%d %H"): float(r["shadow_fraction"]) for r in csv.DictReader(f)}

    seconds = telemetry(mission)
    name = mission.replace("\\", "/").split("/")[-1]
    start = datetime.strptime(name[5:24], "%Y-%m-%d_%H-%M-%S").replace(tzinfo=timezone.utc)

    out = csv.writer(sys.stdout)
    out.writerow(
        "segment start_utc passengers door_open_fraction ambient_temperature_c dni_w_m2 dhi_w_m2 "
        "solar_altitude_deg solar_azimuth_deg shadow_fraction".split()
    )
    for segment in range(len(seconds) // 3600):
        part = seconds[segment * 3600 : (segment + 1) * 3600]
        begin = start + timedelta(hours=segment)
        temperature = dni = dhi = shade = 0.0
        # Second by second: no cleverness that both programs could share.
        for i in range(3600):
            moment = begin + timedelta(seconds=i)
            hour = moment.replace(minute=0, second=0)
            row = weather[hour]
            temperature += float(row["T_degC"]) / 3600
            middle = hour + timedelta(minutes=30)
            beam, diffuse = erbs(float(row["StrGlo_Wm2"]), sun(middle, latitude, longitude)[0], middle.timetuple().tm_yday)
            dni += beam / 3600
            dhi += diffuse / 3600
            share = (moment - hour).total_seconds() + 0.5
            first = shadow[hour.strftime("%m-%d %H")]
            second = shadow[(hour + timedelta(hours=1)).strftime("%m-%d %H")]
            shade += (first + (second - first) * share / 3600) / 3600
        altitude, azimuth = sun(begin + timedelta(minutes=30), latitude, longitude)
        out.writerow(
            [segment, begin.strftime("%Y-%m-%dT%H:%M:%SZ")]
            + [sum(p for p, _ in part) / 3600, 0.6 * sum(d for _, d in part) / 3600]
            + [temperature, dni, dhi, altitude, azimuth, shade]
        )


main()
