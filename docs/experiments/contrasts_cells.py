"""The clumps of contrasts.py: for the M&M candy of packing.py and for a grain, of the candy's volume unless their radii
were changed."""
import json
import math
import os
import sys
from collections import namedtuple

from bed import FRICTION
from packing import A, C, DENSITY, MASS, RESTITUTION, YOUNG, find_candy
from program import run_mskit
import tables  # of docs, where packing looks

# radii: factor on all of them, with places, mass and inertia as they were; rolling: coefficient of rolling friction;
# e: restitution asked for; undone: modulus and restitution by which mskit contact undoes contacts side by side;
# friction: of particles with each other and with the floor; body: candy or grain
Cell = namedtuple("Cell", "method n radii rolling e undone friction body",
                  defaults=(1.0, 0.0, RESTITUTION, False, FRICTION, "candy"))
GRAIN = os.environ.get("GRAIN")  # names the mesh of the cells grain-N
CELLS = {
    "sphere-0": Cell("sphere", 1),
    **{f"variational-{n}": Cell("variational", n) for n in (2, 3, 5, 10, 20)},
    "variational-10-small": Cell("variational", 10, 0.97),
    "variational-10-large": Cell("variational", 10, 1.03),
    "euclid-20": Cell("euclid", 20),
    "setcover-10": Cell("setcover", 10),
    "sphere-0.1": Cell("sphere", 1, 1.0, 0.1),
    **{f"variational-{n}": Cell("variational", n) for n in (60, 120, 265)},
    "smooth": Cell("smooth", 0),  # the candy itself, a superquadric
    "smooth-ball": Cell("smooth", 1),  # the ball of sphere-0 as a superquadric
}
# Two of the cells again, since stiffness and damping change with the number of spheres.
CONTROLLED = ["variational-3", "variational-10"]
CONTROLS = {f"{name}-{what}": CELLS[name]._replace(**changed) for name in CONTROLLED for what, changed in
            (("e0.2", {"e": 0.2}), ("e0.8", {"e": 0.8}), ("undone", {"undone": True}))}
# Whether bumps act as friction does: the candy with more of it, and the clump with less.
FRICTIONS = {f"{name}-f{friction}": CELLS[name]._replace(friction=friction) for name, friction in
             (("smooth", 0.5), ("smooth", 0.7), ("variational-10", 0.2))}
# A second body, of which nothing is fitted.
GRAINS = {f"grain-{n}": Cell("variational", n, body="grain") for n in (2, 3, 5, 10, 20, 60)}
SERIES = ["sphere-0"] + [f"variational-{n}" for n in (2, 3, 5, 10, 20, 60, 120, 265)]
ENVELOPE = 0.5  # radius over r_eq of the ball whose envelope is taken
HIDDEN = 1e-2  # radius of a sphere within a single one, which LIGGGHTS wants beside it, over that of the latter

COLUMNS = ["cell", "method", "n", "radii", "rolling", "dice", "volume", "mean_width", "normal_median", "convexity",
           "envelope", "contacts"]


def find_cell(name):
    return {**CELLS, **CONTROLS, **FRICTIONS, **GRAINS}[name]


def write_rows(path, rows, head="", between=" "):
    with open(path, "w", encoding="ascii") as stream:
        stream.write(head + "".join(between.join(repr(x) for x in row) + "\n" for row in rows))


def read_rows(path):
    with open(path, encoding="ascii") as stream:
        return [[float(x) for x in line.split()] for line in stream]


def tell_template(name, file, spheres, tensor, prime=15485863, number=1):
    """LIGGGHTS' line for a template of the candy's mass and density, no line end. tensor: xx, xy, xz, yy, yz, zz in
    kg m^2; prime and number: each template's own."""
    return (f"fix {name} all particletemplate/multisphere {prime} atom_type 1 volume_limit 1e-300 "
            f"density constant {DENSITY} nspheres {spheres} ntry 1000 spheres file \"{file}\" "
            f"scale 1.0 type {number} mass {MASS!r} inertia_tensor {' '.join(map(repr, tensor))} use_density")


def write_sphere(path):
    """A ball of the candy's volume and density, with the inertia of a ball."""
    r = (A * A * C) ** (1 / 3) * 1e-3
    write_rows(path, [[0.0, 0.0, 0.0, r], [0.0, 0.0, 0.0, HIDDEN * r]])
    i = 0.4 * MASS * r * r
    with open(path + ".in", "w", encoding="ascii") as stream:
        stream.write(tell_template("clump", os.path.basename(path), 2, [i, 0, 0, i, 0, i]) + "\n")


def find_body(folder, cell):
    """Its mesh, and what else generate takes: the unit in which it has the candy's volume."""
    if cell.body == "candy":
        return find_candy(folder), ["--unit", "mm"]
    volume = json.loads(run_mskit("info", GRAIN, "--json")).get("volume")
    if not volume:
        sys.exit(f"{GRAIN}: a mesh that is not closed has no volume to scale it by; mskit info says what is open")
    return GRAIN, ["--scale", repr(1e-3 * (4 / 3 * math.pi * A * A * C / volume) ** (1 / 3))]


def write_clump(folder, path, cell):
    if cell.method == "sphere":
        write_sphere(path)
    else:
        # Scaled after the fit, as other methods are: the rows that are there are of these clumps.
        scaled = ["--set", "hold-volume=0"] if cell.method == "variational" else []
        mesh, unit = find_body(folder, cell)
        run_mskit("generate", mesh, "-g", cell.method, *scaled, "-n", cell.n, "--deq", 100, "--equal-volume",
                  "--correct", "--density", DENSITY, *unit, "-o", path, "-o", find_spheres(path))
    write_rows(path, [[x, y, z, cell.radii * r] for x, y, z, r in read_rows(path)])


def find_spheres(template):
    return os.path.splitext(template)[0] + ".csv"


def write_spheres(folder, name):
    """The clump as CSV in the unit and frame of its body. Templates lie along principal axes, which are the candy's own
    but for a turn about its axis; a grain's is left as generate wrote it."""
    template, cell = os.path.join(folder, name + ".liggghts"), find_cell(name)
    if cell.body == "candy":
        spheres = [[1000 * x for x in row] for row in read_rows(template)]
        write_rows(find_spheres(template), spheres[:cell.n], "x,y,z,r\n", ",")
    return find_spheres(template)


def ask_contact(folder, name, *words):
    return json.loads(run_mskit("contact", write_spheres(folder, name), "--target",
                                find_body(folder, find_cell(name))[0], "--overlap", 0.002, "--json", *words))


def at_random(rows):
    """Of what mskit contact lists, that of a pair that meets at random."""
    (pair,) = [row for row in rows if (row["against"], row["where"]) == ("particle", "random")]
    return pair


def find_law(folder, name):
    """Young's modulus in Pa and restitution of the engine's material."""
    cell = find_cell(name)
    if not cell.undone:
        return {"young": YOUNG, "e": cell.e}
    factors = at_random(ask_contact(folder, name, "--restitution", cell.e, "--factors")["factors"])
    return {"young": YOUNG * factors["modulus"], "e": factors["restitution"]}


def make_smooth(name):
    axes = " ".join(repr(1e-3 * x) for x in ([(A * A * C) ** (1 / 3)] * 3 if name == "smooth-ball" else (A, A, C)))
    return {"template": f"fix clump all particletemplate/superquadric 15485863 atom_type 1 volume_limit 1e-300 density "
                        f"constant {DENSITY} shape constant {axes} blockiness constant 2 2",
            "kinds": "1 clump 1.0", "rolling": 0.0, "friction": find_cell(name).friction, "members": 1, "young": YOUNG,
            "e": RESTITUTION, "smooth": True}


def make(folder, name):
    """The template's line for LIGGGHTS and what its distribution names, its number of spheres, rolling friction,
    friction, modulus in Pa, restitution. What is in the folder is taken."""
    cell, path = find_cell(name), os.path.join(folder, name + ".liggghts")
    if cell.method == "smooth":
        return make_smooth(name)
    if not os.path.exists(path + ".in"):
        write_clump(folder, path, cell)
    with open(path + ".in", encoding="utf-8") as stream:
        line = next(line for line in stream if line.startswith("fix clump "))
    return {"template": line.replace(os.path.basename(path), os.path.abspath(path)).strip(), "kinds": "1 clump 1.0",
            "rolling": cell.rolling, "friction": cell.friction, "members": len(read_rows(path)), "smooth": False,
            **find_law(folder, name)}


def describe(folder, name):
    """A row of contrasts-clumps.csv: what may predict how the clump acts."""
    cell = find_cell(name)
    make(folder, name)
    scores = json.loads(run_mskit("score", write_spheres(folder, name), "--target", find_body(folder, cell)[0], "--deq",
                                  100, "--json"))["scores"]
    contact = ask_contact(folder, name, "--envelope", ENVELOPE)
    (found,) = contact["envelopes"]
    beyond = {what: found[what + "_envelope"] / found[what + "_volume"] for what in ("clump", "shape")}
    return {"cell": name, "method": cell.method, "n": cell.n, "radii": cell.radii, "rolling": cell.rolling,
            "dice": scores["dice"], "volume": scores["off_volume"],
            "mean_width": contact["clump"]["mean_width"] / contact["shape"]["mean_width"],
            "normal_median": scores["normal_median"],
            "convexity": scores["clump_convexity"] / scores["shape_convexity"],
            "envelope": beyond["clump"] / beyond["shape"],
            "contacts": at_random(contact["contacts"])["contacts"]}


def describe_all(folder, path):
    """Adds those that are not in the table yet."""
    there = {row["cell"] for row in tables.read_if_there(path)}
    for name, cell in {**CELLS, **(GRAINS if GRAIN else {})}.items():
        if name not in there and cell.method != "smooth":
            tables.add_row(path, COLUMNS, describe(folder, name))


