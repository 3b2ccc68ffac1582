"""One mission simulated in closed loop, from the paper's equations and ISO 7730 alone.

    mission.py CASES.json

The cases name a mission (ZTBus), a weather file (hours from interval_start_utc: T_degC, DNI_Wm2, DHI_Wm2), a shadow file, the place, where
passengers stand, and for each case the design and what the optimum of each hour prescribes, or a causal controller with its setpoints over
the ambient temperature, and the comfort windows that judge it. Printed is a line for each case: mean power in W, largest 15-minute vote,
share of the time at a power limit, tracking error in K, mean absolute 15-minute vote of the passengers, and for each window the hours that
passengers ride outside it.

Nothing is shared with the program: view factors are double integrals over both areas, the sun is that of the Almanac, every passenger has
a vote of his own, in double precision by numpy. What the paper does not say is what the program's documents say: controllers are asked once
a second, at a limit the integral stands still where it would wind up, resistive heaters hold 70 degrees Celsius by a loop of their own.
"""

import csv
import json
import sys
from datetime import datetime, timedelta, timezone

import numpy as np
from almanac import sun, utc
from ztbus import telemetry

SIGMA, A_S, A_INT, A_RH = 5.67e-8, 199.5, 20.0, 4.0
H_IN, H_OUT, H_RH, K = 8.01, 20.67, 2.1, 6.86
CAPACITIES = np.array([4.8e3, 78e3, 146.6e3, 856.1e3, 856.1e3])
RHO, CP, CD, G, DOOR_H, DOOR_W = 1.25, 1005.0, 0.6, 9.81, 1.95, 4.42
HEAT_PUMP_LIMIT, PTC_LIMIT, COOLING_LIMIT, HEATER_LIMIT = 12e3, 60e3, 12e3, 6e3


def view_factors(positions, points=6):
    """Of upright cuboids, 0.25 m square and 1.7 m high, to 8 by 2 panels of 0.5 m square at a height of 2.4 m."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    on, by = (nodes + 1) / 2, weights / 2

    def integral(corner, edge_u, edge_v, normal, panel):
        """Double integral of cos cos / (pi r^2) over a face and the part of a panel in front of it."""
        (x0, x1), (y0, y1) = panel
        face = corner + on[:, None, None] * edge_u + on[None, :, None] * edge_v
        lit = np.stack(np.meshgrid(x0 + on * (x1 - x0), y0 + on * (y1 - y0), [2.4], indexing="ij"), -1)[:, :, 0]
        ray = lit[None, None] - face[:, :, None, None]
        square = (ray**2).sum(-1)
        kernel = (ray @ normal) * ray[..., 2] / (np.pi * square**2)
        area = np.linalg.norm(np.cross(edge_u, edge_v)) * (x1 - x0) * (y1 - y0)
        return area * np.einsum("i,j,k,l,ijkl", by, by, by, by, kernel)

    panels = []
    for row in range(8):
        for column in range(2):
            x, y = (row + 0.5) * 18.7 / 8, (column + 0.5) * 2.6 / 2
            panels.append(((x - 0.25, x + 0.25), (y - 0.25, y + 0.25)))
    e = np.eye(3)
    side, top = 0.25 * 1.7, 0.25**2
    views = []
    for x, y in positions:
        total = 0.0
        for (x0, x1), (y0, y1) in panels:
            low = np.array([x - 0.125, y - 0.125, 0.0])
            total += integral(low + 1.7 * e[2], 0.25 * e[0], 0.25 * e[1], e[2], ((x0, x1), (y0, y1)))
            if x1 > x + 0.125:
                total += integral(low + 0.25 * e[0], 0.25 * e[1], 1.7 * e[2], e[0], ((max(x0, x + 0.125), x1), (y0, y1)))
            if x0 < x - 0.125:
                total += integral(low, 0.25 * e[1], 1.7 * e[2], -e[0], ((x0, min(x1, x - 0.125)), (y0, y1)))
            if y1 > y + 0.125:
                total += integral(low + 0.25 * e[1], 0.25 * e[0], 1.7 * e[2], e[1], ((x0, x1), (max(y0, y + 0.125), y1)))
            if y0 < y - 0.125:
                total += integral(low, 0.25 * e[0], 1.7 * e[2], -e[1], ((x0, x1), (y0, min(y1, y - 0.125))))
        views.append(total / (4 * side + top))
    return np.array(views)


class Surroundings:
    """Weather between the middles of the hours, shade between full hours, the sun where it stands."""

    def __init__(self, weather, shadow, place):
        with open(weather, encoding="utf-8") as f:
            rows = list(csv.DictReader(f))
        self.middles = [utc(r["interval_start_utc"]).timestamp() + 1800 for r in rows]
        self.weather = [[float(r[name]) for r in rows] for name in ("T_degC", "DNI_Wm2", "DHI_Wm2")]
        with open(shadow, encoding="utf-8") as f:
            self.shadow = {utc(r["time_utc"]).strftime("%m-%d %H"): float(r["shadow_fraction"]) for r in csv.DictReader(f)}
        self.place = place

    def at(self, moment):
        """Ambient temperature in K and the sun on interior, inside and outside of the shell in W."""
        celsius, dni, dhi = (float(np.interp(moment.timestamp(), self.middles, values)) for values in self.weather)
        altitude = np.radians(sun(moment, *self.place)[0])
        roof = max(np.sin(altitude), 0) * dni + dhi
        walls = 102.2 * ((np.cos(altitude) / np.pi * dni if altitude > 0 else 0.0) + 0.5 * dhi)
        hour = moment.replace(minute=0, second=0)
        first, second = (self.shadow[h.strftime("%m-%d %H")] for h in (hour, hour + timedelta(hours=1)))
        lit = 1 - (first + (second - first) * (moment - hour).total_seconds() / 3600)
        inside = lit * walls * 0.354 * 0.46
        outside = lit * 0.3 * (48.6 * roof * (1 - 0.66) + walls * (1 - 0.354))
        return celsius + 273.15, np.array([0.3 * inside, 0.7 * inside, outside])


class Passengers:
    """Their votes; clothing is carried from second to second."""

    def __init__(self, views):
        self.views, self.surface = views, None

    def vote(self, temperatures, ambient):
        heater, interior, cabin, inside, _ = temperatures
        t = ambient - 273.15
        clo = max(1.372 - 0.01866 * t - 0.0004849 * t**2 - 0.000009333 * t**3, 0.3)
        insulation, met = 0.155 * clo, 1.2 * 58.15
        factor = 1 + 1.29 * insulation if insulation <= 0.078 else 1.05 + 0.645 * insulation
        radiant = (self.views * heater**4 + 0.3 * interior**4 + (0.7 - self.views) * inside**4) ** 0.25 - 0.15
        air = cabin - 0.15
        if self.surface is None:
            self.surface = np.full_like(self.views, air + 5)
            self.vote(temperatures, ambient)
        for _ in range(40):
            difference = self.surface - air
            natural = 2.38 * np.abs(difference) ** 0.25
            forced = 12.1 * np.sqrt(0.1)
            hc = np.maximum(natural, forced)
            dry = factor * (3.96e-8 * (self.surface**4 - radiant**4) + hc * difference)
            slope = factor * (4 * 3.96e-8 * self.surface**3 + np.where(natural > forced, 1.25 * hc, hc))
            step = (self.surface + insulation * dry - (308.7 - 0.028 * met)) / (1 + insulation * slope)
            self.surface = self.surface - step
            if np.abs(step).max() < 1e-7:
                break
        dry = dry - slope * step
        air_c = cabin - 273.15
        pa = 400 * np.exp(16.6536 - 4030.183 / (air_c + 235))
        loss = 0.00305 * (5733 - 6.99 * met - pa) + 0.42 * (met - 58.15) + 1.7e-5 * met * (5867 - pa) + 0.0014 * met * (34 - air_c)
        return float(((0.303 * np.exp(-0.036 * met) + 0.028) * (met - loss - dry)).mean())


def pi(gain, integral_s, error, integral, low, high):
    """Command, the integral afterwards, and by how much a limit holds it back."""
    following = integral + gain * error / integral_s
    wanted = gain * error + following
    command = min(max(wanted, low), high)
    return command, following if (wanted - command) * error <= 0 else integral, wanted - command


class Hourly:
    """What the optima of the hours prescribe."""

    def __init__(self, hours):
        self.hours = hours

    def decide(self, second, mode, cabin, ambient):
        """Mode, setpoint, whether heaters and curtains run."""
        hour = self.hours[second // 3600]
        return hour["mode"], hour["cabin_k"], hour["heaters"], hour["curtain"]


class Causal:
    """The paper's state machine on setpoints over the ambient temperature."""

    def __init__(self, given):
        self.curves = [np.array(given[mode]) for mode in ("heating", "cooling")]
        self.above, self.below = given["curtain_above_k"], given["heaters_below_c"]

    def decide(self, second, mode, cabin, ambient):
        heat, cool = (np.interp(ambient - 273.15, curve[:, 0], curve[:, 1]) + 273.15 for curve in self.curves)
        if mode == 0 or (mode > 0 and cabin > heat + 1) or (mode < 0 and cabin < cool - 1):
            mode = 1 if cabin < heat else -1 if cabin > cool else 0
        curtain = mode != 0 and mode * (cabin - ambient) > self.above[0 if mode > 0 else 1]
        return mode, cool if mode < 0 else heat, ambient - 273.15 < self.below, curtain


def simulate(case, seconds, minutes, views):
    heat_pump = case["heat_pump"]
    law = Causal(case["causal"]) if "causal" in case else Hourly(case["hours"])
    depot = 0.5 * (minutes[0][0] - 293.15) + 293.15
    # Heaters, interior, cabin, inside and outside of the shell; heat of the machine.
    x = np.array([depot] * 5 + [0.0])
    people = Passengers(views)
    mode, heaters_on, integral, heater_integral = 0, False, 0.0, 0.0
    votes, energy, held, tracked, largest = [], 0.0, 0, [], 0.0
    windows = case.get("windows", [])
    boarded, votes_felt, outside = 0.0, 0.0, [0.0] * len(windows)
    for second in range(60 * len(minutes)):
        (passengers, door), (ambient, solar) = seconds[second], minutes[second // 60]
        doors = 0.6 * door
        new_mode, setpoint, new_heaters, curtain = law.decide(second, mode, x[2], ambient)
        if new_mode != mode:
            mode, integral = new_mode, 0.0
        if new_heaters != heaters_on:
            heaters_on, heater_integral = new_heaters, 0.0
        power = 0.0
        if mode != 0:
            low, high = (0.0, HEAT_PUMP_LIMIT if heat_pump else PTC_LIMIT) if mode > 0 else (-COOLING_LIMIT, 0.0)
            power, integral, beyond = pi(2000.0, 100.0, setpoint - x[2], integral, low, high)
            held += mode * beyond > 0
        heater_power = 0.0
        if heaters_on:
            heater_power, heater_integral, _ = pi(100.0, 100.0, 343.15 - x[0], heater_integral, 0.0, HEATER_LIMIT)
        exchange = RHO * CP * CD * np.sqrt(G * DOOR_H**3) * DOOR_W / 3 / np.sqrt(ambient) * doors
        exchange *= 0.4 if curtain else 1.0

        def slopes(x):
            heater, interior, cabin, inside, outside, machine = x
            lift = cabin - ambient
            if power < 0:
                cop = min(max(3.05 + 0.09 * lift, 1), 4)
            else:
                cop = min(max(74.13 / (max(lift, 0) + 16.79), 1), 4.5) if heat_pump else 1.0
            at_once = power if power >= 0 and not heat_pump else 0.0
            conv_in, conv_int = H_IN * A_S * (cabin - inside), H_IN * A_INT * (interior - cabin)
            conv_rh, conv_out = H_RH * A_RH * (heater - cabin), H_OUT * A_S * (outside - ambient)
            cond = K * A_S * (inside - outside)
            rad_out = SIGMA * A_S * (outside**4 - ambient**4)
            rad_rh_int, rad_rh_s = SIGMA * A_RH * 0.3 * (heater**4 - interior**4), SIGMA * A_RH * 0.7 * (heater**4 - inside**4)
            rad_int_s = SIGMA * A_INT * 0.94 * (interior**4 - inside**4)
            lost = exchange * np.sqrt(abs(lift)) * lift
            net = np.array(
                [
                    heater_power - conv_rh - rad_rh_int - rad_rh_s,
                    solar[0] + rad_rh_int - conv_int - rad_int_s,
                    125.3 * passengers + 1000.0 + machine + at_once + conv_rh + conv_int - conv_in - lost,
                    conv_in + solar[1] + rad_rh_s + rad_int_s - cond,
                    cond + solar[2] - conv_out - rad_out,
                ]
            )
            return np.append(net / CAPACITIES, ((0.0 if at_once else cop * power) - machine) / 20.0)

        # Heun's method with a Richardson step: once over the second, twice over its halves.
        def heun(x, h):
            first = slopes(x)
            return x + h / 2 * (first + slopes(x + h * first))

        x = (4 * heun(heun(x, 0.5), 0.5) - heun(x, 1.0)) / 3
        energy += abs(power) + heater_power + (1020.0 * doors if curtain else 0.0)
        votes.append(people.vote(x[:5], ambient))
        if passengers > 0:
            last = votes[-900:]
            felt = sum(last) / len(last)
            boarded += passengers
            votes_felt += passengers * abs(felt)
            outside = [o + passengers * (felt < low or felt > high) for o, (low, high) in zip(outside, windows)]
            if passengers >= 1:
                largest = max(largest, abs(felt))
        if mode != 0:
            tracked.append(x[2] - setpoint)
    rms = float(np.sqrt(np.mean(np.square(tracked)))) if tracked else 0.0
    return [energy / len(votes), largest, held / len(votes), rms, votes_felt / max(boarded, 1.0)] + [o / 3600 for o in outside]


def main():
    with open(sys.argv[1], encoding="utf-8") as f:
        given = json.load(f)
    seconds = telemetry(given["mission"])
    name = given["mission"].replace("\\", "/").split("/")[-1]
    start = datetime.strptime(name[5:24], "%Y-%m-%d_%H-%M-%S").replace(tzinfo=timezone.utc)
    views = view_factors(given["positions"])
    out = csv.writer(sys.stdout)
    out.writerow(["views"] + [repr(float(v)) for v in (views.min(), views.mean(), views.max())] + [""])
    minutes = {}
    for case in given["cases"]:
        if case["weather"] not in minutes:
            around = Surroundings(case["weather"], given["shadow"], given["place"])
            middles = (start + timedelta(seconds=60 * m + 30) for m in range(60 * given["hours"]))
            minutes[case["weather"]] = [around.at(middle) for middle in middles]
        out.writerow([case["name"]] + [repr(float(v)) for v in simulate(case, seconds, minutes[case["weather"]], views)])


main()
