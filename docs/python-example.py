"""From a scan to templates in Python: to be run whole, or cell by cell (`# %%`) in Jupyter, VS Code or Spyder.

    python3 docs/python-example.py
"""
# %% A scan of grains: labels [z, y, x]. Here it is made of two ellipsoids; numpy.load or tifffile.imread give yours.
import numpy

import mskit

z, y, x = numpy.indices((40, 40, 90))
scan = numpy.zeros(z.shape, numpy.uint16)
scan[((x - 22) / 18) ** 2 + ((y - 20) / 14) ** 2 + ((z - 20) / 11) ** 2 < 1] = 1
scan[((x - 66) / 16) ** 2 + ((y - 20) / 16) ** 2 + ((z - 20) / 9) ** 2 < 1] = 2

# %% A clump for each grain. A voxel is 0.05 mm wide, so that lengths are in mm.
clumps = {}
for grain in mskit.grains(scan, spacing=0.05, border=False):
    clumps[grain.label] = mskit.generate(grain, "variational", spheres=20)
    print(f"grain {grain.label}: {grain.volume:.3f} mm^3, D = {clumps[grain.label].scores['dice']:.4f}")

# %% In a notebook the last line of a cell shows the clump in 3-D, beside the grain.
clumps[1]

# %% Which method, and how many spheres? A curve of each is arrays, ready for matplotlib.
for method in ("mss", "setcover"):
    clump = mskit.generate(grain, method, spheres=30)
    curve = mskit.curve(clump)
    enough = curve["spheres"][curve["dice"] < 0.06]
    print(f"{method}: D of 10 and 30 spheres {curve['dice'][9]:.3f}, {curve['dice'][-1]:.3f}; "
          f"below 0.06 with {enough[0] if len(enough) else 'more than 30'}")

# %% How many spheres is each grain worth, in a scene of 500 of the first and 80 of the second?
curves = [mskit.curve(mskit.generate(grain, "mss", spheres=30))["dice"]
          for grain in mskit.grains(scan, spacing=0.05, border=False)]
worth = mskit.allocate(curves, [500, 80], budget=6000)
print(f"{worth.spheres[0]} and {worth.spheres[1]} spheres: mean D = {worth.mean_dice:.3f}; "
      f"ten each: {(500 * curves[0][9] + 80 * curves[1][9]) / 580:.3f}")

# %% How does it touch a plane: how many spheres at once, and what rebounds of a contact's e = 0.5?
touch = mskit.contact(clumps[1], poses=200, overlap=0.002)
for row in touch["contacts"][:2]:
    print(f"{row['where']}: {row['contacts']:.2f} spheres at once, e = {row['restitution']:.2f}")

# %% True mass and inertia, made exact by a few carriers, and a template for an engine.
for label, clump in clumps.items():
    heavy = mskit.correct(clump, density=2650, unit="mm", carriers=True)
    heavy.write(f"grain-{label}.lammps")
    print(f"grain {label}: {heavy.particle.mass * 1e6:.3f} mg, moments within {heavy.mass_report['epsilon']:.1g}, "
          f"carriers {len(heavy.carriers or ())}")
clumps[1].write("grain-1.html")  # the same view as a file
