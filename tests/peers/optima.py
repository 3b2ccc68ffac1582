"""The paper's four problems by CasADi, Ipopt and MUMPS, with the exact PMV and the exact door law.

    optima.py CASES.csv VIEW_FACTOR...

A case is a line: ambient temperature in K, solar gains of interior, inside and outside of the shell in W, passengers, open share of the
doors, design, least PMV, largest PMV. For each case the least power in W over all choices of heaters and curtain is printed, and the
heaters and curtain it has; last a line with the number of problems and the seconds that Ipopt took. The clothing temperature of every
passenger is a variable of its own. Written from the paper's equations and ISO 7730 alone.
"""

import csv
import sys
import time

import casadi as ca

SIGMA, A_S, A_INT, A_RH = 5.67e-8, 199.5, 20.0, 4.0
H_IN, H_OUT, H_RH, K = 8.01, 20.67, 2.1, 6.86
RHO, CP, CD, G, DOOR_H, DOOR_W = 1.25, 1005.0, 0.6, 9.81, 1.95, 4.42
TARGET = 343.15
# name: heat pump, radiant heaters, curtain
DESIGNS = {
    "ptc": (False, False, False),
    "ptc+rh": (False, True, False),
    "hp": (True, False, False),
    "hp+rh": (True, True, False),
    "hp+curtain": (True, False, True),
}


def clothing(ambient):
    t = ambient - 273.15
    return max(1.372 - 0.01866 * t - 0.0004849 * t**2 - 0.000009333 * t**3, 0.3)


def problem(heat_pump, heaters, curtain, views):
    """Solver of one choice; what differs between cases are parameters."""
    p = ca.MX.sym("p", 7)
    ambient, sun_int, sun_in, sun_out, passengers, doors, clo = ca.vertsplit(p)
    x = ca.MX.sym("x", 8 + len(views))
    cabin, interior, inside, outside, heater, heat, cool, power = ca.vertsplit(x[:8])
    surfaces = ca.vertsplit(x[8:])

    lift = cabin - ambient
    cop_heat = ca.fmin(ca.fmax(74.13 / (ca.fmax(lift, 0) + 16.79), 1), 4.5) if heat_pump else 1.0
    cop_cool = ca.fmin(ca.fmax(3.05 + 0.09 * lift, 1), 4)
    blowers = 1.020 * doors if curtain else 0
    objective = heat / cop_heat - cool / cop_cool + power + blowers

    # sqrt|lift| without the pole of its slope at 0: off by less than 1e-9 from 0.01 K on.
    root = ca.sqrt(ca.sqrt(lift * lift + 1e-12))
    door = RHO * CD * ca.sqrt(G * DOOR_H**3) * DOOR_W / 3 / ca.sqrt(ambient) * CP * root * lift * doors / 1e3
    if curtain:
        door *= 0.4
    conv_in = H_IN * A_S * (cabin - inside) / 1e3
    conv_int = H_IN * A_INT * (interior - cabin) / 1e3
    conv_rh = H_RH * A_RH * (heater - cabin) / 1e3
    conv_out = H_OUT * A_S * (outside - ambient) / 1e3
    cond = K * A_S * (inside - outside) / 1e3
    rad_out = SIGMA * A_S * (outside**4 - ambient**4) / 1e3
    rad_rh_int = SIGMA * A_RH * 0.30 * (heater**4 - interior**4) / 1e3
    rad_rh_s = SIGMA * A_RH * 0.70 * (heater**4 - inside**4) / 1e3
    rad_int_s = SIGMA * A_INT * 0.94 * (interior**4 - inside**4) / 1e3
    g = [
        power - conv_rh - rad_rh_int - rad_rh_s,
        sun_int + rad_rh_int - conv_int - rad_int_s,
        0.1253 * passengers + 1.0 + heat + cool + conv_rh + conv_int - conv_in - door,
        conv_in + sun_in + rad_rh_s + rad_int_s - cond,
        cond + sun_out - conv_out - rad_out,
    ]

    met, velocity = 1.2 * 58.15, 0.1
    icl = 0.155 * clo
    fcl = ca.if_else(icl <= 0.078, 1 + 1.29 * icl, 1.05 + 0.645 * icl)
    air_c = cabin - 273.15
    pa = 0.40 * 1000 * ca.exp(16.6536 - 4030.183 / (air_c + 235))
    votes = 0
    for view, surface in zip(views, surfaces):
        radiant = (view * heater**4 + (0.7 - view) * inside**4 + 0.3 * interior**4) ** 0.25 - 0.15
        difference = surface - (air_c + 273)
        natural = 2.38 * (difference * difference + 1e-9) ** 0.125
        hc = ca.fmax(12.1 * velocity**0.5, natural)
        dry = fcl * (3.96e-8 * (surface**4 - radiant**4) + hc * difference)
        g.append((308.7 - 0.028 * met - icl * dry - surface) / 10)
        loss = 0.00305 * (5733 - 6.99 * met - pa) + 0.42 * (met - 58.15) + 1.7e-5 * met * (5867 - pa) + 0.0014 * met * (34 - air_c)
        votes += (0.303 * ca.exp(-0.036 * met) + 0.028) * (met - loss - dry)
    g.append(votes / len(views))
    options = {
        "ipopt.print_level": 0,
        "print_time": False,
        "ipopt.sb": "yes",
        "ipopt.tol": 1e-10,
        "ipopt.constr_viol_tol": 1e-10,
        "ipopt.bound_relax_factor": 0.0,
        "ipopt.honor_original_bounds": "yes",
        "ipopt.max_iter": 500,
        "ipopt.linear_solver": "mumps",
    }
    return ca.nlpsol("optimum", "ipopt", {"x": x, "p": p, "f": objective, "g": ca.vertcat(*g)}, options)


def main():
    views = [float(v) for v in sys.argv[2:]]
    solvers = {
        (hp, rh, ac): problem(hp, rh, ac, views)
        for hp in (False, True)
        for rh in (False, True)
        for ac in (False, True)
    }
    equations = 5 + len(views)
    seconds, problems = 0.0, 0
    out = csv.writer(sys.stdout)
    with open(sys.argv[1], encoding="utf-8") as f:
        for row in csv.reader(f):
            ambient, sun_int, sun_in, sun_out, passengers, doors = (float(v) for v in row[:6])
            heat_pump, has_heaters, has_curtain = DESIGNS[row[6]]
            low, high = float(row[7]), float(row[8])
            parameters = [ambient, sun_int / 1e3, sun_in / 1e3, sun_out / 1e3, passengers, doors, clothing(ambient)]
            best = None
            for heaters in (False, True) if has_heaters else (False,):
                for curtain in (False, True) if has_curtain else (False,):
                    tr = TARGET if heaters else 295.0
                    start = [295.0, 295.0, 295.0, ambient, tr, 0.1, -0.1, 0.5 if heaters else 0.0] + [300.0] * len(views)
                    lower = [200.0] * 4 + [TARGET if heaters else 200.0, 0.0, -200.0, 0.0] + [200.0] * len(views)
                    upper = [400.0] * 4 + [TARGET if heaters else 400.0, 200.0, 0.0, 50.0 if heaters else 0.0] + [400.0] * len(views)
                    begin = time.perf_counter()
                    found = solvers[heat_pump, heaters, curtain](
                        x0=start, p=parameters, lbx=lower, ubx=upper, lbg=[0.0] * equations + [low], ubg=[0.0] * equations + [high]
                    )
                    seconds += time.perf_counter() - begin
                    problems += 1
                    stats = solvers[heat_pump, heaters, curtain].stats()
                    if not stats["success"]:
                        continue
                    power = 1e3 * float(found["f"])
                    if best is None or power < best[0]:
                        best = (power, int(heaters), int(curtain))
            out.writerow([repr(best[0]), best[1], best[2]] if best else ["nan", 0, 0])
    out.writerow([problems, repr(seconds), 0])


main()
