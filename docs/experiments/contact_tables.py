"""The tables of docs/behaviour.md from the CSV files beside this one."""
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
import tables  # noqa: E402
from tables import markdown  # noqa: E402

DOCUMENT = os.path.join(HERE, "..", "behaviour.md")
ENGINES = ("LIGGGHTS", "LAMMPS", "YADE")


def read(name):
    return tables.read(os.path.join(HERE, f"contact-{name}.csv"))


def pick(rows, **wanted):
    return [row for row in rows if all(row[name] == value for name, value in wanted.items())]


def span(rows, field, digits=3):
    """One number, or the least and the greatest of several that differ in what is shown."""
    values = sorted(float(row[field]) for row in rows)
    shown = [f"{value:.{digits}f}" for value in (values[0], values[-1])]
    return shown[0] if shown[0] == shown[1] else " to ".join(shown)


def table_impacts(rotation):
    rows, out = pick(read("impacts"), rotation=rotation), []
    if rotation == "free":
        rows = [r for r in rows if abs(float(r["e"]) - float(find_locked(r)["e"])) > 2e-3]
    for shape, impact, n in dict.fromkeys((r["shape"], r["impact"], r["spheres"]) for r in rows):
        these = pick(rows, shape=shape, impact=impact, spheres=n)
        for speeds in split_speeds(these):
            same = [r for r in these if r["speed"] in speeds]
            by = {engine: pick(same, engine=engine) for engine in ENGINES}
            both = by["LIGGGHTS"] + by["LAMMPS"]
            out.append([shape, impact, n, ", ".join(speeds), span(same, "touching", 0), span(both, "number", 2),
                        span(both, "closed"), span(by["LIGGGHTS"], "e"), span(by["LAMMPS"], "e"),
                        span(by["YADE"], "closed"), span(by["YADE"], "e")])
    return markdown(["body", "impact", "spheres", "speed, m/s", "touch", "N", "e(N)", "LIGGGHTS", "LAMMPS",
                     "e(N), YADE's", "YADE"], out)


def find_locked(row):
    (locked,) = pick(read("impacts"), rotation="locked", **{k: row[k] for k in ("engine", "shape", "spheres", "impact",
                                                                              "speed")})
    return locked


def split_speeds(rows):
    """Those at which the engines give the same to a thousandth stand in one line."""
    groups = []
    for speed in dict.fromkeys(r["speed"] for r in rows):
        now = [float(r["e"]) for r in pick(rows, speed=speed)]
        if groups and all(abs(a - b) < 1e-3 for a, b in zip(groups[-1][1], now)):
            groups[-1][0].append(speed)
        else:
            groups.append(([speed], now))
    return [speeds for speeds, _ in groups]


def table_agreement():
    rows, out = read("impacts"), []
    for engine in ENGINES:
        line = [engine]
        for rotation in ("locked", "free"):
            these = pick(rows, engine=engine, rotation=rotation)
            line.append(f"{max(abs(float(r['e']) - float(r['oracle'])) for r in these):.5f}")
        level = [r for r in pick(rows, engine=engine, rotation="locked") if r["touching"] == "1"
                 or r["shape"] == "cube"]
        line.append(f"{max(abs(float(r['e']) - float(r['closed'])) for r in level):.5f}")
        out.append(line)
    return markdown(["engine", "oscillator, locked", "oscillator, free", "e(N), cube and single contacts, locked"], out)


def table_masses():
    rows = read("masses")
    return markdown(["engine", "sphere over body", "contacts", "e", "if the body damps", "if the sphere does"],
                    [[r["engine"], r["member"], r["feet"]] +
                     [f"{float(r[k]):.3f}" for k in ("e", "by_body", "by_member")]
                     for r in rows])


def table_walls():
    return markdown(["engine", "force of a plane over that of Hertz"],
                    [[r["engine"], f"{float(r['over_hertz']):.4f}"] for r in read("walls")])


def step_rows(case, first):
    rows, out = pick(read("steps"), case=case), []
    for key in dict.fromkeys(tuple(r[name] for name in ("law", "restitution", "radius", "feet", "arm")) for r in rows):
        these = [r for r in rows if tuple(r[name] for name in ("law", "restitution", "radius", "feet", "arm")) == key]
        by = {r["engine"]: r for r in these}
        out.append(first(these[0]) + [f"{float(by[e]['over_theory']):.3f}" if e in by else "-" for e in ENGINES]
                   + [f"{float(by[e][k]):.2f}" if e in by else "-" for k in ("over_rayleigh", "over_rayleigh_eq")
                      for e in ENGINES[:1]])
    return out


TAIL = ["LIGGGHTS", "LAMMPS", "YADE", "over its Rayleigh time", "over that of r_eq"]


def table_step_radius():
    return markdown(["law", "r / r_eq"] + TAIL, step_rows("radius", lambda r: [r["law"], r["radius"]]))


def table_step_number():
    return markdown(["e of one contact", "contacts"] + TAIL,
                    step_rows("number", lambda r: [r["restitution"], r["feet"]]))


def table_step_arm():
    return markdown(["lever / r_eq"] + TAIL, step_rows("arm", lambda r: [r["arm"]]))


def table_cost():
    out = []
    for name in ("walls", "masses", "impacts", "steps"):
        rows = read(name)
        out.append([name, str(len(rows)), f"{sum(float(r['cpu']) for r in rows) / 60:.1f}"])
    return markdown(["part", "rows", "CPU minutes"], out)


TABLES = {"locked": lambda: table_impacts("locked"), "free": lambda: table_impacts("free"),
          "agreement": table_agreement, "masses": table_masses, "walls": table_walls, "step-radius": table_step_radius,
          "step-number": table_step_number, "step-arm": table_step_arm, "cost": table_cost}


def fill():
    tables.fill(DOCUMENT, {name: make() for name, make in TABLES.items()})
