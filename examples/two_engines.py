"""One pose and one Jacobian from two engines, and the screws they follow from."""

import numpy as np

import pinscrew as ps

robot = ps.load("anthropomorphic_rrr", l1=1.0, l2=0.5, l3=0.5)
poe, pin = ps.PoE(robot), ps.Pinocchio(robot)

q = np.deg2rad([30.0, -45.0, 60.0])
print("pose of the tool:", poe.fk(q), sep="\n")
print("the engines differ by", abs(poe.fk(q) - pin.fk(q)).max())

for name, twist in zip(robot.joint_names, robot.screws().T, strict=True):
    print(name, ps.Screw.from_twist(twist))

for kind in ("spatial", "body", "hybrid"):
    difference = abs(poe.jacobian(q, None, kind) - pin.jacobian(q, None, kind)).max()
    print(f"{kind} Jacobian: the engines differ by {difference:.1e}")

print(ps.verify(robot, samples=100))
