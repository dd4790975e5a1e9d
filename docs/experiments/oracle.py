"""What an impact of a body of spheres on a plane is to give: closed forms, and the body as an oscillator.

Contacts are by Hertz with a damping of 2 root(5/6) b root(S m), S = 2 E* root(R x), for the mass m of the whole body
(LIGGGHTS, and LAMMPS with `damping tsuji`). In YADE a contact never attracts.
"""
import math
from collections import namedtuple

from dem import damping_ratio, tensor

# e: root of the part of the energy that is left; number: of equal contacts that are as damped, at the largest overlap
Impact = namedtuple("Impact", "e touching number overlap omega seconds")


def wall_modulus(law, engine):
    """4/3 of it times root(R) is the force over overlap^(3/2), with a wall of the same stuff: E / 2 (1 - nu^2) in
    LIGGGHTS, 1 + nu times that in LAMMPS, while YADE takes half the radius (measured by `contact.py walls`)."""
    factor = {"LIGGGHTS": 1, "LAMMPS": 1 + law.poisson, "YADE": math.sqrt(0.5)}[engine]
    return factor * law.young / (1 - law.poisson ** 2) / 2


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rebound(b, attracts):
    """Restitution at a damping ratio b: of the linear oscillator, that of Hertz with overlap^(1/4) being the same in
    another time (Antypov and Elliott 2011). Without attraction the contact ends with the force (Schwager and Poeschel
    2007)."""
    if b >= 1:
        return 0.0 if attracts else math.exp(-2 * b * math.acosh(b) / math.sqrt(b * b - 1))
    return math.exp(-b * (math.pi if attracts else 2 * math.acos(b)) / math.sqrt(1 - b * b))


def ratio_of(restitution, attracts):
    """b that one contact has."""
    if attracts:
        return damping_ratio(restitution)
    low, high = 0.0, 0.99
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if rebound(middle, False) > restitution else (low, middle)
    return low


def closed_form(restitution, number, engine):
    """e(N) of N contacts that are each damped for the mass of the whole body."""
    attracts = engine != "YADE"
    return rebound(ratio_of(restitution, attracts) * math.sqrt(number), attracts)


def inverse(a):
    """Of a symmetric 3 x 3 matrix."""
    columns = [cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])]
    det = sum(x * y for x, y in zip(a[0], columns[0]))
    return [[columns[n][m] / det for n in range(3)] for m in range(3)]


def impact(body, law, speed, engine):
    """The body falls on the plane without friction; it turns little while it touches. Height and two angles, by steps
    of 1/200 of 1/omega; the energy when it has left, or when nothing more comes of it."""
    attracts = engine != "YADE"
    b = ratio_of(law.restitution, attracts)
    base = min(s[2] - s[3] for s in body.spheres)
    modulus = wall_modulus(law, engine)
    size = max(s[3] for s in body.spheres)
    deepest = (15 * body.mass * speed ** 2 / (16 * modulus * math.sqrt(min(s[3] for s in body.spheres)))) ** 0.4
    feet = [(x, y, z - r - base, r) for x, y, z, r in body.spheres if z - r - base < 2 * deepest]
    turn = inverse(tensor(body))
    guess = math.sqrt(2 * modulus * math.sqrt(size * deepest) * len(feet) / body.mass)
    step = 0.005 / guess
    v, q = [-speed, 0.0, 0.0], [0.0, 0.0, 0.0]
    best, time, apart = (0.0, 0, 0.0, 0.0), 0.0, 0
    limit = 30 / math.sqrt(2 * modulus * math.sqrt(size * deepest) / body.mass)
    while time < limit and apart < 400:
        force, lift_x, lift_y, touching, stiffness, damping, deep = 0.0, 0.0, 0.0, 0, 0.0, 0.0, 0.0
        for x, y, gap, r in feet:
            overlap = -(gap + q[0] + q[1] * y - q[2] * x)
            if overlap <= 0:
                continue
            rate = -(v[0] + v[1] * y - v[2] * x)
            s = 2 * modulus * math.sqrt(r * overlap)
            push = 2 / 3 * s * overlap + 2 * math.sqrt(5 / 6) * b * math.sqrt(s * body.mass) * rate
            push = push if attracts else max(push, 0.0)
            force, lift_x, lift_y = force + push, lift_x + y * push, lift_y - x * push
            touching, stiffness, damping, deep = touching + 1, stiffness + s, damping + math.sqrt(s), max(deep, overlap)
        if deep > best[0]:
            best = (deep, touching, damping ** 2 / stiffness, math.sqrt(stiffness / body.mass))
        v[0] += step * force / body.mass
        v[1] += step * (turn[0][0] * lift_x + turn[0][1] * lift_y)
        v[2] += step * (turn[1][0] * lift_x + turn[1][1] * lift_y)
        q = [a + step * c for a, c in zip(q, v)]
        apart = apart + 1 if deep == 0 and time > 0 else 0
        time += step
    energy = body.mass * v[0] ** 2 + spin_energy(turn, v[1], v[2])
    return Impact(math.sqrt(energy / (body.mass * speed ** 2)), best[1], best[2], best[0], best[3], time)


def spin_energy(turn, x, y):
    """w L: L has no part along z, as no push turns about it."""
    det = turn[0][0] * turn[1][1] - turn[0][1] ** 2
    momentum = [(turn[1][1] * x - turn[0][1] * y) / det, (turn[0][0] * y - turn[0][1] * x) / det]
    return momentum[0] * x + momentum[1] * y
