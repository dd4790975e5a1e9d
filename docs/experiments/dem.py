"""One body of spheres over a plane, in LIGGGHTS, LAMMPS and YADE: what the experiments of contact run.

A body is put where it is to be, with velocity and spin; its kinetic energies come back at regular steps. Units are SI,
the plane is z = 0, there is no friction. A restitution of 1 is no damping at all.
"""
import math
import os
import re
import subprocess
from collections import namedtuple

ENGINES = {"LIGGGHTS": "liggghts", "LAMMPS": "lmp", "YADE": "yade"}
DENSITY = 2500.0

# spheres: x, y, z, r about the centre of mass; moments along the rows of axes; member: mass of each sphere over that of
# the body (in LIGGGHTS, which has none of each, the density of all over DENSITY)
Body = namedtuple("Body", "spheres mass moments axes member", defaults=(1.0,))
# hertz: Young's modulus; linear: stiffness of each contact, which YADE has from the modulus: stiffness over radius
Law = namedtuple("Law", "kind young poisson restitution stiffness", defaults=(0.0,))
Start = namedtuple("Start", "height velocity spin gravity")


def tensor(body):
    """Inertia along x, y, z."""
    return [[sum(i * a[m] * a[n] for i, a in zip(body.moments, body.axes)) for n in range(3)] for m in range(3)]


def reach(body):
    return max(math.hypot(*s[:3]) + s[3] for s in body.spheres)


def damping_ratio(restitution):
    """b of a linear oscillator, or of a Hertz contact that is damped as overlap^(1/4): Antypov and Elliott 2011."""
    log = math.log(restitution)
    return -log / math.hypot(math.pi, log)


def tsuji(restitution):
    """What LAMMPS has to be asked for: x at which its polynomial is root 5 b (docs/templates.md)."""
    def polynomial(x):
        return (1.2728 - 4.2783 * x + 11.087 * x ** 2 - 22.348 * x ** 3 + 27.467 * x ** 4 - 18.022 * x ** 5
                + 4.8218 * x ** 6)
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if polynomial(middle) > math.sqrt(5) * damping_ratio(restitution) else (low, middle)
    return low


def numbers(values):
    return " ".join(repr(float(x)) for x in values)


def run_program(folder, runs, samples, *command):
    """Rows of energies, translation and spin, of each of so many runs. LAMMPS ends where a body flies off: the rest,
    which takes larger steps, is infinite."""
    out = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, check=False,
                         env=dict(os.environ, OMP_NUM_THREADS="1")).stdout.decode("utf-8", "replace")
    rows = [[float(x) for x in line.split()[1:]] for line in re.findall(r"(?m)^ENERGY .*", out)]
    if "missing on proc" in out:
        rows += [[math.inf, math.inf]] * (runs * (samples + 1) - len(rows))
    if len(rows) != runs * (samples + 1):
        raise RuntimeError(f"{' '.join(command)} in {folder} has printed {len(rows)} energies:\n{out[-2000:]}")
    return [rows[k:k + samples + 1] for k in range(0, len(rows), samples + 1)]


def write(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="ascii") as f:
        f.write(text)


def run_liggghts(folder, body, law, start, steps, samples, every):
    far = 1000 * reach(body)
    if law.kind == "hertz":
        model, damping = "hertz", ""
    else:
        model = "hooke/stiffness"
        # a coefficient times the mass: 2 b root(k / m)
        rate = 2 * damping_ratio(law.restitution) * math.sqrt(law.stiffness / body.mass) if law.restitution < 1 else 0
        damping = "".join(f"fix {name} all property/global {name} peratomtypepair 1 {value!r}\n" for name, value in (
            ("kn", law.stiffness), ("kt", 0.0), ("gamman", rate), ("gammat", 0.0)))
    write(folder, "spheres", "".join(numbers(s) + "\n" for s in body.spheres))
    inertia = tensor(body)
    six = numbers([inertia[0][0], inertia[0][1], inertia[0][2], inertia[1][1], inertia[1][2], inertia[2][2]])
    box = f"-{far!r} {far!r} " * 2

    def tell(number):
        """A fix prints at multiples of `every`, and the body is there from step 1 on. Each run begins anew, with the
        velocity of a whole step in the damping: of no matter but where each step is looked at."""
        energies = 'print "ENERGY ${motion} ${spin}"\n'
        if every == 1:
            return f"fix energies all {energies.replace('print', 'print 1').strip()} screen yes\nrun {samples}\n"
        return f"variable k loop {samples}\nlabel again{number}\nrun {every}\n{energies}next k\njump in again{number}\n"

    write(folder, "in", "clear\n".join(f"""atom_style granular
atom_modify map array
communicate single vel yes
boundary f f f
newton off
units si
region box block {box} -{far!r} {far!r} units box
create_box 1 box
neighbor {far / 8!r} bin
neigh_modify delay 0
hard_particles yes
soft_particles yes
fix young all property/global youngsModulus peratomtype {law.young!r}
fix poisson all property/global poissonsRatio peratomtype {law.poisson!r}
fix restitution all property/global coefficientRestitution peratomtypepair 1 {law.restitution!r}
fix friction all property/global coefficientFriction peratomtypepair 1 0
{damping}pair_style gran model {model}
pair_coeff * *
fix floor all wall/gran model {model} primitive type 1 zplane 0
timestep {step!r}
fix gravity all gravity {start.gravity!r} vector 0 0 -1
fix clump all particletemplate/multisphere 15485863 atom_type 1 volume_limit 1e-300 density constant &
  {body.member * DENSITY!r} nspheres {len(body.spheres)} ntry 1000 spheres file spheres scale 1.0 type 1 &
  mass {body.mass!r} inertia_tensor {six} use_density
fix kinds all particledistribution/discrete 15485867 1 clump 1.0
region at block -1e-15 1e-15 -1e-15 1e-15 {start.height - 1e-15!r} {start.height + 1e-15!r} &
  volume_limit 1e-300 units box
fix insert all insert/pack seed 32452843 distributiontemplate kinds vel constant {numbers(start.velocity)} &
  omega constant {numbers(start.spin)} insert_every once overlapcheck no orientation constant 1 0 0 0 all_in no &
  particles_in_region 1 region at
fix move all multisphere
compute motion all ke/multisphere
compute spin all erotate/multisphere
thermo_style custom step atoms c_motion c_spin
thermo_modify lost ignore
thermo 1000000000
variable motion equal c_motion
variable spin equal c_spin
run 1
print "ENERGY ${{motion}} ${{spin}}"
{tell(number)}""" for number, step in enumerate(steps)))
    return run_program(folder, len(steps), samples, "liggghts", "-in", "in", "-log", "none")


def run_lammps(folder, body, law, start, steps, samples, every):
    far = 1000 * reach(body)
    if law.kind == "hertz":
        damping = (f"{tsuji(law.restitution)!r} {law.poisson!r} tangential linear_nohistory 0 0 damping tsuji"
                   if law.restitution < 1 else f"0 {law.poisson!r} tangential linear_nohistory 0 0 damping velocity")
        contact = f"hertz/material {law.young!r} {damping}"
    else:
        rate = 2 * damping_ratio(law.restitution) * math.sqrt(law.stiffness / body.mass) if law.restitution < 1 else 0.0
        contact = f"hooke {law.stiffness!r} {rate!r} tangential linear_nohistory 0 0 damping mass_velocity"
    n = len(body.spheres)
    atoms = "".join(f"{k + 1} 1 {2 * r!r} {body.member * body.mass / (math.pi / 6 * (2 * r) ** 3)!r} {x!r} {y!r} "
                    f"{z + start.height!r}\n" for k, (x, y, z, r) in enumerate(body.spheres))
    write(folder, "spheres", f"spheres\n\n{n} atoms\n1 atom types\n"
          + "".join(f"-{far!r} {far!r} {a}lo {a}hi\n" for a in "xyz") + f"\nAtoms # sphere\n\n{atoms}\nMolecules\n\n"
          + "".join(f"{k + 1} 1\n" for k in range(n)))
    inertia = tensor(body)
    six = [inertia[0][0], inertia[1][1], inertia[2][2], inertia[0][1], inertia[0][2], inertia[1][2]]
    momentum = [sum(inertia[m][k] * start.spin[k] for k in range(3)) for m in range(3)]
    for number, step in enumerate(steps):
        # The half kick that begins the first step comes from contacts alone, without the weight.
        velocity = [*start.velocity[:2], start.velocity[2] - start.gravity * step / 2]
        write(folder, f"bodies{number}", "1\n1 " + numbers([body.mass, 0, 0, start.height, *six, *velocity, *momentum])
              + " 0 0 0\n")
    # One run each: in a second one the wall would be damped anew (docs/templates.md).
    write(folder, "in", "clear\n".join(f"""units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
fix molecules all property/atom mol ghost yes
read_data spheres fix molecules NULL Molecules
comm_modify vel yes cutoff {2 * reach(body)!r}
neighbor {far / 8!r} bin
neigh_modify delay 0 exclude molecule/intra all
pair_style granular
pair_coeff * * {contact}
fix floor all wall/gran granular {contact} zplane 0 NULL
timestep {step!r}
fix gravity all gravity {start.gravity!r} vector 0 0 -1 disable
fix move all rigid/small molecule infile bodies{number} reinit no gravity gravity
compute motion all ke/rigid move
compute spin all erotate/rigid move
variable motion equal c_motion
variable spin equal c_spin
thermo_style custom step atoms c_motion c_spin
thermo_modify lost ignore
thermo {every}
fix energies all print {every} "ENERGY ${{motion}} ${{spin}}"
run {samples * every}
""" for number, step in enumerate(steps)))
    return run_program(folder, len(steps), samples, "lmp", "-in", "in", "-log", "none")


def run_yade(folder, body, law, start, steps, samples, every):
    damping = f"en={law.restitution!r}" if law.restitution < 1 else ""
    if law.kind == "hertz":
        physics, contact = f"Ip2_FrictMat_FrictMat_MindlinPhys({damping})", "Law2_ScGeom_MindlinPhys_Mindlin()"
    elif law.restitution == 1:
        physics, contact = "Ip2_FrictMat_FrictMat_FrictPhys()", "Law2_ScGeom_FrictPhys_CundallStrack()"
    else:
        raise ValueError("the linear law of YADE has no damping of contacts")
    arm = min(s[3] for s in body.spheres)
    cross = [[sign * length * arm * x for x in axis] for length, axis in ((1, body.axes[0]), (0.5, body.axes[1]))
             for sign in (-1, 1)]
    write(folder, "in.py", f"""
def material(name, density):
    O.materials.append(FrictMat(label=name, young={law.young!r}, poisson={law.poisson!r}, density=density,
                                frictionAngle=0))


def build():
    \"\"\"As the templates do: weightless spheres, and a cross that has the mass.\"\"\"
    O.reset()
    material('matter', {DENSITY})
    material('weightless', 0)
    material('cross', 1)
    O.bodies.append(wall(0, axis=2, material='matter'))
    centre = Vector3(0, 0, {start.height!r})
    spheres = [sphere(centre + Vector3(*s[:3]), s[3], material='weightless') for s in {body.spheres!r}]
    cross = [sphere(centre + Vector3(*at), {1e-3 * arm!r}, material='cross') for at in {cross!r}]
    clump, members = O.bodies.appendClumped(spheres + cross)
    for i in members:
        O.bodies[i].mat = O.materials['matter']
        O.bodies[i].state.mass = {body.member * body.mass!r}
    for part in cross:
        part.mask = 0
    return O.bodies[clump].state


def tell(state):
    spin = state.ori.conjugate() * state.angVel
    turning = 0.5 * sum(i * w * w for i, w in zip(state.inertia, spin))
    print('ENERGY', 0.5 * state.mass * state.vel.squaredNorm(), turning)


for step in {list(steps)!r}:
    state = build()
    state.mass, state.inertia = {body.mass!r}, Vector3({", ".join(repr(i) for i in body.moments)})
    state.vel, state.angVel = Vector3(*{list(start.velocity)!r}), Vector3(*{list(start.spin)!r})
    state.angMom = state.ori * Vector3(*[i * w for i, w in zip(state.inertia, state.ori.conjugate() * state.angVel)])
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
        InteractionLoop([Ig2_Wall_Sphere_ScGeom()], [{physics}], [{contact}]),
        NewtonIntegrator(damping=0, gravity=(0, 0, {-start.gravity!r})),
    ]
    O.dt = step
    tell(state)
    for k in range({samples}):
        O.run({every}, True)
        tell(state)
""")
    return run_program(folder, len(steps), samples, "yade", "-x", "-n", "in.py")


# run(folder, body, law, start, steps, samples, every): for each of the time steps a run of its own, and of each the
# energies at its start and then `samples` times, `every` steps apart; 0 once the body has left the box
RUN = {"LIGGGHTS": run_liggghts, "LAMMPS": run_lammps, "YADE": run_yade}
