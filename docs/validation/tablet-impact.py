#!/usr/bin/env python3
"""A tablet hits a wall: clumps in LIGGGHTS against rigid body mechanics (Yuan 2019, section 5.1).

    docs/validation/tablet-impact.py [FOLDER] [SPHERES...]      as: tablet-impact.py /tmp/tablet 96 500

MSKIT and LIGGGHTS name the programs. Makes the clumps, runs 20 angles with each, prints a table and writes it as CSV,
and as an SVG if gnuplot is installed.
"""
import csv
import math
import os
import shutil
import subprocess
import sys

MSKIT = os.environ.get("MSKIT", "mskit")
LIGGGHTS = os.environ.get("LIGGGHTS", "liggghts")

# Table 1 of the paper
BAND_RADIUS, BAND_HEIGHT, CAP_HEIGHT = 5.675e-3, 4.0e-3, 1.23e-3
MASS, VOLUME = 6.328e-4, 5.312e-7
SHEAR, POISSON, RESTITUTION, STEP = 1.15e9, 0.3, 0.6, 1e-7
CAP_RADIUS = (BAND_RADIUS ** 2 + CAP_HEIGHT ** 2) / (2 * CAP_HEIGHT)
ANGLES = [5.0 * k for k in range(18)] + [87.5, 90.0]

SCRIPT = """
atom_style granular
atom_modify map array
communicate single vel yes
boundary f f f
newton off
units si
region box block -0.02 0.02 -0.02 0.02 -0.02 0.02 units box
create_box 1 box
neighbor 1e-3 bin
neigh_modify delay 0
hard_particles yes
fix young all property/global youngsModulus peratomtype {young}
fix poisson all property/global poissonsRatio peratomtype {poisson}
fix restitution all property/global coefficientRestitution peratomtypepair 1 {restitution}
fix friction all property/global coefficientFriction peratomtypepair 1 0
pair_style gran model hertz tangential off
pair_coeff * *
timestep {step}
fix wall all wall/gran model hertz tangential off primitive type 1 zplane {wall}
{template}
fix kinds all particledistribution/discrete 15485867 1 clump 1.0
region above block -{side} {side} -{side} {side} -{side} {side} volume_limit 1e-300 units box
fix insert all insert/pack seed 32452843 distributiontemplate kinds vel constant 0 0 -1 orientation constant {turn} &
    insert_every once overlapcheck yes all_in no particles_in_region 1 region above
fix move all multisphere
run 1
dump states all custom 50 states.txt id x y z vx vy vz omegax omegay omegaz
dump_modify states first yes format "%d %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g"
run 20000
"""


def truth(theta, moment, restitution):
    """Velocity and spin after the impact by eqs. 9 to 11. The paper's eq. 11 has sine and cosine exchanged: as printed
    the two arms do not meet at the angle where the contact goes from cap to edge, and do not vanish at 0."""
    alpha = math.atan(BAND_HEIGHT / 2 / BAND_RADIUS)
    if theta < math.asin(BAND_RADIUS / CAP_RADIUS):
        arm = (CAP_RADIUS - CAP_HEIGHT - BAND_HEIGHT / 2) * math.sin(theta)
    else:
        arm = math.hypot(BAND_RADIUS, BAND_HEIGHT / 2) * math.cos(alpha + theta)
    e = restitution(MASS / (1 + MASS * arm ** 2 / moment))
    spin = MASS * (1 + e) * arm / (moment + MASS * arm ** 2)
    return e - spin * arm, spin


def paper(_effective):
    return RESTITUTION


def engine(effective):
    """LIGGGHTS sets the damping for the mass of the whole body; at a contact off the centre less of it takes part."""
    damping = -math.log(RESTITUTION) / math.hypot(math.log(RESTITUTION), math.pi) * math.sqrt(MASS / effective)
    return math.exp(-math.pi * damping / math.sqrt(1 - damping ** 2)) if damping < 1 else 0.0


def run(folder, *command):
    process = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    out = process.stdout.decode("utf-8", "replace")
    if process.returncode or "ERROR" in out:
        sys.exit(f"$ {' '.join(command)}\n{out[-2000:]}")


def make_clump(folder, spheres):
    run(folder, MSKIT, "shape", "tablet", "-o", "tablet.stl")
    if not os.path.exists(os.path.join(folder, f"{spheres}.liggghts.in")):
        run(folder, MSKIT, "generate", "tablet.stl", "-g", "setcover", "--deq", "100", "-n", str(spheres), "--correct",
            "--unit", "mm", "--density", repr(MASS / VOLUME), "-o", f"{spheres}.liggghts", "-o", f"{spheres}.json")
    with open(os.path.join(folder, f"{spheres}.liggghts.in"), encoding="ascii") as f:
        template = next(line for line in f if line.startswith("fix clump")).strip()
    with open(os.path.join(folder, f"{spheres}.liggghts"), encoding="ascii") as f:
        places = [[float(word) for word in line.split()] for line in f]
    return template, places, float(template.split("inertia_tensor ")[1].split()[3])


def states(path):
    """(mean velocity of the spheres, spin, mean place) of each dump."""
    with open(path, encoding="ascii") as f:
        lines = f.read().splitlines()
    at = 0
    while at < len(lines):
        count = int(lines[at + 3])
        rows = [[float(word) for word in line.split()] for line in lines[at + 9:at + 9 + count]]
        yield [sum(row[k] for row in rows) / count for k in range(1, 10)]
        at += 9 + count


def impact(folder, template, places, theta):
    """Velocity along z of the centre of mass and spin about y, after the first contact."""
    sine, cosine = math.sin(theta), math.cos(theta)
    depth = max(p[3] - (cosine * p[2] - sine * p[0]) for p in places)
    side = 1e-4  # of the box in which the centre is put
    with open(os.path.join(folder, "impact.in"), "w", encoding="ascii") as f:
        f.write(SCRIPT.format(young=2 * SHEAR * (1 + POISSON), poisson=POISSON, restitution=RESTITUTION, step=STEP,
                              wall=-side - depth - 1e-6, template=template, side=side,
                              turn=f"{math.cos(theta / 2)} 0 {math.sin(theta / 2)} 0"))
    run(folder, LIGGGHTS, "-in", "impact.in")
    # The mean of the spheres is off the centre of mass, about which a spin w_y adds -w_y * x to the velocity along z.
    mean = [sum(p[k] for p in places) / len(places) for k in range(3)]
    series, turned, before = [], theta, None
    for _, _, _, _, _, vz, _, wy, _ in states(os.path.join(folder, "states.txt")):
        turned += wy * 50 * STEP if before is not None else 0
        before = wy
        series.append((vz + wy * (math.cos(turned) * mean[0] + math.sin(turned) * mean[2]), wy))
    for now, soon, later in zip(series, series[2:], series[4:]):
        if abs(now[0] + 1) > 0.05 and max(abs(now[0] - soon[0]), abs(now[0] - later[0])) < 1e-3 \
                and max(abs(now[1] - soon[1]), abs(now[1] - later[1])) * BAND_RADIUS < 1e-3:
            return now
    sys.exit(f"no end of the contact at {math.degrees(theta)} degrees")


def plot(folder, sizes):
    if not shutil.which("gnuplot"):
        return
    commands = ["set datafile separator ','", "set terminal svg size 900,440 background rgb 'white'",
                "set output 'tablet-impact.svg'", "set multiplot layout 1,2", "set xlabel 'impact angle, degrees'",
                "set key outside below maxcols 2", "set xrange [-3:93]"]
    for title, column in (("velocity after / before", 0), ("spin after * band radius / velocity before", 1)):
        curves = [f"'tablet-impact.csv' skip 1 using 1:{2 + column} with lines title 'e = 0.6'",
                  f"'tablet-impact.csv' skip 1 using 1:{4 + column} with lines title 'e of the damping'"]
        curves += [f"'tablet-impact.csv' skip 1 using 1:{6 + 2 * k + column} with points title '{n} spheres'"
                   for k, n in enumerate(sizes)]
        commands += [f"set title '{title}'", "plot " + ", ".join(curves)]
    subprocess.run(["gnuplot", "-e", "; ".join(commands)], cwd=folder, check=False)


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "tablet-impact"
    sizes = [int(word) for word in sys.argv[2:]] or [96, 500]
    os.makedirs(folder, exist_ok=True)
    clumps = [make_clump(folder, n) for n in sizes]
    head = ["angle"] + [f"{what} {who}" for who in ["e=0.6", "damping"] + [str(n) for n in sizes]
                        for what in ("V", "w")]
    print("| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|")
    with open(os.path.join(folder, "tablet-impact.csv"), "w", encoding="ascii", newline="") as f:
        table = csv.writer(f)
        table.writerow(head)
        for angle in ANGLES:
            theta = math.radians(angle)
            row = [angle]
            for v, w in [truth(theta, clumps[0][2], paper), truth(theta, clumps[0][2], engine)] + \
                    [impact(folder, template, places, theta) for template, places, _ in clumps]:
                row += [v, abs(w) * BAND_RADIUS]
            table.writerow(row)
            print("| " + " | ".join(f"{x:g}" if k == 0 else f"{x:.3f}" for k, x in enumerate(row)) + " |", flush=True)
    plot(folder, sizes)


if __name__ == "__main__":
    main()
